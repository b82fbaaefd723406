"""Turned parts: stepped shafts, bushes, flanges, pulleys, knobs, screws; whole or part turns."""

import math

from OCP.Bnd import Bnd_Box
from OCP.BRepBndLib import BRepBndLib
from OCP.TopoDS import TopoDS_Shape

from ..dice import Dice
from ..dress import soften_edges
from ..features import KINDS, add
from ..kernel import (
    UPRIGHT,
    Refused,
    X,
    Y,
    centred_box,
    cone,
    cut,
    cylinder,
    extrude,
    fuse,
    placed,
    revolve,
    shifted,
    turned,
)
from ..kernel import frame as axes
from ..outline import Outline, face, polygon
from ..sections import ngon_points, rectangle_points, section, slot
from .basic import bevelled


def stepped_profile(dice: Dice, steps: int, bore: float) -> Outline:
    """A half section between the radius ``bore`` and about 1, from z = 0 upwards.

    Between the steps there are shoulders, cones, fillets (tori), grooves and domes.
    """
    low = max(bore * 1.15, 0.2)
    radii = [dice.uniform(low, 1.0) for _ in range(steps)]
    radii[dice.randrange(steps)] = 1.0
    if bore > 0:
        chain = Outline((bore, 0.0)).line(radii[0], 0.0)
    else:
        chain = Outline((0.0, 0.0)).line(radii[0], 0.0)
    z = 0.0
    for i, r in enumerate(radii):
        h = dice.length(0.1, 1.2)
        last = i == steps - 1
        following = bore if last else radii[i + 1]
        gap = following - r
        room = 0.45 * min(abs(gap), h)
        if not last and abs(gap) < 0.05:
            following = r + math.copysign(0.08, gap)
            radii[i + 1] = following
            gap, room = following - r, 0.03
        _side(dice, chain, r, z, z + h, room)
        z += h
        if not last and dice.chance(0.18):
            rise = abs(gap) * dice.choice([1.0, 0.577, 1.73, 0.27])
            chain.line(following, z + rise)  # a cone up to the next step
            z += rise
        elif not last:
            chain.line(following, z)
        elif bore == 0 and dice.chance(0.25):
            half = r * dice.uniform(0.3, 1.0)
            _dome(chain, r, z, half)
            return chain
        elif bore == 0 and dice.chance(0.12):
            chain.line(0.0, z + r * dice.length(0.3, 1.5))
            return chain
        else:
            chain.line(following, z)
    return chain


def _side(dice: Dice, chain: Outline, r: float, z0: float, z1: float, room: float) -> None:
    """One step's outer side, from (r, z0) to its upper edge (r, z1) or the bevel there."""
    h = z1 - z0
    kind = dice.weighted({"plain": 6, "groove": 0.8, "round": 0.7, "waist": 0.5, "belly": 0.5})
    w = h * dice.uniform(0.15, 0.3)
    deep = 0.12 * r
    if kind == "groove":
        mid = z0 + h / 2
        if dice.chance(0.5):
            chain.line(r, mid - w).line(r - deep, mid - w).line(r - deep, mid + w)
            chain.line(r, mid + w)
        elif dice.chance(0.5):
            chain.line(r, mid - w).line(r - deep, mid).line(r, mid + w)
        else:
            chain.line(r, mid - w).arc((r - min(w, deep), mid), (r, mid + w))
    elif kind == "round" and h > 0.15:
        # A bulge as wide as the whole step: a torus.
        chain.line(r, z0 + 0.2 * h).arc((r + 0.3 * h, z0 + h / 2), (r, z0 + 0.8 * h))
    elif kind == "waist":
        chain.arc((r - min(0.25 * h, 0.15 * r), z0 + h / 2), (r, z1))
        return
    elif kind == "belly":
        chain.arc((r + min(0.3 * h, 0.2), z0 + h / 2), (r, z1))
        return
    if room > 0.02 and dice.chance(0.35):
        # The upper edge is rounded or bevelled, where the next radius is smaller.
        chain.line(r, z1 - room)
        b = room * 0.7
        if dice.chance(0.5):
            chain.arc(
                (r - room * (1 - math.sqrt(0.5)), z1 - room * (1 - math.sqrt(0.5))), (r - room, z1)
            )
        else:
            chain.line(r - b, z1)
        return
    chain.line(r, z1)


def _dome(chain: Outline, r: float, z: float, rise: float) -> None:
    """A spherical cap of height ``rise`` on a circle of radius ``r``, up to the axis."""
    big = (r * r + rise * rise) / (2 * rise)
    half = math.asin(min(1.0, r / big)) / 2
    chain.arc((big * math.sin(half), z + rise - big * (1 - math.cos(half))), (0.0, z + rise))


def shaft(dice: Dice) -> TopoDS_Shape:
    """A stepped shaft or bush, with keyways, flats, cross holes, sockets."""
    bore = 0.0 if dice.chance(0.5) else dice.uniform(0.12, 0.6)
    profile = face(stepped_profile(dice, dice.few(5, 0.6), bore))
    part_turn = dice.chance(0.12)
    angle = dice.choice([0.25, 0.5, 0.5, 0.75, dice.uniform(0.15, 0.9)]) * 2 * math.pi
    body = revolve(placed(profile, UPRIGHT), angle=angle if part_turn else 0)
    if dice.chance(0.5):
        body = _cross_features(dice, body)
    if dice.chance(0.2):
        body = add(dice, body, 1)
    if dice.chance(0.25):
        body = soften_edges(dice, body, 0.75)
    return body


def height(body: TopoDS_Shape) -> float:
    """Upper end of a body that stands on z = 0."""
    bounds = Bnd_Box()
    BRepBndLib.Add_s(body, bounds, False)
    return bounds.CornerMax().Z()


def _cross_features(dice: Dice, body: TopoDS_Shape) -> TopoDS_Shape:
    """What is milled or drilled across the axis."""
    top = height(body)
    z, h = dice.uniform(0.15, 0.85) * top, dice.uniform(0.1, 0.4) * top
    match dice.weighted({"hole": 2, "flat": 2, "flats": 1.5, "key": 1.5, "slot": 1.5, "ring": 1.0}):
        case "hole":
            r = min(0.35, 0.2 * top) * dice.uniform(0.4, 0.9)
            deep = 6 if dice.chance(0.6) else 3
            return cut(body, cylinder(r, deep, axes((-3, 0, z), X)))
        case "flat":
            return cut(body, centred_box(2, 4, h, (1 + dice.uniform(0.4, 0.85), 0, z)))
        case "flats":
            n, across = dice.choice([2, 2, 4, 6]), dice.uniform(0.6, 0.9)
            tool = centred_box(2, 4, h, (1 + across, 0, top - h / 2))
            return cut(body, *(turned(tool, 2 * math.pi * i / n) for i in range(n)))
        case "key":
            w = dice.uniform(0.1, 0.22)
            length = max(0.1, 0.5 * h)
            key = extrude(face(slot(length, w / 2, turn=math.pi / 2)), (0, 0, 3))
            at = dice.uniform(0.5, 0.85)
            return cut(body, placed(key, axes((at, 0, z), X, Y)))
        case "slot":
            w, deep = dice.uniform(0.08, 0.3), dice.uniform(0.1, 0.3) * top
            tool = centred_box(6, w, 2 * deep, (0, 0, top - deep))
            if dice.chance(0.3):
                return cut(body, tool, turned(tool, math.pi / 2))
            return cut(body, tool)
        case _:
            n, r = dice.randint(2, 6), min(0.2, 0.12 * top)
            tool = cylinder(r * dice.uniform(0.5, 0.9), 3, axes((0, 0, z), X))
            return cut(body, *(turned(tool, 2 * math.pi * i / n) for i in range(n)))


def flange(dice: Dice) -> TopoDS_Shape:
    """A disc with a hub, a bore and a circle of holes; the rim now and then cut or toothed."""
    thick, hub = dice.length(0.08, 0.5), dice.uniform(0.25, 0.55)
    body = cylinder(1.0, thick)
    tall = 0.0
    if dice.chance(0.7):
        tall = dice.length(0.1, 1.2)
        if dice.chance(0.3):
            neck = cone(hub * 1.15, hub, tall, axes((0, 0, thick * 0.999)))
            hub *= 1.15
        else:
            neck = cylinder(hub, tall + thick)
        body = fuse(body, neck)
    cuts = []
    if dice.chance(0.75):
        bore = hub * dice.uniform(0.3, 0.8)
        through = dice.chance(0.8)
        cuts.append(cylinder(bore, 9, axes((0, 0, -4 if through else thick * 0.5))))
        if dice.chance(0.2):
            cuts.append(centred_box(bore * 0.5, 2.4 * bore, 9, (0, 0, -4)))
    ring = dice.uniform(hub + 0.35 * (1 - hub), hub + 0.6 * (1 - hub))
    n = dice.choice([2, 3, 3, 4, 4, 4, 5, 6, 6, 8])
    most = min(1 - ring, ring - hub, ring * math.sin(math.pi / n))
    if dice.chance(0.85) and most > 0.03:
        cuts += ring_of_holes(dice, n, ring, most * dice.uniform(0.3, 0.75), thick)
    if dice.chance(0.25):
        cuts += _rim_cuts(dice)
    body = cut(body, *cuts)
    if dice.chance(0.35):
        body = soften_edges(dice, body)
    if dice.chance(0.1):
        body = cut(body, centred_box(4, 4, 9, (0, 2, -4)))
    return body


def ring_of_holes(dice: Dice, n: int, ring: float, r: float, thick: float) -> list[TopoDS_Shape]:
    """``n`` equal tools on a circle: plain, stepped, sunk, slotted or square holes."""
    kind = dice.weighted({"plain": 5, "bored": 1.5, "sunk": 1.5, "slot": 1, "square": 0.5})
    if kind == "slot":
        tool = extrude(face(slot(r, r * 0.5, (ring, 0), dice.choice([0, math.pi / 2]))), (0, 0, 9))
        tools = [tool]
    elif kind == "square":
        shape = face(polygon(rectangle_points(1.3 * r, 1.3 * r, (ring, 0))))
        tools = [extrude(shape, (0, 0, 9))]
    else:
        small = r if kind == "plain" else 0.55 * r
        tools = [cylinder(small, 9, axes((ring, 0, 0)))]
    tools = [placed(t, axes((0, 0, -4))) for t in tools]
    if kind in ("bored", "sunk"):
        profile = [(0, 0.1), (r, 0.1), (r, -0.4 * thick), (0, -0.4 * thick)]
        if kind == "sunk":
            profile = [(0, 0.1), (r + 0.1, 0.1), (r - 0.4 * thick, -0.4 * thick), (0, -0.4 * thick)]
            if r - 0.4 * thick <= 0.05 * r:
                profile = [(0, 0.1), (r + 0.1, 0.1), (0, -r)]
        wide = revolve(placed(face(polygon(profile)), UPRIGHT))
        tools = [fuse(tools[0], placed(wide, axes((ring, 0, thick))))]
    turn = dice.choice([0, math.pi / n])
    return [turned(t, turn + 2 * math.pi * i / n) for t in tools for i in range(n)]


def _rim_cuts(dice: Dice) -> list[TopoDS_Shape]:
    """Flats or notches around the rim."""
    n = dice.choice([1, 2, 2, 3, 4, 6])
    if dice.chance(0.5):
        tool = centred_box(2, 4, 9, (1 + dice.uniform(0.75, 0.95), 0, -4))
    elif dice.chance(0.5):
        tool = centred_box(0.4, dice.uniform(0.1, 0.4), 9, (1.05, 0, -4))
    else:
        tool = cylinder(dice.uniform(0.08, 0.2), 9, axes((1.0, 0, -4)))
    return [turned(tool, 2 * math.pi * i / n) for i in range(n)]


def screw(dice: Dice) -> TopoDS_Shape:
    """A bolt without thread: head, shank, drive."""
    r, long = dice.uniform(0.35, 0.6), dice.length(0.8, 5)
    tall = dice.uniform(0.4, 0.9)
    drive_deep = tall * dice.uniform(0.3, 0.6)
    kind = dice.weighted({"hex": 2, "cap": 2, "sunk": 1.5, "pan": 1.5})
    shank = [(0.0, -long), (r * 0.85, -long), (r, -long + 0.15 * r), (r, 0.0)]
    if kind == "hex":
        chain = polygon([*shank, (0.0, 0.0)])
        body = revolve(placed(face(chain), UPRIGHT))
        head = extrude(face(polygon(ngon_points(6, 1.0))), (0, 0, tall))
        if dice.chance(0.6):
            head = bevelled(head, tall, dice.uniform(0.8, 0.95), 0.58)
        body = fuse(body, head)
    else:
        chain = Outline(shank[0])
        for p in shank[1:]:
            chain.line(*p)
        if kind == "cap":
            chain.line(1, 0).line(1, tall * 0.85).line(1 - 0.15 * tall, tall).line(0, tall)
        elif kind == "sunk":
            chain.line(1, tall).line(1, tall * 1.1).line(0, tall * 1.1)
            drive_deep += 0.1 * tall
        else:
            chain.line(1, 0)
            _dome(chain, 1, 0, tall * 0.8)
            drive_deep *= 1.3
        body = revolve(placed(face(chain), UPRIGHT))
    if kind == "hex" and dice.chance(0.7):
        return body
    top = tall * (0.8 if kind == "pan" else 1.1 if kind == "sunk" else 1.0)
    return cut(body, _drive(dice, top, drive_deep))


def _drive(dice: Dice, top: float, deep: float) -> TopoDS_Shape:
    """Hexagon socket, slot, cross or square, down from ``top``."""
    match dice.weighted({"hex": 3, "slot": 2, "cross": 1, "square": 1}):
        case "hex":
            socket = extrude(face(polygon(ngon_points(6, 0.5))), (0, 0, 9))
            return shifted(socket, (0, 0, top - deep))
        case "slot":
            return centred_box(4, 0.22, 9, (0, 0, top - deep))
        case "cross":
            one = centred_box(1.0, 0.22, 9, (0, 0, top - deep))
            return fuse(one, turned(one, math.pi / 2))
        case _:
            return centred_box(0.6, 0.6, 9, (0, 0, top - deep))


def pulley(dice: Dice) -> TopoDS_Shape:
    """A wheel: rim with a groove, web with holes, hub with a bore."""
    w, web, hub = dice.length(0.15, 0.8), dice.uniform(0.15, 0.6), dice.uniform(0.25, 0.45)
    rim, t = dice.uniform(0.7, 0.85), 0.0
    t = web * w / 2
    bore = hub * dice.uniform(0.3, 0.7)
    h, wide = w / 2, (w / 2) * dice.uniform(1.0, 1.5)
    chain = Outline((bore, -wide)).line(hub, -wide).line(hub, -t).line(rim, -t).line(rim, -h)
    chain.line(1, -h)
    deep = (1 - rim) * dice.uniform(0.3, 0.7)
    match dice.weighted({"flat": 1, "vee": 2, "round": 2, "square": 1}):
        case "vee":
            chain.line(1, -0.7 * h).line(1 - deep, -0.3 * h).line(1 - deep, 0.3 * h).line(
                1, 0.7 * h
            )
        case "round":
            chain.line(1, -0.6 * h).arc((1 - min(deep, 0.6 * h), 0), (1, 0.6 * h))
        case "square":
            chain.line(1, -0.6 * h).line(1 - deep, -0.6 * h).line(1 - deep, 0.6 * h).line(
                1, 0.6 * h
            )
        case _:
            pass
    chain.line(1, h).line(rim, h).line(rim, t).line(hub, t).line(hub, wide).line(bore, wide)
    body = revolve(placed(face(chain), UPRIGHT))
    if dice.chance(0.6):
        n = dice.randint(3, 6)
        mid = (rim + hub) / 2
        r = min((rim - hub) / 2, mid * math.sin(math.pi / n)) * dice.uniform(0.4, 0.85)
        tool = cylinder(r, 4, axes((mid, 0, -2)))
        body = cut(body, *(turned(tool, 2 * math.pi * i / n) for i in range(n)))
    return body


def spun(dice: Dice) -> TopoDS_Shape:
    """A knob, vase or handle: a free curve turned about the axis, whole or by a part."""
    h, bore = dice.length(0.6, 3), 0.0 if dice.chance(0.6) else dice.uniform(0.08, 0.25)
    n = dice.randint(1, 3)
    radii = [dice.uniform(0.35, 1.0) for _ in range(n + 2)]
    via = [(r, h * (i + 1) / (n + 1)) for i, r in enumerate(radii[1:-1])]
    chain = Outline((bore, 0.0)).line(radii[0], 0.0)
    if dice.chance(0.3):
        chain = Outline((bore, -0.15 * h)).line(radii[0], -0.15 * h).line(radii[0], 0.0)
    chain.spline(via, (radii[-1], h))
    if dice.chance(0.4):
        chain.line(radii[-1], h * 1.2).line(bore, h * 1.2)
    else:
        chain.line(bore, h)
    angle = dice.part(0.2, 0.8) * 2 * math.pi if dice.chance(0.25) else 0
    body = revolve(placed(face(chain), UPRIGHT), angle=angle)
    if dice.chance(0.25):
        body = _cross_features(dice, body)
    return add(dice, body, 1) if dice.chance(0.25) else body


def ring_sector(dice: Dice) -> TopoDS_Shape:
    """A section turned about an axis outside of it, by a part of a turn: bends and segments."""
    shape = placed(face(section(dice, 0.4)), axes((1.3 + dice.length(0.1, 2), 0, 0), (0, -1, 0), X))
    body = revolve(shape, angle=dice.part(0.1, 0.8) * 2 * math.pi)
    if dice.chance(0.3):
        body = add(dice, body, 1, KINDS)
    return body


def crossed_shaft(dice: Dice) -> TopoDS_Shape:
    """A tube with a second one through it: tees and crosses."""
    r, q = 1.0, dice.uniform(0.4, 0.95)
    long = dice.length(1.2, 3)
    tilt = math.pi / 2 if dice.chance(0.6) else dice.angle()
    branch = axes((0, 0, 0), (math.sin(tilt), 0, math.cos(tilt)))
    body = fuse(cylinder(r, 2 * long, axes((0, 0, -long))), cylinder(q, long * 1.5, branch))
    if dice.chance(0.6):
        wall = dice.uniform(0.5, 0.85)
        body = cut(
            body,
            cylinder(r * wall, 8 * long, axes((0, 0, -4 * long))),
            cylinder(q * wall, 9, branch),
        )
    if long * 1.5 * math.sin(tilt) < 1.2:
        raise Refused("a branch that does not come out")
    return soften_edges(dice, body, 0.9) if dice.chance(0.3) else body


RECIPES = {
    shaft: 5.0,
    flange: 2.5,
    screw: 1.5,
    pulley: 1.2,
    ring_sector: 1.2,
    spun: 2.6,
    crossed_shaft: 0.8,
}
