"""Closed outlines in the plane: chains of lines, arcs and splines, circles and ellipses.

An outline is built as plain numbers first, so that recipes can measure it, and becomes an OCCT wire
or face in the plane z = 0 at the end.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepTools import BRepTools
from OCP.GC import GC_MakeArcOfCircle
from OCP.GeomAPI import GeomAPI_Interpolate
from OCP.gp import gp_Circ, gp_Elips, gp_Pnt
from OCP.TColgp import TColgp_HArray1OfPnt
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Wire

from .kernel import Refused, frame, guarded

Point = tuple[float, float]


@dataclass(frozen=True)
class Step:
    """One curve of a chain: to ``end``, past the points ``via`` (none: a line; ``arc``: one)."""

    end: Point
    via: tuple[Point, ...] = ()
    arc: bool = False


@dataclass
class Outline:
    """A closed chain that starts (and ends) at ``start``."""

    start: Point
    steps: list[Step] = field(default_factory=list)

    def line(self, x: float, y: float) -> "Outline":
        self.steps.append(Step((x, y)))
        return self

    def arc(self, middle: Point, end: Point) -> "Outline":
        self.steps.append(Step(end, (middle,), True))
        return self

    def spline(self, via: Sequence[Point], end: Point) -> "Outline":
        self.steps.append(Step(end, tuple(via)))
        return self

    def edges(self, closed: bool = True) -> list[TopoDS_Edge]:
        """The chain's edges, with the line that closes it if ``closed`` and there is a gap."""
        chain, at = [], self.start
        for step in self.steps:
            chain.append(_edge(at, step))
            at = step.end
        if closed and math.dist(at, self.start) > 1e-9:
            chain.append(_edge(at, Step(self.start)))
        return chain

    def wire(self) -> TopoDS_Wire:
        return chained(self.edges())


@dataclass(frozen=True)
class Ellipse:
    """A whole ellipse, or a circle if both radii are equal; ``turn`` in radians."""

    centre: Point
    rx: float
    ry: float
    turn: float = 0.0

    def wire(self) -> TopoDS_Wire:
        major, minor = max(self.rx, self.ry), min(self.rx, self.ry)
        turn = self.turn + (0 if self.rx >= self.ry else math.pi / 2)
        axes = frame((*self.centre, 0), (0, 0, 1), (math.cos(turn), math.sin(turn), 0))
        if major - minor < 1e-9 * major:
            return chained([BRepBuilderAPI_MakeEdge(gp_Circ(axes, major)).Edge()])
        return chained([BRepBuilderAPI_MakeEdge(gp_Elips(axes, major, minor)).Edge()])


def circle(r: float, centre: Point = (0.0, 0.0)) -> Ellipse:
    return Ellipse(centre, r, r)


def polygon(points: Sequence[Point]) -> Outline:
    chain = Outline(points[0])
    for p in points[1:]:
        chain.line(*p)
    return chain


def rounded(points: Sequence[Point], radii: Sequence[float]) -> Outline:
    """A polygon whose corners are rounded by arcs; a radius of 0 leaves a corner sharp.

    A radius that its corner has no room for raises ``Refused``.
    """
    corners = []
    n = len(points)
    for i, r in enumerate(radii):
        before, p, after = points[i - 1], points[i], points[(i + 1) % n]
        corners.append(_corner(before, p, after, r) if r > 0 else (p, None, p, 0.0))
    for i in range(n):
        room = math.dist(points[i], points[(i + 1) % n])
        if corners[i][3] + corners[(i + 1) % n][3] > room * (1 - 1e-6):
            raise Refused("outline: a corner has no room for its radius")
    chain = Outline(corners[0][2])
    for first, middle, last, _ in corners[1:] + corners[:1]:
        chain.line(*first)
        if middle is not None:
            chain.arc(middle, last)
    return chain


def _corner(before: Point, p: Point, after: Point, r: float):
    """Start, middle and end of a corner's arc, and the length it takes from either side."""
    a = (before[0] - p[0], before[1] - p[1])
    b = (after[0] - p[0], after[1] - p[1])
    la, lb = math.hypot(*a), math.hypot(*b)
    a, b = (a[0] / la, a[1] / la), (b[0] / lb, b[1] / lb)
    half = math.acos(max(-1.0, min(1.0, a[0] * b[0] + a[1] * b[1]))) / 2
    if half > 1.5 or half < 0.05:
        return p, None, p, 0.0
    taken = r / math.tan(half)
    bis = (a[0] + b[0], a[1] + b[1])
    size = math.hypot(*bis)
    inward = r / math.sin(half) - r
    middle = (p[0] + bis[0] / size * inward, p[1] + bis[1] / size * inward)
    first = (p[0] + a[0] * taken, p[1] + a[1] * taken)
    last = (p[0] + b[0] * taken, p[1] + b[1] * taken)
    return first, middle, last, taken


def _edge(start: Point, step: Step) -> TopoDS_Edge:
    a, b = gp_Pnt(*start, 0), gp_Pnt(*step.end, 0)
    if not step.via:
        made = BRepBuilderAPI_MakeEdge(a, b)
    elif step.arc:
        made = BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(a, gp_Pnt(*step.via[0], 0), b).Value())
    else:
        through = TColgp_HArray1OfPnt(1, len(step.via) + 2)
        for i, p in enumerate([start, *step.via, step.end], 1):
            through.SetValue(i, gp_Pnt(*p, 0))
        curve = GeomAPI_Interpolate(through, False, 1e-7)
        curve.Perform()
        made = BRepBuilderAPI_MakeEdge(curve.Curve())
    if not made.IsDone():
        raise Refused("outline")
    return made.Edge()


@guarded("outline")
def chained(edges: Sequence[TopoDS_Edge]) -> TopoDS_Wire:
    made = BRepBuilderAPI_MakeWire()
    for edge in edges:
        made.Add(edge)
    if not made.IsDone():
        raise Refused("outline")
    return made.Wire()


@guarded("outline")
def face(outer: Outline | Ellipse, *holes: Outline | Ellipse) -> TopoDS_Face:
    """The planar face inside ``outer`` and outside ``holes``.

    Outlines that cross themselves or each other are refused: what is swept from them would cross
    itself too, and no check of the body would find that.
    """
    made = BRepBuilderAPI_MakeFace(outer.wire(), True)
    for hole in holes:
        # A hole's wire must run against the outer one: MakeFace takes it as it is.
        alone = BRepBuilderAPI_MakeFace(hole.wire(), True).Face()
        made.Add(TopoDS.Wire_s(BRepTools.OuterWire_s(alone).Reversed()))
    if not made.IsDone() or not BRepCheck_Analyzer(made.Face()).IsValid():
        raise Refused("an outline that crosses itself")
    return made.Face()
