"""Keys tell solids apart by shape, find duplicates in other clothes, and join families."""

from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf

from faceformer_training.project import PreparedSolid, ProjectOptions
from faceformer_training.project.signature import family_key, shape_key, split_of, views_key

FREE = ProjectOptions(min_faces=1)


def prepared(shape):
    return PreparedSolid(shape, FREE)


def plate(holes, radius=2.0):
    shape = BRepPrimAPI_MakeBox(60, 20, 5).Solid()
    for number in range(holes):
        axes = gp_Ax2(gp_Pnt(8 + 10 * number, 9, -1), gp_Dir(0, 0, 1))
        shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(axes, radius, 30).Shape()).Shape()
    return shape


def test_a_moved_and_mirrored_solid_has_the_same_keys():
    mirror = gp_Trsf()
    mirror.SetMirror(gp_Ax2(gp_Pnt(3, 1, 4), gp_Dir(1, 0, 0)))
    a = prepared(plate(3))
    b = prepared(BRepBuilderAPI_Transform(plate(3), mirror, True).Shape())
    assert shape_key(a) == shape_key(b)
    assert views_key(a) == views_key(b)
    assert family_key(a) == family_key(b)


def test_sizes_differ_but_are_one_family():
    a, b = prepared(plate(3)), prepared(plate(3, 2.1))
    assert shape_key(a) != shape_key(b)
    assert family_key(a) == family_key(b)


def test_boxes_that_look_alike_on_a_grid_differ():
    a = prepared(BRepPrimAPI_MakeBox(30, 20, 10).Solid())
    b = prepared(BRepPrimAPI_MakeBox(30, 20, 10.1).Solid())
    assert views_key(a) != views_key(b)


def test_a_repeated_feature_stays_in_the_family():
    assert family_key(prepared(plate(3))) == family_key(prepared(plate(5)))
    assert family_key(prepared(plate(3))) != family_key(prepared(plate(0)))


def test_splits_follow_the_shares():
    found = [split_of(f"family {i}") for i in range(4000)]
    assert 0.87 < found.count("train") / 4000 < 0.93
    assert 0.03 < found.count("valid") / 4000 < 0.07
    assert split_of("x", (1.0, 0.0, 0.0)) == "train"
