# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands, one a file. Importing this package does not register them."""

from __future__ import annotations

import FreeCADGui

from . import convert_to_solid, flip_depth, identify_faces, wireframe_from_solid

NAMES = {
    "Faceformer_IdentifyFaces": identify_faces.IdentifyFaces,
    "Faceformer_ConvertToSolid": convert_to_solid.ConvertToSolid,
    "Faceformer_FlipDepth": flip_depth.FlipDepth,
    "Faceformer_WireframeFromSolid": wireframe_from_solid.WireframeFromSolid,
}
"""Commands by name, in the order of the toolbar."""


def register() -> list[str]:
    """Makes the commands known to FreeCAD and returns their names."""
    for name, command in NAMES.items():
        FreeCADGui.addCommand(name, command())
    return list(NAMES)
