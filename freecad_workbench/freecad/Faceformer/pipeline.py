# SPDX-License-Identifier: LGPL-2.1-or-later
"""The way from an edge list to a solid: library calls, and a small store of recent results.

Nothing here touches FreeCAD, so all of it may run in a thread. A command computes in a thread
with progress; the parametric object then asks for the same work and finds it in the store.
"""

from __future__ import annotations

import re
import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from . import _native
from .errors import BadInput, Failed
from .model import Drawing, Finding, Identification, sentence
from .plane import Vector
from .pose import turn

ENGINES = ("rotation", "varley", "shortest", "faceformer")
"""Engines of the library, the default first."""

ORIENTATIONS = ("upright", "drawn")
"""``upright`` turns the model so that its axes are the main axes, ``drawn`` leaves it as seen."""

MOST_ALTERNATIVES = 4
"""Alternatives that are tried if the best reading conflicts or gives no solid."""

MOST_NAMES = 8
"""Edges that a message names; more would hide what it says."""

_FACES = r"\bfaces? \d+(?:(?:, | and )\d+\b(?! more))*"
_CORNERS = r"\bvert(?:ex \d+|ices \[\d+(?:, \d+)*\])"

Progress = _native.Progress
Result = TypeVar("Result")


@dataclass(frozen=True)
class Identified:
    """A drawing, its faces, and the library's own handle on the drawing."""

    text: str
    identification: Identification
    native: _native.Drawing = field(repr=False, compare=False)


@dataclass(frozen=True)
class SolidOptions:
    """What the user may choose about the solid."""

    scale: float = 1.0
    flip: bool = False
    orientation: str = "upright"
    reading: int = 0
    """Which set of faces: 0 is the best, 1 the first alternative. With 0 and no face off the user
    has left the choice to us, and an alternative is taken if the best one has a fault."""
    off: tuple[str, ...] = ()
    """Keys of faces that are switched off."""

    @property
    def chosen(self) -> bool:
        """Whether the user chose faces: then no others take their place."""
        return self.reading != 0 or bool(self.off)

    def native(self) -> dict[str, Any]:
        """The options as the library takes them."""
        return {
            "flip": self.flip,
            "scale": self.scale,
            "orientation": self.orientation,
            "alternatives": 0 if self.chosen else MOST_ALTERNATIVES,
        }


@dataclass(frozen=True)
class Built:
    """A solid as BREP text with its measures."""

    brep: str = field(repr=False)
    report: dict[str, Any]
    lift: dict[str, Any] = field(repr=False)
    plan: dict[str, Any] = field(repr=False)

    def axes_from(self, drawing: Drawing) -> tuple[Vector, Vector, Vector] | None:
        """Where the drawing's x, y and z axis are in the model."""
        depths = self.lift.get("depths", [])
        if len(depths) != len(drawing.vertices):
            return None
        drawn = [(x, y, z) for (x, y), z in zip(drawing.vertices, depths, strict=True)]
        return turn(drawn, [tuple(vertex) for vertex in self.plan.get("vertices", [])])

    conflicts: tuple[Finding, ...] = ()
    """Faces that the depths contradict."""
    exchange: str = ""
    """Says that an alternative was taken, and why; empty if none was."""

    @property
    def notices(self) -> tuple[str, ...]:
        """Which reading was taken, what was snapped, and which faces conflict."""
        exchange = (self.exchange,) if self.exchange else ()
        snapped = tuple(map(sentence, self.plan.get("notices", [])))
        return (*exchange, *snapped, *(conflict.message for conflict in self.conflicts))


class Store:
    """The results that were used last; safe for threads."""

    def __init__(self, size: int):
        self._size = size
        self._lock = threading.Lock()
        self._items: OrderedDict[Any, Any] = OrderedDict()

    def get(self, key: Any, make: Callable[[], Result]) -> Result:
        """The result under a key, made now if it is not there."""
        with self._lock:
            if key in self._items:
                self._items.move_to_end(key)
                return self._items[key]
        made = make()
        with self._lock:
            self._items[key] = made
            while len(self._items) > self._size:
                self._items.popitem(last=False)
        return made


_identified = Store(8)
_conflicts = Store(32)
_built = Store(8)


def read(text: str, names: Sequence[str]) -> tuple[_native.Drawing, Drawing]:
    """Reads and cleans an edge list; fast."""
    native = _native.read_drawing(text)
    return native, Drawing.parse(native.report(), names)


def identify(
    text: str, names: Sequence[str], engine: str = ENGINES[0], progress: Progress | None = None
) -> Identified:
    """Finds the faces of an edge list."""

    def make() -> Identified:
        native, drawing = read(text, names)
        with names_in_errors(drawing):
            faces = native.identify({"engine": engine}, progress)
        return Identified(text, Identification.parse(faces.identification(), drawing), native)

    return _identified.get((text, engine), make)


def conflicts(
    identified: Identified, options: SolidOptions, progress: Progress | None = None
) -> tuple[Finding, ...]:
    """Which of the faces that are switched on contradict the depths that the others give."""
    faces = chosen_faces(identified.identification, options)

    def make() -> tuple[Finding, ...]:
        lift = identified.native.lift(identified.native.read_faces(faces), progress)
        return told_conflicts(lift, identified.identification, options)

    key = (identified.text, identified.identification.engine, options.reading, options.off)
    return _conflicts.get(key, make)


def solid(identified: Identified, options: SolidOptions, progress: Progress | None = None) -> Built:
    """Builds the solid from the faces that are switched on."""

    def make() -> Built:
        identification = identified.identification
        faces = identified.native.read_faces(offered_faces(identification, options))
        with names_in_errors(identification.drawing, chosen_numbers(identification, options)):
            native = identified.native.solid(faces, options.native(), progress)
        report = native.report()
        return Built(
            native.brep().decode("utf-8"),
            report["report"],
            report["lift"],
            report["plan"],
            told_conflicts(
                report["lift"], identification, replace(options, reading=report["reading"])
            ),
            " ".join(map(sentence, report["notices"])),
        )

    return _built.get((identified.text, identified.identification.engine, options), make)


def told_conflicts(
    lift: dict[str, Any], identification: Identification, options: SolidOptions
) -> tuple[Finding, ...]:
    """The conflicts of a lift as messages that know their faces and vertices."""
    drawing, numbers = identification.drawing, chosen_numbers(identification, options)

    def told(conflict: dict[str, Any]) -> Finding:
        vertices = conflict["vertices"]
        edges = [k for k, edge in enumerate(drawing.edges) if set(vertices) & set(edge.vertices)]
        return Finding(
            "warning",
            sentence(with_numbers(conflict["message"], numbers)),
            (),
            tuple(drawing.vertices[v] for v in vertices),
            tuple(numbers[face] - 1 for face in [conflict["face"], *conflict["others"]]),
            ", ".join(drawing.names_of(edges)),
        )

    return tuple(map(told, lift.get("conflicts", [])))


@contextmanager
def names_in_errors(drawing: Drawing, numbers: Sequence[int] = ()) -> Iterator[None]:
    """Says what the user can find: errors of the library number the edges of the cleaned drawing
    and the faces that are switched on, whose own numbers are given.

    If the diagnosis found the drawing itself at fault, its words are better than what followed.
    """
    try:
        yield
    except Failed as error:
        causes = [finding.message for finding in drawing.findings if finding.severity == "error"]
        text = with_names(with_numbers(str(error), numbers), drawing)
        named = Failed(causes[0] if causes else sentence(text))
        named.partial = error.partial
        raise named from error


def with_names(message: str, drawing: Drawing) -> str:
    """A message of the library with the names of the source's edges in the place of numbers."""

    def edge(match: re.Match[str]) -> str:
        number = int(match.group(1)) - 1
        names = drawing.names_of([number]) if number < len(drawing.edges) else ()
        return ", ".join(names) or match.group(0)

    def corner(match: re.Match[str]) -> str:
        vertices = {int(number) for number in re.findall(r"\d+", match.group(0))}
        edges = [k for k, edge in enumerate(drawing.edges) if vertices & set(edge.vertices)]
        names = drawing.names_of(edges)
        if not names:
            return match.group(0)
        more = ["..."] if len(names) > MOST_NAMES else []
        where = "the corner of" if len(vertices) == 1 else "corners of"
        return f"{where} {', '.join([*names[:MOST_NAMES], *more])}"

    return re.sub(_CORNERS, corner, re.sub(r"\bedge (\d+)\b", edge, message))


def offered_faces(identification: Identification, options: SolidOptions) -> dict[str, Any]:
    """The faces that the options leave, with the alternatives unless the user chose faces."""
    offered = chosen_faces(identification, options)
    if not options.chosen:
        others = identification.readings[1 : 1 + MOST_ALTERNATIVES]
        offered["alternatives"] = [{"faces": list(reading.raw)} for reading in others]
    return offered


def with_numbers(message: str, numbers: Sequence[int]) -> str:
    """A message of the library about the faces that are switched on, with their own numbers."""

    def own(match: re.Match[str]) -> str:
        number = int(match.group(0))
        return str(numbers[number - 1]) if 0 < number <= len(numbers) else match.group(0)

    return re.sub(_FACES, lambda list_: re.sub(r"\d+", own, list_.group(0)), message)


def chosen_numbers(identification: Identification, options: SolidOptions) -> tuple[int, ...]:
    """Numbers, from 1, of the faces that the options leave."""
    faces = identification.readings[options.reading].faces
    return tuple(face.number for face in faces if face.key not in options.off)


def chosen_faces(identification: Identification, options: SolidOptions) -> dict[str, Any]:
    """The faces that the options leave, as the library reads them."""
    if not 0 <= options.reading < len(identification.readings):
        raise BadInput(
            f"There is no reading {options.reading + 1}: this drawing has "
            f"{len(identification.readings)}. Choose another one."
        )
    reading = identification.readings[options.reading]
    off = set(options.off)
    faces = [
        raw for face, raw in zip(reading.faces, reading.raw, strict=True) if face.key not in off
    ]
    if not faces:
        raise BadInput("All faces are switched off. Switch the faces of the solid on.")
    return {"engine": identification.engine, "faces": faces}
