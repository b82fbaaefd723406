# SPDX-License-Identifier: LGPL-2.1-or-later
"""A proxy without data of its own: everything is in the object's properties."""

from __future__ import annotations

from typing import Any


class Stateless:
    """Answers what FreeCAD asks when it saves and restores a proxy."""

    def dumps(self) -> None:
        """Nothing to save; FreeCAD 0.21 and later ask this."""

    def loads(self, _state: Any) -> None:
        """Nothing to restore."""

    def __getstate__(self) -> None:
        """The same for FreeCAD 0.20."""

    def __setstate__(self, _state: Any) -> None:
        """The same for FreeCAD 0.20."""
