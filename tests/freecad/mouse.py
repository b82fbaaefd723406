# SPDX-License-Identifier: LGPL-2.1-or-later
"""Mouse clicks and screenshots in FreeCAD's window. QtTest is not everywhere, events are."""

from freecad.Faceformer.qt import QtCore, QtGui, QtWidgets
from harness import OUTPUT

Event = QtCore.QEvent
LEFT, NONE = QtCore.Qt.LeftButton, QtCore.Qt.NoButton


def wait(milliseconds):
    """Lets the window work for a while."""
    clock = QtCore.QElapsedTimer()
    clock.start()
    while clock.elapsed() < milliseconds:
        QtWidgets.QApplication.processEvents(QtCore.QEventLoop.AllEvents, 20)


def wait_until(condition, milliseconds=10_000):
    """Lets the window work until something holds; says whether it came to hold."""
    clock = QtCore.QElapsedTimer()
    clock.start()
    while clock.elapsed() < milliseconds:
        QtWidgets.QApplication.processEvents(QtCore.QEventLoop.AllEvents, 20)
        if condition():
            return True
    return False


def click(widget, where=None, keys=QtCore.Qt.NoModifier):
    """Moves the mouse to a place in a widget, presses and releases the left button."""
    where = where or widget.rect().center()
    steps = (
        (Event.MouseMove, NONE, NONE),
        (Event.MouseButtonPress, LEFT, LEFT),
        (Event.MouseButtonRelease, LEFT, NONE),
    )
    for kind, button, buttons in steps:
        event = QtGui.QMouseEvent(
            kind,
            QtCore.QPointF(where),
            QtCore.QPointF(widget.mapToGlobal(where)),
            button,
            buttons,
            keys,
        )
        QtWidgets.QApplication.sendEvent(widget, event)
        wait(80)


def click_3d(window, view, point, keys=QtCore.Qt.NoModifier):
    """Clicks on a point of the model in the 3D view."""
    canvas = next(
        widget
        for widget in window.findChildren(QtWidgets.QWidget)
        if widget.metaObject().className() == "QOpenGLWidget" and widget.isVisible()
    )
    x, y = view.getPointOnScreen(point)
    share = canvas.width() / float(view.getSize()[0])
    click(canvas, QtCore.QPoint(int(x * share), canvas.height() - 1 - int(y * share)), keys)


def tool_button(window, command):
    """The visible toolbar button of a command."""
    return next(
        button
        for button in window.findChildren(QtWidgets.QToolButton)
        if button.defaultAction() is not None
        and button.defaultAction().objectName() == command
        and button.isVisible()
    )


def click_item(tree, row, column=0):
    """Clicks on a row of a list."""
    rect = tree.visualItemRect(tree.topLevelItem(row))
    x = tree.columnViewportPosition(column) + tree.columnWidth(column) // 2
    click(tree.viewport(), QtCore.QPoint(x, rect.center().y()))


def click_message(messages, row):
    """Clicks on a row of the list of messages."""
    item = messages.item(row)
    messages.scrollToItem(item)
    click(messages.viewport(), messages.visualItemRect(item).center())


def screenshot(name):
    """Keeps a picture of the whole screen: grabbing the window leaves the 3D view grey."""
    picture = QtWidgets.QApplication.primaryScreen().grabWindow(0)
    picture.save(str(OUTPUT / f"{name}.png"))
