"""The work on one item: its solids read, prepared and drawn, every failure kept with its code."""

from __future__ import annotations

import time
import traceback
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from ..check import check_drawing
from .errors import ProjectionError, require
from .options import ProjectOptions
from .read import Item, ItemReader
from .signature import family_key, shape_key, views_key
from .solid import PreparedSolid

READING = -1
"""The number that stands for a whole item while it is being read."""


@dataclass(frozen=True)
class Plan:
    """How every solid is drawn: ``views`` are (kind, number of drawings)."""

    views: tuple[tuple[str, int], ...] = (("ortho", 1), ("iso", 1), ("persp", 1))
    seed: int = 0
    options: ProjectOptions = field(default_factory=ProjectOptions)


@dataclass
class SolidResult:
    """What became of one solid (``number`` in its item), or of an item that could not be read.

    ``outcome`` is ``ok`` or a reason code. ``drawings`` are (kind, is large, line of JSON);
    ``refused`` the codes of views that gave none, by kind. The first solid's ``cpu_seconds``
    include the reading of its item.
    """

    number: int
    name: str
    source: str
    outcome: str = "ok"
    detail: str = ""
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    drawings: list[tuple[str, bool, str]] = field(default_factory=list)
    refused: dict[str, str] = field(default_factory=dict)
    facts: dict[str, Any] = field(default_factory=dict)

    def row(self) -> dict[str, Any]:
        """The row of the index: all but the drawings, of which only the numbers by kind."""
        skipped = ("drawings", "facts")
        row = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in skipped}
        kinds = [kind for kind, _, _ in self.drawings]
        row["seconds"] = round(self.seconds, 4)
        row["cpu_seconds"] = round(self.cpu_seconds, 4)
        row["drawings"] = {kind: kinds.count(kind) for kind in dict.fromkeys(kinds)}
        row["large"] = any(large for _, large, _ in self.drawings)
        return row | self.facts


def solid_name(item: Item, number: int) -> str:
    """Name of an item's solid: the item's own for the first, numbered for the others."""
    return item.name if number == 0 else f"{item.name}.{number}"


def work_on(item: Item, plan: Plan, reader: ItemReader, first: int = 0) -> Iterator[Any]:
    """Work through an item's solids from number ``first`` on.

    Yields the number of each solid before it is begun (``READING`` before the file), and its
    ``SolidResult`` after.
    """
    if first == 0:
        yield READING
    start, spent = time.monotonic(), time.process_time()
    try:
        solids = reader.read(item)
    except Exception as error:
        result = SolidResult(READING, item.name, item.source)
        _fail(result, error, start, "unreadable")
        yield result
        return
    for number in range(first, len(solids)):
        yield number
        result = _draw(solids[number], number, item, plan)
        result.cpu_seconds = time.process_time() - spent
        spent = time.process_time()
        yield result


def _draw(shape, number: int, item: Item, plan: Plan) -> SolidResult:
    name = solid_name(item, number)
    result = SolidResult(number, name, item.source)
    start = time.monotonic()
    try:
        solid = PreparedSolid(shape, plan.options)
        result.facts = facts(solid)
        for kind, copies in plan.views:
            for copy in range(copies):
                _draw_view(result, solid, kind, copy, plan)
    except Exception as error:
        _fail(result, error, start, "internal")
        return result
    result.seconds = time.monotonic() - start
    if not result.drawings and result.refused:
        # The first kind of view asked for says why nothing came.
        result.outcome = next(iter(result.refused.values()))
    return result


def _draw_view(result: SolidResult, solid: PreparedSolid, kind: str, copy: int, plan: Plan) -> None:
    salt = zlib.crc32(f"{result.name}#{kind}{copy}".encode())
    rng = np.random.default_rng([plan.seed, salt])
    try:
        drawing = solid.draw_generic(kind, rng, f"{result.name}#{kind[0]}{copy}", result.source)
        faults = check_drawing(drawing)
        require(not faults, "check", "; ".join(map(str, faults[:3])))
    except ProjectionError as error:
        result.refused[kind] = error.code
        result.detail = result.detail or str(error)
        return
    result.drawings.append((kind, solid.is_large(drawing), drawing.to_line()))


def facts(solid: PreparedSolid) -> dict[str, Any]:
    """What the index says of a solid: sizes, face types, keys."""
    labels = [face.surface.label for face in solid.brep.faces]
    return {
        "faces": len(labels),
        "edges": sum(e.curve is not None and not e.seam for e in solid.brep.edges),
        "types": {label: labels.count(label) for label in sorted(set(labels))},
        "characteristic": solid.brep.characteristic,
        "volume": round(solid.volume, 5),
        "shape": shape_key(solid),
        "views": views_key(solid),
        "family": family_key(solid),
    }


def _fail(result: SolidResult, error: Exception, start: float, otherwise: str) -> None:
    """Note an error; one that is not ours keeps its place in the code as detail."""
    result.seconds = time.monotonic() - start
    result.drawings.clear()
    if isinstance(error, ProjectionError):
        result.outcome, result.detail = error.code, str(error)
        return
    frame = traceback.extract_tb(error.__traceback__)[-1]
    result.outcome = otherwise
    result.detail = f"{type(error).__name__}: {error} ({frame.name}, line {frame.lineno})"
