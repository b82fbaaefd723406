"""Random outlines of the kinds that sections of parts have.

Each function draws an outline about 2 units wide, its middle near the origin; :func:`section` picks
one. :func:`soften` rounds corners the way drawings do: all alike, or some, or none.
"""

import math
from collections.abc import Sequence

from .dice import Dice
from .outline import Ellipse, Outline, Point, circle, polygon, rounded


def soften(dice: Dice, points: Sequence[Point], p: float = 0.42) -> Outline:
    """The polygon, with probability ``p`` with some or all corners rounded."""
    if not dice.chance(p):
        return polygon(points)
    n = len(points)
    room = min(math.dist(points[i - 1], points[i]) for i in range(n))
    r = room * dice.uniform(0.12, 0.46)
    if dice.chance(0.5):
        return rounded(points, [r] * n)
    share = dice.uniform(0.2, 0.8)
    return rounded(points, [r if dice.chance(share) else 0.0 for _ in range(n)])


def rectangle_points(dx: float, dy: float, centre: Point = (0.0, 0.0)) -> list[Point]:
    x, y = centre
    return [
        (x - dx / 2, y - dy / 2),
        (x + dx / 2, y - dy / 2),
        (x + dx / 2, y + dy / 2),
        (x - dx / 2, y + dy / 2),
    ]


def ngon_points(n: int, r: float, turn: float = 0.0, centre: Point = (0.0, 0.0)) -> list[Point]:
    """A regular polygon of circumradius ``r``."""
    x, y = centre
    angles = [turn + 2 * math.pi * i / n for i in range(n)]
    return [(x + r * math.cos(a), y + r * math.sin(a)) for a in angles]


def slot(length: float, r: float, centre: Point = (0.0, 0.0), turn: float = 0.0) -> Outline:
    """An obround: two half circles of radius ``r``, their centres ``length`` apart."""
    c, s = math.cos(turn), math.sin(turn)

    def at(x: float, y: float) -> Point:
        return (centre[0] + c * x - s * y, centre[1] + s * x + c * y)

    h = length / 2
    chain = Outline(at(-h, -r)).line(*at(h, -r)).arc(at(h + r, 0), at(h, r))
    return chain.line(*at(-h, r)).arc(at(-h - r, 0), at(-h, -r))


def link(length: float, r0: float, r1: float) -> Outline:
    """Two discs and their common tangents: cams, levers and lugs; ``length > |r0 - r1|``."""
    h = length / 2
    tilt = math.acos((r0 - r1) / length)
    c, s = math.cos(tilt), math.sin(tilt)
    chain = Outline((-h + r0 * c, -r0 * s)).line(h + r1 * c, -r1 * s)
    chain.arc((h + r1, 0), (h + r1 * c, r1 * s)).line(-h + r0 * c, r0 * s)
    return chain.arc((-h - r0, 0), (-h + r0 * c, -r0 * s))


def chord(r: float, x: float) -> Outline:
    """The disc of radius ``r`` left of the line at ``x``: a D; a half disc for ``x = 0``."""
    y = math.sqrt(r * r - x * x)
    return Outline((x, -y)).line(x, y).arc((-r, 0), (x, -y))


def sector(r: float, angle: float, inner: float = 0.0) -> Outline:
    """A sector of a disc, or of a ring with ``inner > 0``; ``angle`` below 2 pi."""
    a = angle / 2

    def at(q: float, t: float) -> Point:
        return (q * math.cos(t), q * math.sin(t))

    chain = Outline(at(inner, -a)).line(*at(r, -a)).arc(at(r, 0), at(r, a)).line(*at(inner, a))
    return chain.arc(at(inner, 0), at(inner, -a)) if inner else chain


def ell(dice: Dice) -> list[Point]:
    t, u = dice.uniform(0.2, 0.8), dice.uniform(0.2, 0.8)
    h = dice.uniform(0.5, 1.0)
    return [(-1, -h), (1, -h), (1, -h + t), (-1 + u, -h + t), (-1 + u, h), (-1, h)]


def tee(dice: Dice) -> list[Point]:
    t, u, h = dice.uniform(0.2, 0.6), dice.uniform(0.15, 0.5), dice.uniform(0.5, 1.0)
    a = 0.0 if dice.chance(0.7) else dice.uniform(-0.3, 0.3)
    return [
        (-1, h - t),
        (a - u, h - t),
        (a - u, -h),
        (a + u, -h),
        (a + u, h - t),
        (1, h - t),
        (1, h),
        (-1, h),
    ]


def channel(dice: Dice) -> list[Point]:
    t, b, h = dice.uniform(0.12, 0.55), dice.uniform(0.12, 0.6), dice.uniform(0.4, 1.0)
    other = t if dice.chance(0.7) else dice.uniform(0.12, 0.55)
    top = h if dice.chance(0.7) else dice.uniform(-h + b + 0.1, h)
    return [
        (-1, -h),
        (1, -h),
        (1, top),
        (1 - other, top),
        (1 - other, -h + b),
        (-1 + t, -h + b),
        (-1 + t, h),
        (-1, h),
    ]


def beam(dice: Dice) -> list[Point]:
    t, w, h = dice.uniform(0.15, 0.4), dice.uniform(0.1, 0.4), dice.uniform(0.7, 1.2)
    low = 1.0 if dice.chance(0.7) else dice.uniform(w + 0.1, 1.2)
    right = [(low, -h), (low, -h + t), (w, -h + t), (w, h - t), (1, h - t), (1, h)]
    return right + [(-x, y) for x, y in reversed(right)]


def zed(dice: Dice) -> list[Point]:
    t, w, h = dice.uniform(0.2, 0.5), dice.uniform(0.15, 0.4), dice.uniform(0.5, 1.0)
    right = [(1, -h), (1, -h + t), (w, -h + t), (w, h)]
    return right + [(-x, -y) for x, y in right]


def cross(dice: Dice) -> list[Point]:
    a, b = dice.uniform(0.2, 0.6), dice.uniform(0.2, 0.6)
    quarter = [(1, -b), (1, b), (a, b), (a, 1)]
    return quarter + [(-x, y) for x, y in reversed(quarter)][:-1] + _lower_cross(a, b)


def _lower_cross(a: float, b: float) -> list[Point]:
    return [(-1, -b), (-a, -b), (-a, -1), (a, -1), (a, -b)]


def stairs(dice: Dice) -> list[Point]:
    """A rectangle with steps in one corner, or in two."""
    n = dice.randint(2, 4)
    xs = sorted(dice.uniform(-0.8, 0.9) for _ in range(n))
    ys = sorted((dice.uniform(-0.7, 0.9) for _ in range(n)), reverse=True)
    points = [(-1.0, -1.0), (1.0, -1.0)]
    at = 1.0
    for x, y in zip(reversed(xs), reversed(ys), strict=True):
        points += [(at, y), (x, y)]
        at = x
    points += [(at, 1.0), (-1.0, 1.0)]
    return points


def trapezoid(dice: Dice) -> list[Point]:
    h, a = dice.uniform(0.4, 1.0), dice.uniform(-0.3, 0.8)
    b = a if dice.chance(0.5) else (0.0 if dice.chance(0.6) else dice.uniform(0, 0.8))
    return [(-1, -h), (1, -h), (1 - a, h), (-1 + b, h)]


def triangle(dice: Dice) -> list[Point]:
    h = dice.uniform(0.4, 1.0)
    return [(-1, -h), (1, -h), (dice.choice([-1.0, 0.0, dice.uniform(-0.9, 1.0)]), h)]


def house(dice: Dice) -> list[Point]:
    """A rectangle with one or more corners cut off at an angle."""
    h = dice.uniform(0.5, 1.0)
    points: list[Point] = []
    for i, (x, y) in enumerate(rectangle_points(2, 2 * h)):
        if dice.chance(0.45):
            a = dice.uniform(0.15, 0.8) * min(h, 1.0)
            b = a if dice.chance(0.6) else dice.uniform(0.15, 0.8) * min(h, 1.0)
            sx, sy = -math.copysign(1, x), -math.copysign(1, y)
            along, up = (x + sx * a, y), (x, y + sy * b)
            points += [up, along] if i % 2 == 0 else [along, up]
        else:
            points.append((x, y))
    return points


def notched(dice: Dice) -> list[Point]:
    """A rectangle with a notch, straight or dovetailed, in its upper side."""
    h, w, d = dice.uniform(0.5, 1.0), dice.uniform(0.15, 0.6), dice.uniform(0.2, 1.0)
    x = 0.0 if dice.chance(0.6) else dice.uniform(-0.3, 0.3)
    flare = 0.0 if dice.chance(0.6) else dice.uniform(-0.13, 0.3)
    d = min(d, 1.6 * h)
    return [
        (-1, -h),
        (1, -h),
        (1, h),
        (x + w, h),
        (x + w + flare, h - d),
        (x - w - flare, h - d),
        (x - w, h),
        (-1, h),
    ]


def convex(dice: Dice) -> list[Point]:
    """A convex polygon of 4 to 7 corners on an ellipse."""
    n = dice.randint(4, 7)
    step = 2 * math.pi / n
    b = dice.uniform(0.5, 1.0)
    angles = [step * (i + dice.uniform(-0.3, 0.3)) for i in range(n)]
    return [(math.cos(a), b * math.sin(a)) for a in angles]


def star(dice: Dice) -> list[Point]:
    """A wheel with teeth of straight flanks."""
    n, deep = dice.randint(3, 8), dice.uniform(0.55, 0.85)
    tip, root = dice.uniform(0.15, 0.4), dice.uniform(0.5, 0.7)
    points: list[Point] = []
    for i in range(n):
        for share, r in ((-tip / 2, 1.0), (tip / 2, 1.0), (root / 2, deep), (1 - root / 2, deep)):
            a = 2 * math.pi * (i + share) / n
            points.append((r * math.cos(a), r * math.sin(a)))
    return points


def blob(dice: Dice) -> Outline:
    """A straight base and a free curve over it."""
    n = dice.randint(2, 4)
    xs = [1 - 2 * (i + 1) / (n + 1) for i in range(n)]
    via = [(x, dice.uniform(0.3, 1.0)) for x in xs]
    low = dice.uniform(-0.6, -0.2)
    return Outline((-1, low)).line(1, low).line(1, 0.2).spline(via, (-1, 0.2))


def rectangle(dice: Dice) -> list[Point]:
    return rectangle_points(2, 2 * dice.length(0.25, 1.0))


def arched(dice: Dice) -> Outline:
    """A rectangle with an arc for its upper side: half a circle, flatter, or hollow."""
    h = dice.uniform(0.1, 1.0)
    rise = 1.0 if dice.chance(0.5) else dice.choice([-1, 1, 1]) * dice.uniform(0.15, 0.8)
    h = max(h, -rise)
    return Outline((-1, -h)).line(1, -h).line(1, 0.1).arc((0, 0.1 + rise), (-1, 0.1))


def lens(dice: Dice) -> Outline:
    """A rectangle whose short sides are arcs that stand out, or go in."""
    h, out = dice.uniform(0.25, 0.8), dice.choice([-1, 1, 1]) * dice.uniform(0.1, 0.4)
    chain = Outline((-1, -h)).line(1, -h).arc((1 + out, 0), (1, h)).line(-1, h)
    return chain.arc((-1 - out, 0), (-1, -h))


POLYGONS = {
    rectangle: 4.0,
    ell: 2.0,
    tee: 1.5,
    channel: 2.0,
    beam: 0.7,
    zed: 0.7,
    cross: 0.6,
    stairs: 1.5,
    trapezoid: 1.5,
    triangle: 1.0,
    house: 2.0,
    notched: 1.5,
    convex: 1.0,
    star: 0.4,
}
ROUND = {"disc": 2.0, "slot": 1.5, "link": 1.2, "chord": 1.2, "sector": 1.0, "ellipse": 1.3}
FREE = {arched: 1.2, lens: 0.8, blob: 2.0}


def round_section(dice: Dice) -> Outline | Ellipse:
    """An outline that has arcs without being a rounded polygon."""
    match dice.weighted(ROUND):
        case "disc":
            return circle(1.0)
        case "slot":
            return slot(dice.uniform(0.3, 1.6), dice.uniform(0.25, 0.7))
        case "link":
            r = dice.uniform(0.3, 0.7)
            return link(dice.uniform(0.8, 1.5), r, r * dice.uniform(0.35, 0.95))
        case "chord":
            return chord(1.0, dice.choice([0.0, dice.uniform(-0.6, 0.8)]))
        case "sector":
            inner = 0.0 if dice.chance(0.4) else dice.uniform(0.3, 0.85)
            return sector(1.0, dice.choice([0.5, 1, 1.5]) * math.pi * dice.part(0.4, 1.0), inner)
        case _:
            return Ellipse((0.0, 0.0), 1.0, dice.uniform(0.4, 0.85))


def section(dice: Dice, curved: float = 0.35) -> Outline | Ellipse:
    """Any outline; ``curved`` is the chance of one made of arcs or splines."""
    if dice.chance(curved):
        return round_section(dice) if dice.chance(0.5) else dice.weighted(FREE)(dice)
    return soften(dice, dice.weighted(POLYGONS)(dice))
