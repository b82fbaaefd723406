"""The mesh of a curved face: nodes with exact points and normals, and how they are glued.

A silhouette's topology comes from the sign of normal . view at these nodes. Three places need
care. Along a seam the mesh has two rows of nodes that are one: they share a ``key``. At a pole
with one normal (a sphere's) all nodes share a key. At a pole with many normals (a cone's apex)
OCCT has one node; here every mesh edge that runs into it gets a node of its own, with the
normal seen along that edge, so that a silhouette can end there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from .errors import require

if TYPE_CHECKING:
    from .brep import BrepEdge, BrepFace, CoEdge

SHARP_SEAM = np.cos(0.15)
ONE_NORMAL = np.cos(0.02)


@dataclass
class Polygon:
    """A co-edge's nodes in its face's mesh, with the edge's parameters, both in growing order."""

    nodes: list[int]
    params: list[float]


def glue(size: int, pairs: np.ndarray) -> np.ndarray:
    """Least node of each node's class, (size,), where (2, m) pairs of nodes are one."""
    ones = np.ones(pairs.shape[1], dtype=np.int8)
    graph = coo_matrix((ones, (pairs[0], pairs[1])), shape=(size, size))
    label = connected_components(graph, directed=False)[1]
    first = np.full(label.max() + 1, size)
    np.minimum.at(first, label, np.arange(size))
    return first[label]


class FaceMesh:
    """Mesh of a curved face (taken FORWARD).

    ``uv`` (n, 2); ``points`` and natural unit ``normals`` (n, 3); ``triangles`` (m, 3),
    counter-clockwise in (u, v); ``key`` (n,) the least node that is the same point of the
    solid's surface; ``polygons[wire][position]`` the polygon of each co-edge. ``offset`` is the
    number of the first node in the solid's numbering.
    """

    def __init__(self, face: BrepFace, edges: list[BrepEdge]) -> None:
        self.offset = 0
        self._face = face
        self._edges = edges
        self._curves2d: dict[tuple[int, bool], BRepAdaptor_Curve2d] = {}
        location = TopLoc_Location()
        triangulation = BRep_Tool.Triangulation_s(face.shape, location)
        require(
            triangulation is not None
            and triangulation.HasUVNodes()
            and triangulation.NbNodes() > 2,
            "mesh",
            "a face has no triangulation",
        )
        nodes = (triangulation.UVNode(i) for i in range(1, triangulation.NbNodes() + 1))
        self.uv = np.array([(p.X(), p.Y()) for p in nodes])
        count = triangulation.NbTriangles()
        triangles = np.array([triangulation.Triangle(i).Get() for i in range(1, count + 1)]) - 1
        self.triangles = _counter_clockwise(triangles, self.uv)
        self.polygons: list[list[Polygon]] = [
            [self._polygon(coedge, triangulation, location) for coedge in wire]
            for wire in face.wires
        ]
        self.points, self.normals = face.surface.evaluate(self.uv)
        # Poles first: splitting one changes the nodes at the ends of the seam's rows.
        pairs = self._poles()
        pairs += self._seam_pairs()
        identity = np.tile(np.arange(len(self.uv)), (2, 1))
        self.key = glue(len(self.uv), np.hstack([identity, *pairs]))
        self.polygon_of_edge = {
            coedge.edge: polygon
            for wire, polygons in zip(face.wires, self.polygons, strict=True)
            for coedge, polygon in zip(wire, polygons, strict=True)
        }

    def curve2d(self, coedge: CoEdge) -> BRepAdaptor_Curve2d:
        """The co-edge's curve in (u, v); on a seam the two co-edges have different ones."""
        key = (coedge.edge, coedge.forward)
        if key not in self._curves2d:
            self._curves2d[key] = BRepAdaptor_Curve2d(self._oriented(coedge), self._face.shape)
        return self._curves2d[key]

    def _oriented(self, coedge: CoEdge):
        way = TopAbs_FORWARD if coedge.forward else TopAbs_REVERSED
        return TopoDS.Edge_s(self._edges[coedge.edge].shape.Oriented(way))

    def _polygon(self, coedge: CoEdge, triangulation, location) -> Polygon:
        found = BRep_Tool.PolygonOnTriangulation_s(self._oriented(coedge), triangulation, location)
        require(found is not None and found.HasParameters(), "mesh", "an edge has no polygon")
        size = range(1, found.NbNodes() + 1)
        return Polygon([found.Node(i) - 1 for i in size], [found.Parameter(i) for i in size])

    def _coedges(self):
        for wire, polygons in zip(self._face.wires, self.polygons, strict=True):
            yield from zip(wire, polygons, strict=True)

    def _seam_pairs(self) -> list[np.ndarray]:
        rows: dict[int, list[int]] = {}
        pairs = []
        for coedge, polygon in self._coedges():
            edge = self._edges[coedge.edge]
            if not edge.seam:
                continue
            if coedge.edge not in rows:
                rows[coedge.edge] = polygon.nodes
                continue
            a, b = rows[coedge.edge], polygon.nodes
            require(len(a) == len(b), "mesh", "a seam's two rows differ")
            gap = float(np.abs(self.points[a] - self.points[b]).max())
            require(gap < 2e-3, "mesh", f"a seam's two rows are {gap:g} apart")
            # At a pole the normals may differ, so only the rows' insides tell a sharp seam.
            dots = (self.normals[a] * self.normals[b]).sum(1)
            inner = dots[1:-1] if len(dots) > 2 else dots
            require(float(inner.min()) > SHARP_SEAM, "sharp-seam")
            pairs.append(np.stack([a, b]))
        return pairs

    def _poles(self) -> list[np.ndarray]:
        """Pairs of nodes at poles that are one; splits the poles that have many normals."""
        pairs = []
        for coedge, polygon in list(self._coedges()):
            if self._edges[coedge.edge].curve is not None:
                continue
            fan = self._fan(polygon)
            curve = self.curve2d(coedge)
            params, normals = self._normals_around(curve, fan)
            if len(fan) and (normals @ normals[0]).min() < ONE_NORMAL:
                self._split(polygon, fan, params, curve, normals)
            else:
                nodes = polygon.nodes
                pairs.append(np.stack([[nodes[0]] * len(nodes), nodes]))
        return pairs

    def _fan(self, pole: Polygon) -> np.ndarray:
        """Nodes that share a triangle with the pole."""
        at_pole = np.isin(self.triangles, pole.nodes)
        touching = self.triangles[at_pole.any(1)]
        return np.setdiff1d(touching, pole.nodes)

    def _normals_around(self, curve, fan: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Parameters on the pole's 2D curve facing each fan node, and normals seen from there."""
        first, last = curve.FirstParameter(), curve.LastParameter()
        a, b = curve.Value(first), curve.Value(last)
        start = np.array([a.X(), a.Y()])
        along = np.array([b.X(), b.Y()]) - start
        share = np.clip((self.uv[fan] - start) @ along / max(float(along @ along), 1e-30), 0, 1)
        feet = start + share[:, None] * along
        near = feet + 1e-3 * (self.uv[fan] - feet)
        normals = self._face.surface.evaluate(near)[1] if len(fan) else np.zeros((0, 3))
        return first + share * (last - first), normals

    def _split(self, pole: Polygon, fan, params, curve, normals) -> None:
        old = set(pole.nodes)
        order = np.argsort(params, kind="stable")
        fan, params, normals = fan[order], params[order], normals[order]
        # Nodes on the two seam rows face the pole curve's two ends, which lie apart in (u, v).
        fresh = {int(node): len(self.uv) + i for i, node in enumerate(fan)}
        feet = [curve.Value(float(t)) for t in params]
        self.uv = np.vstack([self.uv, [(p.X(), p.Y()) for p in feet]])
        place = self.points[pole.nodes[0]]
        self.points = np.vstack([self.points, np.broadcast_to(place, (len(fan), 3))])
        self.normals = np.vstack([self.normals, normals])
        triangles = []
        for triangle in self.triangles.tolist():
            corner = [node in old for node in triangle]
            if not any(corner):
                triangles.append(triangle)
            elif sum(corner) == 1:
                at = corner.index(True)
                p, q = triangle[(at + 1) % 3], triangle[(at + 2) % 3]
                triangles += [[fresh[p], p, q], [fresh[p], q, fresh[q]]]
        self.triangles = np.array(triangles)
        for _, polygon in self._coedges():
            if polygon is pole or len(polygon.nodes) < 2:
                continue
            if polygon.nodes[0] in old and polygon.nodes[1] in fresh:
                polygon.nodes[0] = fresh[polygon.nodes[1]]
            if polygon.nodes[-1] in old and polygon.nodes[-2] in fresh:
                polygon.nodes[-1] = fresh[polygon.nodes[-2]]
        pole.nodes[:] = [fresh[int(node)] for node in fan]
        pole.params[:] = params.tolist()


def _counter_clockwise(triangles: np.ndarray, uv: np.ndarray) -> np.ndarray:
    a, b, c = (uv[triangles[:, i]] for i in range(3))
    ab, ac = b - a, c - a
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    return np.where((area < 0)[:, None], triangles[:, [0, 2, 1]], triangles)
