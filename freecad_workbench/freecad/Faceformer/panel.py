# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel: faces that were found, messages, choices, and the button that converts."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui

from . import icon, patches, preferences, selection
from .errors import FaceformerError
from .i18n import translate
from .model import Finding
from .panel_form import PanelForm
from .picking import Picker
from .qt import QtCore, QtGui, QtWidgets, flags
from .report import show_error
from .session import Outcome, Session
from .show import face_drawing, show_solid, view_3d
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
    face_drawing(session.drawn.placement)
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
        self.patches: patches.Patches | None = None
        self._picker: Picker | None = None
        self._ok: Any = None
        self.form = PanelForm(session.engine, session.options())
        self._connect()
        self._timer = QtCore.QTimer(self.form)
        self._timer.timeout.connect(self._poll)
        FreeCADGui.Selection.addSelectionGate(selection.DrawingGate())
        self._observer = _DocumentObserver(self)
        FreeCAD.addDocumentObserver(self._observer)
        self._show_target(False)
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
            built = run(self.session.build())
            solid = self.session.convert()
        except FaceformerError as error:
            if not is_cancelled(error):
                self._show_messages(error)
            return False
        new = self.session.target is None
        self.close()
        if new:
            show_solid(solid, built, self.session.outcome.drawing)
        return True

    def reject(self) -> bool:
        """Closes without a change to the document."""
        self.close()
        return True

    # Life

    def start(self) -> None:
        """Starts the identification."""
        self._stop_task()
        self._show_source()
        self._task = Task(self.session.work())
        self.form.show_progress(self._task.label())
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
        self._show_target(True)
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
        self.form.show_progress(task.label(), task.share)
        if not task.wait(0):
            return
        self._timer.stop()
        self._task = None
        self.form.show_progress(None)
        try:
            self.session.outcome = task.result()
        except Exception as error:  # a fault of the work itself is shown like any other
            self.session.outcome = Outcome(error=error)
        self.show_outcome()

    # Showing

    def show_outcome(self) -> None:
        """Shows what the session knows now."""
        outcome = self.session.outcome
        count = len(outcome.identified.identification.readings) if outcome.identified else 0
        self.session.reading = min(self.session.reading, max(count - 1, 0))
        self.form.show_readings(count, self.session.reading)
        self._show_faces()
        self._show_messages(outcome.error)
        self._update_buttons()

    def _show_faces(self) -> None:
        faces = self.session.faces()
        self.form.faces.show_faces(faces, self.session.off)
        drawing, view = self.session.outcome.drawing, view_3d()
        if drawing is None or view is None:
            self._remove_patches()
            return
        if self.patches is None:
            self.patches = patches.Patches(
                view, self.session.drawn.placement, preferences.transparency()
            )
            self._picker = Picker(view, self.session.drawn.placement, self.form.faces.pick)
        self.patches.show(drawing, faces)
        self._picker.show([face.outline(drawing) for face in faces])
        for number, face in enumerate(faces):
            self.patches.set_visible(number, face.key not in self.session.off)

    def _show_messages(self, error: BaseException | None = None) -> None:
        outcome = self.session.outcome
        findings = list(outcome.drawing.findings) if outcome.drawing else []
        if outcome.identified:
            notices = outcome.identified.identification.notices
            findings += [Finding("notice", text, (), ()) for text in notices]
            findings = [*run(self.session.conflicts), *findings]
        if error is not None and not is_cancelled(error):
            FreeCAD.Console.PrintLog(f"Faceformer: {error}\n")
            if str(error) not in [finding.message for finding in findings]:
                findings.insert(0, Finding("error", str(error), (), ()))
        self.form.show_messages(findings)

    def _show_target(self, visible: bool) -> None:
        """Takes the edited solid out of the way of its drawing."""
        target = self.session.target
        if target is not None and target.ViewObject is not None:
            target.ViewObject.Visibility = visible

    def _show_source(self) -> None:
        count = len(self.session.drawn.edges)
        text = translate("Faceformer", "{}: {} edges").format(self.session.source_label(), count)
        self.form.show_source(text)

    def _update_buttons(self) -> None:
        if self._ok is not None:
            self._ok.setEnabled(bool(self.session.faces()) and not self.busy())

    def _remove_patches(self) -> None:
        if self.patches is not None:
            self.patches.remove()
            self._picker.remove()
            self.patches = self._picker = None

    # What the user does

    def _pick_faces(self, numbers: list[int]) -> None:
        if self.patches is not None:
            self.patches.mark([])
            self.patches.highlight(numbers)

    def _switch_face(self, number: int, on: bool) -> None:
        key = self.session.faces()[number].key
        if on:
            self.session.off.discard(key)
        else:
            self.session.off.add(key)
        if self.patches is not None:
            self.patches.set_visible(number, on)
        self._show_messages()

    def _pick_message(self, finding: Finding) -> None:
        if self.patches is None:
            return
        self.form.faces.pick(*finding.faces)
        edges = self.session.drawn.edges
        lines = [edges[k].points for k in finding.edges if k < len(edges)]
        self.patches.mark(lines, finding.points)

    def _choose_engine(self, engine: str) -> None:
        self.session.engine = engine
        self.start()

    def _cancel(self) -> None:
        if self._task is not None:
            self._task.cancel()

    def _choose_reading(self, number: int) -> None:
        self.session.reading = number
        self._show_faces()
        self._show_messages()

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
        self.session.scale = self.form.scale()
        self.session.flip = self.form.flip()
        self.session.orientation = self.form.orientation()

    def _connect(self) -> None:
        self.form.refreshed.connect(self._use_selection)
        self.form.cancelled.connect(self._cancel)
        self.form.engine_chosen.connect(self._choose_engine)
        self.form.reading_chosen.connect(self._choose_reading)
        self.form.faces_picked.connect(self._pick_faces)
        self.form.face_switched.connect(self._switch_face)
        self.form.message_picked.connect(self._pick_message)
