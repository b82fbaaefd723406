# SPDX-License-Identifier: LGPL-2.1-or-later
"""Brings a new object in front of the user."""

from __future__ import annotations

from typing import Any

import FreeCADGui

from . import preferences


def show_solid() -> None:
    """Turns the view so that a new solid is seen as one, with nothing selected in front of it."""
    FreeCADGui.Selection.clearSelection()
    view = view_3d()
    if view is not None and preferences.turn_view():
        view.viewIsometric()
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
    view = view_3d()
    if view is not None and preferences.turn_view():
        view.viewTop()
        view.fitAll()


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
