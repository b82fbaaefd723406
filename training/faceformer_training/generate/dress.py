"""Dressing a body's edges and walls: fillets, chamfers, shells."""

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepFilletAPI import BRepFilletAPI_MakeChamfer, BRepFilletAPI_MakeFillet
from OCP.BRepOffset import BRepOffset_Mode
from OCP.BRepOffsetAPI import BRepOffsetAPI_MakeThickSolid
from OCP.BRepTools import BRepTools
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.GeomAbs import GeomAbs_CurveType, GeomAbs_JoinType
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedDataMapOfShapeListOfShape

from .dice import Dice
from .kernel import Refused, edges, explore, faces, guarded, shape_list
from .spots import flat


def edge_faces(shape: TopoDS_Shape) -> list[tuple[TopoDS_Edge, list[TopoDS_Face]]]:
    """The edges between two different faces, with these; seams are left out."""
    found = TopTools_IndexedDataMapOfShapeListOfShape()
    TopExp.MapShapesAndAncestors_s(
        shape, TopAbs_ShapeEnum.TopAbs_EDGE, TopAbs_ShapeEnum.TopAbs_FACE, found
    )
    out = []
    for i in range(1, found.Extent() + 1):
        sides = [TopoDS.Face_s(f) for f in found.FindFromIndex(i)]
        if len(sides) == 2 and not sides[0].IsSame(sides[1]):
            out.append((TopoDS.Edge_s(found.FindKey(i)), sides))
    return out


def length(edge: TopoDS_Edge) -> float:
    return GCPnts_AbscissaPoint.Length_s(BRepAdaptor_Curve(edge))


def tangent(edge: TopoDS_Edge) -> np.ndarray | None:
    """The direction of a straight edge, None for a curved one."""
    curve = BRepAdaptor_Curve(edge)
    if curve.GetType() != GeomAbs_CurveType.GeomAbs_Line:
        return None
    return np.array(curve.Line().Direction().Coord())


@guarded("fillet")
def fillet(shape: TopoDS_Shape, chosen: list[TopoDS_Edge], r: float) -> TopoDS_Shape:
    made = BRepFilletAPI_MakeFillet(shape)
    for edge in chosen:
        made.Add(r, edge)
    made.Build()
    if not made.IsDone():
        raise Refused("fillet")
    return made.Shape()


@guarded("chamfer")
def chamfer(shape: TopoDS_Shape, chosen: list[TopoDS_Edge], d: float) -> TopoDS_Shape:
    made = BRepFilletAPI_MakeChamfer(shape)
    for edge in chosen:
        made.Add(d, edge)
    made.Build()
    if not made.IsDone():
        raise Refused("chamfer")
    return made.Shape()


@guarded("shell")
def hollow(shape: TopoDS_Shape, open_faces: list[TopoDS_Face], wall: float) -> TopoDS_Shape:
    """The body hollowed out, its ``open_faces`` away; ``wall`` is measured inwards."""
    made = BRepOffsetAPI_MakeThickSolid()
    made.MakeThickSolidByJoin(
        shape,
        shape_list(open_faces),
        -wall,
        1e-4,
        BRepOffset_Mode.BRepOffset_Skin,
        False,
        False,
        GeomAbs_JoinType.GeomAbs_Intersection,
    )
    if not made.IsDone():
        raise Refused("shell")
    return made.Shape()


def inner_rims(shape: TopoDS_Shape) -> list[list[TopoDS_Edge]]:
    """The inner loops of the planar faces: rims of holes and pockets, feet of bosses."""
    rims = []
    for side in faces(shape):
        wires = explore(side, TopAbs_ShapeEnum.TopAbs_WIRE)
        if len(wires) > 1 and flat(side) is not None:
            outer = BRepTools.OuterWire_s(side)
            rims += [edges(w) for w in wires if not w.IsSame(outer)]
    return rims


def dress_rims(dice: Dice, shape: TopoDS_Shape) -> TopoDS_Shape:
    """One or two inner rims rounded or bevelled; the body as it is if it has none."""
    rims = inner_rims(shape)
    if not rims:
        return shape
    chosen = [e for rim in dice.sample(rims, min(len(rims), dice.few(2))) for e in rim]
    r = room_at(chosen, shape) * dice.uniform(0.1, 0.45)
    return fillet(shape, chosen, r) if dice.chance(0.6) else chamfer(shape, chosen, r)


def choose_edges(dice: Dice, shape: TopoDS_Shape, most: int = 24) -> list[TopoDS_Edge]:
    """Edges as a designer would pick them: a direction's, a face's, all, or a few."""
    pairs = edge_faces(shape)
    if not pairs:
        raise Refused("no edge to dress")
    kind = dice.weighted({"direction": 3, "face": 3, "few": 3, "all": 1.2, "rim": 1.5})
    if kind == "rim":
        rims = inner_rims(shape)
        if rims:
            return dice.choice(rims)
    if kind == "direction":
        ways = [(e, tangent(e)) for e, _ in pairs]
        straight = [(e, t) for e, t in ways if t is not None]
        if straight:
            lead = dice.choice(straight)[1]
            chosen = [e for e, t in straight if abs(t @ lead) > 0.9999]
            if len(chosen) > most:
                chosen = dice.sample(chosen, most)
            return chosen
    if kind == "face":
        side = dice.choice(faces(shape))
        inside = edges(side)
        chosen = [e for e, _ in pairs if any(e.IsSame(o) for o in inside)]
        if chosen and len(chosen) <= most:
            return chosen
    if kind == "all" and len(pairs) <= most:
        return [e for e, _ in pairs]
    return [e for e, _ in dice.sample(pairs, min(len(pairs), dice.few(6, 0.7)))]


def room_at(chosen: list[TopoDS_Edge], shape: TopoDS_Shape) -> float:
    """Half of the shortest edge at the faces of the chosen edges: a bound for their radius."""
    near = [
        side for e, sides in edge_faces(shape) if any(e.IsSame(c) for c in chosen) for side in sides
    ]
    lengths = [length(e) for side in near for e in edges(side)]
    return min(x for x in lengths if x > 1e-9) / 2


def soften_edges(dice: Dice, shape: TopoDS_Shape, rounded: float = 0.65) -> TopoDS_Shape:
    """Some edges filleted (with chance ``rounded``) or chamfered."""
    chosen = choose_edges(dice, shape)
    r = room_at(chosen, shape) * dice.uniform(0.15, 0.8)
    return fillet(shape, chosen, r) if dice.chance(rounded) else chamfer(shape, chosen, r)


def open_shell(dice: Dice, shape: TopoDS_Shape, wall: float) -> TopoDS_Shape:
    """The body hollowed, open at one planar face, or at two."""
    planar = [f for f in faces(shape) if flat(f) is not None]
    if not planar:
        raise Refused("no planar face to open")
    n = min(len(planar), dice.choice([1, 1, 1, 2]))
    return hollow(shape, dice.sample(planar, n), wall)
