# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench from the Python console. These three names do not change.

A *source* is a sketch, another object made of edges in one plane, a shape, a pair such as
``(sketch, ["Edge1", "Edge4"])``, what ``Gui.Selection.getSelectionEx()`` returns, or a list of
these. All errors are `freecad.Faceformer.errors.FaceformerError`, with a message for the user.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import Part

from . import extract, feature, pipeline
from . import wireframe as _wireframe
from .errors import BadInput, Failed
from .i18n import translate
from .model import Identification
from .transaction import transaction

__all__ = ["identify_faces", "to_solid", "wireframe"]


def identify_faces(
    source: Any, engine: str = "rotation", progress: pipeline.Progress | None = None
) -> Identification:
    """Finds the faces of the solid that a drawing shows. Changes no document.

    ``engine`` is ``rotation``, ``varley``, ``shortest`` or ``faceformer``.
    ``progress(stage, share)`` hears how far the work is and returns False to cancel.

    The result has ``faces`` (each with ``number``, ``kind``, ``edges`` by name and
    ``confidence``), ``readings`` (the best set of faces and the alternatives), ``findings`` (what
    is noteworthy in the drawing) and ``notices``.
    """
    return feature.identify(extract.extract(source), _engine(engine), progress).identification


def to_solid(
    source: Any,
    engine: str = "rotation",
    scale: float = 1.0,
    flip: bool = False,
    *,
    orientation: str = "upright",
    reading: int = 0,
    off: tuple[str, ...] = (),
    progress: pipeline.Progress | None = None,
) -> FreeCAD.DocumentObject:
    """Makes a solid that follows its drawing, and returns the document object.

    ``scale`` is the length in the model of one unit in the drawing. ``flip`` takes the other of
    the two solids that look the same. ``orientation`` is ``upright`` or ``drawn`` (left as it is
    seen, on the drawing's plane). ``reading`` chooses a set of faces, 0 is the best. ``off``
    holds the ``key`` of each face to leave out.

    The work is done before the document is touched; if it fails, nothing is added. A shape that
    belongs to no document is added to the document first, since the solid follows its drawing.
    """
    options = pipeline.SolidOptions(
        float(scale), bool(flip), _orientation(orientation), int(reading), tuple(off)
    )
    if not 0 < options.scale < float("inf"):
        raise BadInput(translate("Faceformer", "The scale must be a number above zero."))
    drawn = extract.extract(source)
    identified = feature.identify(drawn, _engine(engine), progress)
    pipeline.solid(identified, options, progress)
    links = extract.normalise(source)
    document = _document(links)
    with transaction(document, translate("Faceformer", "Convert to Solid")):
        return _add(document, links, engine, options)


def wireframe(shape: Any, direction: Any = (1.0, -1.3, 0.8)) -> FreeCAD.DocumentObject:
    """Draws a solid with all its edges into a new sketch in the XY plane, and returns the sketch.

    ``shape`` is a shape or a document object. ``direction`` points from the solid to the viewer,
    as in TechDraw: (1, -1, 1) is the isometric view. The drawing has the shape's own units, and
    the model's z axis is drawn upwards.
    """
    document = getattr(shape, "Document", None) or _active_document()
    label = translate("Faceformer", "Wireframe of {}").format(getattr(shape, "Label", "Shape"))
    solid = shape if isinstance(shape, Part.Shape) else Part.getShape(shape)
    with transaction(document, translate("Faceformer", "Wireframe from Solid")):
        return _wireframe.add_sketch(document, solid, direction, label)


def _add(
    document: FreeCAD.Document, links: list[Any], engine: str, options: pipeline.SolidOptions
) -> FreeCAD.DocumentObject:
    source = [(_object(document, thing), list(names) or [""]) for thing, names in links]
    obj = document.addObject("Part::FeaturePython", "FaceformerSolid")
    feature.Solid(obj)
    obj.Label = translate("Faceformer", "Solid from {}").format(source[0][0].Label)
    obj.Source = source
    feature.apply(obj, engine, options)
    if FreeCAD.GuiUp:
        from . import show, viewprovider

        viewprovider.SolidView(obj.ViewObject)
        show.hide_drawings(source)
    document.recompute([obj])
    if not obj.isValid():
        raise Failed(obj.getStatusString())
    return obj


def _object(document: FreeCAD.Document, thing: Any) -> FreeCAD.DocumentObject:
    if not isinstance(thing, Part.Shape):
        return thing
    obj = document.addObject("Part::Feature", "Drawing")
    obj.Shape = thing
    return obj


def _document(links: list[Any]) -> FreeCAD.Document:
    for thing, _ in links:
        document = getattr(thing, "Document", None)
        if document is not None:
            return document
    return _active_document()


def _active_document() -> FreeCAD.Document:
    return FreeCAD.ActiveDocument or FreeCAD.newDocument()


def _engine(name: str) -> str:
    if name not in pipeline.ENGINES:
        raise BadInput(
            translate("Faceformer", "There is no engine {!r}. The engines are {}.").format(
                name, ", ".join(pipeline.ENGINES)
            )
        )
    return name


def _orientation(name: str) -> str:
    if name not in pipeline.ORIENTATIONS:
        raise BadInput(
            translate("Faceformer", "There is no orientation {!r}. Choose one of {}.").format(
                name, ", ".join(pipeline.ORIENTATIONS)
            )
        )
    return name
