# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric solid: a ``Part::FeaturePython`` that follows the drawing it was made from.

All data is in the object's properties, so that a file opens without this workbench, and the
proxy has none. If the work fails, `Solid.execute` raises, and FreeCAD marks the object as
invalid with the message.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import Part

from . import extract, pipeline
from .errors import Failed
from .i18n import mark, translate
from .stateless import Stateless

SCHEMA = 1
"""Version of the set of properties; `Solid.onDocumentRestored` brings older objects up to it."""

ORIENTATION_NAMES = {"Upright": "upright", "As Drawn": "drawn"}
"""What the property shows, and what the library calls it."""

_READ_ONLY = 1
_NORMAL, _HIDE, _OUTPUT = 0, 4, 8
_PROPERTIES = (
    (
        "App::PropertyLinkSubListGlobal",
        "Source",
        "Drawing",
        mark("App::Property", "The sketch, or the edges, that the solid is made from"),
        _NORMAL,
    ),
    (
        "App::PropertyEnumeration",
        "Engine",
        "Drawing",
        mark("App::Property", "The method that finds the faces"),
        _NORMAL,
    ),
    (
        "App::PropertyIntegerConstraint",
        "Reading",
        "Drawing",
        mark("App::Property", "Which set of faces is built: 0 is the best, 1 the next"),
        _NORMAL,
    ),
    (
        "App::PropertyStringList",
        "FacesOff",
        "Drawing",
        mark("App::Property", "Faces that are switched off, each by the names of its edges"),
        _HIDE,
    ),
    (
        "App::PropertyFloatConstraint",
        "Scale",
        "Solid",
        mark("App::Property", "Length in the model of one millimetre in the drawing"),
        _NORMAL,
    ),
    (
        "App::PropertyBool",
        "Flip",
        "Solid",
        mark("App::Property", "Takes the other of the two solids that look the same"),
        _NORMAL,
    ),
    (
        "App::PropertyEnumeration",
        "Orientation",
        "Solid",
        mark("App::Property", "Turns the solid upright, or leaves it as drawn on the sketch"),
        _NORMAL,
    ),
    (
        "App::PropertyStringList",
        "Messages",
        "Result",
        mark("App::Property", "What was found in the drawing and in the solid"),
        _READ_ONLY | _OUTPUT,
    ),
    (
        "App::PropertyInteger",
        "SchemaVersion",
        "Result",
        mark("App::Property", "Version of these properties"),
        _READ_ONLY | _HIDE,
    ),
)


class Solid(Stateless):
    """Proxy of the object."""

    def __init__(self, obj: FreeCAD.DocumentObject):
        obj.Proxy = self
        upgrade(obj)

    def execute(self, obj: FreeCAD.DocumentObject) -> None:
        """Builds the shape again from the drawing; the same drawing gives the same shape."""
        drawn = extract.extract(obj.Source)
        with progress_bar() as progress:
            identified = identify(drawn, obj.Engine, progress)
            built = pipeline.solid(identified, options_of(obj), progress)
        if built.exchange:
            FreeCAD.Console.PrintWarning(f"{obj.Label}: {built.exchange}\n")
        placement = drawn.placement if obj.Orientation == "As Drawn" else obj.Placement
        obj.Shape = shape_of(built)
        obj.Placement = placement
        obj.Messages = messages(identified, built)

    def onChanged(self, obj: FreeCAD.DocumentObject, name: str) -> None:
        """A solid that is left as drawn lies on its drawing, so it cannot be moved."""
        if name == "Orientation" and hasattr(obj, "Placement"):
            obj.setEditorMode("Placement", _READ_ONLY if obj.Orientation == "As Drawn" else 0)

    def onDocumentRestored(self, obj: FreeCAD.DocumentObject) -> None:
        """Adds what an object of an older schema lacks."""
        upgrade(obj)


def upgrade(obj: FreeCAD.DocumentObject) -> None:
    """Gives an object all properties of the schema, and leaves those that it has."""
    missing = [entry for entry in _PROPERTIES if not hasattr(obj, entry[1])]
    for kind, name, group, tip, attributes in missing:
        obj.addProperty(kind, name, group, tip, attributes)
    added = {entry[1] for entry in missing}
    if "Engine" in added:
        obj.Engine = list(pipeline.ENGINES)
    if "Orientation" in added:
        obj.Orientation = list(ORIENTATION_NAMES)
    if "Reading" in added:
        obj.Reading = (0, 0, 99, 1)
    if "Scale" in added:
        obj.Scale = (1.0, 1e-6, 1e6, 0.1)
    if obj.SchemaVersion != SCHEMA:
        obj.SchemaVersion = SCHEMA


def is_solid(obj: Any) -> bool:
    """Whether an object is one of this workbench's solids."""
    return isinstance(getattr(obj, "Proxy", None), Solid)


def options_of(obj: FreeCAD.DocumentObject) -> pipeline.SolidOptions:
    """The options that an object's properties stand for."""
    return pipeline.SolidOptions(
        scale=float(obj.Scale),
        flip=bool(obj.Flip),
        orientation=ORIENTATION_NAMES[obj.Orientation],
        reading=int(obj.Reading),
        off=tuple(obj.FacesOff),
    )


def apply(obj: FreeCAD.DocumentObject, engine: str, options: pipeline.SolidOptions) -> None:
    """Writes an engine and options into an object's properties."""
    names = {value: name for name, value in ORIENTATION_NAMES.items()}
    obj.Engine = engine
    obj.Scale = options.scale
    obj.Flip = options.flip
    obj.Orientation = names[options.orientation]
    obj.Reading = options.reading
    obj.FacesOff = list(options.off)


def identify(
    drawn: extract.Extraction, engine: str, progress: pipeline.Progress | None
) -> pipeline.Identified:
    """The faces of extracted edges."""
    return pipeline.identify(drawn.to_json(), [edge.name for edge in drawn.edges], engine, progress)


def shape_of(built: pipeline.Built) -> Part.Shape:
    """The shape of a solid. FreeCAD gives a null shape, and no error, for text it cannot read."""
    shape = Part.Shape()
    shape.importBrepFromString(built.brep)
    if shape.isNull():
        raise Failed(translate("Faceformer", "The solid could not be read into FreeCAD."))
    return shape


def messages(identified: pipeline.Identified, built: pipeline.Built) -> list[str]:
    """What the user may want to know of the drawing and of the solid."""
    findings = [finding.message for finding in identified.identification.findings]
    return [*findings, *identified.identification.notices, *built.notices]


class progress_bar:
    """FreeCAD's progress bar around library calls on the main thread; escape cancels.

    ``with progress_bar() as progress`` gives the callback for the library.
    """

    def __init__(self) -> None:
        self._indicator = None

    def __enter__(self) -> pipeline.Progress | None:
        if not FreeCAD.GuiUp or not hasattr(FreeCAD.Base, "ProgressIndicator"):
            return None
        self._indicator = FreeCAD.Base.ProgressIndicator()
        self._indicator.start(translate("Faceformer", "Building the solid..."), 0)
        return self._step

    def __exit__(self, *_error: object) -> None:
        if self._indicator is not None:
            self._indicator.stop()

    def _step(self, _stage: str, _share: float) -> bool:
        try:
            self._indicator.next(True)
        except Exception:  # FreeCAD raises its own error when the user presses escape
            return False
        return True
