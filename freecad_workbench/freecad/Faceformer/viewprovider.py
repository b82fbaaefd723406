# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the solid shows itself in the tree and in the 3D view."""

from __future__ import annotations

from typing import Any

import FreeCADGui

from . import icon
from .stateless import Stateless

DEFAULT_EDIT = 0


class SolidView(Stateless):
    """Proxy of the view object."""

    def __init__(self, vobj: Any):
        vobj.Proxy = self

    def attach(self, vobj: Any) -> None:
        """FreeCAD calls this when the view object is made or restored."""
        self.Object = vobj.Object

    def getIcon(self) -> str:
        """Icon in the tree."""
        return icon("Faceformer_ConvertToSolid")

    def claimChildren(self) -> list[Any]:
        """The drawings hang below the solid in the tree."""
        return [obj for obj, _ in getattr(self, "Object", None).Source]

    def doubleClicked(self, vobj: Any) -> bool:
        """A double click opens the panel."""
        FreeCADGui.ActiveDocument.setEdit(vobj.Object.Name, DEFAULT_EDIT)
        return True

    def setEdit(self, vobj: Any, mode: int) -> bool | None:
        """Opens the panel on the solid; other ways to edit are FreeCAD's own."""
        if mode != DEFAULT_EDIT:
            return None
        from .panel import open_on_solid

        return open_on_solid(vobj.Object)

    def unsetEdit(self, _vobj: Any, mode: int) -> bool | None:
        """Closes the panel."""
        if mode != DEFAULT_EDIT:
            return None
        FreeCADGui.Control.closeDialog()
        return True
