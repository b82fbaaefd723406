# SPDX-License-Identifier: LGPL-2.1-or-later
"""Errors where the user sees them."""

from __future__ import annotations

import FreeCAD
import FreeCADGui

from .qt import QtWidgets


def show_error(error: BaseException) -> None:
    """Logs an error and shows it in a dialog."""
    FreeCAD.Console.PrintError(f"Faceformer: {error}\n")
    QtWidgets.QMessageBox.warning(FreeCADGui.getMainWindow(), "Faceformer", str(error))
