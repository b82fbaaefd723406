# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coloured translucent patches over the drawing, one a face, in the 3D view.

They live in the view's scene only: no document object, nothing to undo, nothing saved.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

import FreeCAD
from pivy import coin

from . import colours
from .model import Drawing, Face, Point
from .tessellate import area, fill

LIFT = 2e-4
"""Distance between patches along the view, as a share of the drawing's size: patches in exactly
one plane would flicker."""


class Patches:
    """The patches of one reading of a drawing, in one view."""

    def __init__(self, view, placement: FreeCAD.Placement, transparency: float):
        self._graph = view.getSceneGraph()
        self._transparency = transparency
        self._root = coin.SoSeparator()
        self._root.addChild(_unpickable())
        self._root.addChild(_transform(placement))
        self._root.addChild(_flat_light())
        self._faces_root = coin.SoSeparator()
        self._marks = coin.SoSeparator()
        self._lines = coin.SoSeparator()
        self._root.addChild(self._faces_root)
        self._root.addChild(self._lines)
        self._root.addChild(self._marks)
        self._switches: list[coin.SoSwitch] = []
        self._materials: list[coin.SoMaterial] = []
        self._outlines: list[coin.SoSwitch] = []
        self._size = 1.0
        self._highlighted: frozenset[int] = frozenset()
        self._marked: list[Point] = []
        self._graph.addChild(self._root)

    def show(self, drawing: Drawing, faces: Sequence[Face]) -> None:
        """Shows these faces in the place of those before, large ones behind small ones."""
        self._faces_root.removeAllChildren()
        self._lines.removeAllChildren()
        self._marks.removeAllChildren()
        self._highlighted, self._marked = frozenset(), []
        self._size = _size(drawing.vertices) or 1.0
        outlines = [face.outline(drawing) for face in faces]
        order = sorted(range(len(faces)), key=lambda k: -area(outlines[k]))
        height = {k: (place + 1) * LIFT * self._size for place, k in enumerate(order)}
        self._switches, self._materials, self._outlines = [], [], []
        for k, outline in enumerate(outlines):
            self._add(k, outline, height[k], len(outlines))
        for k in order:
            self._faces_root.addChild(self._switches[k])
        self._add_lines(drawing)

    def set_visible(self, number: int, visible: bool) -> None:
        """Shows or hides the patch of a face, counted from 0."""
        if number < len(self._switches):
            self._switches[number].whichChild = (
                coin.SO_SWITCH_ALL if visible else (coin.SO_SWITCH_NONE)
            )

    def highlight(self, numbers: Collection[int]) -> None:
        """Brings some faces out and fades the others; without any all are alike."""
        self._highlighted = frozenset(numbers)
        for k, material in enumerate(self._materials):
            if not numbers:
                material.transparency = self._transparency
            else:
                material.transparency = 0.25 if k in numbers else 0.5 + self._transparency / 2
            self._outlines[k].whichChild = (
                coin.SO_SWITCH_ALL if k in numbers else coin.SO_SWITCH_NONE
            )

    def mark(self, lines: Iterable[Sequence[Point]], points: Iterable[Point] = ()) -> None:
        """Marks lines and points of the drawing that a message is about."""
        self._marked = list(points)
        self._marks.removeAllChildren()
        height = (len(self._switches) + 3) * LIFT * self._size
        self._marks.addChild(_material(colours.ERROR, 0.0))
        style = coin.SoDrawStyle()
        style.lineWidth = 5
        style.pointSize = 11
        self._marks.addChild(style)
        for line in lines:
            _add_polyline(self._marks, line, height, closed=False)
        corners = [(x, y, height) for x, y in self._marked]
        if corners:
            self._marks.addChild(_coordinates(corners))
            cloud = coin.SoPointSet()
            cloud.numPoints = len(corners)
            self._marks.addChild(cloud)

    def highlighted(self) -> frozenset[int]:
        """The faces that are brought out."""
        return self._highlighted

    def marked(self) -> list[Point]:
        """The points that are marked."""
        return self._marked

    def remove(self) -> None:
        """Takes everything out of the view again."""
        if self._graph is not None:
            self._graph.removeChild(self._root)
            self._graph = None

    def _add_lines(self, drawing: Drawing) -> None:
        """The drawing's own lines, dark: sketch lines may be white on a white background."""
        self._lines.addChild(_material(colours.EDGE, 0.0))
        style = coin.SoDrawStyle()
        style.lineWidth = 2
        self._lines.addChild(style)
        height = (len(self._switches) + 1) * LIFT * self._size
        for edge in drawing.edges:
            _add_polyline(self._lines, edge.points, height, closed=False)

    def _add(self, number: int, outline: list[list[Point]], height: float, count: int) -> None:
        switch = coin.SoSwitch()
        switch.whichChild = coin.SO_SWITCH_ALL
        patch = coin.SoSeparator()
        material = _material(colours.face(number), self._transparency)
        patch.addChild(material)
        corners, indices = [], []
        for trapezoid in fill(outline):
            for x, y in trapezoid:
                indices.append(len(corners))
                corners.append((x, y, height))
            indices.append(-1)
        if corners:
            patch.addChild(_coordinates(corners))
            surface = coin.SoIndexedFaceSet()
            surface.coordIndex.setValues(0, len(indices), indices)
            patch.addChild(surface)
        frame = coin.SoSwitch()
        frame.whichChild = coin.SO_SWITCH_NONE
        frame.addChild(_material(colours.HIGHLIGHT, 0.0))
        style = coin.SoDrawStyle()
        style.lineWidth = 4
        frame.addChild(style)
        above = (count + 2) * LIFT * self._size
        for loop in outline:
            _add_polyline(frame, loop, above, closed=True)
        switch.addChild(patch)
        switch.addChild(frame)
        self._switches.append(switch)
        self._materials.append(material)
        self._outlines.append(frame)


def _size(points: Sequence[Point]) -> float:
    if not points:
        return 0.0
    xs, ys = zip(*points, strict=True)
    return max(max(xs) - min(xs), max(ys) - min(ys))


def _unpickable() -> coin.SoPickStyle:
    style = coin.SoPickStyle()
    style.style = coin.SoPickStyle.UNPICKABLE
    return style


def _flat_light() -> coin.SoLightModel:
    model = coin.SoLightModel()
    model.model = coin.SoLightModel.BASE_COLOR
    return model


def _transform(placement: FreeCAD.Placement) -> coin.SoTransform:
    transform = coin.SoTransform()
    transform.translation.setValue(*placement.Base)
    transform.rotation.setValue(*placement.Rotation.Q)
    return transform


def _material(colour: colours.Colour, transparency: float) -> coin.SoMaterial:
    material = coin.SoMaterial()
    material.diffuseColor = colour
    material.transparency = transparency
    return material


def _coordinates(corners: Sequence[tuple[float, float, float]]) -> coin.SoCoordinate3:
    node = coin.SoCoordinate3()
    node.point.setValues(0, len(corners), corners)
    return node


def _add_polyline(
    parent: coin.SoGroup, line: Sequence[Point], height: float, *, closed: bool
) -> None:
    points = [*line, line[0]] if closed else list(line)
    parent.addChild(_coordinates([(x, y, height) for x, y in points]))
    lines = coin.SoLineSet()
    lines.numVertices.setValue(len(points))
    parent.addChild(lines)
