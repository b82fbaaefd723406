"""Faces split along their silhouettes: a half-edge structure, no boolean operations.

Every edge is cut into arcs where contours meet it, every contour is an arc more. Half-edge 2 a
walks arc a forwards, 2 a + 1 backwards. In each face the half-edges are linked as the wires and
the contours say, then seams and poles are taken out, and the cycles that remain are the loops of
the face's parts.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from .brep import Brep
from .contours import FaceSigns, contour_polyline, trace
from .curves import is_straight
from .cuts import Cut, find_cuts
from .errors import require
from .views import View

EDGE_END = 5e-3
"""Farthest that a polyline may end from its vertex: the slack of a solid's tolerances."""


@dataclass
class Arc:
    """A piece of an edge between ``params`` (``edge`` its number), or a contour (of ``face``).

    ``points`` (m, 3); None for seams and poles, which are not drawn.
    """

    tail: int
    head: int
    points: np.ndarray | None
    edge: int | None = None
    params: tuple[float, float] = (0.0, 0.0)
    face: int | None = None


@dataclass
class Part:
    """A face or a part of one: loops of half-edges seen from outside, ``front`` if seen so."""

    face: int
    label: str
    loops: list[list[int]]
    front: bool


@dataclass
class Split:
    """All arcs and parts of a solid in one view; ``vertices`` (N, 3) in the solid's frame."""

    vertices: list[np.ndarray] = field(default_factory=list)
    arcs: list[Arc] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)


def split_solid(
    brep: Brep, view: View, refuse: Callable[[np.ndarray], None] | None = None
) -> Split:
    """Split every curved face of a solid along its silhouettes in a view.

    ``refuse`` is given the vertices (n, 3) that the drawing is sure to have as soon as they are
    known, before the costly silhouettes, and may raise. Raises ``ProjectionError`` with
    ``contour``, ``split`` or ``edge-end``.
    """
    signs = face_signs(brep, view)
    cuts = find_cuts(brep, view, signs)
    result = Split(vertices=list(brep.vertices))
    arcs_of_edge, ends = _cut_edges(brep, cuts, result)
    if refuse is not None:
        fresh = np.array(result.vertices[len(brep.vertices) :]).reshape(-1, 3)
        refuse(np.vstack([brep.vertices[brep.firm], fresh]))
    plane_facing = view.facing(brep.plane_points, brep.plane_normals) > 0
    flat_number = 0
    for index, face in enumerate(brep.faces):
        found = signs.get(index)
        if found is None:
            front = bool(plane_facing[flat_number]) != face.reversed
            flat_number += 1
            mesh_signs = FaceSigns(np.zeros(0, bool), np.zeros(0, int), {0: front}, [])
        else:
            mesh_signs = found
        linker = _FaceLinker(brep, view, index, mesh_signs, result)
        linker.add_contours(ends)
        linker.link_wires(arcs_of_edge, cuts)
        result.parts += linker.parts()
    return result


def face_signs(brep: Brep, view: View) -> dict[int, FaceSigns]:
    """Signs, regions and contours of every curved face; True is seen from outside."""
    if not brep.meshed:
        return {}
    facing = view.facing(brep.node_points, brep.node_normals)
    shared = facing[brep.node_class] >= 0
    out = {}
    for index in brep.meshed:
        mesh = brep.faces[index].mesh
        assert mesh is not None
        out[index] = trace(mesh, shared[mesh.offset : mesh.offset + len(mesh.uv)])
    return out


def _cut_edges(brep: Brep, cuts: dict[int, list[Cut]], result: Split):
    """Arcs of every edge, in the order of its parameters; the vertex of every contour's end."""
    arcs_of_edge: list[list[int]] = []
    ends: dict[tuple[int, int, bool], int] = {}
    chord_error = brep.options.chord_error
    for number, edge in enumerate(brep.edges):
        own = cuts.get(number, [])
        vertices = [edge.v[0]]
        for cut in own:
            if edge.curve is None:
                vertex = edge.v[0]
            else:
                vertex = len(result.vertices)
                result.vertices.append(edge.curve.points(np.array([cut.param]))[0])
            vertices.append(vertex)
            for crossing in cut.crossings:
                ends[crossing.face, crossing.contour, crossing.is_start] = vertex
        vertices.append(edge.v[1])
        arcs = []
        params = [0.0] * len(vertices)
        if edge.curve is not None:
            params = [edge.curve.first, *(cut.param for cut in own), edge.curve.last]
        for i in range(len(vertices) - 1):
            points = None
            if edge.curve is not None and not edge.seam:
                points = edge.curve.polyline(params[i], params[i + 1], chord_error)
            arcs.append(len(result.arcs))
            span = (params[i], params[i + 1])
            result.arcs.append(Arc(vertices[i], vertices[i + 1], points, edge=number, params=span))
        arcs_of_edge.append(arcs)
    return arcs_of_edge, ends


class _FaceLinker:
    """Links the half-edges of one face (taken FORWARD) and reads off the loops of its parts."""

    def __init__(self, brep: Brep, view: View, index: int, signs: FaceSigns, result: Split) -> None:
        self.brep, self.view, self.index, self.signs = brep, view, index, signs
        self.face = brep.faces[index]
        self.result = result
        self.next: dict[int, int] = {}
        self.region: dict[int, int] = {}
        self.contour_arcs: list[int] = []

    def add_contours(self, ends: dict[tuple[int, int, bool], int]) -> None:
        """Add an arc for every contour, between the vertices where it meets the boundary."""
        result = self.result
        chord_error = self.brep.options.chord_error
        for number, contour in enumerate(self.signs.contours):
            mesh = self.face.mesh
            assert mesh is not None
            points = contour_polyline(self.face.surface, mesh, self.view, contour, chord_error)
            if contour.closed:
                tail = head = len(result.vertices)
                points[-1] = points[0]
                result.vertices.append(points[0].copy())
            else:
                tail, head = (ends[self.index, number, which] for which in (True, False))
                gap = max(
                    float(np.linalg.norm(points[0] - result.vertices[tail])),
                    float(np.linalg.norm(points[-1] - result.vertices[head])),
                )
                require(gap < 4 * EDGE_END, "edge-end", f"a silhouette ends {gap:g} away")
                points[0], points[-1] = result.vertices[tail], result.vertices[head]
                if is_straight(points, 2e-5):
                    points = points[[0, -1]]
            arc = len(result.arcs)
            self.contour_arcs.append(arc)
            result.arcs.append(Arc(tail, head, points, face=self.index))
            self.region[2 * arc] = contour.front
            self.region[2 * arc + 1] = contour.back
            if contour.closed:
                self.next[2 * arc] = 2 * arc
                self.next[2 * arc + 1] = 2 * arc + 1

    def link_wires(self, arcs_of_edge: list[list[int]], cuts: dict[int, list[Cut]]) -> None:
        """Link the wires' half-edges, turning into a contour wherever one starts or ends."""
        for wire in range(len(self.face.wires)):
            walk = self._walk(wire, arcs_of_edge, cuts)
            for (half, branch), (following, _) in zip(walk, walk[1:] + walk[:1], strict=True):
                if branch is None:
                    self.next[half] = following
                    continue
                number, is_start = branch
                forwards = 2 * self.contour_arcs[number]
                out, back = (forwards, forwards + 1) if is_start else (forwards + 1, forwards)
                self.next[half] = out
                self.next[back] = following

    def _walk(self, wire: int, arcs_of_edge, cuts):
        """Half-edges of a wire in order, each with the contour end that follows it, or None."""
        walk: list[tuple[int, tuple[int, bool] | None]] = []
        mesh = self.face.mesh
        for position, coedge in enumerate(self.face.wires[wire]):
            arcs = arcs_of_edge[coedge.edge]
            region = 0
            if mesh is not None:
                nodes = mesh.polygons[wire][position].nodes
                region = int(self.signs.region[nodes[0 if coedge.forward else -1]])
            branches: list[tuple[int, bool] | None] = [
                next(
                    (
                        (c.contour, c.is_start)
                        for c in cut.crossings
                        if (c.face, c.wire, c.position) == (self.index, wire, position)
                    ),
                    None,
                )
                for cut in cuts.get(coedge.edge, [])
            ]
            ordered = arcs if coedge.forward else arcs[::-1]
            after = [*(branches if coedge.forward else branches[::-1]), None]
            for arc, branch in zip(ordered, after, strict=True):
                half = 2 * arc + (0 if coedge.forward else 1)
                self.region[half] = region
                walk.append((half, branch))
                if branch is not None:
                    contour = self.signs.contours[branch[0]]
                    sides = (contour.front, contour.back)
                    here, there = sides if branch[1] else sides[::-1]
                    require(region == here, "split", "a contour has the wrong region beside it")
                    region = there
        return walk

    def parts(self) -> list[Part]:
        """The face's parts, one a region, loops seen from outside the solid."""
        loops: dict[int, list[list[int]]] = defaultdict(list)
        seen: set[int] = set()
        for start in self.next:
            if start in seen or self.result.arcs[start >> 1].points is None:
                continue
            loop = []
            half = start
            while half not in seen:
                seen.add(half)
                loop.append(half)
                half = self._follow(half)
            require(half == start, "split", "a loop does not close")
            regions = {self.region[h] for h in loop}
            require(len(regions) == 1, "split", "a loop lies in two regions")
            loops[regions.pop()].append(loop)
        require(loops.keys() == self.signs.regions.keys(), "split", "a region has no loop")
        if self.face.reversed:
            loops = {
                region: [[h ^ 1 for h in reversed(loop)] for loop in found]
                for region, found in loops.items()
            }
        label = self.face.surface.label
        return [
            Part(self.index, label, found, self.signs.regions[region])
            for region, found in loops.items()
        ]

    def _follow(self, half: int) -> int:
        """The half-edge after this one, across seams and past poles."""
        half = self.next[half]
        for _ in range(len(self.next) + 1):
            arc = self.result.arcs[half >> 1]
            if arc.points is not None:
                return half
            seam = self.brep.edges[arc.edge].seam
            half = self.next[half ^ 1] if seam else self.next[half]
        require(False, "split", "a wire of nothing but seams and poles")
        raise AssertionError
