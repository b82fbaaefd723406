# SPDX-License-Identifier: LGPL-2.1-or-later
"""A solid seen from a direction, drawn with all its edges: lines, arcs and silhouettes.

FreeCAD's hidden line removal gives exact pieces, but cuts an edge wherever it goes behind
another. The library's clean-up joins the pieces again, so the sketch has the edges that a person
would draw.
"""

from __future__ import annotations

import math
from typing import Any

import FreeCAD
import Part

from . import pipeline, sketch_writer
from .errors import BadInput, LibraryMissing
from .extract import Extraction, SourceEdge, sample
from .i18n import translate

COMPOUNDS = (0, 1, 3, 5, 6, 8)
"""Of the ten results of ``TechDraw.projectEx``: sharp, smooth and outline, visible and hidden.
The seams (2, 7) are no edges of the part, and the iso lines (4, 9) are decoration."""

TINY = 1e-6
"""Pieces shorter than this share of the part's size are dropped: they are cuts, not edges."""


def camera(direction: Any) -> FreeCAD.Rotation:
    """Turns the model so that it is seen along -z by a viewer in ``direction``.

    The model's z axis is drawn upwards; seen from straight above or below, its y axis is.
    Raises `BadInput` for a direction without length.
    """
    try:
        x, y, z = (float(value) for value in direction)
    except (TypeError, ValueError) as error:
        raise BadInput(
            translate("Faceformer", "A direction is three numbers, for instance (1, -1, 1).")
        ) from error
    z = FreeCAD.Vector(x, y, z)
    if not (math.isfinite(z.Length) and z.Length > 1e-12):
        raise BadInput(
            translate("Faceformer", "The direction has no length. Give one such as (1, -1, 1).")
        )
    z.normalize()
    x = FreeCAD.Vector(0, 0, 1).cross(z)
    if x.Length < 1e-9:
        x = FreeCAD.Vector(0, 1, 0).cross(z)
    x.normalize()
    return FreeCAD.Rotation(x, z.cross(x), z, "ZXY").inverted()


def project(shape: Part.Shape, direction: Any) -> list[Part.Edge]:
    """The pieces of the drawing of a shape in the camera frame: x right, y up, z = 0."""
    import TechDraw

    turned = shape.copy()
    turned.Placement = FreeCAD.Placement(FreeCAD.Vector(), camera(direction)).multiply(
        shape.Placement
    )
    results = TechDraw.projectEx(turned, FreeCAD.Vector(0, 0, 1))
    least = TINY * shape.BoundBox.DiagonalLength
    pieces = [
        edge
        for number in COMPOUNDS
        if not results[number].isNull()
        for edge in results[number].Edges
        if edge.Length > least
    ]
    if not pieces:
        raise BadInput(translate("Faceformer", "The shape has no edges to draw."))
    return pieces


def hidden_corners(shape: Part.Shape, direction: Any) -> int:
    """Number of corners that are drawn in the same place as another corner.

    Such a drawing does not tell which edges meet there; another direction is better.
    """
    rotation = camera(direction)
    least = 1e-5 * shape.BoundBox.DiagonalLength
    seen = sorted((rotation.multVec(v.Point) for v in shape.Vertexes), key=lambda p: p.x)
    count = 0
    for k, first in enumerate(seen):
        for second in seen[k + 1 :]:
            if second.x - first.x > least:
                break
            if abs(second.y - first.y) < least:
                count += 1
                break
    return count


def extraction(shape: Part.Shape, direction: Any) -> Extraction:
    """The pieces of the drawing as an edge list for the library."""
    edges = [
        SourceEdge(f"Edge{k}", tuple((p.x, p.y) for p in sample(piece)))
        for k, piece in enumerate(project(shape, direction), 1)
    ]
    return Extraction(tuple(edges), FreeCAD.Placement())


def add_sketch(
    document: FreeCAD.Document, shape: Part.Shape, direction: Any, label: str
) -> FreeCAD.DocumentObject:
    """Adds the drawing of a shape to a document, as a sketch in the XY plane in true size."""
    if shape.isNull() or not shape.Faces:
        raise BadInput(
            translate("Faceformer", "Select a solid: the selection has no faces to draw.")
        )
    drawn = extraction(shape, direction)
    covered = hidden_corners(shape, direction)
    if covered:
        FreeCAD.Console.PrintWarning(
            translate(
                "Faceformer",
                "{} corners are drawn on top of another one. A direction further away from the "
                "part's own diagonals and axes gives a clearer drawing.\n",
            ).format(covered)
        )
    try:
        _, drawing = pipeline.read(drawn.to_json(), [edge.name for edge in drawn.edges])
    except LibraryMissing as error:
        FreeCAD.Console.PrintWarning(f"{error}\n")
        geometry, joints = [sketch_writer.piece(e) for e in project(shape, direction)], []
    else:
        geometry, joints = sketch_writer.convert(drawing)
    sketch = document.addObject("Sketcher::SketchObject", "Wireframe")
    sketch.Label = label
    sketch_writer.write(sketch, geometry, joints)
    document.recompute([sketch])
    return sketch
