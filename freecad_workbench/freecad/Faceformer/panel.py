# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel: faces that were found, messages, choices, and the button that converts."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui

from . import icon, patches, pipeline, preferences, selection
from .errors import FaceformerError
from .i18n import translate
from .model import Finding
from .panel_lists import FaceList, MessageList
from .picking import Picker
from .qt import QtCore, QtGui, QtWidgets, flags
from .report import show_error
from .session import Session
from .show import show_solid
from .worker import Task, is_cancelled, run

POLL = 40
"""Milliseconds between two looks at the work on the thread."""

_open_panel: Panel | None = None


def current() -> Panel | None:
    """The open panel, if there is one."""
    return _open_panel


def open_on_source(links: list[Any]) -> Panel:
    """Opens the panel on a drawing. Raises `BadInput` if the source is none."""
    session = Session(links)
    session.extract()
    return _show(session)


def open_on_solid(obj: Any) -> bool:
    """Opens the panel on a solid that exists; says whether it could."""
    session = Session.of_solid(obj)
    try:
        session.extract()
    except FaceformerError as error:
        show_error(error)
        return False
    _show(session)
    return True


def _show(session: Session) -> Panel:
    if _open_panel is not None:
        _open_panel.close()
    panel = Panel(session)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Control.showDialog(panel)
    panel.start()
    return panel


class _DocumentObserver:
    """Closes a panel together with the document of its drawing."""

    def __init__(self, panel: Panel):
        self._panel = panel
        self._name = panel.session.document().Name

    def slotDeletedDocument(self, document: FreeCAD.Document) -> None:
        """FreeCAD calls this before a document goes."""
        if document.Name == self._name:
            self._panel.close()


class Panel:
    """Shows a `Session` and lets the user change it. FreeCAD calls accept, reject and so on."""

    def __init__(self, session: Session):
        global _open_panel
        self.session = session
        self._task: Task | None = None
        self._patches: patches.Patches | None = None
        self._picker: Picker | None = None
        self._ok: Any = None
        self._build()
        self._timer = QtCore.QTimer(self.form)
        self._timer.timeout.connect(self._poll)
        FreeCADGui.Selection.addSelectionGate(selection.DrawingGate())
        self._observer = _DocumentObserver(self)
        FreeCAD.addDocumentObserver(self._observer)
        _open_panel = self

    # What FreeCAD calls

    def getStandardButtons(self) -> int:
        """Convert and close."""
        buttons = QtWidgets.QDialogButtonBox
        return flags(buttons.Ok) | flags(buttons.Close)

    def modifyStandardButtons(self, box: QtWidgets.QDialogButtonBox) -> None:
        """Names the first button after what it does."""
        self._ok = box.button(QtWidgets.QDialogButtonBox.Ok)
        self._ok.setObjectName("Faceformer_Convert")
        if self.session.target is None:
            self._ok.setText(translate("Faceformer", "Convert to Solid"))
            self._ok.setIcon(QtGui.QIcon(icon("Faceformer_ConvertToSolid")))
        self._update_buttons()

    def isAllowedAlterSelection(self) -> bool:
        """The user may select while the panel is open."""
        return True

    def isAllowedAlterView(self) -> bool:
        """The user may turn the view."""
        return True

    def isAllowedAlterDocument(self) -> bool:
        """Other commands may run."""
        return True

    def accept(self) -> bool:
        """Converts; the panel stays open if that fails."""
        if self.session.outcome.identified is None:
            return False
        self._read_options()
        try:
            run(self.session.build())
            self.session.convert()
        except FaceformerError as error:
            if not is_cancelled(error):
                self._show_messages(error)
            return False
        new = self.session.target is None
        self.close()
        if new:
            show_solid()
        return True

    def reject(self) -> bool:
        """Closes without a change to the document."""
        self.close()
        return True

    # Life

    def start(self) -> None:
        """Starts the identification."""
        self._stop_task()
        self._update_head()
        self._task = Task(self.session.work())
        self._bar.setVisible(True)
        self._timer.start(POLL)
        self._update_buttons()
        if self._task.wait(0.15):
            self._poll()

    def close(self) -> None:
        """Takes the panel and its patches away."""
        global _open_panel
        if _open_panel is not self:
            return
        _open_panel = None
        self._stop_task()
        self._remove_patches()
        FreeCADGui.Selection.removeSelectionGate()
        FreeCAD.removeDocumentObserver(self._observer)
        FreeCADGui.Control.closeDialog()
        if self.session.target is not None and FreeCADGui.ActiveDocument is not None:
            FreeCADGui.ActiveDocument.resetEdit()

    def busy(self) -> bool:
        """Whether the identification is still running."""
        return self._task is not None

    def _stop_task(self) -> None:
        self._timer.stop()
        if self._task is not None:
            self._task.cancel()
            self._task = None

    def _poll(self) -> None:
        task = self._task
        if task is None:
            return
        self._bar.setFormat(f"{task.label()}... %p %")
        self._bar.setValue(int(100 * task.share))
        if not task.wait(0):
            return
        self._timer.stop()
        self._task = None
        self._bar.setVisible(False)
        self.session.outcome = task.result()
        self._show_outcome()

    # Showing

    def _show_outcome(self) -> None:
        outcome = self.session.outcome
        readings = outcome.identified.identification.readings if outcome.identified else ()
        self._reading.blockSignals(True)
        self._reading.clear()
        for number in range(len(readings)):
            self._reading.addItem(
                translate("Faceformer", "Best")
                if number == 0
                else translate("Faceformer", "Alternative {}").format(number)
            )
        self.session.reading = min(self.session.reading, max(len(readings) - 1, 0))
        self._reading.setCurrentIndex(self.session.reading)
        self._reading.blockSignals(False)
        self._reading.setVisible(len(readings) > 1)
        self._reading_label.setVisible(len(readings) > 1)
        self._show_faces()
        self._show_messages(outcome.error)
        self._update_buttons()

    def _show_faces(self) -> None:
        faces = self.session.faces()
        self._faces.show_faces(faces, self.session.off)
        if self.session.outcome.drawing is None:
            self._remove_patches()
            return
        if self._patches is None:
            view = FreeCADGui.ActiveDocument.ActiveView
            self._patches = patches.Patches(
                view, self.session.drawn.placement, preferences.transparency()
            )
            self._picker = Picker(view, self.session.drawn.placement, self._faces.pick)
        drawing = self.session.outcome.drawing
        self._patches.show(drawing, faces)
        self._picker.show([face.outline(drawing) for face in faces])
        for number, face in enumerate(faces):
            self._patches.set_visible(number, face.key not in self.session.off)

    def _show_messages(self, error: BaseException | None = None) -> None:
        findings = []
        if error is not None and not is_cancelled(error):
            FreeCAD.Console.PrintError(f"Faceformer: {error}\n")
            findings.append(Finding("error", str(error), (), ()))
        outcome = self.session.outcome
        findings += outcome.drawing.findings if outcome.drawing else ()
        if outcome.identified:
            notices = outcome.identified.identification.notices
            findings += [Finding("notice", text, (), ()) for text in notices]
        self._messages.show_findings(findings)
        self._messages_label.setVisible(bool(findings))

    def _update_head(self) -> None:
        count = len(self.session.drawn.edges)
        text = translate("Faceformer", "{}: {} edges").format(self.session.source_label(), count)
        self._head.setText(text)
        self._head.setToolTip(text)

    def _update_buttons(self) -> None:
        if self._ok is not None:
            self._ok.setEnabled(bool(self.session.faces()) and not self.busy())

    def _remove_patches(self) -> None:
        if self._patches is not None:
            self._patches.remove()
            self._picker.remove()
            self._patches = self._picker = None

    # The user's choices

    def _pick_face(self, number: int | None) -> None:
        if self._patches is not None:
            self._patches.mark([])
            self._patches.highlight(number)

    def _switch_face(self, number: int, on: bool) -> None:
        key = self.session.faces()[number].key
        if on:
            self.session.off.discard(key)
        else:
            self.session.off.add(key)
        if self._patches is not None:
            self._patches.set_visible(number, on)

    def _pick_message(self, finding: Finding) -> None:
        if self._patches is None:
            return
        self._faces.pick(None)
        edges = self.session.drawn.edges
        lines = [edges[k].points for k in finding.edges if k < len(edges)]
        self._patches.mark(lines, finding.points)

    def _choose_engine(self, number: int) -> None:
        self.session.engine = pipeline.ENGINES[number]
        self.start()

    def _choose_reading(self, number: int) -> None:
        self.session.reading = number
        self._show_faces()

    def _use_selection(self) -> None:
        links = selection.drawing_links() or self.session.links
        before = self.session.links
        self.session.links = links
        try:
            self.session.extract()
        except FaceformerError as error:
            self.session.links = before
            show_error(error)
            return
        self._remove_patches()
        self.start()

    def _read_options(self) -> None:
        self.session.scale = self._scale.value()
        self.session.flip = self._flip.isChecked()
        self.session.orientation = pipeline.ORIENTATIONS[self._orientation.currentIndex()]

    # Widgets

    def _build(self) -> None:
        self.form = QtWidgets.QWidget()
        self.form.setObjectName("Faceformer_Panel")
        self.form.setWindowTitle(translate("Faceformer", "Identify Faces"))
        self.form.setWindowIcon(QtGui.QIcon(icon("Faceformer_IdentifyFaces")))
        layout = QtWidgets.QVBoxLayout(self.form)
        layout.setContentsMargins(4, 4, 4, 4)
        layout.addLayout(self._build_head())
        self._bar = QtWidgets.QProgressBar()
        self._bar.setRange(0, 100)
        self._bar.setVisible(False)
        layout.addWidget(self._bar)
        self._faces = FaceList(self._pick_face, self._switch_face)
        layout.addWidget(self._faces)
        self._messages_label = QtWidgets.QLabel(translate("Faceformer", "Messages"))
        self._messages_label.setVisible(False)
        layout.addWidget(self._messages_label)
        self._messages = MessageList(self._pick_message)
        self._messages.setVisible(False)
        layout.addWidget(self._messages)
        layout.addLayout(self._build_options())

    def _build_head(self) -> QtWidgets.QHBoxLayout:
        head = QtWidgets.QHBoxLayout()
        self._head = QtWidgets.QLabel()
        self._head.setSizePolicy(QtWidgets.QSizePolicy.Ignored, QtWidgets.QSizePolicy.Preferred)
        head.addWidget(self._head, 1)
        button = QtWidgets.QToolButton()
        button.setObjectName("Faceformer_UseSelection")
        button.setIcon(QtGui.QIcon(":/icons/view-refresh.svg"))
        button.setToolTip(
            translate("Faceformer", "Takes the selected lines, or reads the drawing again")
        )
        button.clicked.connect(lambda *_: self._use_selection())
        head.addWidget(button)
        return head

    def _build_options(self) -> QtWidgets.QFormLayout:
        options = QtWidgets.QFormLayout()
        self._reading_label = QtWidgets.QLabel(translate("Faceformer", "Reading"))
        self._reading = _narrow_box()
        self._reading.currentIndexChanged.connect(self._choose_reading)
        options.addRow(self._reading_label, self._reading)
        self._engine = _narrow_box()
        self._engine.addItems(pipeline.ENGINES)
        self._engine.setCurrentIndex(pipeline.ENGINES.index(self.session.engine))
        self._engine.currentIndexChanged.connect(self._choose_engine)
        options.addRow(translate("Faceformer", "Engine"), self._engine)
        self._scale = QtWidgets.QDoubleSpinBox()
        self._scale.setDecimals(4)
        self._scale.setRange(1e-4, 1e6)
        self._scale.setValue(self.session.scale)
        options.addRow(translate("Faceformer", "Scale"), self._scale)
        self._orientation = _narrow_box()
        self._orientation.addItems(
            [translate("Faceformer", "Upright"), translate("Faceformer", "As drawn")]
        )
        self._orientation.setCurrentIndex(pipeline.ORIENTATIONS.index(self.session.orientation))
        options.addRow(translate("Faceformer", "Orientation"), self._orientation)
        self._flip = QtWidgets.QCheckBox(translate("Faceformer", "Flip depth"))
        self._flip.setChecked(self.session.flip)
        options.addRow("", self._flip)
        return options


def _narrow_box() -> QtWidgets.QComboBox:
    """A combo box that does not make the panel wider than FreeCAD's side bar."""
    box = QtWidgets.QComboBox()
    box.setMinimumContentsLength(6)
    box.setSizeAdjustPolicy(QtWidgets.QComboBox.AdjustToMinimumContentsLengthWithIcon)
    return box
