# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bad input through the console: a message that says what to do, and a document left alone."""

import math
import os
from pathlib import Path

import FreeCAD
import Part
from freecad.Faceformer import _native, api
from freecad.Faceformer.errors import BadInput, Cancelled, LibraryMissing
from harness import check, refuses, run

V = FreeCAD.Vector


def sketch_of(document, lines):
    """A sketch of straight lines given by their ends."""
    sketch = document.addObject("Sketcher::SketchObject", "Sketch")
    sketch.addGeometry([Part.LineSegment(V(*a), V(*b)) for a, b in lines], False)
    document.recompute()
    return sketch


def _raise(_stage, _share):
    raise ValueError("from the callback")


def main():
    document = FreeCAD.newDocument("BadInput")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    square = [((0, 0), (9, 1)), ((9, 1), (8, 9)), ((8, 9), (1, 8)), ((1, 8), (0, 0))]
    open_wire = sketch_of(document, square[:3])
    crossing = sketch_of(document, [((0, 0), (10, 9)), ((0, 9), (10, 0))])
    empty = document.addObject("Sketcher::SketchObject", "Empty")
    block = api.wireframe(Part.makeBox(40, 30, 20))
    before = [obj.Name for obj in document.Objects]

    for name, work in (("identify", api.identify_faces), ("solid", api.to_solid)):
        refuses(f"{name}: nothing", ["Nothing is selected"], lambda w=work: w(None), BadInput)
        refuses(f"{name}: an empty list", ["Nothing is selected"], lambda w=work: w([]), BadInput)
        refuses(f"{name}: an empty sketch", ["Empty"], lambda w=work: w(empty), BadInput)
        refuses(f"{name}: a face", ["Face1"], lambda w=work: w((box, "Face1")), BadInput)
        refuses(f"{name}: a solid", ["has faces"], lambda w=work: w(box), BadInput)
        refuses(
            f"{name}: edges in space",
            ["off the plane"],
            lambda w=work: w((box, [f"Edge{k}" for k in range(1, 13)])),
            BadInput,
        )
        refuses(f"{name}: an open wire", ["Edge"], lambda w=work: w(open_wire))
        refuses(f"{name}: lines that cross freely", ["connect"], lambda w=work: w(crossing))
        refuses(f"{name}: no such engine", ["engine"], lambda w=work: w(block, "magic"), BadInput)
        broken = Part.makePolygon([V(0, 0, 0), V(5, 0, 0), V(5, 5, 0)])
        broken.Placement = FreeCAD.Placement(V(math.nan, 0, 0), FreeCAD.Rotation())
        refuses(f"{name}: NaN", ["not a finite number"], lambda w=work, s=broken: w(s), BadInput)
        refuses(
            f"{name}: cancelled",
            [],
            lambda w=work: w(block, progress=lambda _stage, _share: False),
            Cancelled,
        )
    refuses(
        "a progress callback that raises",
        ["from the callback"],
        lambda: api.identify_faces(block, progress=_raise),
        ValueError,
    )
    steps = [V(math.cos(k), math.sin(k)) * k for k in range(1, 6002)]
    refuses(
        "6000 edges", ["the limit is 5000"], lambda: api.identify_faces(Part.makePolygon(steps))
    )
    refuses("solid: scale 0", ["scale"], lambda: api.to_solid(block, scale=0), BadInput)
    refuses("solid: scale NaN", ["scale"], lambda: api.to_solid(block, scale=math.nan), BadInput)
    refuses("wireframe: no direction", ["length"], lambda: api.wireframe(box, (0, 0, 0)), BadInput)
    refuses("wireframe: of a sketch", ["faces"], lambda: api.wireframe(block, (1, 1, 1)), BadInput)
    refuses("garbage", ["not a drawing"], lambda: _native.read_drawing("garbage"), BadInput)
    refuses("NaN in JSON", [], lambda: _native.read_drawing('{"edges":[NaN]}'), BadInput)

    # The workbench may have a library of its own, which would be taken instead.
    os.environ[_native.ENVIRONMENT] = "/nowhere/library.so"
    _native.NATIVE = Path("/nowhere/native")
    refuses(
        "a missing library",
        ["/nowhere/library.so", "/nowhere/native"],
        _native.load,
        LibraryMissing,
    )
    check([obj.Name for obj in document.Objects] == before, "the document is as it was")


run(main)
