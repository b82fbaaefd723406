"""Machined blocks: steps, slots, pockets and holes in a box; stacked and slanted polyhedra."""

import math

from OCP.TopoDS import TopoDS_Shape

from ..dice import Dice
from ..dress import soften_edges
from ..features import PLANAR, add
from ..kernel import (
    UPRIGHT,
    Vector,
    X,
    Y,
    Z,
    centred_box,
    common,
    cut,
    extrude,
    frame,
    fuse,
    placed,
    shifted,
    turned,
)
from ..outline import face, polygon
from ..sections import POLYGONS, ngon_points, rectangle_points


def machined(dice: Dice) -> TopoDS_Shape:
    """A box with planar machining features cut into several of its sides."""
    size = (2.0, 2 * dice.length(0.35, 1), 2 * dice.length(0.2, 1))
    body = centred_box(*size)
    cuts = [_side_cut(dice, size) for _ in range(dice.few(4, 0.6))]
    body = cut(body, *cuts)
    if dice.chance(0.75):
        body = add(dice, body, dice.few(4, 0.5), PLANAR)
    if dice.chance(0.1):
        body = soften_edges(dice, body, 0.0)
    return body


def _side_cut(dice: Dice, size: Vector) -> TopoDS_Shape:
    """A step, slot, vee or bevel that runs across a side of the box, or stops within it."""
    side = dice.randrange(3)
    across, along, height = (size[(side + i) % 3] for i in range(3))
    depth = height * dice.part(0.15, 0.7)
    kind = dice.weighted(
        {"step": 2, "slot": 2, "vee": 1, "bevel": 1.5, "dovetail": 0.7, "end": 1.5}
    )
    w = across * dice.part(0.1, 0.4)
    x = across * dice.part(0.25, 0.75) - across / 2
    x = max(-across / 2 + 0.7 * w, min(across / 2 - 0.7 * w, x))
    up = 0.2 * height
    match kind:
        case "step":
            points = [
                (across, -depth),
                (across, up),
                (across / 2 - w, up),
                (across / 2 - w, -depth),
            ]
        case "bevel":
            points = [(across / 2 - w, 0), (across / 2, -depth), (across, -depth), (across, up)]
            points.append((across / 2 - w, up))
        case "vee":
            points = [(x - w / 2, up), (x - w / 2, 0), (x, -depth), (x + w / 2, 0), (x + w / 2, up)]
        case "dovetail":
            flare = 0.25 * w
            points = [(x - w / 4, up), (x - w / 4, 0), (x - w / 4 - flare, -depth)]
            points += [(-p + 2 * x, q) for p, q in reversed(points)]
        case _:
            points = [(x - w / 2, up), (x - w / 2, -depth), (x + w / 2, -depth), (x + w / 2, up)]
    tool = placed(extrude(face(polygon(points)), (0, 0, 2 * along)), UPRIGHT)
    # The extrusion runs along -y; leave it short of the far end for a slot that stops.
    start = along if kind != "end" else along * dice.part(-0.2, 0.3)
    if dice.chance(0.15) and kind in ("step", "slot"):
        start = along * dice.part(-0.2, 0.3)
    tool = shifted(tool, (0, start, 0))
    if dice.chance(0.5):
        tool = turned(tool, math.pi, Z)
    # The tool was drawn at a top at z = 0: move it to one of the two sides of its direction.
    sign = 1 if dice.chance(0.65) else -1
    normal, x = ((Z, X), (X, Y), (Y, Z))[side]
    origin = [sign * height / 2 * n for n in normal]
    origin[2] += size[2] / 2
    return placed(tool, frame(origin, [sign * n for n in normal], x))


def stacked(dice: Dice) -> TopoDS_Shape:
    """Boxes on a common grid, some added, some taken away: rectilinear parts of any genus."""
    lines = [_grid(dice, dice.randint(2, 4), length) for length in (2.0, 1.6, 1.2)]
    body = None
    adds, cuts = [], []
    for i in range(dice.randint(2, 5)):
        block = _grid_box(dice, lines)
        if body is None:
            body = block
        elif i < 2 or dice.chance(0.5):
            adds.append(block)
        else:
            cuts.append(block)
    body = fuse(body, *adds) if adds else body
    body = cut(body, *cuts) if cuts else body
    return add(dice, body, 1) if dice.chance(0.3) else body


def _grid(dice: Dice, n: int, length: float) -> list[float]:
    gaps = [dice.uniform(0.3, 1.0) for _ in range(n)]
    total, at, out = sum(gaps), 0.0, [0.0]
    for gap in gaps:
        at += gap / total * length
        out.append(at)
    return out


def _grid_box(dice: Dice, lines: list[list[float]]) -> TopoDS_Shape:
    ends = [sorted(dice.sample(line, 2)) for line in lines]
    (x0, x1), (y0, y1), (z0, z1) = ends
    return centred_box(x1 - x0, y1 - y0, z1 - z0, ((x0 + x1) / 2, (y0 + y1) / 2, z0))


def slanted(dice: Dice) -> TopoDS_Shape:
    """A box or prism cut by oblique planes: polyhedra without right angles."""
    if dice.chance(0.5):
        body = centred_box(2, 2 * dice.length(0.4, 1), 2 * dice.length(0.3, 1))
    else:
        outline = polygon(dice.weighted(POLYGONS)(dice))
        body = extrude(face(outline), (0, 0, dice.length(0.4, 2)))
    cuts = []
    for _ in range(dice.few(3, 0.6)):
        normal = [dice.uniform(-1, 1) for _ in range(3)]
        if dice.chance(0.6):
            normal[dice.randrange(3)] = 0.0
        size = math.hypot(*normal)
        if size < 0.2:
            continue
        normal = [x / size for x in normal]
        centre = [0.75 * n * dice.uniform(0.6, 1.1) for n in normal]
        centre[2] += 0.5
        cuts.append(placed(centred_box(20, 20, 20), frame(centre, normal)))
    body = cut(body, *cuts)
    if dice.chance(0.4):
        body = add(dice, body, 1, PLANAR if dice.chance(0.5) else None)
    return body


def crossed(dice: Dice) -> TopoDS_Shape:
    """The common part, or the union, of two prisms along different axes."""
    one = extrude(face(polygon(dice.weighted(POLYGONS)(dice))), (0, 0, 2))
    other = extrude(face(polygon(dice.weighted(POLYGONS)(dice))), (0, 0, 3))
    upright = shifted(placed(other, UPRIGHT), (0, 1.5, 1.0))
    if dice.chance(0.6):
        return common(one, upright)
    return cut(one, shifted(upright, (0, 0, dice.uniform(0.5, 1.2))))


def frame_part(dice: Dice) -> TopoDS_Shape:
    """A block with a large window, and with cuts in its rim."""
    size = (2.0, 2 * dice.length(0.5, 1), dice.length(0.2, 1))
    body = centred_box(*size)
    wx, wy = size[0] * dice.part(0.4, 0.85), size[1] * dice.part(0.4, 0.85)
    body = cut(body, centred_box(wx, wy, 9, (0, 0, -3)))
    if dice.chance(0.7):
        body = cut(body, *(_side_cut(dice, size) for _ in range(dice.few(3, 0.5))))
    return body


def gable(dice: Dice) -> TopoDS_Shape:
    """A prism of one section with a smaller one of another section standing on it."""
    n = dice.randint(3, 8)
    body = extrude(face(polygon(ngon_points(n, 1.0))), (0, 0, dice.length(0.2, 1.0)))
    kinds = PLANAR if dice.chance(0.6) else None
    body = add(dice, body, dice.few(3, 0.6), kinds)
    if dice.chance(0.3):
        slot_tool = centred_box(4, dice.uniform(0.15, 0.5), 1, (0, 0, 0.25))
        body = cut(body, slot_tool)
    return body


def cornered(dice: Dice) -> TopoDS_Shape:
    """A block with its upright corners cut, square, bevelled or notched."""
    size = (2.0, 2 * dice.length(0.5, 1), dice.length(0.2, 1.5))
    cuts = []
    for x, y in rectangle_points(size[0], size[1]):
        if dice.chance(0.55):
            a, b = dice.uniform(0.15, 0.4), dice.uniform(0.15, 0.4) * size[1] / 2
            deep = 9 if dice.chance(0.6) else size[2] * dice.part(0.25, 0.7)
            low = -1 if deep == 9 else size[2] - deep
            if dice.chance(0.7):
                cuts.append(centred_box(2 * a, 2 * b, 9, (x, y, low)))
            else:
                points = [(x - math.copysign(2 * a, x), y), (x, y - math.copysign(2 * b, y))]
                points.append((x * 2, y - math.copysign(2 * b, y)))
                points.append((x * 2, y * 2))
                points.append((x - math.copysign(2 * a, x), y * 2))
                cuts.append(shifted(extrude(face(polygon(points)), (0, 0, 9)), (0, 0, low)))
    body = cut(centred_box(*size), *cuts) if cuts else centred_box(*size)
    return add(dice, body, dice.few(3, 0.5), PLANAR if dice.chance(0.6) else None)


RECIPES = {
    machined: 7.0,
    stacked: 3.0,
    slanted: 2.0,
    crossed: 1.5,
    frame_part: 1.2,
    gable: 1.0,
    cornered: 1.5,
}
