# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solid -> wireframe sketch -> faces -> solid, and the solids compared. Run by `freecadcmd`."""

import FreeCAD
from freecad.Faceformer import api, extract
from harness import OUTPUT, check, run
from parts import examples, surfaces

DIRECTION = (1.0, -1.3, 0.8)
VOLUME_SHARE = 1e-3
"""Largest difference of the volumes, as a share."""


def travel(document, example):
    """Takes one part round and returns a row of the table."""
    row = {"part": example.name}
    assert surfaces(example.shape) == (example.planes, example.cylinders), example.name
    sketch = api.wireframe(example.shape, DIRECTION)
    (OUTPUT / f"{example.name}.json").write_text(extract.extract(sketch).to_json())
    row["edges"] = len(sketch.Shape.Edges)
    identification = api.identify_faces(sketch)
    row["faces"] = len(identification.faces)
    solid = api.to_solid(sketch).Shape
    row["volume"] = solid.Volume
    row["error"] = abs(solid.Volume / example.shape.Volume - 1)
    row["planes"], row["cylinders"] = surfaces(solid)
    row["valid"] = solid.isValid() and solid.isClosed() and solid.ShapeType == "Solid"
    row["good"] = (
        row["valid"]
        and row["error"] <= VOLUME_SHARE
        and (row["planes"], row["cylinders"]) == (example.planes, example.cylinders)
    )
    return row


def show(row):
    """One row of the table as text."""
    return "  ".join(
        f"{key} {value:.6g}" if isinstance(value, float) else f"{key} {value}"
        for key, value in row.items()
        if key != "good"
    )


def main():
    document = FreeCAD.newDocument("RoundTrip")
    for example in examples():
        before = {obj.Name for obj in document.Objects}
        try:
            row = travel(document, example)
        except Exception as error:  # the table shows every part, whatever happens to one
            check(False, f"{example.name}: {type(error).__name__}: {error}")
            continue
        check(row["good"], show(row))
        added = {obj.Name for obj in document.Objects} - before
        check(len(added) == 2, f"{example.name} added a sketch and a solid")


run(main)
