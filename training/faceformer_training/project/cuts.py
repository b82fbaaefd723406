"""Where silhouettes cross the edges of a solid: exact places, shared by the faces beside."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from .brep import Brep, BrepFace, CoEdge
from .contours import FaceSigns, edge_key
from .errors import require
from .mesh import Polygon
from .views import View

SAME_CUT = 5e-4
"""Cuts of one edge by its two faces nearer than this are one (a nearly smooth edge)."""


@dataclass(frozen=True)
class Crossing:
    """Contour ``contour`` of face ``face`` starts or ends on segment ``segment`` of a co-edge."""

    face: int
    wire: int
    position: int
    segment: int
    contour: int
    is_start: bool


@dataclass
class Cut:
    """A place on an edge where one contour, or one of each face beside it, starts or ends."""

    param: float
    crossings: list[Crossing]


def find_cuts(brep: Brep, view: View, signs: dict[int, FaceSigns]) -> dict[int, list[Cut]]:
    """The cuts of every edge that has any, in the order of the edge's parameters.

    Raises ``ProjectionError("contour")`` where a contour ends off the boundary.
    """
    found: dict[int, list[Crossing]] = defaultdict(list)
    for index, face_signs in signs.items():
        if face_signs.contours:
            for edge, crossing in _crossings(brep, index, face_signs):
                found[edge].append(crossing)
    return {edge: _place(brep, view, edge, crossings) for edge, crossings in found.items()}


def _crossings(brep: Brep, index: int, face_signs: FaceSigns):
    face = brep.faces[index]
    mesh = face.mesh
    assert mesh is not None
    ends: dict[tuple[int, bool], int] = {}
    for number, contour in enumerate(face_signs.contours):
        if not contour.closed:
            ends[contour.start, True] = number
            ends[contour.end, False] = number
    for wire, (coedges, polygons) in enumerate(zip(face.wires, mesh.polygons, strict=True)):
        for position, (coedge, polygon) in enumerate(zip(coedges, polygons, strict=True)):
            if brep.edges[coedge.edge].seam:
                continue
            nodes = polygon.nodes
            for segment in np.flatnonzero(np.diff(face_signs.signs[nodes].astype(int))).tolist():
                key = edge_key(mesh, nodes[segment], nodes[segment + 1])
                # Walked with the face on the left, a contour starts where front turns to back.
                is_start = bool(face_signs.signs[nodes[segment]]) == coedge.forward
                number = ends.pop((key, is_start), None)
                require(number is not None, "contour", f"no contour ends on edge {coedge.edge + 1}")
                yield coedge.edge, Crossing(index, wire, position, segment, number, is_start)
    require(not ends, "contour", f"a contour of face {index + 1} ends inside it")


def _place(brep: Brep, view: View, number: int, crossings: list[Crossing]) -> list[Cut]:
    edge = brep.edges[number]
    if edge.curve is None:
        # All of a pole is one point: only the order matters.
        cuts = [Cut(float(c.segment), [c]) for c in crossings]
        return sorted(cuts, key=lambda cut: cut.param)
    if edge.smooth:
        return _place_shared(brep, view, crossings)
    cuts = sorted((Cut(_root(brep, view, c), [c]) for c in crossings), key=lambda cut: cut.param)
    points = edge.curve.points(np.array([cut.param for cut in cuts]))
    merged = [cuts[0]]
    for before, here, cut in zip(points, points[1:], cuts[1:], strict=False):
        last = merged[-1].crossings
        near = float(np.linalg.norm(here - before)) < SAME_CUT
        if near and len(last) == 1 and last[0].face != cut.crossings[0].face:
            last.append(cut.crossings[0])
        else:
            merged.append(cut)
    return merged


def _place_shared(brep: Brep, view: View, crossings: list[Crossing]) -> list[Cut]:
    by_segment: dict[int, list[Crossing]] = defaultdict(list)
    for crossing in crossings:
        by_segment[crossing.segment].append(crossing)
    cuts = []
    for segment in sorted(by_segment):
        pair = by_segment[segment]
        require(len(pair) == 2, "contour", "one silhouette stops at a smooth edge")
        cuts.append(Cut(_root(brep, view, pair[0]), pair))
    return cuts


def _root(brep: Brep, view: View, crossing: Crossing) -> float:
    """The edge's parameter where normal . view is zero, within the crossing's segment."""
    face: BrepFace = brep.faces[crossing.face]
    mesh = face.mesh
    assert mesh is not None
    coedge: CoEdge = face.wires[crossing.wire][crossing.position]
    polygon: Polygon = mesh.polygons[crossing.wire][crossing.position]
    curve = mesh.curve2d(coedge)

    def value(param: float) -> float:
        place = curve.Value(param)
        uv = np.array([[place.X(), place.Y()]])
        return float(view.facing(*face.surface.evaluate(uv))[0])

    a, b = polygon.params[crossing.segment], polygon.params[crossing.segment + 1]
    at_a, at_b = value(a), value(b)
    if (at_a >= 0) != (at_b >= 0):
        return float(brentq(value, a, b, xtol=1e-12 * max(1.0, abs(a), abs(b)), rtol=1e-12))
    # The sign at one end came from the neighbour across a smooth edge, or from rounding:
    # the zero is at that end, up to the difference of the normals.
    require(min(abs(at_a), abs(at_b)) < 0.03, "contour", "no root where the sign changes")
    nearer, other = (a, b) if abs(at_a) < abs(at_b) else (b, a)
    return nearer + 1e-6 * (other - nearer)
