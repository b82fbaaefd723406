# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes a cleaned drawing into a sketch as lines, arcs and ellipses joined at their ends."""

from __future__ import annotations

import math
from typing import Any

import FreeCAD
import Part

from .model import Drawing, Edge, Ellipse

CIRCLE_RATIO = 1e-6
"""An ellipse whose axes differ by less than this share is written as a circle."""

MOST_TIED = 250
"""Curves of a sketch whose ends are tied; FreeCAD's solver takes minutes for a thousand."""

FULL_TURN = 2 * math.pi * (1 - 1e-9)

Joint = tuple[tuple[int, int], tuple[int, int]]
"""Two ends that coincide: (number of the geometry, 1 for its start or 2 for its end)."""


def convert(drawing: Drawing) -> tuple[list[Any], list[Joint]]:
    """Sketch geometry of the edges, and which of their ends coincide."""
    geometry, joints = [], []
    at_vertex: dict[int, tuple[int, int]] = {}
    for number, edge in enumerate(drawing.edges):
        geometry.append(_geometry(edge))
        if edge.vertices[0] == edge.vertices[1]:
            continue
        backwards = edge.ellipse is not None and edge.ellipse.sweep < 0
        for vertex, end in zip(edge.vertices, (2, 1) if backwards else (1, 2), strict=True):
            if vertex in at_vertex:
                joints.append((at_vertex[vertex], (number, end)))
            else:
                at_vertex[vertex] = (number, end)
    return geometry, joints


def write(sketch: Any, geometry: list[Any], joints: list[Joint]) -> None:
    """Adds geometry to a sketch and ties the ends that coincide, so that they move together.

    A large drawing is left untied: its ends still meet.
    """
    import Sketcher

    sketch.addGeometry(geometry, False)
    if joints and len(geometry) <= MOST_TIED:
        sketch.addConstraint(
            [Sketcher.Constraint("Coincident", *first, *second) for first, second in joints]
        )


def piece(edge: Part.Edge) -> Any:
    """Sketch geometry of one edge in the XY plane, as it is."""
    first, last = edge.ParameterRange
    curve = edge.Curve
    if isinstance(curve, (Part.Line, Part.LineSegment)):
        return Part.LineSegment(edge.valueAt(first), edge.valueAt(last))
    if isinstance(curve, (Part.Circle, Part.Ellipse)):
        return arc(_ellipse_of(edge))
    return curve.toBSpline(first, last)


def _ellipse_of(edge: Part.Edge) -> Ellipse:
    """The elliptic arc of an edge whose axis may point either way."""
    first, last = edge.ParameterRange
    curve = edge.Curve
    center = curve.Center
    start = edge.valueAt(first) - center
    if isinstance(curve, Part.Circle):
        major, ratio = FreeCAD.Vector(curve.Radius, 0, 0), 1.0
    else:
        major = curve.XAxis * curve.MajorRadius
        ratio = curve.MinorRadius / curve.MajorRadius
    along = (start.x * major.x + start.y * major.y) / major.Length**2
    across = (start.y * major.x - start.x * major.y) / (major.Length**2 * ratio)
    sweep = (last - first) * (1 if curve.Axis.z > 0 else -1)
    return Ellipse(
        (center.x, center.y), (major.x, major.y), ratio, math.atan2(across, along), sweep
    )


def _geometry(edge: Edge) -> Any:
    points = [FreeCAD.Vector(*point) for point in edge.points]
    if edge.straight:
        return Part.LineSegment(points[0], points[-1])
    if edge.ellipse is not None:
        return arc(edge.ellipse)
    curve = Part.BSplineCurve()
    curve.interpolate(points)
    return curve


def arc(ellipse: Ellipse) -> Any:
    """A circle, an ellipse, or an arc of one, as a sketch holds it."""
    center = FreeCAD.Vector(*ellipse.center)
    major = FreeCAD.Vector(*ellipse.major)
    start, end = ellipse.start, ellipse.start + ellipse.sweep
    if ellipse.sweep < 0:
        start, end = end, start
    whole = end - start >= FULL_TURN
    if 1 - ellipse.ratio < CIRCLE_RATIO:
        turn = math.atan2(major.y, major.x)
        circle = Part.Circle(center, FreeCAD.Vector(0, 0, 1), major.Length)
        return circle if whole else Part.ArcOfCircle(circle, start + turn, end + turn)
    minor = FreeCAD.Vector(-major.y, major.x, 0) * ellipse.ratio
    full = Part.Ellipse(center + major, center + minor, center)
    return full if whole else Part.ArcOfEllipse(full, start, end)
