# SPDX-License-Identifier: LGPL-2.1-or-later
"""Long work on a thread, so that the window stays alive and the user can cancel.

The work itself must not touch FreeCAD or Qt; the library releases the interpreter lock.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import FreeCAD

from .errors import Cancelled
from .i18n import mark, translate
from .pipeline import Progress

Work = Callable[[Progress], Any]

QUICK = 0.3
"""Seconds that a command waits before it shows a progress dialog."""

STAGES = {
    "drawing": mark("Faceformer", "Reading the drawing"),
    "identify": mark("Faceformer", "Identifying faces"),
    "lift": mark("Faceformer", "Recovering depth"),
    "plan": mark("Faceformer", "Planning the solid"),
    "build": mark("Faceformer", "Building the solid"),
}


class Task:
    """A function that runs on a thread of its own."""

    def __init__(self, work: Work):
        self.stage = ""
        self.share = 0.0
        self._cancelled = threading.Event()
        self._value: Any = None
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._run, args=(work,), daemon=True)
        self._thread.start()

    def cancel(self) -> None:
        """Asks the work to stop; it ends with `Cancelled` at its next report."""
        self._cancelled.set()

    def wait(self, seconds: float) -> bool:
        """Waits that long at most, and says whether the work has ended."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def result(self) -> Any:
        """What the work returned; raises what it raised."""
        if self._error is not None:
            raise self._error
        return self._value

    def label(self) -> str:
        """What the work is doing, for the user."""
        return translate("Faceformer", STAGES.get(self.stage, "Working"))

    def _run(self, work: Work) -> None:
        try:
            self._value = work(self._report)
        except BaseException as error:  # handed to the thread that asks for the result
            self._error = error

    def _report(self, stage: str, share: float) -> bool:
        self.stage, self.share = stage, share
        return not self._cancelled.is_set()


def run(work: Work) -> Any:
    """Runs work with a progress dialog and a cancel button; in the console, on the spot."""
    if not FreeCAD.GuiUp:
        return work(lambda _stage, _share: True)
    task = Task(work)
    if not task.wait(QUICK):
        _wait_in_dialog(task)
    return task.result()


def _wait_in_dialog(task: Task) -> None:
    import FreeCADGui

    from .qt import QtCore, QtWidgets, execute

    dialog = QtWidgets.QProgressDialog(FreeCADGui.getMainWindow())
    dialog.setWindowTitle("Faceformer")
    dialog.setCancelButtonText(translate("Faceformer", "Cancel"))
    dialog.setWindowModality(QtCore.Qt.ApplicationModal)
    dialog.setAutoClose(False)
    dialog.setAutoReset(False)
    dialog.setRange(0, 100)
    dialog.canceled.connect(task.cancel)
    dialog.show()
    loop = QtCore.QEventLoop()
    timer = QtCore.QTimer()

    def look() -> None:
        dialog.setLabelText(task.label() + "...")
        dialog.setValue(int(100 * task.share))
        if task.wait(0):
            loop.quit()

    timer.timeout.connect(look)
    timer.start(40)
    execute(loop)
    timer.stop()
    dialog.canceled.disconnect(task.cancel)
    dialog.close()


def is_cancelled(error: BaseException) -> bool:
    """Whether an error only says that the user stopped the work."""
    return isinstance(error, Cancelled)
