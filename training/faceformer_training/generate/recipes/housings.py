"""Shelled and drafted bodies, bodies with all edges soft, cases with bosses, chip packages."""

import math

from OCP.TopoDS import TopoDS, TopoDS_Shape

from ..dice import Dice
from ..dress import (
    chamfer,
    dress_rims,
    edge_faces,
    fillet,
    hollow,
    open_shell,
    soften_edges,
    tangent,
)
from ..features import add
from ..kernel import (
    Z,
    centred_box,
    cut,
    cylinder,
    draft,
    extrude,
    faces,
    fuse,
    loft,
    shifted,
)
from ..kernel import frame as axes
from ..outline import circle, face, polygon, rounded
from ..sections import POLYGONS, rectangle_points, round_section, section, soften
from ..spots import flat
from .turned import height


def shelled(dice: Dice) -> TopoDS_Shape:
    """A prism or a stepped body hollowed out."""
    body = extrude(face(section(dice, 0.35)), (0, 0, dice.length(0.3, 2)))
    if dice.chance(0.25):
        body = soften_edges(dice, body, 0.8)
    body = open_shell(dice, body, dice.uniform(0.04, 0.14))
    return add(dice, body, dice.few(3, 0.5)) if dice.chance(0.6) else body


def drafted(dice: Dice) -> TopoDS_Shape:
    """A moulded block: sides tilted (arcs become cones), edges soft, now and then hollow."""
    outline = soften(dice, rectangle_points(2, 2 * dice.length(0.4, 1)), 0.7)
    if dice.chance(0.3):
        outline = section(dice, 0.3)
    h = dice.length(0.2, 1.2)
    body = extrude(face(outline), (0, 0, h))
    sides = [f for f in faces(body) if (p := flat(f)) is None or abs(p.normal[2]) < 0.5]
    body = draft(body, sides, Z, math.radians(dice.choice([2, 5, 8, 12])), (0, 0, 0))
    if dice.chance(0.3):
        top = next(f for f in faces(body) if (p := flat(f)) is not None and p.normal[2] > 0.9)
        edges_of_top = [e for e, fs in edge_faces(body) if any(f.IsSame(top) for f in fs)]
        body = fillet(body, edges_of_top, h * dice.uniform(0.05, 0.3))
    if dice.chance(0.3):
        low = next(f for f in faces(body) if (p := flat(f)) is not None and p.normal[2] < -0.9)
        body = hollow(body, [low], min(h, 0.4) * dice.uniform(0.1, 0.25))
    return add(dice, body, dice.few(3, 0.5)) if dice.chance(0.5) else body


def soft_block(dice: Dice) -> TopoDS_Shape:
    """A block with all edges, or all of one direction and then one face's, rounded or bevelled."""
    size = (2, 2 * dice.length(0.3, 1), 2 * dice.length(0.2, 1))
    body = centred_box(*size)
    least = min(size)
    kind = dice.weighted({"all": 2, "upright": 2, "mixed": 1.5, "some": 2})
    pairs = [e for e, _ in edge_faces(body)]
    if kind == "all":
        work = fillet if dice.chance(0.75) else chamfer
        body = work(body, pairs, least * dice.uniform(0.06, 0.42))
    elif kind in ("upright", "mixed"):
        ups = [e for e in pairs if abs(tangent(e)[2]) > 0.9]
        r = min(size[:2]) * dice.uniform(0.1, 0.45)
        body = fillet(body, ups, r)
        top = next(f for f in faces(body) if (p := flat(f)) is not None and p.normal[2] > 0.9)
        rim = [e for e, fs in edge_faces(body) if any(f.IsSame(top) for f in fs)]
        if kind == "mixed":
            q = min(0.8 * r, 0.6 * size[2]) * dice.uniform(0.2, 0.9)
            body = (fillet if dice.chance(0.7) else chamfer)(body, rim, q)
    else:
        body = soften_edges(dice, body)
        body = soften_edges(dice, body) if dice.chance(0.4) else body
    return add(dice, body, dice.few(2, 0.4)) if dice.chance(0.35) else body


def cast(dice: Dice) -> TopoDS_Shape:
    """A cast body: soft outline, rims rounded on one side or on both, bosses with rounded feet."""
    if dice.chance(0.5):
        points = dice.weighted(POLYGONS)(dice)
        room = min(math.dist(points[i - 1], points[i]) for i in range(len(points)))
        r = room * dice.uniform(0.2, 0.46)
        outline = rounded(points, [r] * len(points))
    else:
        outline, r = round_section(dice), 0.25
    h = dice.length(0.15, 1.5)
    body = extrude(face(outline), (0, 0, h))
    if dice.chance(0.25):
        sides = [f for f in faces(body) if (p := flat(f)) is None or abs(p.normal[2]) < 0.5]
        body = draft(body, sides, Z, math.radians(dice.uniform(2, 10)), (0, 0, 0))
    ends = (1,) if dice.chance(0.6) else (1, -1)
    rim = []
    for end in ends:
        side = next(
            f for f in faces(body) if (p := flat(f)) is not None and end * p.normal[2] > 0.9
        )
        rim += [e for e, fs in edge_faces(body) if any(f.IsSame(side) for f in fs)]
    q = min(0.9 * r, 0.45 * h) * dice.uniform(0.2, 0.9)
    body = fillet(body, rim, q)
    if dice.chance(0.3):
        low = [f for f in faces(body) if (p := flat(f)) is not None and p.normal[2] < -0.9]
        body = hollow(body, low, q * dice.uniform(0.3, 0.8)) if low else body
    if dice.chance(0.4):
        body = add(dice, body, dice.few(2, 0.4))
        body = dress_rims(dice, body) if dice.chance(0.5) else body
    return body


def case(dice: Dice) -> TopoDS_Shape:
    """A box, open on top, with screw bosses, ribs and cut-outs in its walls."""
    dy, h, wall = 2 * dice.length(0.5, 1), dice.length(0.3, 1.2), dice.uniform(0.06, 0.15)
    r = dice.uniform(0.1, 0.3) * dy / 2
    round_corners = dice.chance(0.5)

    def outline(inset: float):
        points = rectangle_points(2 - 2 * inset, dy - 2 * inset)
        q = r - inset
        return rounded(points, [q] * 4) if round_corners and q > 0.02 else polygon(points)

    body = extrude(face(outline(0.0)), (0, 0, h))
    room = shifted(extrude(face(outline(wall)), (0, 0, h)), (0, 0, wall))
    body = cut(body, room)
    adds, cuts = [], []
    if dice.chance(0.5):
        q = dice.uniform(0.08, 0.14)
        tall = (h - wall) * dice.part(0.3, 0.8)
        inset = wall + q * 1.3
        places = rectangle_points(2 - 2 * inset, dy - 2 * inset)
        places = places if dice.chance(0.6) else places[::2]
        adds += [cylinder(q, tall + wall / 2, axes((x, y, wall / 2))) for x, y in places]
        if dice.chance(0.6):
            cuts += [
                cylinder(q * 0.5, 9, axes((x, y, wall if dice.chance(0.5) else -1)))
                for x, y in places
            ]
    if dice.chance(0.5):
        z, w = h * dice.uniform(0.4, 0.8), dice.uniform(0.15, 0.5)
        if dice.chance(0.5):
            cuts.append(cylinder(min(0.2, 0.3 * h) * 0.8, 4, axes((0, 0, z * 0.8), (1, 0, 0))))
        else:
            cuts.append(centred_box(4, w, h, (2, 0, z)))
    body = fuse(body, *adds) if adds else body
    body = cut(body, *cuts) if cuts else body
    return add(dice, body, 1) if dice.chance(0.3) else body


def package(dice: Dice) -> TopoDS_Shape:
    """An electronic package: a body with tilted sides or bevels and a row of pins or pads."""
    dy, h = 2 * dice.length(0.3, 1), dice.length(0.15, 0.8)
    tilt = dice.uniform(0.03, 0.12)
    mid = h * dice.uniform(0.3, 0.7)
    base, wide = rectangle_points(2 - tilt, dy - tilt), rectangle_points(2, dy)
    style = dice.weighted({"double": 2, "single": 1, "box": 1, "round": 1})
    if style == "double":
        lower = _frustum(base, wide, mid)
        upper = shifted(_frustum(wide, base, h - mid), (0, 0, mid))
        body = fuse(lower, upper)
    elif style == "single":
        body = _frustum(wide, base, h)
    elif style == "round":
        body = extrude(face(circle(1.0)), (0, 0, h))
        body = soften_edges(dice, body) if dice.chance(0.5) else body
        dy = 1.2
    else:
        body = centred_box(2, dy, h)
    n = dice.randint(1, 4)
    pitch = 1.6 / n
    adds = []
    w = pitch * dice.uniform(0.2, 0.5)
    round_pin = dice.chance(0.3)
    sides = (-1, 1) if dice.chance(0.6) else (1,)
    if style == "round":
        sides = (-1, 1) if dice.chance(0.5) else (0,)
    down = dice.length(0.2, 1.5)
    for i in range(n):
        for s in sides:
            x = pitch * (i - (n - 1) / 2)
            y = s * dy * 0.3
            if round_pin or style == "round":
                adds.append(cylinder(w / 2, down, axes((x, y, 0.01), (0, 0, -1))))
            else:
                adds.append(centred_box(w, w * dice_ratio(dice), down, (x, y, -down + 0.01)))
    body = fuse(body, *adds)
    if dice.chance(0.4):
        r = min(0.2, 0.2 * dy)
        mark = cylinder(
            r * 0.6, h * 0.2, axes((-0.6, 0.2 * dy if style != "round" else 0, h * 0.9))
        )
        body = cut(body, mark)
    return body


def dice_ratio(dice: Dice) -> float:
    """Thickness to width of a pin; equal for all pins of a package most of the time."""
    return dice.choice([1.0, 0.6]) if dice.chance(0.1) else 1.0


def _frustum(low: list, high: list, h: float) -> TopoDS_Shape:
    upper = TopoDS.Wire_s(shifted(polygon(high).wire(), (0, 0, h)))
    return loft([polygon(low).wire(), upper], True)


def cap(dice: Dice) -> TopoDS_Shape:
    """A turned cup: a soft cylinder hollowed from below."""
    h = dice.length(0.3, 2)
    body = cylinder(1.0, h)
    if dice.chance(0.7):
        top = [f for f in faces(body) if (p := flat(f)) is not None and p.normal[2] > 0.9][0]
        rim = [e for e, fs in edge_faces(body) if any(f.IsSame(top) for f in fs)]
        body = (fillet if dice.chance(0.7) else chamfer)(
            body, rim, min(h, 1.0) * dice.uniform(0.1, 0.7)
        )
    low = next(f for f in faces(body) if (p := flat(f)) is not None and p.normal[2] < -0.9)
    body = hollow(body, [low], dice.uniform(0.05, 0.2) * min(1.0, h))
    if dice.chance(0.5):
        body = cut(body, cylinder(dice.uniform(0.1, 0.5), 9, axes((0, 0, -1))))
    if dice.chance(0.4):
        body = cut(body, centred_box(4, dice.uniform(0.2, 0.6), height(body) * 0.4, (0, 0, -0.01)))
    return body


RECIPES = {
    shelled: 2.5,
    drafted: 2.0,
    soft_block: 5.0,
    cast: 5.0,
    case: 1.0,
    package: 1.5,
    cap: 1.2,
}
