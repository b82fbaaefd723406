"""Features on a free spot: holes, pockets and grooves to cut, bosses and ribs to add.

A feature is a :class:`Tools`: bodies to fuse to the part and bodies to cut from it. Tools reach a
little out of the face, so that no two coincident faces have to be matched.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from OCP.gp import gp_Ax2, gp_Dir, gp_Vec
from OCP.TopoDS import TopoDS_Shape

from .dice import Dice
from .dress import dress_rims, edge_faces, length, tangent
from .kernel import (
    UPRIGHT,
    Refused,
    X,
    Y,
    Z,
    centred_box,
    cone,
    cut,
    cylinder,
    extrude,
    frame,
    fuse,
    placed,
    revolve,
    sphere,
    torus,
    turned,
)
from .outline import Ellipse, Outline, circle, face, polygon, rounded
from .sections import ngon_points, rectangle_points, sector, slot
from .spots import Board, Spot, polyline


@dataclass
class Tools:
    """Bodies to add and bodies to cut, in this order."""

    adds: list[TopoDS_Shape] = field(default_factory=list)
    cuts: list[TopoDS_Shape] = field(default_factory=list)

    def extend(self, other: "Tools") -> None:
        self.adds += other.adds
        self.cuts += other.cuts

    def apply(self, body: TopoDS_Shape) -> TopoDS_Shape:
        if self.adds:
            body = fuse(body, *self.adds)
        return cut(body, *self.cuts) if self.cuts else body


def through(dice: Dice, spot: Spot) -> float:
    """Depth of a cut that goes through the wall below the spot, or through all that is below."""
    return spot.depth + min(spot.depth, spot.room) * 0.3 if dice.chance(0.6) else 50 * spot.depth


def sunk(spot: Spot, shape: Outline | Ellipse, depth: float, turn: float = 0.0) -> TopoDS_Shape:
    """The prism over an outline, from just above the face down to ``depth``."""
    above = 0.1 * min(depth, spot.depth)
    return placed(extrude(face(shape), (0, 0, -depth - above)), spot.frame(above, turn))


def raised(spot: Spot, shape: Outline | Ellipse, height: float, turn: float = 0.0) -> TopoDS_Shape:
    """The prism over an outline, from just below the face up to ``height``."""
    below = 0.1 * min(height, spot.depth)
    return placed(extrude(face(shape), (0, 0, height + below)), spot.frame(-below, turn))


def bore(spot: Spot, r: float, depth: float) -> TopoDS_Shape:
    return sunk(spot, circle(r), depth)


# Holes


def plain_hole(dice: Dice, spot: Spot) -> Tools:
    deep = through(dice, spot) if dice.chance(0.7) else spot.depth * dice.part(0.2, 0.8)
    return Tools(cuts=[bore(spot, spot.room * dice.part(0.3, 0.9), deep)])


def drilled_hole(dice: Dice, spot: Spot) -> Tools:
    """A blind hole with the cone of the drill's tip."""
    r = spot.room * dice.part(0.3, 0.9)
    deep = spot.depth * dice.part(0.25, 0.7)
    tip = min(r * dice.choice([0.577, 0.577, 1.0]), 0.2 * spot.depth)
    profile = polygon([(0, 0.1 * deep), (r, 0.1 * deep), (r, -deep), (0, -deep - tip)])
    return Tools(cuts=[turned_tool(spot, profile)])


def counterbore(dice: Dice, spot: Spot) -> Tools:
    wide = spot.room * dice.part(0.5, 0.92)
    r, first = wide * dice.part(0.35, 0.8), spot.depth * dice.part(0.2, 0.6)
    deep = through(dice, spot)
    top = 0.1 * spot.depth
    profile = polygon([(0, top), (wide, top), (wide, -first), (r, -first), (r, -deep), (0, -deep)])
    return Tools(cuts=[turned_tool(spot, profile)])


def countersink(dice: Dice, spot: Spot) -> Tools:
    wide = spot.room * dice.part(0.5, 0.92)
    r = wide * dice.part(0.35, 0.75)
    slope = dice.choice([1.0, 1.0, 0.7, 1.7])
    first = min((wide - r) / slope, 0.7 * spot.depth)
    rise = 0.05 * spot.depth
    out = wide + rise * (wide - r) / first
    deep = through(dice, spot) if dice.chance(0.8) else (first + spot.depth) / 2
    profile = polygon([(0, rise), (out, rise), (r, -first), (r, -deep), (0, -deep)])
    return Tools(cuts=[turned_tool(spot, profile)])


def tapered_hole(dice: Dice, spot: Spot) -> Tools:
    wide = spot.room * dice.part(0.4, 0.9)
    end, deep = wide * dice.uniform(0.0, 0.85), spot.depth * dice.part(0.3, 0.8)
    end = 0.0 if end < 0.3 * wide and dice.chance(0.5) else max(end, 0.3 * wide)
    rise = 0.05 * deep
    out = wide + rise * (wide - end) / deep
    return Tools(cuts=[cone(out, end, deep + rise, _down(spot, rise))])


def dimple(dice: Dice, spot: Spot) -> Tools:
    """A part of a sphere pressed into the face."""
    r = spot.room * dice.part(0.4, 0.95)
    up = dice.choice([0.0, dice.uniform(-0.3, 0.6)]) * r
    if r - up > 0.9 * spot.depth:
        r = 0.6 * spot.depth
        up = min(up, 0.5 * r)
    return Tools(cuts=[sphere(r, spot.frame(up))])


def ring_groove(dice: Dice, spot: Spot) -> Tools:
    """A groove around the spot, round (a torus) or square."""
    outer = spot.room * dice.part(0.6, 0.92)
    inner = outer * dice.part(0.45, 0.8)
    half = (outer - inner) / 2
    middle = (outer + inner) / 2
    if half < 0.8 * spot.depth and dice.chance(0.6):
        return Tools(cuts=[torus(middle, half, spot.frame())])
    deep = spot.depth * dice.part(0.2, 0.6)
    top = 0.1 * deep
    profile = polygon([(inner, top), (outer, top), (outer, -deep), (inner, -deep)])
    return Tools(cuts=[turned_tool(spot, profile)])


# Pockets


def footprint(dice: Dice, room: float) -> Outline | Ellipse:
    """An outline within the disc of radius ``room``."""
    kind = dice.weighted(
        {
            "rectangle": 4,
            "rounded": 3,
            "slot": 2,
            "ngon": 1.5,
            "hexagon": 1,
            "sector": 0.7,
            "oval": 0.3,
        }
    )
    room *= dice.part(0.5, 0.93)
    if kind == "slot":
        r = room * dice.part(0.2, 0.6)
        return slot(2 * (room - r), r)
    if kind == "ngon":
        return polygon(ngon_points(dice.randint(3, 6), room, dice.choice([0, math.pi / 4])))
    if kind == "hexagon":
        return polygon(ngon_points(6, room))
    if kind == "sector":
        inner = room * dice.part(0.3, 0.7) if dice.chance(0.6) else 0.0
        return sector(room, dice.uniform(0.4, 1.6) * math.pi, inner)
    if kind == "oval":
        return Ellipse((0.0, 0.0), room, room * dice.uniform(0.4, 0.8))
    turn = math.atan(dice.length(0.25, 1.0))
    points = rectangle_points(2 * room * math.cos(turn), 2 * room * math.sin(turn))
    if kind == "rectangle":
        return polygon(points)
    return rounded(points, [room * math.sin(turn) * dice.uniform(0.2, 0.9)] * 4)


def pocket(dice: Dice, spot: Spot) -> Tools:
    """A hole of any section, blind or through, now and then with an island or a second step."""
    deep = through(dice, spot) if dice.chance(0.35) else spot.depth * dice.part(0.15, 0.8)
    turn = 0.0 if dice.chance(0.8) else dice.angle()
    tool = sunk(spot, footprint(dice, spot.room), deep, turn)
    if deep < spot.depth and dice.chance(0.15):
        low = 2 * deep
        island = bore(spot, spot.room * dice.uniform(0.08, 0.2), low)
        return Tools(cuts=[cut(tool, island)])
    if deep < 0.7 * spot.depth and dice.chance(0.2):
        second = sunk(spot, footprint(dice, 0.45 * spot.room), through(dice, spot), turn)
        return Tools(cuts=[fuse(tool, second)])
    return Tools(cuts=[tool])


# Bosses


def boss(dice: Dice, spot: Spot) -> Tools:
    """A cylinder or a prism on the face, often with a hole."""
    height = min(spot.room, 2 * spot.depth) * dice.length(0.15, 2.0)
    if dice.chance(0.35):
        return Tools(adds=[raised(spot, footprint(dice, spot.room), height)])
    r = spot.room * dice.part(0.35, 0.9)
    tools = Tools(adds=[raised(spot, circle(r), height)])
    if dice.chance(0.5):
        deep = through(dice, spot) if dice.chance(0.5) else 0.0
        reach = deep or -height * dice.part(0.2, 0.7)
        hole = extrude(face(circle(r * dice.part(0.3, 0.8))), (0, 0, -height * 1.1 - reach))
        tools.cuts.append(placed(hole, spot.frame(height * 1.1)))
    return tools


def cone_boss(dice: Dice, spot: Spot) -> Tools:
    """A frustum or a whole cone, upright; the foot is a little below the face."""
    wide = spot.room * dice.part(0.4, 0.9)
    top = 0.0 if dice.chance(0.25) else wide * dice.part(0.3, 0.9)
    height = wide * dice.length(0.3, 2.0)
    below = 0.1 * min(height, spot.depth)
    foot = wide + below * (wide - top) / height
    return Tools(adds=[cone(foot, top, height + below, spot.frame(-below))])


def dome(dice: Dice, spot: Spot) -> Tools:
    """A spherical cap: half a ball, a ball on its foot, or the end of a pin."""
    r = spot.room * dice.part(0.35, 0.85)
    match dice.weighted({"half": 1.5, "ball": 1, "pin": 1.5}):
        case "half":
            return Tools(adds=[sphere(r, spot.frame(min(0.0, spot.depth - r)))])
        case "ball":
            return Tools(adds=[sphere(r, spot.frame(r * dice.uniform(0.2, 0.85)))])
        case _:
            height = r * dice.length(0.3, 3)
            profile = Outline((0.0, -0.1 * spot.depth)).line(r, -0.1 * spot.depth).line(r, height)
            profile.arc((r * math.sqrt(0.5), height + r * math.sqrt(0.5)), (0.0, height + r))
            return Tools(adds=[turned_tool(spot, profile)])


def rib(dice: Dice, spot: Spot) -> Tools:
    """A thin wall, straight or sloping at its ends."""
    half = spot.room * dice.part(0.6, 0.93)
    thick, height = half * dice.length(0.08, 0.4), half * dice.length(0.2, 1.2)
    slope = 0.0 if dice.chance(0.5) else min(height, half * dice.part(0.3, 0.9))
    below = 0.1 * spot.depth
    side = [(-half, -below), (half, -below), (half - slope, height), (-half, height)]
    wall = extrude(face(polygon(side)), (0, 0, thick))
    upright = spot.frame()
    # The outline's y goes up the normal, its extrusion across the rib.
    z, x = upright.Direction(), upright.XDirection()
    across = gp_Dir(gp_Vec(x).Crossed(gp_Vec(z)))
    corner = upright.Location().Translated(gp_Vec(across).Multiplied(-thick / 2))
    return Tools(adds=[placed(wall, gp_Ax2(corner, across, x))])


def grid_of_holes(dice: Dice, spot: Spot) -> Tools:
    """A few equal holes in a row, a rectangle or a circle within the spot."""
    deep = through(dice, spot) if dice.chance(0.75) else spot.depth * dice.part(0.3, 0.7)
    if dice.chance(0.5):
        n = dice.randint(3, 8)
        ring = spot.room * dice.uniform(0.6, 0.8)
        r = min(spot.room * 0.95 - ring, ring * math.sin(math.pi / n)) * dice.uniform(0.4, 0.85)
        centres = ngon_points(n, ring, dice.choice([0, math.pi / n]))
    else:
        nx, ny = dice.choice([(2, 1), (3, 1), (4, 1), (2, 2), (2, 2), (3, 2)])
        pitch = 1.3 * spot.room / math.hypot(nx, ny)
        r = pitch * dice.uniform(0.2, 0.42)
        xs = [pitch * (i - (nx - 1) / 2) for i in range(nx)]
        centres = [(x, pitch * (j - (ny - 1) / 2)) for x in xs for j in range(ny)]
    square = dice.chance(0.2)
    shapes = [
        polygon(rectangle_points(1.6 * r, 1.6 * r, c)) if square else circle(r, c) for c in centres
    ]
    return Tools(cuts=[sunk(spot, s, deep) for s in shapes])


def turned_tool(spot: Spot, profile: Outline) -> TopoDS_Shape:
    """A body of revolution about the spot's normal; the profile's (x, y) is (radius, height)."""
    return placed(revolve(placed(face(profile), UPRIGHT)), spot.frame())


def _down(spot: Spot, above: float) -> gp_Ax2:
    """Axis system that looks into the solid."""
    return frame(spot.centre + above * spot.normal, -spot.normal, spot.along)


def notch(dice: Dice, body: TopoDS_Shape) -> TopoDS_Shape:
    """The body with a bite out of one of its straight edges: square, round or slanted."""
    straight = [(e, t) for e, _ in edge_faces(body) if (t := tangent(e)) is not None]
    if not straight:
        raise Refused("no edge for a notch")
    edge, way = dice.choice(straight)
    long = length(edge)
    ends = polyline(edge)
    at = ends[0] + dice.part(0.1, 0.9) * (ends[1] - ends[0])
    w, deep = long * dice.uniform(0.1, 0.35), long * dice.length(0.08, 0.4)
    along = frame(at, way)
    match dice.weighted({"box": 3, "turned box": 1, "across": 2, "ball": 0.6, "cone": 0.6}):
        case "box":
            tool = placed(centred_box(2 * deep, 2 * deep, w), along)
        case "turned box":
            tool = placed(turned(centred_box(2 * deep, 2 * deep, w), math.pi / 4), along)
        case "across":
            across = np.cross(way, dice.choice([X, Y, Z]))
            if np.linalg.norm(across) < 0.5:
                across = np.cross(way, X if abs(way[0]) < 0.9 else Y)
            tool = cylinder(w / 2, 200, frame(at - 100 * across, across))
        case "ball":
            tool = sphere(min(w, deep), along)
        case _:
            tool = cone(deep, 0.4 * deep, w, along)
    return cut(body, tool)


KINDS = {
    plain_hole: 3.0,
    drilled_hole: 1.0,
    counterbore: 1.6,
    countersink: 1.6,
    tapered_hole: 0.8,
    dimple: 0.8,
    ring_groove: 0.8,
    pocket: 3.0,
    boss: 2.5,
    cone_boss: 1.0,
    dome: 1.2,
    rib: 0.8,
    grid_of_holes: 0.4,
}
PLANAR = {pocket: 3.0, rib: 1.0, boss: 1.0}


def add(dice: Dice, body: TopoDS_Shape, count: int, kinds: dict | None = None) -> TopoDS_Shape:
    """The body with up to ``count`` features, on spots that do not overlap."""
    if count == 0:
        return body
    while count and dice.chance(0.18):
        body, count = notch(dice, body), count - 1
    if count == 0:
        return body
    board, tools = Board(body), Tools()
    for _ in range(count):
        tools.extend(dice.weighted(kinds or KINDS)(dice, board.spot(dice)))
    body = tools.apply(body)
    return dress_rims(dice, body) if kinds is not PLANAR and dice.chance(0.2) else body
