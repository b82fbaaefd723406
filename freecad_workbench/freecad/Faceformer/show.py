# SPDX-License-Identifier: LGPL-2.1-or-later
"""Brings a new object in front of the user."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui

from . import preferences
from .model import Drawing
from .pipeline import Built


def show_solid(solid: Any, built: Built, drawing: Drawing) -> None:
    """Shows a new solid the way it was drawn, with nothing selected in front of it."""
    FreeCADGui.Selection.clearSelection()
    view, axes = view_3d(), built.axes_from(drawing)
    if view is None or axes is None or not preferences.turn_view():
        return
    x, y, z = (FreeCAD.Vector(*axis) for axis in axes)
    view.setCameraOrientation(solid.Placement.Rotation.multiply(FreeCAD.Rotation(x, y, z, "ZXY")).Q)
    view.fitAll()


def face_drawing(placement: FreeCAD.Placement) -> None:
    """Turns the view so that it looks straight at a drawing, if it does not yet."""
    view = view_3d()
    if view is None or not preferences.turn_view():
        return
    if not view.getCameraOrientation().isSame(placement.Rotation, 0.02):
        view.setCameraOrientation(placement.Rotation.Q)
        view.fitAll()


def hide_drawings(links: list[Any]) -> None:
    """Hides the sketches that a solid was made from whole, as FreeCAD's own pads do."""
    if preferences.hide_source():
        for obj, names in links:
            if not any(names):
                obj.ViewObject.Visibility = False


def show_drawing(sketch: Any) -> None:
    """Selects a new drawing and looks straight at it."""
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(sketch)
    face_drawing(sketch.Placement)


def view_3d() -> Any | None:
    """The active 3D view, else the first one of the active document, else None."""
    document = FreeCADGui.ActiveDocument
    if document is None:
        return None
    view = document.ActiveView
    if hasattr(view, "getSceneGraph"):
        return view
    views = document.mdiViewsOfType("Gui::View3DInventor")
    return views[0] if views else None
