# SPDX-License-Identifier: LGPL-2.1-or-later
"""A solid that follows its sketch: changes, failures that stand on the object, saving, undo."""

import os

import FreeCAD
import Part
from freecad.Faceformer import api, feature
from harness import OUTPUT, check, run

V = FreeCAD.Vector
ALONG = V(12, 10)
"""How the depth axis is drawn."""


def block(document, width, height):
    """A sketch of a block in an oblique view: twelve lines."""
    sketch = document.addObject("Sketcher::SketchObject", "Block")
    sketch.addGeometry(block_lines(width, height), False)
    document.recompute()
    return sketch


def block_lines(width, height):
    """The twelve edges of a block, seen so that no two corners coincide."""
    axes = [V(width, -width / 3), V(0.6 * width, 0.4 * width), V(0, height)]
    lines = []
    for k, axis in enumerate(axes):
        others = axes[:k] + axes[k + 1 :]
        for first in (V(), others[0]):
            for second in (V(), others[1]):
                start = first + second
                lines.append(Part.LineSegment(start, start + axis))
    return lines


def volumes(solid):
    """Volume of a solid, and whether it is sound."""
    return solid.Shape.Volume, solid.isValid() and solid.Shape.isValid()


def main():
    document = FreeCAD.newDocument("Follow")
    document.UndoMode = 1
    sketch = block(document, 30, 20)

    solid = api.to_solid(sketch)
    first, sound = volumes(solid)
    check(sound and len(solid.Shape.Faces) == 6, f"a block from twelve lines, volume {first:.3f}")
    check(document.UndoCount == 1, f"one undo step, not {document.UndoCount}")
    document.undo()
    check(not document.getObject("FaceformerSolid"), "undo removes the solid")
    document.redo()
    solid = document.getObject("FaceformerSolid")
    check(solid is not None and feature.is_solid(solid), "redo brings it back")

    solid.Scale = 2
    document.recompute()
    scaled, sound = volumes(solid)
    check(sound and abs(scaled / first - 8) < 1e-6, "scale 2 gives eight times the volume")
    solid.Scale = 1
    solid.Flip = True
    document.recompute()
    flipped, sound = volumes(solid)
    check(sound and abs(flipped / first - 1) < 1e-6, "flipped depth gives the same volume")
    solid.Flip = False

    solid.Orientation = "As Drawn"
    sketch.Placement = FreeCAD.Placement(V(5, 6, 7), FreeCAD.Rotation(V(1, 0, 0), 90))
    document.recompute()
    corner = min(
        (vertex.Point - V(5, 6, 7)).cross(V(0, 1, 0)).Length for vertex in solid.Shape.Vertexes
    )
    check(corner < 1e-6, "as drawn, a corner lies behind the corner of the sketch")

    for line in range(11, -1, -1):
        sketch.delGeometry(line)
    sketch.addGeometry(block_lines(30, 40), False)
    document.recompute()
    higher, sound = volumes(solid)
    check(sound and higher > 1.2 * first, f"a higher block follows, volume {higher:.3f}")

    sketch.delGeometry(0)
    document.recompute()
    check(not solid.isValid(), "with a line missing the solid is invalid")
    check("Edge" in solid.getStatusString(), f"it says why: {solid.getStatusString()!r}")
    sketch.addGeometry(block_lines(30, 40)[0], False)
    document.recompute()
    again, sound = volumes(solid)
    check(sound and abs(again / higher - 1) < 1e-6, "with the line back it is sound again")

    path = os.fspath(OUTPUT / "follow.FCStd")
    document.saveAs(path)
    FreeCAD.closeDocument(document.Name)
    document = FreeCAD.openDocument(path)
    solid = document.getObject("FaceformerSolid")
    check(feature.is_solid(solid), "a saved solid comes back with its proxy")
    solid.touch()
    document.recompute()
    restored, sound = volumes(solid)
    check(sound and abs(restored / higher - 1) < 1e-6, "and recomputes to the same solid")

    edges = [f"Edge{k}" for k in range(1, len(document.getObject("Block").Shape.Edges) + 1)]
    picked = api.to_solid((document.getObject("Block"), edges))
    check(picked.isValid() and len(picked.Source[0][1]) == 12, "picked edges give a solid too")


run(main)
