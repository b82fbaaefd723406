# SPDX-License-Identifier: LGPL-2.1-or-later
"""*Identify Faces*: shows the faces of the selected drawing as patches and in the panel."""

from __future__ import annotations

from typing import Any

import FreeCADGui

from .. import icon, panel, selection
from ..errors import FaceformerError
from ..i18n import mark
from ..report import show_error


class IdentifyFaces:
    """Opens the panel on the selection."""

    def GetResources(self) -> dict[str, Any]:
        """Texts and icon."""
        return {
            "Pixmap": icon("Faceformer_IdentifyFaces"),
            "MenuText": mark("Faceformer_IdentifyFaces", "Identify Faces"),
            "ToolTip": mark(
                "Faceformer_IdentifyFaces",
                "Finds the faces of the solid that the selected sketch or edges show",
            ),
        }

    def IsActive(self) -> bool:
        """A drawing or one of this workbench's solids must be selected."""
        return bool(selection.drawing_links() or len(selection.own_solids()) == 1)

    def Activated(self, _index: int = 0) -> None:
        """Runs the command."""
        solids = selection.own_solids()
        try:
            if solids:
                FreeCADGui.ActiveDocument.setEdit(solids[0].Name, 0)
            else:
                panel.open_on_source(selection.drawing_links())
        except FaceformerError as error:
            show_error(error)
