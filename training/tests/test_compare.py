"""Two drawings agree whatever their numbering, and not if a face or an edge differs."""

import copy

import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

from faceformer_training.compare import difference, type_difference
from faceformer_training.drawing import Edge
from faceformer_training.project import PreparedSolid, View
from faceformer_training.project.hlr import outline_lengths

VIEW = View(np.array([0.61, 0.33, 0.72]))


@pytest.fixture(scope="module")
def solid():
    tool = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(10, 8, -1), gp_Dir(0, 0, 1)), 4, 30).Shape()
    return PreparedSolid(BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(30, 20, 10).Solid(), tool).Shape())


@pytest.fixture
def drawing(solid):
    return solid.draw(VIEW)


def renumbered(drawing):
    """The same drawing with vertices and edges in reverse order, every other edge turned."""
    other = copy.deepcopy(drawing)
    count, edges = len(drawing.vertices), len(drawing.edges)
    other.vertices = drawing.vertices[::-1].copy()
    turn = {}
    other.edges = []
    for new, old in enumerate(range(edges, 0, -1), 1):
        edge = drawing.edges[old - 1]
        way = -1 if old % 2 else 1
        v = tuple(count - 1 - x for x in edge.v)[::way]
        other.edges.append(Edge(v, edge.points[::way]))
        turn[old] = way * new
    for face in other.truth.faces:
        face.loops = [
            [turn[abs(k)] * (1 if k > 0 else -1) for k in loop[1:] + loop[:1]]
            for loop in face.loops
        ]
    return other


def test_numbering_does_not_matter(drawing):
    assert difference(drawing, renumbered(drawing)) is None
    assert difference(renumbered(drawing), drawing) is None


def test_a_turned_face_is_a_difference(drawing):
    other = renumbered(drawing)
    loops = other.truth.faces[0].loops
    other.truth.faces[0].loops = [[-k for k in reversed(loop)] for loop in loops]
    assert difference(drawing, other).startswith("faces")


def test_a_moved_vertex_is_a_difference(drawing):
    other = copy.deepcopy(drawing)
    other.vertices[3] += 0.01
    assert difference(drawing, other).startswith("vertices")


def test_a_missing_edge_is_a_difference(drawing):
    other = copy.deepcopy(drawing)
    other.edges.pop()
    assert difference(drawing, other).startswith("edges")


def test_types_are_compared_apart(drawing):
    other = copy.deepcopy(drawing)
    other.truth.faces[0].type = "torus"
    assert difference(drawing, other) is None
    assert "torus" in type_difference(drawing, other)


def test_the_view_of_a_drawing_is_found_again(solid, drawing):
    view = View.of_directions(np.round(drawing.truth.directions, 6))
    assert difference(solid.draw(view), drawing) is None


@pytest.mark.parametrize("distance", [None, 2.7])
def test_outlines_are_as_long_as_by_hidden_line_removal(solid, distance):
    ours, kernel = outline_lengths(solid, View(VIEW.direction, distance))
    assert ours == pytest.approx(kernel, rel=1e-3) and ours > 0.1
