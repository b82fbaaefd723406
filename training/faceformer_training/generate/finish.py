"""From a recipe's body to a finished solid: checked, unified, centred and scaled."""

import hashlib
from collections import Counter
from dataclasses import dataclass

from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GeomAbs import GeomAbs_SurfaceType
from OCP.gp import gp_Pnt, gp_Trsf, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Shape, TopoDS_Solid
from OCP.TopTools import TopTools_IndexedDataMapOfShapeListOfShape

from .dress import length
from .kernel import Refused, edges, explore, faces, guarded

SURFACES = {
    GeomAbs_SurfaceType.GeomAbs_Plane: "plane",
    GeomAbs_SurfaceType.GeomAbs_Cylinder: "cylinder",
    GeomAbs_SurfaceType.GeomAbs_Cone: "cone",
    GeomAbs_SurfaceType.GeomAbs_Sphere: "sphere",
    GeomAbs_SurfaceType.GeomAbs_Torus: "torus",
}
# In half diagonals. A drawing needs edges of 1e-3 in every view, so the solid's are longer.
SHORTEST_EDGE = 0.008
LARGEST_TOLERANCE = 1e-4
SMALLEST_VOLUME = 2e-4


@dataclass(frozen=True)
class Limits:
    """What a solid may have; more is refused."""

    faces: int = 60
    edges: int = 160


@dataclass(frozen=True)
class Finished:
    """A finished solid with what an index says about it.

    ``types`` counts the faces' surface types, ``volume`` is in half diagonals cubed,
    ``signature`` is 16 hexadecimal digits of the shape.
    """

    shape: TopoDS_Solid
    faces: int
    edges: int
    types: dict[str, int]
    volume: float
    signature: str


def single_solid(shape: TopoDS_Shape) -> TopoDS_Solid:
    solids = explore(shape, TopAbs_ShapeEnum.TopAbs_SOLID)
    if len(solids) != 1:
        raise Refused("no solid" if not solids else "more than one solid")
    solid = TopoDS.Solid_s(solids[0])
    if len(explore(solid, TopAbs_ShapeEnum.TopAbs_SHELL)) != 1:
        raise Refused("a hollow without an opening")
    return solid


@guarded("unification")
def unified(shape: TopoDS_Shape) -> TopoDS_Shape:
    """Same-domain faces and edges merged."""
    made = ShapeUpgrade_UnifySameDomain(shape, True, True, False)
    made.Build()
    return made.Shape()


@guarded("bounding box")
def normalised(solid: TopoDS_Shape) -> TopoDS_Shape:
    """Centred on the origin, half diagonal of the bounding box 1."""
    bounds = Bnd_Box()
    BRepBndLib.AddOptimal_s(solid, bounds, False, False)
    if bounds.IsVoid():
        raise Refused("bounding box")
    low, high = bounds.CornerMin(), bounds.CornerMax()
    half = low.Distance(high) / 2
    middle = gp_Pnt(*((a + b) / 2 for a, b in zip(low.Coord(), high.Coord(), strict=True)))
    to_origin, scale = gp_Trsf(), gp_Trsf()
    to_origin.SetTranslation(gp_Vec(middle, gp_Pnt(0, 0, 0)))
    scale.SetScale(gp_Pnt(0, 0, 0), 1 / half)
    return BRepBuilderAPI_Transform(solid, scale.Multiplied(to_origin), True).Shape()


def check_closed(solid: TopoDS_Shape) -> None:
    """Every edge lies between two faces, or is the seam of one, or is a degenerate one."""
    found = TopTools_IndexedDataMapOfShapeListOfShape()
    TopExp.MapShapesAndAncestors_s(
        solid, TopAbs_ShapeEnum.TopAbs_EDGE, TopAbs_ShapeEnum.TopAbs_FACE, found
    )
    for i in range(1, found.Extent() + 1):
        edge = TopoDS.Edge_s(found.FindKey(i))
        if BRep_Tool.Degenerated_s(edge):
            continue
        sides = [TopoDS.Face_s(f) for f in found.FindFromIndex(i)]
        if len(sides) == 1 and not BRep_Tool.IsClosed_s(edge, sides[0]):
            raise Refused("an open shell")
        if len(sides) > 2:
            raise Refused("an edge of more than two faces")


@guarded("finish")
def finish(body: TopoDS_Shape, limits: Limits) -> Finished:
    """The finished solid of a recipe's body; raises ``Refused`` with what is wrong."""
    solid = single_solid(body)
    if len(faces(solid)) > 3 * limits.faces:
        raise Refused("too many faces")
    solid = single_solid(normalised(single_solid(unified(solid))))
    all_faces, all_edges = faces(solid), edges(solid)
    if len(all_faces) > limits.faces or len(all_edges) > limits.edges:
        raise Refused("too many faces")
    surfaces = [BRepAdaptor_Surface(f, False).GetType() for f in all_faces]
    if GeomAbs_SurfaceType.GeomAbs_OffsetSurface in surfaces:
        # A shell's offset of a free-form surface: it cannot be evaluated everywhere.
        raise Refused("an offset surface")
    lengths = [length(e) for e in all_edges if not BRep_Tool.Degenerated_s(e)]
    if not lengths or min(lengths) < SHORTEST_EDGE:
        raise Refused("an edge too short")
    corners = [TopoDS.Vertex_s(v) for v in explore(solid, TopAbs_ShapeEnum.TopAbs_VERTEX)]
    tolerance = max(BRep_Tool.Tolerance_s(s) for s in (*all_edges, *corners))
    if tolerance > LARGEST_TOLERANCE:
        raise Refused("a tolerance too large")
    check_closed(solid)
    if not BRepCheck_Analyzer(solid).IsValid():
        raise Refused("not valid")
    measured = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid, measured, True)
    volume = measured.Mass()
    if volume < SMALLEST_VOLUME:
        raise Refused("no volume")
    kinds = [SURFACES.get(s, "other") for s in surfaces]
    return Finished(
        TopoDS.Solid_s(solid),
        len(all_faces),
        len(all_edges),
        dict(Counter(kinds)),
        volume,
        signature(kinds, lengths, volume),
    )


def signature(kinds: list[str], lengths: list[float], volume: float) -> str:
    """Equal for solids that are the same up to a motion, to about three digits."""
    text = f"{sorted(kinds)}{sorted(f'{x:.3f}' for x in lengths)}{volume:.3f}"
    return hashlib.sha256(text.encode()).hexdigest()[:16]
