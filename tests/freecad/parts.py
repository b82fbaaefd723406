# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parts that go the whole way round, with the planes and cylinders that each must have."""

from dataclasses import dataclass

import FreeCAD
import Part

V = FreeCAD.Vector


@dataclass(frozen=True)
class Example:
    """A part with what its solid must have."""

    name: str
    shape: Part.Shape
    planes: int
    cylinders: int


def examples():
    """All parts."""
    box, cylinder = Part.makeBox, Part.makeCylinder
    bracket = box(40, 30, 8).fuse(box(8, 30, 35))
    pierced = box(40, 30, 20).cut(cylinder(6, 60, V(20, 15, -10)))
    slotted = box(50, 30, 20).cut(cylinder(5, 12, V(14, 15, 8))).cut(box(12, 40, 6, V(30, -5, 14)))
    shaft = cylinder(8, 20).fuse(cylinder(14, 15, V(0, 0, 20))).fuse(cylinder(10, 25, V(0, 0, 35)))
    pocket = box(60, 40, 10).cut(box(30, 20, 6, V(15, 10, 4)))
    return [
        Example("box", box(40, 30, 20), 6, 0),
        Example("l_bracket", bracket.removeSplitter(), 8, 0),
        Example("through_hole", pierced, 6, 1),
        Example("blind_hole_and_slot", slotted, 11, 1),
        Example("stepped_shaft", shaft.removeSplitter(), 4, 3),
        Example("pocket", pocket, 11, 0),
        Example("wedge", prism([V(0, 0, 0), V(40, 0, 0), V(0, 0, 25)], V(0, 20, 0)), 5, 0),
    ]


def prism(corners, along):
    """The solid between a polygon and its copy."""
    return Part.Face(Part.makePolygon([*corners, corners[0]])).extrude(along)


def surfaces(shape):
    """Numbers of planar and of cylindrical faces."""
    kinds = [type(face.Surface).__name__ for face in shape.Faces]
    return kinds.count("Plane"), kinds.count("Cylinder")
