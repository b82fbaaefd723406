# SPDX-License-Identifier: LGPL-2.1-or-later
"""Translation of the workbench's texts. The context is always ``Faceformer``."""

import FreeCAD

translate = FreeCAD.Qt.translate
"""``translate("Faceformer", text)`` gives the text in the user's language."""


def mark(_context: str, text: str) -> str:
    """Marks a text that FreeCAD itself translates later, such as the name of a command."""
    return text
