# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of the round trips: each real part, its wireframe, and the solid that came of it.

Needs a window; with FACEFORMER_LIBRARY set, in the root:

    xvfb-run -a -s "-screen 0 1280x800x24 -dpi 96" freecad tests/freecad/round_trip_pictures.py \
        -M "$PWD/freecad_workbench"

and round_trips.png is in the folder FACEFORMER_OUTPUT, or here.
"""

import math

import FreeCAD
import FreeCADGui
from freecad.Faceformer import api
from freecad.Faceformer.errors import FaceformerError
from freecad.Faceformer.qt import QtCore, QtGui
from harness import OUTPUT, check, run
from mouse import wait
from real_parts import real_parts

V = FreeCAD.Vector
DIRECTION = V(1.0, -1.3, 0.8)
WIDTH, HEIGHT, TEXT = 210, 160, 18
ACROSS = 2
"""Parts beside each other."""


def show_alone(document, obj):
    """Hides all but one object."""
    for other in document.Objects:
        other.ViewObject.Visibility = other is obj


def picture(view, rotation, name):
    """The view from one side, as an image."""
    view.setCameraOrientation(rotation.Q)
    view.fitAll()
    wait(150)
    path = str(OUTPUT / f"{name}.png")
    view.saveImage(path, 2 * WIDTH, 2 * HEIGHT, "White")
    image = QtGui.QImage(path).scaled(
        WIDTH, HEIGHT, QtCore.Qt.KeepAspectRatio, QtCore.Qt.SmoothTransformation
    )
    (OUTPUT / f"{name}.png").unlink()
    return image


def pictures(part):
    """The part, its wireframe and its solid; None in the place of what there is none of."""
    document = FreeCAD.newDocument("Picture")
    view = FreeCADGui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    view.setCameraType("Orthographic")
    from_above = FreeCAD.Rotation()
    # As the sketch shows it: the viewer is at the direction's end, the model's z axis upwards.
    across = V(0, 0, 1).cross(DIRECTION)
    as_drawn = FreeCAD.Rotation(across, V(0, 0, 1), DIRECTION, "ZXY")
    original = document.addObject("Part::Feature", "Original")
    original.Shape = part.shape()
    found = []
    try:
        show_alone(document, original)
        found.append(picture(view, as_drawn, "original"))
        sketch = api.wireframe(original, DIRECTION)
        sketch.ViewObject.LineColor = (0.1, 0.1, 0.1)
        sketch.ViewObject.PointSize = 1
        show_alone(document, sketch)
        found.append(picture(view, from_above, "sketch"))
        solid = api.to_solid(sketch, orientation="drawn")
        solid.ViewObject.ShapeColor = (0.55, 0.75, 0.55)
        show_alone(document, solid)
        found.append(picture(view, from_above, "solid"))
    except FaceformerError as error:
        print(f"{part.file}: {error}", flush=True)
    FreeCAD.closeDocument(document.Name)
    return found


def main():
    parts = real_parts()
    rows = math.ceil(len(parts) / ACROSS)
    sheet = QtGui.QImage(ACROSS * 3 * WIDTH, rows * (HEIGHT + TEXT), QtGui.QImage.Format_RGB32)
    sheet.fill(QtGui.QColor("white"))
    painter = QtGui.QPainter(sheet)
    for number, part in enumerate(parts):
        left = number // rows * 3 * WIDTH
        top = number % rows * (HEIGHT + TEXT)
        painter.drawText(left + 6, top + 14, f"{number + 1}. {part.name}")
        found = pictures(part)
        for column, image in enumerate(found):
            painter.drawImage(left + column * WIDTH, top + TEXT, image)
        if len(found) < 3:
            painter.drawText(left + 2 * WIDTH + 60, top + TEXT + HEIGHT // 2, "no solid")
    painter.end()
    path = OUTPUT / "round_trips.png"
    check(sheet.save(str(path)), f"{path} is written")


QtCore.QTimer.singleShot(1500, lambda: run(main))
