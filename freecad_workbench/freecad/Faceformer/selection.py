# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the user may select: drawings for the way to a solid, solids for the way back."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui

from .extract import is_planar_object
from .feature import is_solid

Links = list[tuple[Any, list[str]]]


def is_drawing(obj: Any) -> bool:
    """Whether a whole object can be a drawing: a sketch, a Draft object, or edges without faces."""
    if is_planar_object(obj):
        return True
    shape = getattr(obj, "Shape", None)
    if shape is None or not hasattr(shape, "countElement"):
        return False
    return shape.countElement("Edge") > 0 and shape.countElement("Face") == 0


def drawing_links() -> Links | None:
    """The selection as a source; None if it is empty or has anything but drawings and edges.

    All edges of a sketch count as the whole sketch, which lines that are added later join.
    """
    links: Links = []
    for entry in FreeCADGui.Selection.getSelectionEx():
        obj, names = entry.Object, list(entry.SubElementNames)
        if any(not name.rpartition(".")[2].startswith("Edge") for name in names):
            return None
        if not names and not is_drawing(obj):
            return None
        whole = is_drawing(obj) and len(set(names)) == obj.Shape.countElement("Edge")
        links.append((obj, [] if whole else names))
    return links or None


def solid_to_draw() -> Any | None:
    """The one selected object with faces, or None. A picked face stands for its object."""
    objects = [entry.Object for entry in FreeCADGui.Selection.getSelectionEx()]
    if len(objects) != 1:
        return None
    shape = getattr(objects[0], "Shape", None)
    if shape is None or not hasattr(shape, "countElement") or shape.countElement("Face") == 0:
        return None
    return objects[0]


def own_solids() -> list[Any]:
    """The selected solids of this workbench; empty if anything else is selected too."""
    objects = [entry.Object for entry in FreeCADGui.Selection.getSelectionEx()]
    return objects if all(is_solid(obj) for obj in objects) else []


def solids_to_flip() -> list[Any]:
    """The selected solids of this workbench, or the only one of the document if nothing is."""
    if FreeCADGui.Selection.getSelectionEx() or FreeCAD.ActiveDocument is None:
        return own_solids()
    solids = [obj for obj in FreeCAD.ActiveDocument.Objects if is_solid(obj)]
    return solids if len(solids) == 1 else []


class DrawingGate:
    """Lets the user pick edges and drawings while the panel is open, and refuses faces."""

    def allow(self, _document: Any, obj: Any, name: str) -> bool:
        """FreeCAD asks this for everything under the cursor."""
        if not name:
            return is_drawing(obj)
        return name.rpartition(".")[2].startswith("Edge")
