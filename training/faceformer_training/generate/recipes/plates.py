"""Plates and prisms with holes, pockets, bosses, patterns and dressed edges."""

import math

from OCP.gp import gp_Trsf
from OCP.TopoDS import TopoDS_Shape

from ..dice import Dice
from ..dress import soften_edges
from ..features import add, footprint, raised
from ..kernel import (
    UPRIGHT,
    centred_box,
    cone,
    cut,
    cylinder,
    extrude,
    fuse,
    moved,
    placed,
    point,
    shifted,
    turned,
)
from ..kernel import frame as axes
from ..outline import face, polygon, rounded
from ..sections import POLYGONS, rectangle_points, section, slot, soften
from ..spots import Board
from .basic import half_space
from .turned import height, ring_of_holes


def plate(dice: Dice) -> TopoDS_Shape:
    """A plate of any outline, with corner holes or others, pockets and bosses."""
    thick = dice.length(0.06, 0.5)
    body = extrude(face(section(dice, 0.3)), (0, 0, thick))
    body = add(dice, body, dice.few(4, 0.45))
    if dice.chance(0.3):
        body = soften_edges(dice, body)
    return body


def corner_plate(dice: Dice) -> TopoDS_Shape:
    """A rectangle, its corners rounded or not, with a hole in each and a feature in the middle."""
    dy, thick = 2 * dice.length(0.4, 1), dice.length(0.06, 0.5)
    points = rectangle_points(2, dy)
    r = dice.uniform(0.05, 0.3) * dy / 2
    style = dice.weighted({"sharp": 1, "round": 1.5, "cut": 0.5})
    outline = rounded(points, [r] * 4) if style == "round" else polygon(points)
    body = extrude(face(outline), (0, 0, thick))
    if style == "cut":
        body = cut(body, *(cylinder(r, 9, axes((x, y, -1))) for x, y in points))
    inset, hole = dice.uniform(0.14, 0.22) * dy, dice.uniform(0.03, 0.09) * dy
    cuts = []
    places = rectangle_points(2 - 2 * inset, dy - 2 * inset)
    if style != "cut":
        places = dice.choice(
            [places, places, places[::2], [((2 - 2 * inset) / 2, 0), (-(2 - 2 * inset) / 2, 0)]]
        )
        kind = dice.weighted({"plain": 5, "bored": 1.5, "sunk": 1.5, "slot": 1})
        for x, y in places:
            if kind == "slot":
                cuts.append(
                    shifted(extrude(face(slot(2 * hole, hole, (x, y))), (0, 0, 9)), (0, 0, -1))
                )
                continue
            cuts.append(cylinder(hole, 9, axes((x, y, -1))))
            if kind == "bored":
                cuts.append(cylinder(1.5 * hole, thick, axes((x, y, thick * 0.6))))
            elif kind == "sunk":
                cuts.append(cone(hole, hole + thick, thick, axes((x, y, thick * 0.6))))
    body = cut(body, *cuts) if cuts else body
    if dice.chance(0.6):
        body = add(dice, body, dice.few(2, 0.4))
    if dice.chance(0.3):
        body = soften_edges(dice, body)
    return body


def profile_bar(dice: Dice) -> TopoDS_Shape:
    """A length of rolled section, drilled, slotted, or cut off askew."""
    body = extrude(face(section(dice, 0.15)), (0, 0, dice.length(0.8, 5)))
    if dice.chance(0.2):
        body = cut(body, half_space((1.0, 1.0, 0.0), (dice.uniform(-0.5, 0.5), 0.3, -1), 0.4))
    body = add(dice, body, dice.few(3, 0.45)) if dice.chance(0.6) else body
    if dice.chance(0.3):
        body = soften_edges(dice, body)
    return body


def perforated(dice: Dice) -> TopoDS_Shape:
    """A plate with a row, grid or circle of equal holes or slots."""
    thick, dy = dice.length(0.05, 0.4), 2 * dice.length(0.3, 1)
    body = extrude(face(soften(dice, rectangle_points(2, dy), 0.5)), (0, 0, thick))
    nx = dice.randint(2, 5)
    ny = max(1, min(3, round(nx * dy / 2 * dice.uniform(0.5, 1.2))))
    px, py = 2 / (nx + 0.5), dy / (ny + 0.5)
    r = min(px, py) * dice.uniform(0.15, 0.36)
    kind = dice.weighted({"round": 4, "slot": 2, "square": 1.5})
    cuts = []
    for i in range(nx):
        for j in range(ny):
            x, y = px * (i - (nx - 1) / 2), py * (j - (ny - 1) / 2)
            if kind == "round":
                shape = None
                cuts.append(cylinder(r, 9, axes((x, y, -3))))
                continue
            if kind == "slot":
                shape = slot(0.8 * (px - 2 * r) * 0.7, 0.7 * r, (x, y))
            else:
                shape = polygon(rectangle_points(1.5 * r, 1.5 * r, (x, y)))
            cuts.append(shifted(extrude(face(shape), (0, 0, 9)), (0, 0, -3)))
    return cut(body, *cuts)


def two_levels(dice: Dice) -> TopoDS_Shape:
    """Two or three prisms of different outlines on each other."""
    body = extrude(face(section(dice, 0.4)), (0, 0, dice.length(0.1, 0.8)))
    top = height(body)
    for _ in range(dice.few(2, 0.3)):
        board = Board(body)
        up = board.facing((0, 0, 1))
        spot = board.spot(dice, max(up, key=lambda i: board.flats[i].origin[2]))
        high = dice.length(0.1, 0.8) * top * 2
        body = fuse(body, raised(spot, footprint(dice, spot.room), high))
        top += high
    if dice.chance(0.7):
        body = add(dice, body, dice.few(2, 0.4))
    if dice.chance(0.3):
        body = soften_edges(dice, body)
    return body


def lever(dice: Dice) -> TopoDS_Shape:
    """Two eyes and a web between them."""
    long, r0 = dice.length(1.6, 4), dice.uniform(0.5, 0.8)
    r1 = r0 if dice.chance(0.3) else r0 * dice.uniform(0.5, 0.95)
    h0, h1 = dice.length(0.3, 1.2), dice.length(0.3, 1.2)
    web_h, web_w = min(h0, h1) * dice.uniform(0.3, 0.9), min(r0, r1) * dice.uniform(0.3, 0.9)
    web = centred_box(long, 2 * web_w, web_h, (long / 2, 0, -web_h / 2))
    eyes = [
        cylinder(r0, h0, axes((0, 0, -h0 / 2 if dice.chance(0.5) else -web_h / 2))),
        cylinder(r1, h1, axes((long, 0, -h1 / 2 if dice.chance(0.5) else -web_h / 2))),
    ]
    body = fuse(web, *eyes)
    q0, q1 = r0 * dice.uniform(0.3, 0.75), r1 * dice.uniform(0.3, 0.75)
    cuts = [cylinder(q0, 9, axes((0, 0, -4))), cylinder(q1, 9, axes((long, 0, -4)))]
    if dice.chance(0.2):
        cuts.append(centred_box(0.3 * q0, 2.4 * q0, 9, (0, 0, -4)))
    body = cut(body, *cuts)
    return soften_edges(dice, body) if dice.chance(0.2) else body


def disc(dice: Dice) -> TopoDS_Shape:
    """A disc with a pattern of holes and a feature in its middle."""
    body = cylinder(1.0, dice.length(0.06, 0.6))
    n = dice.randint(3, 8)
    ring = dice.uniform(0.55, 0.8)
    r = min(1 - ring, ring * math.sin(math.pi / n)) * dice.uniform(0.3, 0.7)
    body = cut(body, *ring_of_holes(dice, n, ring, r, height(body)))
    return add(dice, body, dice.few(2, 0.4)) if dice.chance(0.6) else body


def fork(dice: Dice) -> TopoDS_Shape:
    """A prism of one outline cut across by another: forks, claws, jaws."""
    body = extrude(face(section(dice, 0.5)), (0, 0, dice.length(0.5, 2)))
    shape = polygon(dice.weighted(POLYGONS)(dice)) if dice.chance(0.5) else section(dice, 1.0)
    small = dice.uniform(0.2, 0.5)
    tool = extrude(face(shape), (0, 0, 9))
    tool = _scaled(tool, small)

    tool = shifted(placed(tool, UPRIGHT), (0, 2, height(body) * dice.choice([0, 0.5, 1])))
    tool = turned(tool, dice.choice([0, math.pi / 2, dice.angle()]))
    return cut(body, tool)


def _scaled(shape: TopoDS_Shape, factor: float) -> TopoDS_Shape:
    trsf = gp_Trsf()
    trsf.SetScale(point((0, 0, 0)), factor)
    return moved(shape, trsf)


RECIPES = {
    plate: 4.0,
    corner_plate: 2.0,
    profile_bar: 4.0,
    perforated: 0.7,
    two_levels: 3.0,
    lever: 1.2,
    disc: 0.7,
    fork: 1.5,
}
