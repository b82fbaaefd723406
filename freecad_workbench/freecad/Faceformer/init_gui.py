# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench in FreeCAD's window."""

import FreeCAD
import FreeCADGui

from . import RESOURCES, icon

translate = FreeCAD.Qt.translate
FreeCADGui.addLanguagePath(str(RESOURCES / "translations"))
FreeCADGui.updateLocale()


class FaceformerWorkbench(FreeCADGui.Workbench):
    """Toolbar and menu."""

    MenuText = translate("Faceformer", "Faceformer")
    ToolTip = translate("Faceformer", "From a 2D line drawing to a solid")
    Icon = icon("Faceformer")

    def Initialize(self) -> None:
        """FreeCAD calls this when the workbench is first used."""
        from . import commands

        names = commands.register()
        self.appendToolbar("Faceformer", names)
        self.appendMenu("Faceformer", names)
        FreeCADGui.addIconPath(str(RESOURCES / "icons"))
        FreeCADGui.addPreferencePage(str(RESOURCES / "ui" / "preferences.ui"), "Faceformer")

    def GetClassName(self) -> str:
        """What kind of workbench this is, for FreeCAD."""
        return "Gui::PythonWorkbench"


FreeCADGui.addWorkbench(FaceformerWorkbench())
