"""Archives of solids: a tar of ``NNNNN.bin.zst`` members and an index of JSON lines beside it.

A member is a solid in OCCT's binary form (``BinTools``, without triangles) under Zstandard. The
index of ``DIR/NAME.tar`` is ``DIR/index_NAME.jsonl``: one object a member, in order, with its
``id`` (``NAME/NNNNN``). Both grow together, so that a stopped run can be taken up again.
"""

import io
import json
import os
import tarfile
from pathlib import Path
from types import TracebackType

import zstandard
from OCP.BinTools import BinTools, BinTools_FormatVersion
from OCP.TopoDS import TopoDS_Shape

BLOCK = tarfile.BLOCKSIZE


def packed(shape: TopoDS_Shape, level: int = 10) -> bytes:
    """A shape as a member's bytes."""
    out = io.BytesIO()
    version = BinTools_FormatVersion.BinTools_FormatVersion_VERSION_4
    BinTools.Write_s(shape, out, False, False, version)
    return zstandard.ZstdCompressor(level=level).compress(out.getvalue())


def index_path(archive: str | Path) -> Path:
    archive = Path(archive)
    return archive.with_name(f"index_{archive.stem}.jsonl")


class ArchiveWriter:
    """Appends members and index lines; opening an archive that is there goes on with it.

    ``records`` are the index's objects so far. An archive and an index that a stopped run left
    out of step are cut back to what both have. Use it as a context manager.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.records: list[dict] = []
        end = 0
        if self.path.exists():
            self.records, end = _common_part(self.path, index_path(self.path))
        self._tar = open(self.path, "r+b" if self.path.exists() else "w+b")  # noqa: SIM115
        self._tar.truncate(end)
        self._tar.seek(end)
        lines = "".join(_line(r) for r in self.records)
        index_path(self.path).write_text(lines, "utf-8")
        self._index = open(index_path(self.path), "a", encoding="utf-8")  # noqa: SIM115

    def add(self, name: str, data: bytes, record: dict) -> None:
        """Writes one member, then its line."""
        header = tarfile.TarInfo(name)
        header.size = len(data)
        self._tar.write(header.tobuf(tarfile.USTAR_FORMAT))
        self._tar.write(data + b"\0" * (-len(data) % BLOCK))
        self._tar.flush()
        record = {"id": f"{self.path.stem}/{name.partition('.')[0]}", **record}
        self._index.write(_line(record))
        self._index.flush()
        self.records.append(record)

    def __enter__(self) -> "ArchiveWriter":
        return self

    def __exit__(
        self, kind: type | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        # A tar ends with two blocks of zeros, padded to a record.
        self._tar.write(b"\0" * 2 * BLOCK)
        self._tar.write(b"\0" * (-self._tar.tell() % tarfile.RECORDSIZE))
        self._tar.close()
        self._index.close()


def _line(record: dict) -> str:
    return json.dumps(record) + "\n"


def _common_part(archive: Path, index: Path) -> tuple[list[dict], int]:
    """The index lines that the archive has members for, and where the last of these ends.

    Raises ``FileNotFoundError`` without an index, ``ValueError`` if the two are not of a pair.
    """
    whole = index.read_text("utf-8").split("\n")[:-1]  # what follows the last line end is torn
    records = [json.loads(line) for line in whole]
    size, end, count = os.path.getsize(archive), 0, 0
    with open(archive, "rb") as raw:
        while count < len(records):
            raw.seek(end)
            head = raw.read(BLOCK)
            if len(head) < BLOCK or not any(head):
                break
            member = tarfile.TarInfo.frombuf(head, "utf-8", "strict")
            following = end + BLOCK + -(-member.size // BLOCK) * BLOCK
            if following > size:
                break
            if records[count]["id"] != f"{archive.stem}/{member.name.partition('.')[0]}":
                raise ValueError(f"{index} is not the index of {archive}: member {member.name}")
            end, count = following, count + 1
    return records[:count], end
