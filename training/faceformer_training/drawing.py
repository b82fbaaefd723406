"""The wireframe drawing: its data classes, its JSON form, and files of drawings.

One drawing is one JSON object; a data set holds one drawing a line (``.jsonl``, ``.jsonl.zst``).
Lengths are in units of the half diagonal of the solid's bounding box. Points live in the camera
frame: x to the right, y up, z towards the viewer. Edges and faces count from 1 in co-edges
(``k`` walks edge ``k`` from ``v[0]`` to ``v[1]``, ``-k`` walks it backwards); vertices from 0.
"""

from __future__ import annotations

import io
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import zstandard

FACE_TYPES = ("plane", "cylinder", "cone", "sphere", "torus", "other")
DECIMALS = 6


class DrawingFormatError(ValueError):
    """A JSON object or line that is no drawing; the message says where and what is missing."""


@dataclass
class Face:
    """One true face: surface type (one of ``FACE_TYPES``) and loops of signed co-edge numbers."""

    type: str
    loops: list[list[int]]


@dataclass
class Truth:
    """The solid behind a drawing, in the camera frame.

    ``vertices3d`` is (N, 3), ``edges3d`` one (M, 3) array an edge with as many points as the
    edge has in the drawing, ``directions`` the (3, 3) model axes as rows, or None.
    """

    faces: list[Face]
    vertices3d: np.ndarray
    edges3d: list[np.ndarray]
    directions: np.ndarray | None = None


@dataclass
class Edge:
    """An edge from vertex ``v[0]`` to ``v[1]``; ``points`` is (M, 2), both ends included."""

    v: tuple[int, int]
    points: np.ndarray


@dataclass
class Drawing:
    """A wireframe drawing; ``vertices`` is (N, 2), ``projection`` as in the format's page."""

    id: str
    source: str
    projection: dict[str, Any]
    vertices: np.ndarray
    edges: list[Edge]
    truth: Truth | None = None

    def to_json(self) -> dict[str, Any]:
        """The drawing as plain data, coordinates rounded to 1e-6."""
        out: dict[str, Any] = {
            "id": self.id,
            "source": self.source,
            "projection": dict(self.projection),
            "vertices": _rounded(self.vertices),
            "edges": [{"v": list(e.v), "points": _rounded(e.points)} for e in self.edges],
        }
        if self.truth is not None:
            truth: dict[str, Any] = {
                "faces": [{"type": f.type, "loops": f.loops} for f in self.truth.faces],
                "vertices3d": _rounded(self.truth.vertices3d),
                "edges3d": [_rounded(e) for e in self.truth.edges3d],
            }
            if self.truth.directions is not None:
                truth["directions"] = _rounded(self.truth.directions)
            out["truth"] = truth
        return out

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Drawing:
        """Read plain data; only ``vertices`` and ``edges`` are required.

        Raises ``DrawingFormatError`` where a field is missing or has the wrong form. It checks
        form only; ``faceformer_training.check`` checks sense.
        """
        try:
            truth = data.get("truth")
            return cls(
                id=str(data.get("id", "")),
                source=str(data.get("source", "")),
                projection=dict(data.get("projection", {"kind": "orthographic"})),
                vertices=_points(data["vertices"], 2),
                edges=[
                    Edge((int(e["v"][0]), int(e["v"][1])), _points(e["points"], 2))
                    for e in data["edges"]
                ],
                truth=None if truth is None else _truth(truth),
            )
        except (KeyError, TypeError, IndexError, ValueError, AttributeError) as error:
            name = data.get("id", "?") if isinstance(data, dict) else "?"
            raise DrawingFormatError(f"drawing {name}: {error!r}") from error

    def to_line(self) -> str:
        """The drawing as one line of JSON, without the line's end."""
        return json.dumps(self.to_json(), separators=(",", ":"))


def _truth(data: dict[str, Any]) -> Truth:
    directions = data.get("directions")
    return Truth(
        faces=[
            Face(str(f["type"]), [[int(k) for k in loop] for loop in f["loops"]])
            for f in data["faces"]
        ],
        vertices3d=_points(data["vertices3d"], 3),
        edges3d=[_points(e, 3) for e in data["edges3d"]],
        directions=None if directions is None else _points(directions, 3),
    )


def _points(rows: Any, width: int) -> np.ndarray:
    array = np.asarray(rows, dtype=float)
    if array.size == 0:
        return np.zeros((0, width))
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"expected rows of {width} numbers, found shape {array.shape}")
    return array


def _rounded(array: np.ndarray) -> list[list[float]]:
    # Adding zero turns -0.0 into 0.0.
    return (np.round(np.asarray(array, dtype=float), DECIMALS) + 0.0).tolist()


def read_lines(path: str | Path) -> Iterator[str]:
    """The non-empty lines of a text file, plain or ``.zst`` of any number of frames."""
    path = Path(path)
    with open(path, "rb") as raw:
        binary: Any = raw
        if path.suffix == ".zst":
            binary = zstandard.ZstdDecompressor().stream_reader(raw, read_across_frames=True)
        for line in io.TextIOWrapper(binary, "utf-8"):
            if line.strip():
                yield line


def read_drawings(path: str | Path) -> Iterator[Drawing]:
    """The drawings of a ``.json`` (one drawing), ``.jsonl`` or ``.jsonl.zst`` file, in order.

    Raises ``DrawingFormatError`` naming the line that is no drawing.
    """
    path = Path(path)
    if path.suffix == ".json":
        yield Drawing.from_json(json.loads(path.read_text("utf-8")))
        return
    for number, line in enumerate(read_lines(path), 1):
        try:
            data = json.loads(line)
        except json.JSONDecodeError as error:
            raise DrawingFormatError(f"{path}, line {number}: {error}") from error
        yield Drawing.from_json(data)


class DrawingWriter:
    """Writes drawings to a ``.jsonl`` or ``.jsonl.zst`` file, in whole resumable pieces.

    What was written up to a ``flush`` is a complete file of its own: a compressed file is a
    series of Zstandard frames, one a flush. ``flush`` returns the file's length, and a writer
    opened with ``resume_at`` that length cuts off whatever came later and goes on from there
    (``resume_at=None`` starts a new file). Use it as a context manager; leaving it flushes.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        resume_at: int | None = None,
        level: int = 10,
        flush_every: int = 512,
    ) -> None:
        self.path = Path(path)
        self.written = 0
        self._compress = self.path.suffix == ".zst"
        self._level = level
        self._flush_every = flush_every
        self._lines: list[str] = []
        if resume_at is not None and not self.path.exists() and resume_at > 0:
            raise FileNotFoundError(f"{self.path} is to be resumed, but is not there")
        self._file = open(self.path, "r+b" if resume_at else "wb")  # noqa: SIM115
        if resume_at:
            size = self._file.seek(0, os.SEEK_END)
            if size < resume_at:
                self._file.close()
                raise ValueError(f"{self.path} has {size} bytes, fewer than {resume_at}")
            self._file.truncate(resume_at)
            self._file.seek(resume_at)

    def write(self, drawing: Drawing | str) -> None:
        """Append a drawing, or the line of JSON that ``Drawing.to_line`` gave."""
        self._lines.append(drawing if isinstance(drawing, str) else drawing.to_line())
        self.written += 1
        if len(self._lines) >= self._flush_every:
            self.flush()

    def flush(self) -> int:
        """Bring all that was written to the file; its length in bytes."""
        if self._lines:
            data = ("\n".join(self._lines) + "\n").encode("utf-8")
            if self._compress:
                data = zstandard.ZstdCompressor(level=self._level).compress(data)
            self._file.write(data)
            self._lines.clear()
        self._file.flush()
        return self._file.tell()

    def close(self) -> None:
        if not self._file.closed:
            self.flush()
            self._file.close()

    def __enter__(self) -> DrawingWriter:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
