"""Unions at odd angles, bent rods and tubes, lofts."""

import itertools
import math

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeWire
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopoDS import TopoDS, TopoDS_Shape

from ..dice import Dice
from ..dress import soften_edges
from ..features import add
from ..kernel import (
    Refused,
    X,
    Z,
    centred_box,
    cut,
    cylinder,
    explore,
    extrude,
    fuse,
    loft,
    mirrored,
    placed,
    shifted,
    sweep,
    turned,
)
from ..kernel import frame as axes
from ..outline import Outline, circle, face, polygon
from ..sections import ngon_points, rectangle_points, section
from ..spots import polyline
from . import basic


def odd_union(dice: Dice) -> TopoDS_Shape:
    """Two or three simple bodies fused at odd angles."""
    body = _piece(dice)
    for _ in range(dice.few(2, 0.3)):
        other = _piece(dice)
        axis = dice.choice([(1, 0, 0), (0, 1, 0), (dice.uniform(-1, 1), 1, dice.uniform(-1, 1))])
        other = turned(other, dice.angle(), axis)
        by = [dice.uniform(-0.6, 0.6) for _ in range(3)]
        body = fuse(body, shifted(other, by))
    if dice.chance(0.2):
        body = soften_edges(dice, body, 0.8)
    return add(dice, body, 1) if dice.chance(0.25) else body


def _piece(dice: Dice) -> TopoDS_Shape:
    """A body of about the size of the others, about the origin."""
    match dice.weighted({"box": 3, "prism": 2, "rod": 3, "simple": 1}):
        case "box":
            h = dice.length(0.3, 1.6)
            return centred_box(dice.length(0.4, 2.4), dice.length(0.4, 1.6), h, (0, 0, -h / 2))
        case "prism":
            h = dice.length(0.3, 1.2)
            return shifted(extrude(face(section(dice, 0.3)), (0, 0, h)), (0, 0, -h / 2))
        case "rod":
            h = dice.length(0.8, 3)
            return cylinder(dice.uniform(0.2, 0.7), h, axes((0, 0, -h / 2)))
        case _:
            return dice.choice([basic.pin, basic.frustum, basic.ball])(dice)


def cut_by_body(dice: Dice) -> TopoDS_Shape:
    """A simple body with another taken out of it at an odd angle."""
    other = turned(_piece(dice), dice.angle(), dice.choice([(1, 0, 0), (0, 1, 0), (1, 1, 1)]))
    by = [dice.uniform(-0.9, 0.9) for _ in range(3)]
    return cut(_piece(dice), shifted(other, by))


def bent_rod(dice: Dice) -> TopoDS_Shape:
    """A rod, tube or bar along a planar path with round bends."""
    radius = dice.uniform(0.1, 0.3)
    bend = radius * dice.length(1.2, 4)
    chain, a, at = Outline((0.0, 0.0)), 0.0, (0.0, 0.0)
    way = dice.choice([-1, 1])
    for i in range(n := dice.few(3, 0.55)):
        long = dice.length(0.3, 2)
        if i or dice.chance(0.8):
            at = (at[0] + long * math.cos(a), at[1] + long * math.sin(a))
            chain.line(*at)
        turn = way * (math.pi / 2 if dice.chance(0.6) else dice.uniform(0.4, 2.4))
        cx, cy = at[0] - way * bend * math.sin(a), at[1] + way * bend * math.cos(a)
        mid, end = (
            (cx + way * bend * math.sin(a + q * turn), cy - way * bend * math.cos(a + q * turn))
            for q in (0.5, 1.0)
        )
        chain.arc(mid, end)
        a, at = a + turn, end
        way = way if dice.chance(0.5) else -way
        if i == n - 1 and dice.chance(0.85):
            long = dice.length(0.3, 2)
            chain.line(at[0] + long * math.cos(a), at[1] + long * math.sin(a))
    check_clear(chain, radius, bend)
    path = BRepBuilderAPI_MakeWire()
    start = chain.start
    for step_edge in chain.edges(closed=False):
        path.Add(step_edge)
    plane = axes((*start, 0), X, Z)
    kind = dice.weighted({"rod": 3, "tube": 2, "bar": 2, "ngon": 0.7})
    if kind == "rod":
        shape = face(circle(radius))
    elif kind == "tube":
        shape = face(circle(radius), circle(radius * dice.uniform(0.5, 0.88)))
    elif kind == "bar":
        shape = face(polygon(rectangle_points(2 * radius * dice.uniform(0.4, 1), 2 * radius)))
    else:
        shape = face(polygon(ngon_points(dice.choice([3, 5, 6]), radius)))
    body = sweep(path.Wire(), placed(shape, plane))
    if kind in ("rod", "tube") and dice.chance(0.3):
        collar = cylinder(
            radius * dice.uniform(1.2, 2), radius * dice.length(0.4, 2), axes((0, 0, 0), X)
        )
        if kind == "tube":
            return body
        body = fuse(body, collar)
    return body


def check_clear(chain: Outline, radius: float, bend: float) -> None:
    """Refuses a path whose rod would run into itself, which no check of the body finds."""
    lines = [polyline(edge) for edge in chain.edges(closed=False)]
    ends = [(a, b) for p in lines for a, b in itertools.pairwise(p)]
    dense = np.concatenate([np.linspace(a, b, 12, endpoint=False) for a, b in ends])
    run = np.r_[0, np.cumsum(np.linalg.norm(np.diff(dense, axis=0), axis=1))]
    gap = np.linalg.norm(dense[:, None] - dense, axis=-1)
    # Half a turn further on the rod is two bend radii away, which is clear.
    far = np.abs(run[:, None] - run) > math.pi * bend
    if (gap[far] < 2.1 * radius).any():
        raise Refused("a rod that runs into itself")


def lofted(dice: Dice) -> TopoDS_Shape:
    """A transition between two outlines, ruled or smooth: free-form faces."""
    h = dice.length(0.5, 2)
    n = dice.choice([3, 4, 4, 5, 6])
    low = polygon(ngon_points(n, 1.0, math.pi / n)).wire()
    twist = dice.uniform(-0.4, 0.4) if dice.chance(0.5) else 0.0
    small = dice.uniform(0.3, 0.9)
    high = polygon(ngon_points(n, small, math.pi / n + twist)).wire()
    wires = [low, TopoDS.Wire_s(shifted(high, (0, 0, h)))]
    if dice.chance(0.4):
        middle = polygon(ngon_points(n, dice.uniform(0.6, 1.1), math.pi / n)).wire()
        wires.insert(1, TopoDS.Wire_s(shifted(middle, (0, 0, h / 2))))
    body = loft(wires, dice.chance(0.4))
    return add(dice, body, 1) if dice.chance(0.4) else body


def tower(dice: Dice) -> TopoDS_Shape:
    """Features on features: each stands on, or sinks into, a face of what is there."""
    body = basic.prism(dice)
    for _ in range(dice.randint(1, 3)):
        body = add(dice, body, dice.few(2, 0.5))
    return soften_edges(dice, body) if dice.chance(0.2) else body


def mirrored_pair(dice: Dice) -> TopoDS_Shape:
    """A part that is its own mirror image: half of it made, mirrored and joined."""
    half = _piece(dice)
    half = add(dice, half, dice.few(2, 0.4))
    half = turned(half, dice.choice([0, 0, dice.angle()]), (0, 1, 0))
    half = cut(half, centred_box(20, 20, 20, (-10 + dice.uniform(-0.3, 0.3), 0, -10)))
    if len(explore(half, TopAbs_ShapeEnum.TopAbs_SOLID)) != 1:
        raise Refused("a half that is not one body")
    x = min(p for p in _xs(half))
    return fuse(half, mirrored(half, X, (x, 0, 0)))


def _xs(body: TopoDS_Shape) -> list[float]:
    bounds = Bnd_Box()
    BRepBndLib.AddOptimal_s(body, bounds, False, False)
    return [bounds.CornerMin().X(), bounds.CornerMax().X()]


RECIPES = {
    odd_union: 4.0,
    cut_by_body: 1.5,
    bent_rod: 3.0,
    lofted: 4.5,
    tower: 2.5,
    mirrored_pair: 1.5,
}
