# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faceformer: from a 2D line drawing to a solid, inside FreeCAD.

The console has the same functions as the buttons::

    from freecad.Faceformer import api

    identification = api.identify_faces(sketch)
    solid = api.to_solid(sketch)
    drawing = api.wireframe(solid.Shape, (1, -1.3, 0.8))
"""

from pathlib import Path

import FreeCAD

__version__ = "0.1.0"

RESOURCES = Path(__file__).resolve().parent / "resources"
"""Folder of icons, translations and preference pages."""

_TESTS = "freecad.Faceformer.tests"


def icon(name: str) -> str:
    """Path of an icon of the workbench."""
    return str(RESOURCES / "icons" / f"{name}.svg")


if _TESTS not in getattr(FreeCAD, "__unit_test__", [_TESTS]):
    FreeCAD.__unit_test__ += [_TESTS]
