# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small dialog that asks for a view direction."""

from __future__ import annotations

import FreeCADGui

from .i18n import mark, translate
from .qt import QtWidgets, execute
from .show import view_3d

Direction = tuple[float, float, float]

PRESETS: tuple[tuple[str, Direction], ...] = (
    (mark("Faceformer", "General View"), (1.0, -1.3, 0.8)),
    (mark("Faceformer", "General View from the Left"), (-0.7, -1.4, 0.9)),
    (mark("Faceformer", "Dimetric View"), (1.0, -1.0, 0.5)),
    (mark("Faceformer", "Isometric View"), (1.0, -1.0, 1.0)),
)
"""Directions towards the viewer. In the general views no two corners of a block coincide; in the
isometric view of a cube, two do."""


class DirectionDialog(QtWidgets.QDialog):
    """Presets, the current view, or three numbers."""

    def __init__(self, parent: QtWidgets.QWidget):
        super().__init__(parent)
        self.setObjectName("Faceformer_DirectionDialog")
        self.setWindowTitle(translate("Faceformer", "Wireframe from Solid"))
        layout = QtWidgets.QFormLayout(self)
        self._preset = QtWidgets.QComboBox()
        self._directions = [direction for _, direction in PRESETS]
        self._preset.addItems([translate("Faceformer", name) for name, _ in PRESETS])
        current = current_direction()
        if current is not None:
            self._directions.append(current)
            self._preset.addItem(translate("Faceformer", "Current View"))
        self._preset.addItem(translate("Faceformer", "Custom"))
        layout.addRow(translate("Faceformer", "Seen From"), self._preset)
        row = QtWidgets.QHBoxLayout()
        self._values = [self._value_box(row) for _ in range(3)]
        layout.addRow(translate("Faceformer", "Direction"), row)
        buttons = QtWidgets.QDialogButtonBox(
            QtWidgets.QDialogButtonBox.Ok | QtWidgets.QDialogButtonBox.Cancel
        )
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout.addRow(buttons)
        self._preset.currentIndexChanged.connect(self._show_preset)
        self._show_preset(0)

    def direction(self) -> Direction:
        """The direction that the user chose, towards the viewer."""
        number = self._preset.currentIndex()
        if number < len(self._directions):
            return self._directions[number]
        x, y, z = (box.value() for box in self._values)
        return (x, y, z)

    def _value_box(self, row: QtWidgets.QHBoxLayout) -> QtWidgets.QDoubleSpinBox:
        box = QtWidgets.QDoubleSpinBox()
        box.setRange(-1000.0, 1000.0)
        box.setDecimals(3)
        box.setSingleStep(0.1)
        row.addWidget(box)
        return box

    def _show_preset(self, number: int) -> None:
        custom = number >= len(self._directions)
        for k, box in enumerate(self._values):
            box.setEnabled(custom)
            if not custom:
                box.setValue(self._directions[number][k])


def current_direction() -> Direction | None:
    """The direction from the scene to the viewer in the active 3D view."""
    view = view_3d()
    if view is None:
        return None
    x, y, z = view.getViewDirection()
    return (-x, -y, -z)


def ask_direction() -> Direction | None:
    """The chosen direction, or None if the user cancels."""
    dialog = DirectionDialog(FreeCADGui.getMainWindow())
    return dialog.direction() if execute(dialog) else None
