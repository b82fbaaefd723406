# SPDX-License-Identifier: LGPL-2.1-or-later
import math
import unittest

import FreeCAD
import Part

from .. import sketch_writer
from ..errors import BadInput
from ..model import Drawing
from ..wireframe import camera, extraction, hidden_corners, project
from .test_extract import DocumentTest
from .test_model import NAMES, REPORT

V = FreeCAD.Vector


class WireframeTest(unittest.TestCase):
    def test_the_viewer_looks_along_z_and_the_model_stands_upright(self):
        rotation = camera((1, -1.3, 0.8))
        seen = rotation.multVec(V(1, -1.3, 0.8).normalize())
        self.assertTrue(seen.isEqual(V(0, 0, 1), 1e-12))
        up = rotation.multVec(V(0, 0, 1))
        self.assertAlmostEqual(up.x, 0)
        self.assertGreater(up.y, 0)

    def test_seen_from_above_the_models_axes_are_the_sketchs(self):
        self.assertTrue(camera((0, 0, 2)).isSame(FreeCAD.Rotation(), 1e-12))

    def test_a_box_has_its_twelve_edges_where_its_corners_are_seen(self):
        box = Part.makeBox(40, 30, 20)
        direction = (1, -1.3, 0.8)
        pieces = project(box, direction)
        self.assertEqual(len(pieces), 12)
        corners = [camera(direction).multVec(vertex.Point) for vertex in box.Vertexes]
        for piece in pieces:
            for vertex in piece.Vertexes:
                gaps = [math.hypot(vertex.X - c.x, vertex.Y - c.y) for c in corners]
                self.assertLess(min(gaps), 1e-9)

    def test_a_placed_shape_is_drawn_where_it_is(self):
        box = Part.makeBox(1, 2, 3)
        box.Placement = FreeCAD.Placement(V(10, 20, 30), FreeCAD.Rotation(V(0, 0, 1), 30))
        corners = [camera((1, -1, 1)).multVec(vertex.Point) for vertex in box.Vertexes]
        box_of_pieces = Part.makeCompound(project(box, (1, -1, 1))).BoundBox
        self.assertAlmostEqual(box_of_pieces.XMin, min(c.x for c in corners))
        self.assertAlmostEqual(box_of_pieces.YMax, max(c.y for c in corners))

    def test_a_cylinder_has_two_silhouettes_and_no_seam(self):
        pieces = project(Part.makeCylinder(5, 20), (1, -1.3, 0.8))
        lines = [
            piece for piece in pieces if isinstance(piece.Curve, (Part.Line, Part.LineSegment))
        ]
        self.assertEqual(len(lines), 2)
        gap = abs(lines[0].Vertexes[0].X - lines[1].Vertexes[0].X)
        self.assertAlmostEqual(gap, 10)

    def test_the_extraction_names_the_pieces(self):
        drawn = extraction(Part.makeBox(1, 2, 3), (1, -1.3, 0.8))
        self.assertEqual(drawn.edges[0].name, "Edge1")
        self.assertTrue(all(len(edge.points) == 2 for edge in drawn.edges))

    def test_corners_that_cover_each_other_are_counted(self):
        cube = Part.makeBox(10, 10, 10)
        self.assertEqual(hidden_corners(cube, (1, -1.3, 0.8)), 0)
        self.assertEqual(hidden_corners(cube, (1, -1, 1)), 1)
        self.assertEqual(hidden_corners(cube, (0, 0, 1)), 4)

    def test_a_direction_without_length_is_refused(self):
        for direction in ((0, 0, 0), (math.nan, 0, 1)):
            with self.assertRaisesRegex(BadInput, "no length"):
                camera(direction)
        with self.assertRaisesRegex(BadInput, "three numbers"):
            camera((1, 2))


class SketchWriterTest(DocumentTest):
    def test_the_curves_of_a_drawing_meet_at_its_vertices(self):
        sketch = self.document.addObject("Sketcher::SketchObject", "Sketch")
        geometry, joints = sketch_writer.convert(Drawing.parse(REPORT, NAMES))
        sketch_writer.write(sketch, geometry, joints)
        self.document.recompute()
        self.assertEqual(len(joints), 3)
        self.assertEqual(len(sketch.Shape.Vertexes), 3)
        kinds = [type(curve).__name__ for curve in sketch.Geometry]
        self.assertEqual(kinds, ["LineSegment", "LineSegment", "ArcOfCircle"])
        self.assertTrue(sketch.isValid())

    def test_an_elliptic_arc_keeps_its_ends_and_its_way(self):
        for sweep in (1.2, -1.2):
            axis = sketch_writer.Ellipse((3, 1), (2, 2), 0.4, 0.7, sweep)
            arc = sketch_writer.arc(axis)
            ends = {(round(p.x, 9), round(p.y, 9)) for p in (arc.StartPoint, arc.EndPoint)}
            expected = set()
            for t in (0.7, 0.7 + sweep):
                c, s = math.cos(t), math.sin(t)
                expected.add((round(3 + 2 * c - 0.8 * s, 9), round(1 + 2 * c + 0.8 * s, 9)))
            self.assertEqual(ends, expected)
            self.assertLess(arc.length(), 4)

    def test_a_piece_of_hidden_line_removal_keeps_its_shape(self):
        for piece in project(Part.makeCylinder(5, 20), (1, -1.3, 0.8)):
            again = sketch_writer.piece(piece).toShape()
            self.assertAlmostEqual(again.Length, piece.Length)
            middle = again.valueAt(sum(again.ParameterRange) / 2)
            self.assertLess(piece.distToShape(Part.Vertex(middle))[0], 1e-7)
