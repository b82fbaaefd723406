# SPDX-License-Identifier: LGPL-2.1-or-later
"""*Flip Depth*: takes the other of the two solids that look the same in the drawing."""

from __future__ import annotations

from typing import Any

from .. import icon, selection
from ..errors import FaceformerError, Failed
from ..i18n import mark, translate
from ..report import show_error
from ..transaction import transaction


class FlipDepth:
    """Turns near into far."""

    def GetResources(self) -> dict[str, Any]:
        """Texts and icon."""
        return {
            "Pixmap": icon("Faceformer_FlipDepth"),
            "MenuText": mark("Faceformer_FlipDepth", "Flip Depth"),
            "ToolTip": mark(
                "Faceformer_FlipDepth",
                "Swaps near and far: the other solid that has the same drawing",
            ),
        }

    def IsActive(self) -> bool:
        """Solids of this workbench must be selected, or the document has just one."""
        return bool(selection.solids_to_flip())

    def Activated(self, _index: int = 0) -> None:
        """Runs the command."""
        solids = selection.solids_to_flip()
        document = solids[0].Document
        try:
            with transaction(document, translate("Faceformer", "Flip Depth")):
                for solid in solids:
                    solid.Flip = not solid.Flip
                document.recompute(solids)
                for solid in solids:
                    if not solid.isValid():
                        raise Failed(solid.getStatusString())
        except FaceformerError as error:
            show_error(error)
