# SPDX-License-Identifier: LGPL-2.1-or-later
"""Qt through FreeCAD's wrapper only: it is Qt 5 or Qt 6, whichever FreeCAD was built with."""

from PySide import QtCore, QtGui

try:
    from PySide import QtWidgets
except ImportError:  # FreeCAD before 0.21 keeps the widgets in QtGui
    QtWidgets = QtGui

__all__ = ["QtCore", "QtGui", "QtWidgets", "execute", "flags"]


def flags(value) -> int:
    """A Qt flag as an integer, as FreeCAD's task panels want it; Qt 6 flags are no integers."""
    return int(getattr(value, "value", value))


def execute(runnable) -> int:
    """Runs a dialog or an event loop until it ends; Qt 6 has no ``exec_``."""
    return runnable.exec_() if hasattr(runnable, "exec_") else runnable.exec()
