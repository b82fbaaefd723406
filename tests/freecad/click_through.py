# SPDX-License-Identifier: LGPL-2.1-or-later
"""The two clicks in FreeCAD's window: Identify Faces, Convert to Solid. Run under Xvfb."""

import re
import time
from dataclasses import replace

import FreeCAD
import FreeCADGui
import Part
from freecad.Faceformer import api, panel, worker
from freecad.Faceformer.errors import Cancelled
from freecad.Faceformer.model import Identification
from freecad.Faceformer.qt import QtCore, QtWidgets
from harness import check, refuses, run
from mouse import (
    click,
    click_3d,
    click_item,
    click_message,
    screenshot,
    tool_button,
    wait,
    wait_until,
)

V = FreeCAD.Vector
NAMES = ("IdentifyFaces", "ConvertToSolid", "FlipDepth", "WireframeFromSolid")
FACES = 10
"""Faces of the part, with each half of a hole's cylinder counted."""


def part():
    """A bracket with a hole."""
    body = Part.makeBox(50, 36, 10).fuse(Part.makeBox(10, 36, 34)).removeSplitter()
    return body.cut(Part.makeCylinder(8, 40, V(31, 18, -10)))


def buttons(window):
    """Which of the workbench's buttons are on, by the names of their commands."""
    return {name for name in NAMES if tool_button(window, f"Faceformer_{name}").isEnabled()}


def select(document, *links):
    """Selects objects, or (object, edge) pairs, as a click in the tree does."""
    FreeCADGui.Selection.clearSelection()
    for link in links:
        obj, names = link if isinstance(link, tuple) else (link, ())
        FreeCADGui.Selection.addSelection(document.Name, obj.Name, *names)


def test_buttons(window, document, sketch, solid):
    """Buttons are on for what they can work on, and grey otherwise."""
    cases = (
        ("nothing", (), set()),
        ("a sketch", (sketch,), {"IdentifyFaces", "ConvertToSolid"}),
        ("an edge", ((sketch, ("Edge1",)),), {"IdentifyFaces", "ConvertToSolid"}),
        ("a face", ((solid, ("Face1",)),), {"WireframeFromSolid"}),
        ("a sketch and a solid", (sketch, solid), set()),
    )
    for what, links, expected in cases:
        select(document, *links)
        on = wait_until(lambda e=expected: buttons(window) == e, 3000)
        check(on, f"with {what} selected: {sorted(buttons(window))}")


def test_picking(window, view, document, sketch):
    """Edges are picked in the 3D view with the mouse."""
    FreeCADGui.Selection.clearSelection()
    for name, keys in (("Edge1", QtCore.Qt.NoModifier), ("Edge5", QtCore.Qt.ControlModifier)):
        edge = sketch.Shape.getElement(name)
        first, last = edge.ParameterRange
        click_3d(window, view, edge.valueAt(first + 0.37 * (last - first)), keys)
    picked = [n for entry in FreeCADGui.Selection.getSelectionEx() for n in entry.SubElementNames]
    check(picked == ["Edge1", "Edge5"], f"picked with the mouse: {picked}")


def test_identify(window, document, sketch):
    """The first click: patches and the panel."""
    select(document, sketch)
    wait_until(lambda: "IdentifyFaces" in buttons(window), 3000)
    screenshot("selected")
    undo = document.UndoCount
    click(tool_button(window, "Faceformer_IdentifyFaces"))
    found = wait_until(lambda: panel.current() is not None and not panel.current().busy())
    check(found, "the panel is open and has finished")
    wait(700)
    screenshot("faces")
    faces = window.findChild(QtWidgets.QTreeWidget, "Faceformer_Faces")
    check(faces.topLevelItemCount() == FACES, f"{faces.topLevelItemCount()} faces in the list")
    check(document.UndoCount == undo, "looking for faces changes nothing")
    click_item(faces, 2, 1)
    check(bool(faces.selectedItems()), "a click picks a row")
    wait(400)
    screenshot("picked")
    faces.clearSelection()


def test_convert(window, document):
    """The second click: a solid, and one undo step that takes it away."""
    objects = len(document.Objects)
    wait_until(lambda: "ConvertToSolid" in buttons(window), 3000)
    click(tool_button(window, "Faceformer_ConvertToSolid"))
    made = wait_until(lambda: len(document.Objects) == objects + 1, 5000)
    check(made, "the click makes one object")
    check(panel.current() is None, "the panel is closed")
    solid = document.Objects[-1]
    check(solid.isValid() and solid.Shape.isValid(), "the solid is valid")
    share = abs(solid.Shape.Volume / part().Volume - 1)
    check(share < 1e-3, f"its volume is right, off by {share:.2e}")
    wait(900)
    screenshot("solid")

    wait_until(lambda: "FlipDepth" in buttons(window), 3000)
    click(tool_button(window, "Faceformer_FlipDepth"))
    check(solid.Flip and solid.isValid(), "flip depth works on the only solid")
    wait(600)
    screenshot("flipped")
    document.undo()
    check(not solid.Flip, "one undo flips it back")

    FreeCADGui.ActiveDocument.setEdit(solid.Name)
    opened = wait_until(lambda: panel.current() is not None and not panel.current().busy())
    check(opened and panel.current().session.target is solid, "editing opens the panel")
    panel.current().reject()
    check(panel.current() is None, "and closing it ends the editing")
    test_edit(solid)

    document.undo()
    check(len(document.Objects) == objects, "one undo removes the solid")
    document.redo()
    check(len(document.Objects) == objects + 1, "one redo brings it back")


def test_edit(solid):
    """The panel changes a solid in one undo step."""
    volume = solid.Shape.Volume
    FreeCADGui.ActiveDocument.setEdit(solid.Name)
    wait_until(lambda: panel.current() is not None and not panel.current().busy())
    check(not solid.ViewObject.Visibility, "the solid makes room for its drawing")
    panel.current().form.findChild(QtWidgets.QDoubleSpinBox).setValue(2)
    check(panel.current().accept(), "the panel accepts a change")
    check(solid.ViewObject.Visibility, "the solid is back")
    check(abs(solid.Shape.Volume / volume - 8) < 1e-6, "twice the scale, eight times the volume")
    check(FreeCADGui.ActiveDocument.getInEdit() is None, "the editing has ended")
    solid.Document.undo()
    solid.Document.recompute()
    check(abs(solid.Shape.Volume / volume - 1) < 1e-6, "one undo takes it back")


def test_messages(window, document, sketch):
    """What is wrong in a drawing is said in the panel, and nothing is changed."""
    broken = document.copyObject(sketch)
    broken.Label = "Open Wireframe"
    for obj in document.Objects:
        obj.ViewObject.Visibility = obj is broken
    broken.addGeometry(Part.LineSegment(V(0, 0), V(14, 34)), False)
    document.recompute()
    select(document, broken)
    wait_until(lambda: "IdentifyFaces" in buttons(window), 3000)
    objects = len(document.Objects)
    click(tool_button(window, "Faceformer_IdentifyFaces"))
    wait_until(lambda: panel.current() is not None and not panel.current().busy())
    messages = window.findChild(QtWidgets.QListWidget, "Faceformer_Messages")
    check(messages.count() > 0, f"{messages.count()} messages on an open drawing")
    if messages.count():
        click_message(messages, messages.count() - 1)
    wait(500)
    screenshot("messages")
    check(not panel.current().accept(), "it cannot be converted")
    panel.current().reject()
    check(len(document.Objects) == objects, "and the document is as it was")


def merged(identified):
    """The same faces, with the first and a planar neighbour of it taken for one."""
    reading = identified.identification.readings[0]
    first = reading.faces[0]
    beside = next(
        k
        for k, face in enumerate(reading.faces)
        if k and face.kind == "plane" and set(face.edge_indices) & set(first.edge_indices)
    )
    raw = [dict(face) for face in reading.raw]
    raw[0]["loops"] = raw[0]["loops"] + raw.pop(beside)["loops"]
    # Another engine's name, so that nothing that is known of the right faces is taken for theirs.
    wrong = Identification.parse(
        {"engine": "by hand", "faces": raw}, identified.identification.drawing
    )
    return replace(identified, identification=wrong)


def test_conflict(window, document, sketch):
    """Wrong faces are said in the panel, and a click on that shows them and their vertices."""
    for obj in document.Objects:
        obj.ViewObject.Visibility = obj is sketch
    select(document, sketch)
    wait_until(lambda: "IdentifyFaces" in buttons(window), 3000)
    objects = len(document.Objects)
    click(tool_button(window, "Faceformer_IdentifyFaces"))
    wait_until(lambda: panel.current() is not None and not panel.current().busy())
    messages = window.findChild(QtWidgets.QListWidget, "Faceformer_Messages")
    texts = [messages.item(k).text() for k in range(messages.count())]
    check(not any("conflict" in text for text in texts), "right faces have no conflict")

    shown = panel.current()
    shown.session.outcome = replace(
        shown.session.outcome, identified=merged(shown.session.outcome.identified)
    )
    shown.show_outcome()
    texts = [messages.item(k).text() for k in range(messages.count())]
    told = [k for k, text in enumerate(texts) if text.startswith("Face 1 conflicts with face")]
    check(len(told) == 1, f"the wrong face is named: {texts}")
    click_message(messages, told[0])
    numbers, corners = re.match(
        r"Face 1 conflicts with faces? (.*) at vert\w+ (.*)", texts[told[0]]
    ).groups()
    expected = {1, *map(int, re.findall(r"\d+", numbers))}
    faces = window.findChild(QtWidgets.QTreeWidget, "Faceformer_Faces")
    rows = {int(item.text(0)) for item in faces.selectedItems()}
    check(rows == expected, f"a click selects its faces {sorted(expected)}: {sorted(rows)}")
    seen = {number + 1 for number in shown.patches.highlighted()}
    check(seen == expected, f"and brings them out in the 3D view: {sorted(seen)}")
    drawing = shown.session.outcome.drawing
    places = [drawing.vertices[int(v)] for v in re.findall(r"\d+", corners)]
    check(shown.patches.marked() == places, f"and marks its vertices: {shown.patches.marked()}")
    wait(600)
    screenshot("conflict")
    click_item(faces, 1, 1)
    check(shown.patches.marked() == [], "a click on another face takes the marks away")
    check(not shown.accept(), "wrong faces cannot be converted")
    texts = [messages.item(k).text() for k in range(messages.count())]
    check(any("conflicts" in text for text in texts), "and the conflict is still said")
    shown.reject()
    check(len(document.Objects) == objects, "and the document is as it was")


def test_wireframe(window, document, solid):
    """The way back asks for a direction and makes one sketch in one undo step."""
    select(document, solid)
    wait_until(lambda: "WireframeFromSolid" in buttons(window), 3000)
    objects, undo = len(document.Objects), document.UndoCount

    def accept():
        dialog = QtWidgets.QApplication.activeModalWidget()
        screenshot("direction")
        dialog.accept()

    QtCore.QTimer.singleShot(800, accept)
    click(tool_button(window, "Faceformer_WireframeFromSolid"))
    check(len(document.Objects) == objects + 1, "a wireframe is made")
    check(document.UndoCount == undo + 1, "in one undo step")
    document.undo()
    check(len(document.Objects) == objects, "which takes it away")


def test_cancel(window):
    """Long work shows a dialog, and its button ends the work."""

    def work(progress):
        while progress("build", 0.4):
            time.sleep(0.02)
        raise Cancelled("stopped")

    def press():
        dialog = window.findChild(QtWidgets.QProgressDialog)
        screenshot("progress")
        click(dialog.findChild(QtWidgets.QPushButton))

    QtCore.QTimer.singleShot(1200, press)
    refuses("cancelled work", ["stopped"], lambda: worker.run(work), Cancelled)
    check(not window.findChild(QtWidgets.QProgressDialog).isVisible(), "the dialog is gone")


def main():
    window = FreeCADGui.getMainWindow()
    window.setGeometry(0, 0, 1280, 800)
    FreeCADGui.activateWorkbench("FaceformerWorkbench")
    document = FreeCAD.newDocument("Bracket")
    solid = document.addObject("Part::Feature", "Bracket")
    solid.Shape = part()
    sketch = api.wireframe(solid, (1.0, -1.3, 0.8))
    solid.ViewObject.Visibility = False
    document.recompute()
    view = FreeCADGui.ActiveDocument.ActiveView
    view.viewTop()
    view.fitAll()
    wait(1200)
    test_buttons(window, document, sketch, solid)
    test_picking(window, view, document, sketch)
    test_identify(window, document, sketch)
    test_convert(window, document)
    test_messages(window, document, sketch)
    test_conflict(window, document, sketch)
    test_wireframe(window, document, solid)
    test_cancel(window)


QtCore.QTimer.singleShot(1500, lambda: run(main))
