# SPDX-License-Identifier: LGPL-2.1-or-later
"""*Wireframe from Solid*: draws a solid, seen from a chosen direction, into a sketch."""

from __future__ import annotations

from typing import Any

import FreeCADGui

from .. import api, icon, selection
from ..direction_dialog import ask_direction
from ..errors import FaceformerError
from ..i18n import mark
from ..report import show_error
from ..show import show_drawing


class WireframeFromSolid:
    """Asks for a direction and makes the sketch."""

    def GetResources(self) -> dict[str, Any]:
        """Texts and icon."""
        return {
            "Pixmap": icon("Faceformer_WireframeFromSolid"),
            "MenuText": mark("Faceformer_WireframeFromSolid", "Wireframe from Solid..."),
            "ToolTip": mark(
                "Faceformer_WireframeFromSolid",
                "Creates a sketch with all edges of the selected solid, seen from a direction",
            ),
        }

    def IsActive(self) -> bool:
        """One object with faces must be selected, and no panel be open."""
        return selection.solid_to_draw() is not None and not FreeCADGui.Control.activeDialog()

    def Activated(self, _index: int = 0) -> None:
        """Runs the command."""
        solid = selection.solid_to_draw()
        direction = ask_direction()
        if direction is None:
            return
        try:
            sketch = api.wireframe(solid, direction)
        except FaceformerError as error:
            show_error(error)
            return
        solid.ViewObject.Visibility = False
        show_drawing(sketch)
