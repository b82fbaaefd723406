# SPDX-License-Identifier: LGPL-2.1-or-later
"""A click on a patch in the 3D view picks its face; a click in the same place the one behind."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import FreeCAD

from .model import Point
from .tessellate import area, contains

_EVENT = "SoMouseButtonEvent"


class Picker:
    """Watches a 3D view for clicks on faces of a drawing."""

    def __init__(self, view: Any, placement: FreeCAD.Placement, picked: Callable[[int], None]):
        self._view = view
        self._to_drawing = placement.inverse()
        self._picked = picked
        self._faces: list[tuple[int, list[list[Point]]]] = []
        self._last: list[int] = []
        self._callback = view.addEventCallback(_EVENT, self._click)

    def show(self, outlines: Sequence[list[list[Point]]]) -> None:
        """Takes the outlines of the faces that can be picked."""
        self._faces = sorted(enumerate(outlines), key=lambda entry: area(entry[1]))
        self._last = []

    def remove(self) -> None:
        """Stops watching."""
        if self._callback is not None:
            self._view.removeEventCallback(_EVENT, self._callback)
            self._callback = None

    def at(self, point: Point) -> int | None:
        """The face to pick at a point: the smallest there, at the next call the next larger."""
        here = [number for number, outline in self._faces if contains(outline, point)]
        if not here:
            self._last = []
            return None
        if set(here) != set(self._last):
            self._last = here
        else:
            self._last.append(self._last.pop(0))
        return self._last[0]

    def _click(self, event: dict[str, Any]) -> None:
        if event["Button"] != "BUTTON1" or event["State"] != "DOWN":
            return
        point = self._on_plane(event["Position"])
        number = self.at(point) if point is not None else None
        if number is not None:
            self._picked(number)

    def _on_plane(self, position: tuple[int, int]) -> Point | None:
        """Where the line of sight through a pixel meets the drawing."""
        near, far = (
            self._to_drawing.multVec(FreeCAD.Vector(*end))
            for end in self._view.projectPointToLine(*position)
        )
        if abs(near.z - far.z) < 1e-9 * (far - near).Length:
            return None
        place = near + (far - near) * (near.z / (near.z - far.z))
        return (place.x, place.y)
