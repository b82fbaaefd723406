"""A plain copy of a solid's B-rep: vertices, edges with curves, faces with wires of co-edges.

OCCT supplies geometry and the meshes of curved faces; all topology after this is ours.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools, BRepTools_WireExplorer
from OCP.TopAbs import (
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_FORWARD,
    TopAbs_REVERSED,
    TopAbs_VERTEX,
    TopAbs_WIRE,
)
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Iterator, TopoDS_Solid
from OCP.TopTools import TopTools_IndexedMapOfShape

from .curves import EdgeCurve
from .errors import require
from .mesh import FaceMesh, glue
from .options import ProjectOptions
from .surfaces import FaceSurface, xyz

SMOOTH = 3e-3
"""Largest angle between two faces' normals (radians) along an edge that counts as smooth."""


@dataclass
class CoEdge:
    """Edge ``edge`` in a face's wire, walked from its first vertex if ``forward``.

    Orientation is that of the FORWARD face: its material is on the left, seen against the
    surface's natural normal.
    """

    edge: int
    forward: bool


@dataclass
class BrepEdge:
    """An edge; ``curve`` is None where it is degenerate (a pole). ``seam``: one face, both ways."""

    shape: TopoDS_Edge
    v: tuple[int, int]
    curve: EdgeCurve | None
    uses: list[tuple[int, bool]] = field(default_factory=list)
    seam: bool = False
    smooth: bool = False
    """Both faces are curved and have the same normals along it."""


# OCCT fails to mesh a face now and then; it seldom fails with a finer or coarser mesh as well.
MESHES = (1.0, 0.5, 2.5)


def _mesh(solid: TopoDS_Solid, options: ProjectOptions) -> None:
    for factor in MESHES:
        BRepTools.Clean_s(solid)
        deflection, angle = factor * options.mesh_deflection, factor * options.mesh_angle
        BRepMesh_IncrementalMesh(solid, deflection, False, angle, False)
        if BRepTools.Triangulation_s(solid, 2 * deflection):
            return


@dataclass
class BrepFace:
    """A face: ``reversed`` where its outward normal is against the natural one."""

    shape: TopoDS_Face
    reversed: bool
    surface: FaceSurface
    wires: list[list[CoEdge]]
    mesh: FaceMesh | None = None

    @property
    def flat(self) -> bool:
        return self.surface.label == "plane"


class Brep:
    """The copy of a normalised solid. Raises ``ProjectionError`` where it is no closed manifold.

    Attributes: ``vertices`` (N, 3), ``edges``, ``faces``; ``characteristic`` is
    V - E + 2 F - loops over the non-degenerate edges; ``firm`` the vertices that every drawing
    has; ``planes`` (K, 3) points and (K, 3) natural normals of the plane faces.
    """

    def __init__(self, solid: TopoDS_Solid, options: ProjectOptions) -> None:
        self.options = options
        _mesh(solid, options)
        edge_map, vertex_map, face_map = (TopTools_IndexedMapOfShape() for _ in range(3))
        TopExp.MapShapes_s(solid, TopAbs_EDGE, edge_map)
        TopExp.MapShapes_s(solid, TopAbs_VERTEX, vertex_map)
        TopExp.MapShapes_s(solid, TopAbs_FACE, face_map)
        self._edge_map = edge_map
        self.vertices = np.array(
            [
                xyz(BRep_Tool.Pnt_s(TopoDS.Vertex_s(vertex_map.FindKey(i))))
                for i in range(1, vertex_map.Extent() + 1)
            ]
        ).reshape(-1, 3)
        self.edges = [
            _edge(TopoDS.Edge_s(edge_map.FindKey(i)), vertex_map)
            for i in range(1, edge_map.Extent() + 1)
        ]
        self.faces: list[BrepFace] = []
        for i in range(1, face_map.Extent() + 1):
            self.faces.append(self._face(TopoDS.Face_s(face_map.FindKey(i))))
        self._check_manifold()
        for face in self.faces:
            if face.flat:
                slit = any(self.edges[c.edge].seam for wire in face.wires for c in wire)
                require(not slit, "slit")
            else:
                face.mesh = FaceMesh(face, self.edges)
        self._glue()
        self._summarise()

    def _face(self, shape: TopoDS_Face) -> BrepFace:
        index = len(self.faces)
        turned = shape.Orientation() == TopAbs_REVERSED
        forward = TopoDS.Face_s(shape.Oriented(TopAbs_FORWARD))
        wires = []
        children = TopoDS_Iterator(forward)
        while children.More():
            child = children.Value()
            children.Next()
            require(child.ShapeType() == TopAbs_WIRE, "wire", f"face {index + 1} has other parts")
            wire = self._wire(TopoDS.Wire_s(child), forward, index)
            for coedge in wire:
                self.edges[coedge.edge].uses.append((index, coedge.forward != turned))
            wires.append(wire)
        require(bool(wires), "wire", f"face {index + 1} has none")
        surface = FaceSurface(forward, self.options.recognition)
        return BrepFace(forward, turned, surface, wires)

    def _wire(self, wire, face: TopoDS_Face, index: int) -> list[CoEdge]:
        size = 0
        members = TopoDS_Iterator(wire)
        while members.More():
            size += 1
            members.Next()
        walk = []
        explorer = BRepTools_WireExplorer(wire, face)
        while explorer.More():
            edge = explorer.Current()
            way = edge.Orientation()
            require(way in (TopAbs_FORWARD, TopAbs_REVERSED), "wire", "internal edge")
            walk.append(CoEdge(self._edge_map.FindIndex(edge) - 1, way == TopAbs_FORWARD))
            explorer.Next()
        require(len(walk) == size and size > 0, "wire", f"face {index + 1} is not one walk")
        if not self._linked(walk):
            # A wire that is itself REVERSED is explored against its edges' orientation.
            walk.reverse()
            require(self._linked(walk), "wire", f"face {index + 1} is not linked")
        return walk

    def _linked(self, walk: list[CoEdge]) -> bool:
        ends = [self.edges[c.edge].v[:: 1 if c.forward else -1] for c in walk]
        return all(a[1] == b[0] for a, b in zip(ends, ends[1:] + ends[:1], strict=True))

    def _check_manifold(self) -> None:
        for number, edge in enumerate(self.edges, 1):
            if edge.curve is None:
                continue
            require(len(edge.uses) == 2, "not-closed", f"edge {number}: {len(edge.uses)} uses")
            (face_a, way_a), (face_b, way_b) = edge.uses
            require(way_a != way_b, "not-closed", f"edge {number} is used twice one way")
            edge.seam = face_a == face_b

    def _glue(self) -> None:
        """Number the mesh nodes of all curved faces, those on smooth edges as one.

        Where two faces meet smoothly they have the same normal, so the same sign of
        normal . view: deciding it once makes a silhouette pass from one to the other at one
        point whatever the rounding.
        """
        self.meshed = [i for i, face in enumerate(self.faces) if face.mesh is not None]
        offset = 0
        for i in self.meshed:
            mesh = self.faces[i].mesh
            assert mesh is not None
            mesh.offset = offset
            offset += len(mesh.uv)
        if not self.meshed:
            return
        meshes = [self.faces[i].mesh for i in self.meshed]
        self.node_points = np.vstack([m.points for m in meshes])
        outward = [
            m.normals * (-1.0 if self.faces[i].reversed else 1.0)
            for i, m in zip(self.meshed, meshes, strict=True)
        ]
        self.node_normals = np.vstack(outward)
        pairs = [np.stack([np.arange(len(m.uv)) + m.offset, m.key + m.offset]) for m in meshes]
        for number, edge in enumerate(self.edges):
            if edge.curve is None or edge.seam:
                continue
            sides = [self.faces[face].mesh for face, _ in edge.uses]
            if None in sides:
                continue
            nodes = [
                np.array(m.polygon_of_edge[number].nodes) + m.offset for m in sides if m is not None
            ]
            if len(nodes[0]) != len(nodes[1]):
                continue
            dots = (self.node_normals[nodes[0]] * self.node_normals[nodes[1]]).sum(1)
            if dots.min() > np.cos(SMOOTH):
                edge.smooth = True
                pairs.append(np.stack(nodes))
        self.node_class = glue(offset, np.hstack(pairs))

    def _summarise(self) -> None:
        drawn = Counter(
            v for edge in self.edges if edge.curve is not None and not edge.seam for v in edge.v
        )
        self.firm = np.array([v for v, n in drawn.items() if n >= 3], dtype=int)
        real = sum(edge.curve is not None for edge in self.edges)
        self.characteristic = (
            len(self.vertices) - real + sum(2 - len(face.wires) for face in self.faces)
        )
        flat = [face for face in self.faces if face.flat]
        self.plane_normals = np.array([f.surface.natural_normal() for f in flat]).reshape(-1, 3)
        anchors = [self.edges[f.wires[0][0].edge].v[0] for f in flat]
        self.plane_points = self.vertices[anchors].reshape(-1, 3)


def _edge(shape: TopoDS_Edge, vertex_map: TopTools_IndexedMapOfShape) -> BrepEdge:
    edge = TopoDS.Edge_s(shape.Oriented(TopAbs_FORWARD))
    first, last = TopExp.FirstVertex_s(edge, False), TopExp.LastVertex_s(edge, False)
    require(not first.IsNull() and not last.IsNull(), "wire", "an edge without vertices")
    ends = (vertex_map.FindIndex(first) - 1, vertex_map.FindIndex(last) - 1)
    pole = BRep_Tool.Degenerated_s(edge)
    return BrepEdge(edge, ends, None if pole else EdgeCurve(edge))
