# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the library answers, as plain Python data. Nothing here touches FreeCAD."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

Point = tuple[float, float]

KINDS = ("plane", "cylinder", "cone", "sphere", "torus", "other")
"""Kinds of surface that a face may have."""


@dataclass(frozen=True)
class Ellipse:
    """An arc of an ellipse, ``center + cos(t) major + sin(t) minor`` from ``start`` by ``sweep``.

    ``minor`` is ``major`` turned a quarter counter-clockwise, times ``ratio``. Angles are in
    radians, and a positive sweep is counter-clockwise.
    """

    center: Point
    major: Point
    ratio: float
    start: float
    sweep: float


@dataclass(frozen=True)
class Edge:
    """An edge of the cleaned drawing."""

    vertices: tuple[int, int]
    points: tuple[Point, ...]
    ellipse: Ellipse | None
    straight: bool
    sources: tuple[int, ...]
    """Edges of the source (from 0) that it came from."""


@dataclass(frozen=True)
class Finding:
    """Something about the drawing that the user should know."""

    severity: str
    """``error``, ``warning`` or ``notice``."""
    message: str
    edges: tuple[int, ...]
    """Edges of the source (from 0) that it is about."""
    points: tuple[Point, ...]
    faces: tuple[int, ...] = ()
    """Faces of the chosen reading (from 0) that it is about, the wrong one first."""
    detail: str = ""
    """What a tooltip says further."""


@dataclass(frozen=True)
class Drawing:
    """A cleaned drawing with the names of the source's edges."""

    vertices: tuple[Point, ...]
    edges: tuple[Edge, ...]
    findings: tuple[Finding, ...]
    names: tuple[str, ...]
    """Names of the source's edges."""

    @classmethod
    def parse(cls, report: dict[str, Any], names: Sequence[str]) -> Drawing:
        """Reads the library's report on a drawing."""
        drawing = report["drawing"]
        sources = report.get("sources") or [[k] for k in range(len(drawing["edges"]))]
        edges = [
            _edge(edge, source) for edge, source in zip(drawing["edges"], sources, strict=True)
        ]
        findings = [_finding(finding) for finding in report.get("findings", [])]
        vertices = [_point(vertex) for vertex in drawing["vertices"]]
        return cls(tuple(vertices), tuple(edges), tuple(findings), tuple(names))

    def names_of(self, edges: Sequence[int]) -> tuple[str, ...]:
        """Names of the source's edges behind edges of the drawing, each once, in order."""
        found = sorted({source for edge in edges for source in self.edges[edge].sources})
        return tuple(self.names[k] for k in found if k < len(self.names))


@dataclass(frozen=True)
class Face:
    """A face of the solid as the drawing shows it."""

    number: int
    """Number of the face, from 1."""
    kind: str
    """Kind of its surface, one of `KINDS`."""
    loops: tuple[tuple[int, ...], ...]
    """Closed walks of co-edges: ``k`` is edge ``k`` of the drawing (from 1), ``-k`` backwards."""
    edges: tuple[str, ...]
    """Names of the source's edges around it."""
    confidence: float
    """Probability that the face is right, 0 to 1."""

    @property
    def edge_indices(self) -> tuple[int, ...]:
        """Edges of the drawing (from 0) around the face, each once."""
        return tuple(sorted({abs(k) - 1 for loop in self.loops for k in loop}))

    @property
    def key(self) -> str:
        """Names the face by its edges, so that it is found again in a changed drawing."""
        return " ".join(self.edges)

    def outline(self, drawing: Drawing) -> list[list[Point]]:
        """The loops as closed polylines in the drawing's plane."""
        return [_walk(drawing, loop) for loop in self.loops]


@dataclass(frozen=True)
class Reading:
    """One consistent set of faces."""

    faces: tuple[Face, ...]
    raw: tuple[dict[str, Any], ...] = field(repr=False)
    """The faces as the library gave them."""


@dataclass(frozen=True)
class Identification:
    """What an engine found in a drawing."""

    engine: str
    drawing: Drawing
    readings: tuple[Reading, ...]
    """The best set of faces, then the alternatives."""
    notices: tuple[str, ...]

    @classmethod
    def parse(cls, data: dict[str, Any], drawing: Drawing) -> Identification:
        """Reads the library's identification."""
        sets = [data["faces"], *(other["faces"] for other in data.get("alternatives", []))]
        readings = tuple(
            Reading(tuple(_face(k, face, drawing) for k, face in enumerate(faces, 1)), tuple(faces))
            for faces in sets
        )
        return cls(data["engine"], drawing, readings, tuple(map(sentence, data.get("notices", []))))

    @property
    def faces(self) -> tuple[Face, ...]:
        """The faces of the best reading."""
        return self.readings[0].faces

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What the diagnosis of the drawing says."""
        return self.drawing.findings


def sentence(message: str) -> str:
    """A message of the library as a sentence of its own."""
    return message[:1].upper() + message[1:]


def _point(values: Sequence[float]) -> Point:
    return (float(values[0]), float(values[1]))


def _edge(edge: dict[str, Any], sources: Sequence[int]) -> Edge:
    points = tuple(_point(p) for p in edge["points"])
    curve = edge.get("curve") or {}
    kind = curve.get("kind", "line" if len(points) == 2 else "polyline")
    ellipse = None
    if kind == "ellipse":
        ellipse = Ellipse(
            _point(curve["center"]),
            _point(curve["major"]),
            float(curve["ratio"]),
            float(curve["start"]),
            float(curve["sweep"]),
        )
    first, second = edge["v"]
    return Edge((first, second), points, ellipse, kind == "line", tuple(sources))


def _finding(finding: dict[str, Any]) -> Finding:
    return Finding(
        str(finding["severity"]).lower(),
        sentence(finding["message"]),
        tuple(finding.get("edges", [])),
        tuple(_point(p) for p in finding.get("points", [])),
    )


def _face(number: int, face: dict[str, Any], drawing: Drawing) -> Face:
    loops = tuple(tuple(loop) for loop in face["loops"])
    edges = sorted({abs(k) - 1 for loop in loops for k in loop})
    return Face(
        number, face["type"], loops, drawing.names_of(edges), float(face.get("confidence", 1.0))
    )


def _walk(drawing: Drawing, loop: Sequence[int]) -> list[Point]:
    points: list[Point] = []
    for k in loop:
        part = drawing.edges[abs(k) - 1].points
        points += part[:-1] if k > 0 else part[:0:-1]
    return points
