"""Solids of known shape are drawn as they must be."""

import math

import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert, BRepBuilderAPI_Transform
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from faceformer_training.check import check_drawing
from faceformer_training.project import (
    PreparedSolid,
    ProjectionError,
    ProjectOptions,
    View,
    ViewError,
    project_solid,
)

FREE = ProjectOptions(min_faces=1)
VIEW = View(np.array([0.61, 0.33, 0.72]))
NEAR = View(np.array([0.61, 0.33, 0.72]), 2.7)


def box(x=30.0, y=20.0, z=10.0):
    return BRepPrimAPI_MakeBox(gp_Pnt(5, -3, 2), x, y, z).Solid()


def cylinder(radius=5.0, height=12.0, at=(0, 0, 0), axis=(0, 0, 1)):
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(*at), gp_Dir(*axis)), radius, height).Shape()


def moved(shape, transform):
    return BRepBuilderAPI_Transform(shape, transform, True).Shape()


def counts(drawing):
    """Vertices, edges, faces."""
    return len(drawing.vertices), len(drawing.edges), len(drawing.truth.faces)


def types(drawing):
    return sorted(face.type for face in drawing.truth.faces)


def drawn(shape, view=VIEW, options=FREE):
    drawing = project_solid(shape, view, options, "test", "made here")
    assert check_drawing(drawing) == []
    return drawing


@pytest.mark.parametrize("view", [VIEW, NEAR])
def test_a_box(view):
    drawing = drawn(box(), view)
    assert counts(drawing) == (8, 12, 6)
    assert types(drawing) == ["plane"] * 6
    # Half diagonal 1, centred.
    corners = drawing.truth.vertices3d - [0, 0, 0 if view is VIEW else -2.7]
    assert np.linalg.norm(corners, axis=1) == pytest.approx(np.ones(8), abs=2e-6)


@pytest.mark.parametrize("view", [VIEW, NEAR])
def test_a_cylinder_is_split_in_two(view):
    drawing = drawn(cylinder(), view)
    # Two silhouettes; the seam and its two vertices are gone.
    assert counts(drawing) == (4, 6, 4)
    assert types(drawing) == ["cylinder", "cylinder", "plane", "plane"]
    straight = [e for e in drawing.edges if len(e.points) == 2]
    assert len(straight) == 2


def test_silhouettes_of_a_cylinder_touch_its_circles():
    drawing = drawn(cylinder())
    axis = drawing.truth.directions[2]
    for edge, points in zip(drawing.edges, drawing.truth.edges3d, strict=True):
        if len(edge.points) == 2:
            outward = points[0] - axis * (points[0] @ axis)
            # Orthographic: the normal on the silhouette is at right angles to the view.
            assert outward[2] == pytest.approx(0, abs=3e-6)


def test_a_cone_has_silhouettes_to_its_apex_or_none():
    cone = BRepPrimAPI_MakeCone(5.0, 0.0, 12.0).Shape()
    assert counts(drawn(cone)) == (3, 4, 3)
    # From above, within the cone's own angle, all of it is seen and the apex is no vertex.
    flat = BRepPrimAPI_MakeCone(12.0, 0.0, 3.0).Shape()
    above = drawn(flat, View(np.array([0.1, 0.05, 1.0])))
    assert counts(above) == (1, 1, 2)


def test_a_truncated_cone():
    assert counts(drawn(BRepPrimAPI_MakeCone(5.0, 2.0, 7.0).Shape())) == (4, 6, 4)


@pytest.mark.parametrize("view", [VIEW, NEAR])
def test_a_sphere_is_two_faces_and_a_circle(view):
    drawing = drawn(BRepPrimAPI_MakeSphere(3.0).Shape(), view)
    assert counts(drawing) == (1, 1, 2)
    assert types(drawing) == ["sphere", "sphere"]
    radius = np.linalg.norm(drawing.edges[0].points, axis=1)
    # The bounding box's half diagonal is sqrt(3) radii; a camera at 2.7 sees more of a cone.
    r = 1 / math.sqrt(3)
    expected = r if view is VIEW else 2.7 * math.tan(math.asin(r / 2.7))
    assert radius == pytest.approx(np.full(len(radius), expected), abs=1e-5)


def test_a_torus():
    drawing = drawn(BRepPrimAPI_MakeTorus(10.0, 2.0).Shape(), View(np.array([0.5, 0.2, 1.0])))
    # Outer and inner outline; both parts are rings with two loops.
    assert counts(drawing) == (2, 2, 2)
    assert [len(f.loops) for f in drawing.truth.faces] == [2, 2]


def test_a_hole_is_seen_from_inside():
    plate = BRepAlgoAPI_Cut(box(), cylinder(4.0, 30.0, (18, 6, -5))).Shape()
    drawing = drawn(plate)
    assert counts(drawing) == (12, 18, 10 - 2)
    ringed = [f for f in drawing.truth.faces if len(f.loops) == 2]
    assert [f.type for f in ringed] == ["plane", "plane"]


def test_a_fillet_smoothly_beside_another():
    shape = box()
    fillet = BRepFilletAPI_MakeFillet(shape)
    edges = TopExp_Explorer(shape, TopAbs_EDGE)
    while edges.More():
        fillet.Add(2.0, TopoDS.Edge_s(edges.Current()))
        edges.Next()
    drawing = drawn(fillet.Shape())
    # 6 planes; some of the 12 quarter cylinders and 8 sphere patches are split.
    assert len(drawing.truth.faces) > 26
    degree = np.bincount([v for e in drawing.edges for v in e.v])
    # A silhouette passes from one face to its smooth neighbour at one vertex.
    assert set(degree) <= {3, 4} and (degree == 4).any()


def test_a_mirrored_solid_is_drawn_mirrored():
    part = BRepAlgoAPI_Cut(box(), cylinder(3.0, 30.0, (12, 4, -5))).Shape()
    mirror = gp_Trsf()
    mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)))
    there = drawn(moved(part, mirror), View(VIEW.direction * [-1, 1, 1]))
    assert counts(there) == counts(drawn(part))


def test_free_surfaces_are_recognised():
    part = BRepAlgoAPI_Fuse(box(), cylinder(4.0, 30.0, (18, 6, -5))).Shape()
    plain = drawn(part)
    free = drawn(BRepBuilderAPI_NurbsConvert(part).Shape())
    assert counts(free) == counts(plain)
    assert types(free) == types(plain)


def test_where_a_solid_stands_does_not_matter():
    part = BRepAlgoAPI_Cut(box(), cylinder(3.0, 30.0, (12, 4, -5))).Shape()
    scale = gp_Trsf()
    scale.SetScale(gp_Pnt(100, 7, 3), 0.02)
    a, b = drawn(part), drawn(moved(part, scale))
    assert a.vertices == pytest.approx(b.vertices, abs=3e-6)


def test_a_turned_solid_in_a_turned_view_is_the_same_drawing():
    part = BRepAlgoAPI_Cut(box(), cylinder(3.0, 30.0, (12, 4, -5))).Shape()
    turn = gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), math.pi / 2)
    x, y, z = VIEW.direction
    a, b = drawn(part), drawn(moved(part, turn), View(np.array([-y, x, z])))
    assert a.vertices == pytest.approx(b.vertices, abs=3e-6)


def code(call, *arguments):
    with pytest.raises(ProjectionError) as caught:
        call(*arguments)
    return caught.value.code


def test_what_cannot_be_drawn_is_refused_with_a_code():
    hollow = BRepAlgoAPI_Cut(box(30, 30, 30), cylinder(2.0, 5.0, (20, 12, 14))).Shape()
    assert code(PreparedSolid, hollow) == "several-shells"
    assert code(PreparedSolid, box(30, 20, 0.01)) == "too-thin"
    assert code(project_solid, BRepPrimAPI_MakeSphere(3.0).Shape(), VIEW) == "too-few-faces"


def test_a_solid_inside_out_is_turned():
    assert counts(drawn(box().Reversed())) == (8, 12, 6)


def test_a_view_along_a_face_is_refused():
    with pytest.raises(ViewError):
        project_solid(box(), View(np.array([0.0, 0.6, 0.8])))


def test_random_views_depend_on_the_seed_alone():
    solid = PreparedSolid(box())
    a, b, c = (solid.draw_generic("ortho", np.random.default_rng(s)).to_json() for s in (1, 1, 2))
    assert a == b != c


def test_large_drawings_are_told():
    solid = PreparedSolid(box(), ProjectOptions(max_faces=5))
    assert solid.is_large(solid.draw(VIEW))
    assert not PreparedSolid(box()).is_large(solid.draw(VIEW))
