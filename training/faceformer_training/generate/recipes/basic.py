"""Single bodies: boxes, prisms, pins, washers, cones, balls, rings."""

import math

from OCP.TopoDS import TopoDS, TopoDS_Shape

from ..dice import Dice
from ..kernel import (
    UPRIGHT,
    centred_box,
    common,
    cone,
    cut,
    cylinder,
    extrude,
    fuse,
    loft,
    placed,
    revolve,
    shifted,
    sphere,
    torus,
)
from ..kernel import frame as axes
from ..outline import Outline, circle, face, polygon
from ..sections import ngon_points, section


def box(dice: Dice) -> TopoDS_Shape:
    body = centred_box(2, 2 * dice.length(0.2, 1), 2 * dice.length(0.08, 1))
    if dice.chance(0.5):
        return body
    # One corner or side cut off by an oblique plane.
    normal = [dice.choice([0, 1, dice.uniform(0.3, 1)]) for _ in range(3)]
    if not any(normal):
        normal = [1, 0, 1]
    return cut(
        body, half_space(body_corner=(1.0, 1.0, 1.0), normal=normal, deep=dice.part(0.2, 0.6))
    )


def half_space(body_corner, normal, deep: float) -> TopoDS_Shape:
    """A large box beyond a plane that cuts ``deep`` into a body 2 wide at one of its corners."""
    size = math.hypot(*normal)
    unit = [x / size for x in normal]
    centre = [c - deep * u for c, u in zip(body_corner, unit, strict=True)]
    return placed(centred_box(20, 20, 20), axes(centre, unit))


def prism(dice: Dice) -> TopoDS_Shape:
    return extrude(face(section(dice)), (0, 0, dice.length(0.1, 3)))


def nut_blank(dice: Dice) -> TopoDS_Shape:
    """A regular prism, often with a hole and corners turned off (cone cut)."""
    h, n = dice.length(0.2, 2), dice.choice([3, 5, 6, 6, 6, 8])
    body = extrude(face(polygon(ngon_points(n, 1.0))), (0, 0, h))
    if dice.chance(0.6):
        body = cut(
            body, cylinder(dice.uniform(0.3, 0.7) * math.cos(math.pi / n), h * 3, axes((0, 0, -h)))
        )
    if dice.chance(0.4):
        body = bevelled(body, h, dice.uniform(0.8, 0.98), dice.choice([0.27, 0.58]))
    return body


def bevelled(body: TopoDS_Shape, h: float, r: float, slope: float) -> TopoDS_Shape:
    """The corners of a body of height ``h`` turned off by a cone that meets the top at ``r``."""
    keep = polygon([(0, -9), (3, -9), (3, h - (3 - r) * slope), (0, h + r * slope)])
    return common(body, revolve(placed(face(keep), UPRIGHT)))


def pin(dice: Dice) -> TopoDS_Shape:
    """A rod with ends flat, bevelled, conical or round."""
    r, h = 1.0, dice.length(0.3, 8)

    def end() -> tuple[str, float]:
        return dice.weighted({"flat": 3, "bevel": 2, "ball": 1.5, "tip": 1}), dice.uniform(0.1, 0.5)

    (top, a), (bottom, b) = end(), end()
    chain = Outline((0.0, 0.0))
    match bottom:
        case "bevel":
            chain.line(r - b, 0).line(r, b)
        case "ball":
            chain = Outline((0.0, -r)).arc((r * math.sqrt(0.5), -r * math.sqrt(0.5)), (r, 0.0))
        case "tip":
            chain = Outline((0.0, -r * 2 * b)).line(r, 0)
        case _:
            chain.line(r, 0)
    h += b
    match top:
        case "bevel":
            chain.line(r, h).line(r - a, h + a).line(0, h + a)
        case "ball":
            chain.line(r, h).arc((r * math.sqrt(0.5), h + r * math.sqrt(0.5)), (0.0, h + r))
        case "tip":
            chain.line(r, h).line(0, h + 2 * a)
        case _:
            chain.line(r, h).line(0, h)
    return revolve(placed(face(chain), UPRIGHT))


def washer(dice: Dice) -> TopoDS_Shape:
    h, r = dice.length(0.05, 3), dice.uniform(0.2, 0.92)
    body = extrude(face(circle(1.0), circle(r)), (0, 0, h))
    if dice.chance(0.25):
        # A tab or a key.
        w = dice.uniform(0.15, 0.4) * r
        if dice.chance(0.5):
            return fuse(body, centred_box(dice.uniform(0.2, 0.8), w, h, (1.0, 0, 0)))
        return cut(body, centred_box(0.8, w, 3 * h, (r, 0, -h)))
    return body


def frustum(dice: Dice) -> TopoDS_Shape:
    top = dice.choice([0.0, dice.uniform(0.2, 0.9), dice.uniform(0.2, 0.9)])
    h = dice.length(0.25, 3)
    body = cone(1.0, top, h)
    if dice.chance(0.4):
        deep = h * dice.part(0.3, 0.7) if dice.chance(0.5) or top == 0 else 3 * h
        r = (top or 0.5) * dice.uniform(0.3, 0.8)
        body = cut(body, cylinder(r, deep + h, axes((0, 0, -h))))
    return body


def ball(dice: Dice) -> TopoDS_Shape:
    """A ball cut flat, bored through, or on a stem."""
    body = sphere(1.0)
    if dice.chance(0.6):
        body = cut(body, centred_box(3, 3, 3, (0, 0, dice.choice([0.0, dice.uniform(-0.4, 0.9)]))))
    match dice.weighted({"bored": 1, "stem": 1.5, "both": 0.5}):
        case "bored":
            return cut(body, cylinder(dice.uniform(0.2, 0.7), 4, axes((0, 0, -2))))
        case "stem":
            return fuse(
                body,
                cylinder(dice.uniform(0.2, 0.7), dice.length(1.3, 4), axes((0, 0, 0), (0, 0, -1))),
            )
        case _:
            body = fuse(body, cylinder(0.7, dice.length(1.3, 3), axes((0, 0, 0), (0, 0, -1))))
            return cut(body, cylinder(dice.uniform(0.15, 0.5), 20, axes((0, 0, -10))))


def ring(dice: Dice) -> TopoDS_Shape:
    """A torus: a part of a turn, cut flat, or on a stem."""
    minor = dice.uniform(0.12, 0.45)
    body = torus(1.0, minor)
    match dice.weighted({"turn": 2, "flat": 1, "eye": 1.5}):
        case "turn":
            section_face = face(circle(minor, (1.0, 0.0)))
            return revolve(placed(section_face, UPRIGHT), angle=dice.part(0.2, 0.9) * 2 * math.pi)
        case "flat":
            return cut(body, centred_box(5, 5, 3, (0, 0, dice.uniform(-0.5, 0.5) * minor)))
        case _:
            stem = cylinder(
                minor * dice.uniform(0.6, 1.3), dice.length(0.5, 3), axes((0.0, 1.0, 0), (0, 1, 0))
            )
            return fuse(body, stem)


def wedge(dice: Dice) -> TopoDS_Shape:
    """A pyramid, whole or cut off, on a polygon."""
    n = dice.choice([3, 4, 4, 4, 5, 6])
    base = ngon_points(n, 1.0, math.pi / n)
    q, h = dice.uniform(0.2, 0.85), dice.length(0.3, 2)
    off = (dice.uniform(-0.2, 0.2), dice.uniform(-0.2, 0.2)) if dice.chance(0.3) else (0.0, 0.0)
    upper = polygon([(q * x + off[0], q * y + off[1]) for x, y in base]).wire()
    return loft([polygon(base).wire(), TopoDS.Wire_s(shifted(upper, (0, 0, h)))], True)


RECIPES = {
    box: 2.0,
    prism: 4.0,
    nut_blank: 1.2,
    pin: 2.0,
    washer: 1.5,
    frustum: 1.5,
    ball: 1.5,
    ring: 1.5,
    wedge: 1.0,
}
