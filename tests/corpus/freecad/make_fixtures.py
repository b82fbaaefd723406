"""Writes the edge lists in this folder: hidden-line projections that FreeCAD makes of small parts.

Run with `LC_ALL=C.UTF-8 freecadcmd make_fixtures.py` in this folder. Each file is a plain edge list
as the workbench hands it over, with one more key, `expected`: what clean-up must make of it. The
numbers there follow from the solid: its edges without seams, plus two silhouettes a cylinder, which
cut the cylinder's circles where they touch them.
"""

import json
import math
import sys

import Part
import TechDraw
from FreeCAD import Vector

DIRECTIONS = {"iso": Vector(1, -1, 1), "free": Vector(0.48, -0.6, 0.64)}
# Compounds of projectEx: visible sharp, smooth and outline edges, hidden ones alike. Seams and
# iso-parametric curves are not edges of the solid.
VISIBLE, HIDDEN = (0, 1, 3), (5, 6, 8)
# Seen from the corner, a silhouette of the slot is cut in the very point of an arc where the arc is
# cut too. From the lines alone that is a vertex of four edges, so clean-up leaves it one.
ACCIDENTS = {"blind_hole_and_slot_iso": (25, 38, 25)}


def box():
    return Part.makeBox(40, 30, 20), (8, 12, 12)


def l_bracket():
    return Part.makeBox(40, 30, 8).fuse(Part.makeBox(8, 30, 30)).removeSplitter(), (12, 18, 18)


def through_hole():
    hole = Part.makeCylinder(7, 20, Vector(18, 14, 0))
    return Part.makeBox(40, 30, 20).cut(hole), (8 + 4, 12 + 6, 12 + 2)


def blind_hole_and_slot():
    hole = Part.makeCylinder(5, 12, Vector(12, 15, 8))
    ends = [Part.makeCylinder(4, 20, Vector(x, 15, 0)) for x in (27, 43)]
    slot = Part.makeBox(16, 8, 20, Vector(27, 11, 0)).fuse(ends).removeSplitter()
    block = Part.makeBox(50, 30, 20).cut(hole).cut(slot)
    # The slot's four half circles are cut by one silhouette each half cylinder.
    return block, (8 + 4 + 8 + 4, 12 + 6 + 8 + 10, 12 + 2 + 8 + 2)


def stepped_shaft():
    steps = [Part.makeCylinder(r, h, Vector(0, 0, z)) for r, h, z in ((8, 18, 20), (5, 15, 38))]
    return Part.makeCylinder(12, 20).fuse(steps).removeSplitter(), (12, 18, 6)


def pocket():
    return Part.makeBox(40, 30, 10).cut(Part.makeBox(20, 12, 5, Vector(10, 9, 5))), (16, 24, 24)


def wedge():
    corners = [Vector(*p) for p in ((0, 0, 0), (40, 0, 0), (0, 0, 25), (0, 0, 0))]
    return Part.Face(Part.makePolygon(corners)).extrude(Vector(0, 30, 0)), (6, 9, 9)


def half_round():
    block = Part.makeBox(40, 20, 20).fuse(Part.makeCylinder(10, 20, Vector(40, 10, 0)))
    return block.removeSplitter(), (10, 15, 11)


def polyline(edge):
    """Points along an edge, enough of them for its curve to be recognised."""
    first, last = edge.ParameterRange
    if isinstance(edge.Curve, (Part.Line, Part.LineSegment)):
        count = 1
    elif isinstance(edge.Curve, (Part.Circle, Part.Ellipse)):
        count = max(8, math.ceil(abs(last - first) / math.tau * 32))
    else:
        count = 24
    points = (edge.valueAt(first + (last - first) * i / count) for i in range(count + 1))
    return [[round(p.x, 9), round(p.y, 9)] for p in points]


def main():
    parts = (box, l_bracket, through_hole, blind_hole_and_slot, stepped_shaft, pocket, wedge)
    for part in (*parts, half_round):
        shape, counts = part()
        for view, direction in DIRECTIONS.items():
            compounds = TechDraw.projectEx(shape, direction)
            found = [(e, k in HIDDEN) for k in VISIBLE + HIDDEN for e in compounds[k].Edges]
            name = f"{part.__name__}_{view}"
            vertices, edges, straight = ACCIDENTS.get(name, counts)
            drawing = {
                "source": f"FreeCAD, TechDraw.projectEx, {part.__name__}, view {view}",
                "expected": {"vertices": vertices, "edges": edges, "straight": straight},
                "edges": [
                    {"name": f"Edge{i}", "hidden": hidden, "points": polyline(e)}
                    for i, (e, hidden) in enumerate(found, 1)
                ],
            }
            with open(f"{name}.json", "w", encoding="utf-8") as file:
                json.dump(drawing, file, separators=(",", ":"))
                file.write("\n")


main()
sys.exit(0)
