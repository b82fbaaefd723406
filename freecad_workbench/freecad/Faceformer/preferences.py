# SPDX-License-Identifier: LGPL-2.1-or-later
"""The user's preferences. The widgets of ``resources/ui/preferences.ui`` write the same names."""

from __future__ import annotations

import FreeCAD

from .pipeline import ENGINES

PATH = "User parameter:BaseApp/Preferences/Mod/Faceformer"


def _group():
    return FreeCAD.ParamGet(PATH)


def engine() -> str:
    """Engine of new solids."""
    number = _group().GetInt("Engine", 0)
    return ENGINES[number] if 0 <= number < len(ENGINES) else ENGINES[0]


def transparency() -> float:
    """How much shows through the coloured patches, 0 to 1."""
    return min(max(_group().GetInt("Transparency", 60), 0), 95) / 100


def turn_view() -> bool:
    """Whether the view turns to a new solid."""
    return _group().GetBool("TurnView", True)


def hide_source() -> bool:
    """Whether a sketch is hidden once a solid was made from it."""
    return _group().GetBool("HideSource", True)
