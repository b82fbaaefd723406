# SPDX-License-Identifier: LGPL-2.1-or-later
"""*Convert to Solid*: makes a solid that follows the selected drawing."""

from __future__ import annotations

from typing import Any

from .. import icon, panel, selection
from ..errors import FaceformerError
from ..i18n import mark
from ..report import show_error
from ..session import Session
from ..show import show_solid
from ..worker import is_cancelled, run


class ConvertToSolid:
    """Converts what the open panel shows, or the selection."""

    def GetResources(self) -> dict[str, Any]:
        """Texts and icon."""
        return {
            "Pixmap": icon("Faceformer_ConvertToSolid"),
            "MenuText": mark("Faceformer_ConvertToSolid", "Convert to Solid"),
            "ToolTip": mark(
                "Faceformer_ConvertToSolid",
                "Creates a solid that follows the selected sketch or edges",
            ),
        }

    def IsActive(self) -> bool:
        """The panel must have faces, or a drawing must be selected."""
        current = panel.current()
        if current is not None:
            return bool(current.session.faces()) and not current.busy()
        return selection.drawing_links() is not None

    def Activated(self, _index: int = 0) -> None:
        """Runs the command."""
        current = panel.current()
        if current is not None:
            current.accept()
            return
        session = Session(selection.drawing_links())
        try:
            session.extract()
            session.outcome = run(session.work())
            if session.outcome.error is not None:
                raise session.outcome.error
            built = run(session.build())
            solid = session.convert()
        except FaceformerError as error:
            if not is_cancelled(error):
                show_error(error)
            return
        show_solid(solid, built, session.outcome.drawing)
