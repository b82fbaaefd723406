# SPDX-License-Identifier: LGPL-2.1-or-later
"""The two lists of the panel: faces with check boxes, and messages."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from . import colours
from .i18n import mark, translate
from .model import Face, Finding
from .qt import QtCore, QtGui, QtWidgets

KIND_NAMES = {
    "plane": mark("Faceformer", "Plane"),
    "cylinder": mark("Faceformer", "Cylinder"),
    "cone": mark("Faceformer", "Cone"),
    "sphere": mark("Faceformer", "Sphere"),
    "torus": mark("Faceformer", "Torus"),
    "other": mark("Faceformer", "Other"),
}

_ICONS = {"error": "SP_MessageBoxCritical", "warning": "SP_MessageBoxWarning"}


class FaceList(QtWidgets.QTreeWidget):
    """Faces with their colour, type, number of edges and confidence."""

    def __init__(self, picked: Callable[[list[int]], None], switched: Callable[[int, bool], None]):
        super().__init__()
        self._picked, self._switched = picked, switched
        self.setObjectName("Faceformer_Faces")
        self.setSelectionMode(QtWidgets.QAbstractItemView.ExtendedSelection)
        self.setRootIsDecorated(False)
        self.setAlternatingRowColors(True)
        self.setUniformRowHeights(True)
        self.setIndentation(0)
        self.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        self.setHeaderLabels(
            [
                translate("Faceformer", "Face"),
                translate("Faceformer", "Type"),
                translate("Faceformer", "Edges"),
                translate("Faceformer", "Conf."),
            ]
        )
        self.headerItem().setToolTip(
            3, translate("Faceformer", "Confidence: how probable it is that the face is right")
        )
        header = self.header()
        header.setStretchLastSection(False)
        for column in range(self.columnCount() - 1):
            header.setSectionResizeMode(column, QtWidgets.QHeaderView.ResizeToContents)
        header.setSectionResizeMode(self.columnCount() - 1, QtWidgets.QHeaderView.Stretch)
        self.setMinimumSize(120, 220)
        self.itemSelectionChanged.connect(self._selection_changed)
        self.itemChanged.connect(self._item_changed)

    def show_faces(self, faces: Sequence[Face], off: set[str]) -> None:
        """Fills the list; faces whose key is in ``off`` are switched off."""
        self.blockSignals(True)
        self.clear()
        for number, face in enumerate(faces):
            self.addTopLevelItem(self._row(number, face, face.key not in off))
        self.blockSignals(False)

    def pick(self, *numbers: int) -> None:
        """Selects the rows of faces, counted from 0, and no other; the first one is in sight."""
        self.blockSignals(True)
        self.clearSelection()
        items = [self.topLevelItem(k) for k in numbers if k < self.topLevelItemCount()]
        for item in items:
            item.setSelected(True)
        self.blockSignals(False)
        self._selection_changed()
        if items:
            self.scrollToItem(items[0])

    def _row(self, number: int, face: Face, on: bool) -> QtWidgets.QTreeWidgetItem:
        item = QtWidgets.QTreeWidgetItem(
            [
                str(face.number),
                translate("Faceformer", KIND_NAMES.get(face.kind, face.kind)),
                str(len(face.edge_indices)),
                f"{100 * face.confidence:.0f}%",
            ]
        )
        item.setFlags(item.flags() | QtCore.Qt.ItemIsUserCheckable)
        item.setCheckState(0, QtCore.Qt.Checked if on else QtCore.Qt.Unchecked)
        item.setIcon(0, swatch(colours.face(number)))
        for column in (2, 3):
            item.setTextAlignment(column, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
        item.setToolTip(0, translate("Faceformer", "Edges: {}").format(", ".join(face.edges)))
        return item

    def _selection_changed(self) -> None:
        self._picked([self.indexOfTopLevelItem(item) for item in self.selectedItems()])

    def _item_changed(self, item: QtWidgets.QTreeWidgetItem, column: int) -> None:
        if column == 0:
            on = item.checkState(0) == QtCore.Qt.Checked
            self._switched(self.indexOfTopLevelItem(item), on)


class MessageList(QtWidgets.QListWidget):
    """Messages; a click shows the lines, faces and points that a message is about."""

    def __init__(self, picked: Callable[[Finding], None]):
        super().__init__()
        self._findings: list[Finding] = []
        self._picked = picked
        self.setObjectName("Faceformer_Messages")
        self.setWordWrap(True)
        self.setMaximumHeight(130)
        self.itemClicked.connect(lambda item: self._picked(self._findings[self.row(item)]))

    def show_findings(self, findings: Sequence[Finding]) -> None:
        """Fills the list; it hides when there is nothing to say."""
        self.clear()
        self._findings = list(findings)
        for finding in findings:
            icon = getattr(
                QtWidgets.QStyle, _ICONS.get(finding.severity, "SP_MessageBoxInformation")
            )
            item = QtWidgets.QListWidgetItem(self.style().standardIcon(icon), finding.message)
            item.setToolTip(
                f"{finding.message}\n{finding.detail}" if finding.detail else finding.message
            )
            self.addItem(item)
        self.setVisible(bool(findings))


def swatch(colour: colours.Colour) -> QtGui.QIcon:
    """A small square in a colour, with a darker frame."""
    pixmap = QtGui.QPixmap(14, 14)
    red, green, blue = (int(255 * value) for value in colour)
    pixmap.fill(QtGui.QColor(red, green, blue))
    painter = QtGui.QPainter(pixmap)
    painter.setPen(QtGui.QColor(red // 2, green // 2, blue // 2))
    painter.drawRect(0, 0, 13, 13)
    painter.end()
    return QtGui.QIcon(pixmap)
