"""The calls to OpenCASCADE that the recipes share.

Every function either returns a shape or raises :class:`Refused`; OCCT's own exceptions
are turned into it by :func:`guarded`, so that a refusal always has a reason
that can be counted. Lengths are the recipe's own: :mod:`.finish` scales at the end.
"""

import functools
import math
from collections.abc import Callable, Iterable, Sequence

from OCP.Bnd import Bnd_Box
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepOffsetAPI import (
    BRepOffsetAPI_DraftAngle,
    BRepOffsetAPI_MakePipe,
    BRepOffsetAPI_ThruSections,
)
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakePrism,
    BRepPrimAPI_MakeRevol,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.gp import gp_Ax1, gp_Ax2, gp_Ax3, gp_Dir, gp_Pln, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Wire
from OCP.TopTools import TopTools_IndexedMapOfShape, TopTools_ListOfShape

Vector = Sequence[float]
X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
ORIGIN = (0.0, 0.0, 0.0)


class Refused(Exception):
    """A solid that could not be made as drawn; its text is the reason it is counted under."""


def from_kernel(error: BaseException) -> bool:
    """Whether an exception is OCCT's. Its Python classes have no base of their own in common."""
    return type(error).__module__.partition(".")[0] == "OCP"


def guarded(reason: str) -> Callable:
    """Turns an exception of OCCT in the decorated function into ``Refused(reason)``."""

    def wrap(function: Callable) -> Callable:
        @functools.wraps(function)
        def call(*args, **kwargs):
            try:
                return function(*args, **kwargs)
            except Exception as error:
                if from_kernel(error):
                    raise Refused(reason) from error
                raise

        return call

    return wrap


def point(p: Vector) -> gp_Pnt:
    return gp_Pnt(*map(float, p))


def vector(v: Vector) -> gp_Vec:
    return gp_Vec(*map(float, v))


def direction(v: Vector) -> gp_Dir:
    return gp_Dir(*map(float, v))


def frame(origin: Vector = ORIGIN, normal: Vector = Z, x: Vector | None = None) -> gp_Ax2:
    """A right-handed axis system; ``x`` need not be exactly normal to ``normal``."""
    if x is None:
        return gp_Ax2(point(origin), direction(normal))
    return gp_Ax2(point(origin), direction(normal), direction(x))


# The xz plane: what was drawn in (x, y) stands upright, as a profile about the z axis does.
UPRIGHT = frame(ORIGIN, (0, -1, 0), X)
Z_AXIS = gp_Ax1(point(ORIGIN), direction(Z))


def explore(shape: TopoDS_Shape, kind: TopAbs_ShapeEnum) -> list[TopoDS_Shape]:
    """The distinct subshapes of one kind, in the order in which the shape lists them."""
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(i) for i in range(1, found.Extent() + 1)]


def faces(shape: TopoDS_Shape) -> list[TopoDS_Face]:
    return [TopoDS.Face_s(f) for f in explore(shape, TopAbs_ShapeEnum.TopAbs_FACE)]


def edges(shape: TopoDS_Shape) -> list[TopoDS_Edge]:
    return [TopoDS.Edge_s(e) for e in explore(shape, TopAbs_ShapeEnum.TopAbs_EDGE)]


def shape_list(shapes: Iterable[TopoDS_Shape]) -> TopTools_ListOfShape:
    out = TopTools_ListOfShape()
    for shape in shapes:
        out.Append(shape)
    return out


# Bodies


def box(dx: float, dy: float, dz: float, corner: Vector = ORIGIN) -> TopoDS_Shape:
    return BRepPrimAPI_MakeBox(point(corner), dx, dy, dz).Shape()


def centred_box(dx: float, dy: float, dz: float, base: Vector = ORIGIN) -> TopoDS_Shape:
    """A box that stands on ``base``, the middle of its bottom."""
    return box(dx, dy, dz, (base[0] - dx / 2, base[1] - dy / 2, base[2]))


@guarded("cylinder")
def cylinder(r: float, h: float, at: gp_Ax2 | None = None, angle: float = 0) -> TopoDS_Shape:
    """A cylinder along the frame's normal; ``angle`` in radians, 0 for a whole one."""
    return BRepPrimAPI_MakeCylinder(at or frame(), r, h, angle or 2 * math.pi).Shape()


@guarded("cone")
def cone(r0: float, r1: float, h: float, at: gp_Ax2 | None = None) -> TopoDS_Shape:
    """A frustum with radius ``r0`` at the frame's origin and ``r1`` at height ``h``."""
    return BRepPrimAPI_MakeCone(at or frame(), r0, r1, h).Shape()


@guarded("sphere")
def sphere(r: float, at: gp_Ax2 | None = None) -> TopoDS_Shape:
    return BRepPrimAPI_MakeSphere(at or frame(), r).Shape()


@guarded("torus")
def torus(major: float, minor: float, at: gp_Ax2 | None = None) -> TopoDS_Shape:
    return BRepPrimAPI_MakeTorus(at or frame(), major, minor).Shape()


@guarded("extrusion")
def extrude(shape: TopoDS_Shape, along: Vector) -> TopoDS_Shape:
    return BRepPrimAPI_MakePrism(shape, vector(along)).Shape()


@guarded("revolution")
def revolve(profile: TopoDS_Shape, angle: float = 0) -> TopoDS_Shape:
    """The body that a face in the xz plane sweeps about z; ``angle`` in radians, 0: a whole turn.

    A face on both sides of the axis would sweep through itself, which no check of the result
    finds: it is refused.
    """
    bounds = Bnd_Box()
    BRepBndLib.AddOptimal_s(profile, bounds, False, False)
    if bounds.CornerMin().X() < -1e-6:
        raise Refused("a profile that crosses its axis")
    made = BRepPrimAPI_MakeRevol(profile, Z_AXIS, angle or 2 * math.pi)
    return made.Shape()


@guarded("sweep")
def sweep(spine: TopoDS_Wire, face: TopoDS_Shape) -> TopoDS_Shape:
    return BRepOffsetAPI_MakePipe(spine, face).Shape()


@guarded("loft")
def loft(wires: Iterable[TopoDS_Wire], ruled: bool) -> TopoDS_Shape:
    made = BRepOffsetAPI_ThruSections(True, ruled)
    for wire in wires:
        made.AddWire(wire)
    made.CheckCompatibility(True)
    made.Build()
    if not made.IsDone():
        raise Refused("loft")
    return made.Shape()


@guarded("draft")
def draft(
    shape: TopoDS_Shape, sides: Iterable[TopoDS_Face], pull: Vector, angle: float, base: Vector
) -> TopoDS_Shape:
    """Tilts faces by ``angle`` (radians) about their meeting with the plane through ``base``."""
    made = BRepOffsetAPI_DraftAngle(shape)
    neutral = gp_Pln(gp_Ax3(point(base), direction(pull)))
    for side in sides:
        made.Add(side, direction(pull), angle, neutral)
        if not made.AddDone():
            raise Refused("draft")
    made.Build()
    if not made.IsDone():
        raise Refused("draft")
    return made.Shape()


# Booleans: all tools in one operation, which is several times as fast as one after the other


def _boolean(operation, name: str, base: TopoDS_Shape, tools: Sequence[TopoDS_Shape]):
    if not tools:
        return base
    operation.SetArguments(shape_list([base]))
    operation.SetTools(shape_list(tools))
    operation.SetRunParallel(False)
    operation.SetToFillHistory(False)
    operation.Build()
    # After an error of the operation there is no shape.
    if not operation.IsDone() or operation.Shape().IsNull():
        raise Refused(name)
    return operation.Shape()


@guarded("cut")
def cut(base: TopoDS_Shape, *tools: TopoDS_Shape) -> TopoDS_Shape:
    return _boolean(BRepAlgoAPI_Cut(), "cut", base, tools)


@guarded("fusion")
def fuse(base: TopoDS_Shape, *tools: TopoDS_Shape) -> TopoDS_Shape:
    return _boolean(BRepAlgoAPI_Fuse(), "fusion", base, tools)


@guarded("intersection")
def common(base: TopoDS_Shape, *tools: TopoDS_Shape) -> TopoDS_Shape:
    return _boolean(BRepAlgoAPI_Common(), "intersection", base, tools)


# Placement


def moved(shape: TopoDS_Shape, trsf: gp_Trsf) -> TopoDS_Shape:
    return BRepBuilderAPI_Transform(shape, trsf, True).Shape()


def shifted(shape: TopoDS_Shape, by: Vector) -> TopoDS_Shape:
    trsf = gp_Trsf()
    trsf.SetTranslation(vector(by))
    return moved(shape, trsf)


def turned(
    shape: TopoDS_Shape, angle: float, axis: Vector = Z, origin: Vector = ORIGIN
) -> TopoDS_Shape:
    """The shape turned by ``angle`` (radians) about an axis."""
    trsf = gp_Trsf()
    trsf.SetRotation(gp_Ax1(point(origin), direction(axis)), angle)
    return moved(shape, trsf)


def mirrored(shape: TopoDS_Shape, normal: Vector, origin: Vector = ORIGIN) -> TopoDS_Shape:
    """The mirror image in the plane through ``origin``."""
    trsf = gp_Trsf()
    trsf.SetMirror(frame(origin, normal))
    return moved(shape, trsf)


def placed(shape: TopoDS_Shape, at: gp_Ax2) -> TopoDS_Shape:
    """What was built in the xy plane, moved to a frame."""
    trsf = gp_Trsf()
    trsf.SetTransformation(gp_Ax3(at), gp_Ax3(frame(ORIGIN, Z, X)))
    return moved(shape, trsf)
