# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solid -> wireframe sketch -> faces -> solid, and the solids compared. Run by `freecadcmd`.

Parts made here, then real ones, of which docs/round-trips.md has the table.
"""

import FreeCAD
from freecad.Faceformer import api, extract
from freecad.Faceformer.errors import FaceformerError
from harness import OUTPUT, check, run
from parts import examples, surfaces
from real_parts import kinds_of, real_parts

DIRECTION = (1.0, -1.3, 0.8)
VOLUME_SHARE = 1e-3
"""Largest difference of the volumes, as a share."""
LEAST = 10
"""Real parts that come back, at least."""


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


def travel_real(part):
    """Takes a real part round and returns a row of the table."""
    row = {"part": part.file}
    shape = part.shape()
    found = kinds_of(shape)
    # What is written as a spline has no kind of its own to compare with.
    assert "other" in found or found == part.kinds, (part.file, found)
    sketch = api.wireframe(shape, DIRECTION)
    row["edges"] = len(sketch.Shape.Edges)
    solid = api.to_solid(sketch).Shape
    row["error"] = abs(solid.Volume / shape.Volume - 1)
    row["kinds"] = kinds_of(solid)
    row["valid"] = solid.isValid() and solid.isClosed() and solid.ShapeType == "Solid"
    row["good"] = row["valid"] and row["error"] <= VOLUME_SHARE and row["kinds"] == part.kinds
    return row


def real(part):
    """Checks a real part. One that is listed as failing and comes back fails the check too."""
    try:
        row = travel_real(part)
        text, good = show(row), row["good"]
    except FaceformerError as error:
        text, good = f"part {part.file}: {error}", False
    if part.fails:
        check(not good, f"{text}  as listed: {part.fails}")
    else:
        check(good, text)
    return good


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
    back = sum(real(part) for part in real_parts())
    check(back >= LEAST, f"{back} real parts came back")


run(main)
