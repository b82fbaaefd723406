"""Solids in files: STEP, BREP, FCStd, BinTools' binary form, and archives of all these.

A ``.zst`` suffix means Zstandard around any of them. An ``Item`` is one file or one member of an
archive; reading it gives its distinct solids, in an order that is always the same.
"""

from __future__ import annotations

import json
import re
import tarfile
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path, PurePosixPath

import zstandard
from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.BRepTools import BRepTools
from OCP.IFSelect import IFSelect_RetDone
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopExp import TopExp
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Shape, TopoDS_Solid
from OCP.TopTools import TopTools_IndexedMapOfShape

from .errors import ProjectionError, kernel_errors, require

SOLID_FILE = re.compile(r"\.(step|stp|brep|brp|bin|fcstd)(\.zst)?$", re.IGNORECASE)
ARCHIVE = re.compile(r"\.(tar|tgz|tar\.(gz|bz2|xz|zst))$", re.IGNORECASE)


@dataclass(frozen=True)
class Item:
    """A file of solids, or ``member`` of the archive ``path``.

    ``name`` identifies it in drawings; ``source`` says where the solids came from.
    """

    path: str
    member: str | None
    name: str
    source: str


def list_items(paths: list[str | Path]) -> list[Item]:
    """The items of files, archives and directories (searched through), in a fixed order.

    Beside an archive ``STEM.tar`` a file ``index_STEM.jsonl`` may give, for each ``id``
    (``STEM/member``), ``repo``, ``path``, ``name`` and ``licence``: they become the source.
    Raises ``FileNotFoundError``, and ``ValueError`` for a file of another kind.
    """
    items: list[Item] = []
    for path in map(Path, paths):
        if path.is_dir():
            for file in sorted(p for p in path.rglob("*") if p.is_file()):
                place = file.relative_to(path)
                if ARCHIVE.search(file.name):
                    items += _members(file)
                elif SOLID_FILE.search(file.name):
                    name = f"{path.name}/{SOLID_FILE.sub('', place.as_posix())}"
                    items.append(Item(str(file), None, name, place.as_posix()))
        elif not path.exists():
            raise FileNotFoundError(path)
        elif ARCHIVE.search(path.name):
            items += _members(path)
        elif SOLID_FILE.search(path.name):
            items.append(Item(str(path), None, SOLID_FILE.sub("", path.name), path.name))
        else:
            raise ValueError(f"{path}: neither a file of solids nor an archive of them")
    return items


def _members(path: Path) -> list[Item]:
    stem = ARCHIVE.sub("", path.name)
    index = _index(path.with_name(f"index_{stem}.jsonl"))
    items = []
    with _open_tar(path) as archive:
        for member in archive:
            if not (member.isfile() and SOLID_FILE.search(member.name)):
                continue
            name = f"{stem}/{SOLID_FILE.sub('', member.name)}"
            items.append(Item(str(path), member.name, name, index.get(name, member.name)))
    return items


def _index(path: Path) -> dict[str, str]:
    if not path.exists():
        return {}
    sources = {}
    for line in path.read_text("utf-8").splitlines():
        row = json.loads(line)
        if row.get("source") == "generated":
            place = f"generated, seed {row['seed']}, mix {row['mix']}, number {row['n']}"
        else:
            part = f":{row['name']}" if row.get("name") else ""
            place = f"github.com/{row.get('repo', '')} {row.get('path', '')}{part}"
            place += f" ({row.get('licence', 'licence unknown')})"
        sources[row["id"]] = place
    return sources


def _open_tar(path: Path) -> tarfile.TarFile:
    if path.name.lower().endswith(".zst"):
        with open(path, "rb") as raw:
            data = zstandard.ZstdDecompressor().stream_reader(raw, read_across_frames=True).read()
        return tarfile.open(fileobj=BytesIO(data))
    return tarfile.open(path)


class ItemReader:
    """Reads items; keeps the last archive open, since items come archive by archive."""

    def __init__(self) -> None:
        self._path: str | None = None
        self._archive: tarfile.TarFile | None = None

    def read(self, item: Item) -> list[TopoDS_Solid]:
        """The distinct solids of an item.

        Raises ``ProjectionError`` with ``unreadable`` or ``no-solid``.
        """
        solids = _distinct_solids(_shapes(item.member or item.path, self._bytes(item)))
        require(bool(solids), "no-solid")
        return solids

    def _bytes(self, item: Item) -> bytes:
        if item.member is None:
            return Path(item.path).read_bytes()
        if self._path != item.path:
            if self._archive is not None:
                self._archive.close()
            self._archive, self._path = _open_tar(Path(item.path)), item.path
        assert self._archive is not None
        member = self._archive.extractfile(item.member)
        require(member is not None, "unreadable", f"{item.member} is no file")
        return member.read()


def _shapes(name: str, data: bytes) -> Iterator[TopoDS_Shape]:
    """The shapes of a file's bytes; the name's suffix says of which form."""
    if name.lower().endswith(".zst"):
        try:
            reader = zstandard.ZstdDecompressor().stream_reader(data, read_across_frames=True)
            data = reader.read()
        except zstandard.ZstdError as error:
            raise ProjectionError("unreadable", str(error)) from error
        name = name[:-4]
    suffix = PurePosixPath(name).suffix.lower()
    if suffix != ".fcstd":
        yield _through_file(data, suffix)
        return
    try:
        with zipfile.ZipFile(BytesIO(data)) as document:
            for part in sorted(document.namelist()):
                kind = PurePosixPath(part).suffix.lower()
                if kind in (".brp", ".brep", ".bin"):
                    content = document.read(part)
                    if content:
                        yield _through_file(content, kind)
    except zipfile.BadZipFile as error:
        raise ProjectionError("unreadable", str(error)) from error


def _through_file(data: bytes, suffix: str) -> TopoDS_Shape:
    # OCCT's readers take file names; reading from memory is not bound reliably.
    with tempfile.NamedTemporaryFile(suffix=suffix) as file:
        file.write(data)
        file.flush()
        with kernel_errors("unreadable"):
            return _READERS[suffix](file.name)


def _read_step(path: str) -> TopoDS_Shape:
    reader = STEPControl_Reader()
    require(reader.ReadFile(path) == IFSelect_RetDone, "unreadable", "STEP")
    require(reader.TransferRoots() > 0, "unreadable", "STEP without shapes")
    return reader.OneShape()


def _read_brep(path: str) -> TopoDS_Shape:
    shape = TopoDS_Shape()
    done = BRepTools.Read_s(shape, path, BRep_Builder())
    require(done, "unreadable", "BREP")
    return shape


def _read_binary(path: str) -> TopoDS_Shape:
    shape = TopoDS_Shape()
    require(BinTools.Read_s(shape, path), "unreadable", "binary BREP")
    return shape


_READERS: dict[str, Callable[[str], TopoDS_Shape]] = {
    ".step": _read_step,
    ".stp": _read_step,
    ".brep": _read_brep,
    ".brp": _read_brep,
    ".bin": _read_binary,
}


def _distinct_solids(shapes: Iterator[TopoDS_Shape]) -> list[TopoDS_Solid]:
    """Each solid once, wherever and however often it is placed."""
    found = TopTools_IndexedMapOfShape()
    for shape in shapes:
        if shape.IsNull():
            continue
        solids = TopTools_IndexedMapOfShape()
        TopExp.MapShapes_s(shape, TopAbs_SOLID, solids)
        for i in range(1, solids.Extent() + 1):
            found.Add(solids.FindKey(i).Located(TopLoc_Location()))
    return [TopoDS.Solid_s(found.FindKey(i)) for i in range(1, found.Extent() + 1)]
