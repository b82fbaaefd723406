# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a FreeCAD source to a flat list of edges, in the coordinates of the drawing's plane.

A source is a sketch, another object whose shape is made of edges in one plane, some edges of
such objects, or a list of these. Construction geometry is left out, since the shape of a sketch
leaves it out. Points lie exactly on their curves; the library recognises the curves again.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import FreeCAD
import Part

from .errors import BadInput
from .i18n import translate
from .plane import fit_plane

PLANE_TOLERANCE = 1e-5
"""Largest distance of a point from the drawing's plane, as a share of the drawing's size."""

FULL_TURN_POINTS = 96
"""Points on a whole circle or ellipse."""

LEAST_CURVE_POINTS = 17
"""Points on a short curve, both ends included: an ellipse needs five to be told."""

SPAN_POINTS = 24
"""Points on each span of a spline."""

_EDGE_NAME = re.compile(r"(?:^|\.)Edge\d+$")


@dataclass(frozen=True)
class SourceEdge:
    """One edge of the source in the plane of the drawing."""

    name: str
    """Name for messages: ``Edge3``, or ``Sketch.Edge3`` if the source is several objects."""
    points: tuple[tuple[float, float], ...]
    """Points on the curve, both ends included."""


@dataclass(frozen=True)
class Extraction:
    """The edges of a source, and where the drawing's plane lies."""

    edges: tuple[SourceEdge, ...]
    placement: FreeCAD.Placement
    """Takes (x, y, 0) of the drawing to the model; its z axis points to the viewer."""

    def to_json(self) -> str:
        """The edge list that the library reads."""
        edges = [{"name": edge.name, "points": edge.points} for edge in self.edges]
        return json.dumps({"edges": edges}, allow_nan=False)


def normalise(source: Any) -> list[tuple[Any, tuple[str, ...]]]:
    """The source as a list of objects, each with the names of its edges; none means all of it.

    Takes a document object, a shape, ``(object, "Edge1")``, ``(object, ["Edge1", ...])``, an
    entry of ``Gui.Selection.getSelectionEx()``, or a list of these.
    Raises `BadInput` if nothing is given or something other than an edge is named.
    """
    links: dict[int, tuple[Any, list[str]]] = {}
    for thing, names in _flatten(source):
        link = links.setdefault(id(thing), (thing, []))
        for name in names:
            if not _EDGE_NAME.search(name):
                raise BadInput(
                    translate(
                        "Faceformer",
                        "{} is not an edge. Select edges of a drawing, or a whole sketch.",
                    ).format(name)
                )
            if name not in link[1]:
                link[1].append(name)
    if not links:
        raise BadInput(
            translate("Faceformer", "Nothing is selected. Select a sketch, or edges in a plane.")
        )
    return [(thing, tuple(names)) for thing, names in links.values()]


def property_links(source: Any) -> list[tuple[Any, list[str]]]:
    """A source of document objects in the form of FreeCAD's link properties."""
    return [(thing, list(names) or [""]) for thing, names in normalise(source)]


def _flatten(source: Any) -> Iterator[tuple[Any, Iterable[str]]]:
    if source is None:
        return
    if hasattr(source, "SubElementNames") and hasattr(source, "Object"):
        yield source.Object, source.SubElementNames
    elif isinstance(source, Part.Shape) or hasattr(source, "TypeId"):
        yield source, ()
    elif _is_pair(source):
        names = [source[1]] if isinstance(source[1], str) else source[1]
        yield source[0], [name for name in names if name]
    elif isinstance(source, (list, tuple)):
        for part in source:
            yield from _flatten(part)
    else:
        raise BadInput(
            translate("Faceformer", "A drawing cannot be taken from {}.").format(
                type(source).__name__
            )
        )


def _is_pair(source: Any) -> bool:
    if not isinstance(source, (list, tuple)) or len(source) != 2:
        return False
    names = source[1]
    if isinstance(names, str):
        return True
    return (
        isinstance(names, (list, tuple))
        and bool(names)
        and all(isinstance(name, str) for name in names)
    )


def extract(source: Any) -> Extraction:
    """The edges of a source in the plane that they lie in.

    Raises `BadInput` if the source is empty, has faces, lies in no plane or has coordinates that
    are not finite numbers; the message names the edge.
    """
    links = normalise(source)
    several = len(links) > 1
    named = []
    for thing, names in links:
        prefix = f"{getattr(thing, 'Label', 'Shape')}." if several else ""
        named += [(prefix + name, edge) for name, edge in _edges(thing, names)]
    if not named:
        raise BadInput(
            translate("Faceformer", "There are no edges in the selection. Draw some lines first.")
        )
    sampled = [(name, _finite(name, sample(edge))) for name, edge in named]
    placement = _sketch_placement([thing for thing, _ in links]) or _best_placement(sampled)
    return Extraction(tuple(_flat(sampled, placement)), placement)


def is_planar_object(thing: Any) -> bool:
    """Whether an object is flat by its type: a sketch, or a Draft object, which may be filled."""
    return hasattr(thing, "isDerivedFrom") and thing.isDerivedFrom("Part::Part2DObject")


def _edges(thing: Any, names: tuple[str, ...]) -> list[tuple[str, Part.Edge]]:
    if isinstance(thing, Part.Shape):
        shape, outer = thing, FreeCAD.Placement()
    else:
        shape, outer = Part.getShape(thing), _parents_placement(thing)
    if shape.isNull():
        raise BadInput(
            translate("Faceformer", "{} has no lines. Draw some, or select another.").format(
                getattr(thing, "Label", type(thing).__name__)
            )
        )
    if not names and shape.Faces and not is_planar_object(thing):
        raise BadInput(
            translate(
                "Faceformer",
                "{} has faces already. Select a sketch or single edges; a solid is turned into a "
                "drawing by Wireframe from Solid.",
            ).format(getattr(thing, "Label", "The shape"))
        )
    if names:
        edges = [(name.rpartition(".")[2], _sub_edge(thing, shape, name)) for name in names]
    else:
        edges = [(f"Edge{k}", edge) for k, edge in enumerate(shape.Edges, 1)]
    matrix = outer.toMatrix()
    if not outer.isIdentity():
        edges = [(name, edge.transformed(matrix)) for name, edge in edges]
    return [(name, edge) for name, edge in edges if not edge.Degenerated]


def _sub_edge(thing: Any, shape: Part.Shape, name: str) -> Part.Edge:
    try:
        found = (
            thing.getElement(name)
            if isinstance(thing, Part.Shape)
            else Part.getShape(thing, name, needSubElement=True)
        )
    except Exception:  # FreeCAD raises different errors for a missing element
        found = None
    if found is None or found.isNull() or not isinstance(found, Part.Edge):
        raise BadInput(
            translate("Faceformer", "{} is not there any more. Select the lines again.").format(
                name
            )
        )
    return found


def _parents_placement(thing: Any) -> FreeCAD.Placement:
    """What the containers of an object add to its own placement."""
    if not (hasattr(thing, "getGlobalPlacement") and hasattr(thing, "Placement")):
        return FreeCAD.Placement()
    return thing.getGlobalPlacement().multiply(thing.Placement.inverse())


def sample(edge: Part.Edge) -> list[FreeCAD.Vector]:
    """Points on the curve of an edge, both ends included; the ends of a closed one are equal."""
    points = _sample(edge)
    if edge.isClosed():
        points[-1] = points[0]
    return points


def _sample(edge: Part.Edge) -> list[FreeCAD.Vector]:
    first, last = edge.ParameterRange
    curve = edge.Curve
    if isinstance(curve, (Part.Line, Part.LineSegment)):
        count = 2
    elif isinstance(curve, (Part.Circle, Part.Ellipse)):
        count = math.ceil(FULL_TURN_POINTS * abs(last - first) / (2 * math.pi)) + 1
        count = max(count, LEAST_CURVE_POINTS)
    elif isinstance(curve, Part.BSplineCurve):
        if curve.Degree == 1 and curve.NbPoles == 2:
            count = 2
        else:
            inside = [k for k in curve.getKnots() if first < k < last]
            return _sample_spans(edge, [first, *inside, last])
    else:
        count = FULL_TURN_POINTS + 1
    step = (last - first) / (count - 1)
    parameters = [first + step * k for k in range(count - 1)] + [last]
    return [edge.valueAt(t) for t in parameters]


def _sample_spans(edge: Part.Edge, knots: list[float]) -> list[FreeCAD.Vector]:
    points = [edge.valueAt(knots[0])]
    for start, end in zip(knots, knots[1:], strict=False):
        step = (end - start) / SPAN_POINTS
        points += [edge.valueAt(start + step * k) for k in range(1, SPAN_POINTS)]
        points.append(edge.valueAt(end))
    return points


def _finite(name: str, points: list[FreeCAD.Vector]) -> list[FreeCAD.Vector]:
    for point in points:
        if not all(math.isfinite(value) for value in point):
            raise BadInput(
                translate(
                    "Faceformer",
                    "{} has a coordinate that is not a finite number. Draw it again.",
                ).format(name)
            )
    return points


def _sketch_placement(things: list[Any]) -> FreeCAD.Placement | None:
    """The plane of the first sketch, if the source is made of sketches; others must lie in it."""
    if not all(getattr(thing, "TypeId", "").startswith("Sketcher::") for thing in things):
        return None
    first = things[0]
    return _parents_placement(first).multiply(first.Placement)


def _best_placement(sampled: list[tuple[str, list[FreeCAD.Vector]]]) -> FreeCAD.Placement:
    frame = fit_plane([tuple(point) for _, points in sampled for point in points])
    if frame is None:
        raise BadInput(
            translate(
                "Faceformer",
                "All selected edges lie on one straight line. A drawing needs lines in two "
                "directions.",
            )
        )
    origin, x, y, z = (FreeCAD.Vector(*v) for v in frame)
    return FreeCAD.Placement(origin, FreeCAD.Rotation(x, y, z, "ZXY"))


def _flat(
    sampled: list[tuple[str, list[FreeCAD.Vector]]], placement: FreeCAD.Placement
) -> Iterator[SourceEdge]:
    inverse = placement.inverse()
    local = [(name, [inverse.multVec(point) for point in points]) for name, points in sampled]
    size = _extent([point for _, points in local for point in points])
    for name, points in local:
        off = max(abs(point.z) for point in points)
        if not off <= PLANE_TOLERANCE * size:
            raise BadInput(
                translate(
                    "Faceformer",
                    "{} is {:.3g} mm off the plane of the other lines. A drawing must lie in one "
                    "plane.",
                ).format(name, off)
            )
        yield SourceEdge(name, tuple((point.x, point.y) for point in points))


def _extent(points: list[FreeCAD.Vector]) -> float:
    """Diagonal of the bounding box."""
    spans = [max(values) - min(values) for values in zip(*points, strict=True)]
    return math.hypot(*spans)
