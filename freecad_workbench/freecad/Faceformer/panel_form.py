# SPDX-License-Identifier: LGPL-2.1-or-later
"""The widgets of the task panel. They know what a face is, and nothing of FreeCAD's documents."""

from __future__ import annotations

from . import icon
from .i18n import translate
from .panel_lists import FaceList, MessageList
from .pipeline import ENGINES, ORIENTATIONS, SolidOptions
from .qt import QtCore, QtGui, QtWidgets


class PanelForm(QtWidgets.QWidget):
    """Source, progress, faces, messages and options, one below the other."""

    refreshed = QtCore.Signal()
    cancelled = QtCore.Signal()
    engine_chosen = QtCore.Signal(str)
    reading_chosen = QtCore.Signal(int)
    faces_picked = QtCore.Signal(object)
    face_switched = QtCore.Signal(int, bool)
    message_picked = QtCore.Signal(object)

    def __init__(self, engine: str, options: SolidOptions):
        super().__init__()
        self.setObjectName("Faceformer_Panel")
        self.setWindowTitle(translate("Faceformer", "Identify Faces"))
        self.setWindowIcon(QtGui.QIcon(icon("Faceformer_IdentifyFaces")))
        layout = QtWidgets.QVBoxLayout(self)
        layout.setContentsMargins(4, 4, 4, 4)
        layout.addLayout(self._source_row())
        layout.addWidget(self._progress_row())
        self.faces = FaceList(self.faces_picked.emit, self.face_switched.emit)
        layout.addWidget(self.faces)
        self._messages_label = QtWidgets.QLabel(translate("Faceformer", "Messages"))
        layout.addWidget(self._messages_label)
        self.messages = MessageList(self.message_picked.emit)
        layout.addWidget(self.messages)
        layout.addLayout(self._option_rows(engine, options))
        self.show_messages([])
        self.show_readings(0, 0)

    def show_source(self, text: str) -> None:
        """Says what the faces are looked for in."""
        self._source.setText(text)
        self._source.setToolTip(text)

    def show_progress(self, text: str | None, share: float = 0.0) -> None:
        """Shows how far the work is; None hides the bar."""
        self._progress.setVisible(text is not None)
        self._bar.setFormat(f"{text}... %p %")
        self._bar.setValue(int(100 * share))

    def show_readings(self, count: int, chosen: int) -> None:
        """Offers the readings of a drawing, if there are several."""
        self._reading.blockSignals(True)
        self._reading.clear()
        for number in range(count):
            self._reading.addItem(
                translate("Faceformer", "Alternative {}").format(number)
                if number
                else translate("Faceformer", "Best")
            )
        self._reading.setCurrentIndex(chosen)
        self._reading.blockSignals(False)
        for widget in (self._reading, self._reading_label):
            widget.setVisible(count > 1)

    def show_messages(self, findings) -> None:
        """Lists what is to be said about the drawing."""
        self.messages.show_findings(findings)
        self._messages_label.setVisible(bool(findings))

    def scale(self) -> float:
        """The chosen scale."""
        return self._scale.value()

    def flip(self) -> bool:
        """Whether near and far are swapped."""
        return self._flip.isChecked()

    def orientation(self) -> str:
        """The chosen orientation, one of `ORIENTATIONS`."""
        return ORIENTATIONS[self._orientation.currentIndex()]

    def _source_row(self) -> QtWidgets.QHBoxLayout:
        row = QtWidgets.QHBoxLayout()
        self._source = QtWidgets.QLabel()
        self._source.setSizePolicy(QtWidgets.QSizePolicy.Ignored, QtWidgets.QSizePolicy.Preferred)
        row.addWidget(self._source, 1)
        tip = translate("Faceformer", "Takes the selected lines, or reads the drawing again")
        button = _tool_button(":/icons/view-refresh.svg", tip)
        button.clicked.connect(lambda *_: self.refreshed.emit())
        row.addWidget(button)
        return row

    def _progress_row(self) -> QtWidgets.QWidget:
        self._progress = QtWidgets.QWidget()
        row = QtWidgets.QHBoxLayout(self._progress)
        row.setContentsMargins(0, 0, 0, 0)
        self._bar = QtWidgets.QProgressBar()
        self._bar.setRange(0, 100)
        row.addWidget(self._bar, 1)
        button = _tool_button(":/icons/process-stop.svg", translate("Faceformer", "Cancel"))
        button.clicked.connect(lambda *_: self.cancelled.emit())
        row.addWidget(button)
        self._progress.setVisible(False)
        return self._progress

    def _option_rows(self, engine: str, options: SolidOptions) -> QtWidgets.QFormLayout:
        rows = QtWidgets.QFormLayout()
        self._reading_label = QtWidgets.QLabel(translate("Faceformer", "Reading"))
        self._reading = _narrow_box([])
        self._reading.currentIndexChanged.connect(self.reading_chosen.emit)
        rows.addRow(self._reading_label, self._reading)
        self._engine = _narrow_box(ENGINES)
        self._engine.setCurrentIndex(ENGINES.index(engine))
        self._engine.currentIndexChanged.connect(
            lambda number: self.engine_chosen.emit(ENGINES[number])
        )
        rows.addRow(translate("Faceformer", "Engine"), self._engine)
        self._scale = QtWidgets.QDoubleSpinBox()
        self._scale.setDecimals(4)
        self._scale.setRange(1e-4, 1e6)
        self._scale.setValue(options.scale)
        rows.addRow(translate("Faceformer", "Scale"), self._scale)
        names = [translate("Faceformer", "Upright"), translate("Faceformer", "As Drawn")]
        self._orientation = _narrow_box(names)
        self._orientation.setCurrentIndex(ORIENTATIONS.index(options.orientation))
        rows.addRow(translate("Faceformer", "Orientation"), self._orientation)
        self._flip = QtWidgets.QCheckBox(translate("Faceformer", "Flip Depth"))
        self._flip.setChecked(options.flip)
        rows.addRow("", self._flip)
        return rows


def _narrow_box(texts) -> QtWidgets.QComboBox:
    """A combo box that does not make the panel wider than FreeCAD's side bar."""
    box = QtWidgets.QComboBox()
    box.addItems(list(texts))
    box.setMinimumContentsLength(6)
    box.setSizeAdjustPolicy(QtWidgets.QComboBox.AdjustToMinimumContentsLengthWithIcon)
    return box


def _tool_button(picture: str, tip: str) -> QtWidgets.QToolButton:
    button = QtWidgets.QToolButton()
    button.setIcon(QtGui.QIcon(picture))
    button.setToolTip(tip)
    return button
