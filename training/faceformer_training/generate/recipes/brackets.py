"""Brackets, bearing blocks, clevises; bent sheet metal."""

import math

from OCP.TopoDS import TopoDS_Shape

from ..dice import Dice
from ..dress import edge_faces, fillet, length, soften_edges, tangent
from ..features import add
from ..kernel import UPRIGHT, X, centred_box, cut, cylinder, extrude, fuse, placed, shifted
from ..kernel import frame as axes
from ..outline import Outline, circle, face, polygon
from ..sections import channel, ell, rectangle_points, soften, tee, zed


def angle_bracket(dice: Dice) -> TopoDS_Shape:
    """An angle, channel, tee or zed, with gussets, holes and rounded ends."""
    points = dice.choice([ell, ell, channel, tee, zed])(dice)
    deep = dice.length(0.5, 2)
    body = placed(extrude(face(soften(dice, points, 0.3)), (0, 0, deep)), UPRIGHT)
    if dice.chance(0.3) and len(points) == 6:
        corner, reach = points[3], min(points[2][0] - points[3][0], points[4][1] - points[3][1])
        a, b = reach * dice.part(0.4, 0.9), reach * dice.part(0.4, 0.9)
        thick = deep * dice.uniform(0.08, 0.25)
        x, y = corner
        gusset = polygon(
            [(x - 0.02, y - 0.02), (x + a, y - 0.02), (x + a, y), (x, y + b), (x - 0.02, y + b)]
        )
        rib = placed(extrude(face(gusset), (0, 0, thick)), UPRIGHT)
        body = fuse(body, shifted(rib, (0, -(deep - thick) * dice.choice([0.5, 0.5, 0.2]), 0)))
    body = add(dice, body, dice.few(3, 0.5)) if dice.chance(0.8) else body
    return soften_edges(dice, body) if dice.chance(0.35) else body


def bearing_block(dice: Dice) -> TopoDS_Shape:
    """A base with an upright eye: pillow blocks and pedestals."""
    foot_h, deep = dice.uniform(0.15, 0.4), dice.length(0.4, 1.2)
    r, up = dice.uniform(0.35, 0.6), dice.uniform(0.7, 1.4)
    base = centred_box(2, deep * dice.uniform(1.0, 1.4), foot_h)
    w = r if dice.chance(0.6) else dice.uniform(0.8 * r, 0.95)
    if abs(w - r) < 1e-9:
        outline = Outline((-r, 0)).line(r, 0).line(r, up).arc((0, up + r), (-r, up))
    else:
        # Flanks that run tangentially into the eye.
        w = max(w, r * 1.05)
        d = math.hypot(w, up)
        t = math.atan2(-up, w) + math.acos(r / d)
        p = (r * math.cos(t), up + r * math.sin(t))
        outline = Outline((-w, 0)).line(w, 0).line(*p).arc((0, up + r), (-p[0], p[1]))
    wall_t = deep * dice.uniform(0.3, 0.95)
    wall = placed(extrude(face(outline), (0, 0, wall_t)), UPRIGHT)
    body = fuse(base, shifted(wall, (0, wall_t / 2, 0)))
    bore = cylinder(r * dice.uniform(0.4, 0.8), 9, axes((0, 4, up), (0, -1, 0)))
    cuts = [bore]
    if dice.chance(0.4):
        wide = r * 0.88
        cuts.append(cylinder(wide, deep * 0.3 + 4, axes((0, -4 - wall_t * 0.3, up), (0, 1, 0))))
    if dice.chance(0.7):
        x, q = dice.uniform(0.74, 0.8), dice.uniform(0.06, 0.13)
        cuts += [cylinder(q, 9, axes((s * x, 0, -4))) for s in (-1, 1)]
    if dice.chance(0.25):
        cuts.append(centred_box(dice.uniform(0.4, 1.2), 9, foot_h * 0.3))
    body = cut(body, *cuts)
    if dice.chance(0.25):
        ring = cylinder(r * 0.98, wall_t * 0.3 + 0.2, axes((0, -wall_t / 2 + 0.2, up), (0, -1, 0)))
        body = cut(fuse(body, ring), bore)
    return soften_edges(dice, body) if dice.chance(0.35) else body


def clevis(dice: Dice) -> TopoDS_Shape:
    """Two ears with a cross hole on a stem or a base."""
    w, r = dice.uniform(0.5, 1.0), dice.uniform(0.3, 0.5)
    up = dice.uniform(0.5, 1.2)
    ear = Outline((-r, 0)).line(r, 0).line(r, up).arc((0, up + r), (-r, up))
    body = placed(extrude(face(ear), (0, 0, w)), UPRIGHT)
    body = shifted(body, (0, w / 2, 0))
    gap = w * dice.uniform(0.3, 0.6)
    low = dice.uniform(0.1, 0.4) * up
    cuts = [cylinder(r * dice.uniform(0.3, 0.7), 9, axes((0, 4, up), (0, -1, 0)))]
    cuts.append(centred_box(4, gap, 9, (0, 0, low)))
    if dice.chance(0.5):
        stem = cylinder(
            min(r, w / 2) * dice.uniform(0.5, 0.98),
            dice.length(0.4, 2.5),
            axes((0, 0, 0.02), (0, 0, -1)),
        )
        body = fuse(body, stem)
    else:
        base = centred_box(
            2 * r * dice.uniform(1.2, 3), w * dice.uniform(1.0, 2), 0.25, (0, 0, -0.2)
        )
        body = fuse(body, base)
    body = cut(body, *cuts)
    return add(dice, body, 1) if dice.chance(0.3) else body


def hook_strip(dice: Dice) -> TopoDS_Shape:
    """Bent sheet: a strip of one thickness through several bends with inner and outer radius."""
    thick, wide = dice.uniform(0.05, 0.2), dice.length(0.3, 1.5)
    bend = thick * dice.length(0.3, 2.5)
    x, y, a = 0.0, 0.0, 0.0
    outer: list = [((x, y), None)]
    left = [((0.0, thick), None)]
    n = dice.randint(1, 4)
    way = 1
    for i in range(n + 1):
        straight = dice.length(0.3, 1.2)
        x, y = x + straight * math.cos(a), y + straight * math.sin(a)
        outer.append(((x, y), None))
        left.append(((x - thick * math.sin(a), y + thick * math.cos(a)), None))
        if i == n:
            break
        turn = math.pi / 2 if dice.chance(0.7) else dice.uniform(0.4, 2.0)
        way = way if dice.chance(0.5) else -way
        # Centre of the bend: on the left for way = 1, on the right for -1.
        r = bend + thick if way > 0 else bend
        cx, cy = x - way * r * math.sin(a), y + way * r * math.cos(a)
        for share in (0.5, 1.0):
            b = a + way * turn * share
            qx, qy = cx + way * r * math.sin(b), cy - way * r * math.cos(b)
            mark = "middle" if share == 0.5 else None
            outer.append(((qx, qy), mark))
            left.append(((qx - thick * math.sin(b), qy + thick * math.cos(b)), mark))
        a += way * turn
        x, y = outer[-1][0]
    chain = _chained(outer, left)
    body = placed(extrude(face(chain), (0, 0, wide)), UPRIGHT)
    body = add(dice, body, dice.few(3, 0.4)) if dice.chance(0.5) else body
    if dice.chance(0.35):
        body = _round_corners(dice, body, thick, wide)
    return body


def _chained(outer: list, left: list) -> Outline:
    """There along one side of the strip, back along the other."""
    walk = outer + left[::-1]
    chain = Outline(walk[0][0])
    i = 1
    while i < len(walk):
        p, mark = walk[i]
        if mark == "middle":
            chain.arc(p, walk[i + 1][0])
            i += 1
        else:
            chain.line(*p)
        i += 1
    return chain


def _round_corners(dice: Dice, body: TopoDS_Shape, thick: float, wide: float) -> TopoDS_Shape:
    """The free corners of the sheet rounded: the edges as long as the sheet is thick."""
    short = [
        e
        for e, _ in edge_faces(body)
        if tangent(e) is not None and abs(length(e) - thick) < 1e-6 and abs(tangent(e)[1]) < 1e-6
    ]
    if not short or len(short) > 8:
        return body
    return fillet(body, short, wide * dice.uniform(0.08, 0.3))


def tab_sheet(dice: Dice) -> TopoDS_Shape:
    """A flat sheet with upright tabs on some of its sides."""
    thick, dy = dice.uniform(0.05, 0.12), 2 * dice.length(0.4, 1)
    body = centred_box(2, dy, thick)
    adds = []
    for side in range(4):
        if dice.chance(0.5):
            long = (2.0 if side % 2 == 0 else dy) * dice.part(0.3, 1.0)
            tall = dice.length(0.2, 0.8)
            reach = dy / 2 if side % 2 == 0 else 1.0
            sign = 1 if side < 2 else -1
            if side % 2 == 0:
                adds.append(centred_box(long, thick, tall, (0, sign * (reach - thick / 2), 0)))
            else:
                adds.append(centred_box(thick, long, tall, (sign * (reach - thick / 2), 0, 0)))
    body = fuse(body, *adds) if adds else body
    return add(dice, body, dice.few(4, 0.6))


def half_clamp(dice: Dice) -> TopoDS_Shape:
    """A half ring with two ears: pipe clamps."""
    r, wall, deep = 1.0, dice.uniform(0.1, 0.35), dice.length(0.3, 1.5)
    ear, t = dice.uniform(0.3, 0.8), dice.uniform(0.1, 0.35)
    ring = extrude(face(circle(r + wall)), (0, 0, deep))
    ears = [centred_box(2 * (r + wall + ear), t, deep, (0, t / 2, 0))]
    body = fuse(ring, *ears)
    cuts = [cylinder(r, 9, axes((0, 0, -4))), centred_box(9, 4, 9, (0, -2, -4))]
    at, q = r + wall + ear * 0.55, min(ear * 0.3, deep * 0.3)
    cuts += [
        cylinder(q * dice.uniform(0.5, 0.95), 9, axes((s * at, -4, deep / 2), (0, 1, 0), X))
        for s in (-1, 1)
    ]
    body = cut(body, *cuts)
    return soften_edges(dice, body) if dice.chance(0.3) else body


def stand(dice: Dice) -> TopoDS_Shape:
    """A plate on legs or ribs: tables, feet, spacers."""
    dy, t, tall = 2 * dice.length(0.5, 1), dice.uniform(0.1, 0.3), dice.length(0.3, 1.5)
    body = centred_box(2, dy, t)
    w = dice.uniform(0.1, 0.3)
    kind = dice.weighted({"round": 2, "square": 2, "walls": 1})
    places = rectangle_points(2 - 2.6 * w, dy - 2.6 * w)
    if kind == "walls":
        legs = [centred_box(w, dy, tall, (s * (1 - w / 2), 0, -tall + 0.01)) for s in (-1, 1)]
    elif kind == "square":
        legs = [centred_box(2 * w, 2 * w, tall, (x, y, -tall + 0.01)) for x, y in places]
    else:
        legs = [cylinder(w, tall, axes((x, y, 0.01), (0, 0, -1))) for x, y in places]
    body = fuse(body, *legs)
    return add(dice, body, dice.few(3, 0.5)) if dice.chance(0.6) else body


RECIPES = {
    angle_bracket: 3.0,
    bearing_block: 2.5,
    clevis: 1.2,
    hook_strip: 3.5,
    tab_sheet: 1.0,
    half_clamp: 1.0,
    stand: 1.0,
}
