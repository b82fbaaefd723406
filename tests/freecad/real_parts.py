# SPDX-License-Identifier: LGPL-2.1-or-later
"""Real parts that go the whole way round; `tests/corpus/round_trips` has them and their list."""

import gzip
import json
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import Part

FOLDER = Path(__file__).resolve().parents[1] / "corpus" / "round_trips"
KINDS = {
    "Plane": "plane",
    "Cylinder": "cylinder",
    "Cone": "cone",
    "Sphere": "sphere",
    "Toroid": "torus",
}


@dataclass(frozen=True)
class RealPart:
    """A part of somebody's, with what its solid must have."""

    file: str
    """Name of the file, without ``.brep.gz``."""
    name: str
    has: str
    """What is to be seen on it."""
    source: str
    licence: str
    kinds: dict[str, int]
    """Number of its faces of each kind of surface, by what they are: some files say all of it by
    splines."""
    fails: str = ""
    """Why it does not come back yet; empty if it does."""

    def shape(self) -> Part.Shape:
        """The solid, with a half diagonal of 50 mm."""
        shape = Part.Shape()
        with gzip.open(FOLDER / f"{self.file}.brep.gz", "rt", encoding="ascii") as text:
            shape.importBrepFromString(text.read())
        return shape


def real_parts() -> list[RealPart]:
    """All of them, in the order of the list."""
    entries = json.loads((FOLDER / "parts.json").read_text(encoding="utf-8"))
    return [RealPart(**entry) for entry in entries]


def kinds_of(shape: Part.Shape) -> dict[str, int]:
    """Number of a shape's faces of each kind of surface."""
    return dict(Counter(KINDS.get(type(f.Surface).__name__, "other") for f in shape.Faces))
