# SPDX-License-Identifier: LGPL-2.1-or-later
import json
import math
import unittest

import FreeCAD
import Part

from ..errors import BadInput
from ..extract import extract, normalise, sample

V = FreeCAD.Vector


class DocumentTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("FaceformerTest")

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def sketch(self, placement=None):
        sketch = self.document.addObject("Sketcher::SketchObject", "Sketch")
        if placement is not None:
            sketch.Placement = placement
        sketch.addGeometry(
            [Part.LineSegment(V(0, 0), V(10, 0)), Part.Circle(V(4, 3), V(0, 0, 1), 2)], False
        )
        sketch.addGeometry(Part.LineSegment(V(0, 0), V(50, 50)), True)
        self.document.recompute()
        return sketch


class ExtractTest(DocumentTest):
    def test_a_sketch_gives_its_own_coordinates_without_construction_lines(self):
        placement = FreeCAD.Placement(V(1, 2, 3), FreeCAD.Rotation(V(1, 1, 0), 40))
        drawn = extract(self.sketch(placement))
        self.assertEqual(len(drawn.edges), 2)
        line = next(edge for edge in drawn.edges if len(edge.points) == 2)
        self.assertAlmostEqual(line.points[1][0], 10)
        self.assertAlmostEqual(line.points[1][1], 0)
        self.assertTrue(drawn.placement.Base.isEqual(placement.Base, 1e-9))
        self.assertTrue(drawn.placement.Rotation.isSame(placement.Rotation, 1e-9))

    def test_points_of_a_circle_lie_on_it_and_close_it(self):
        drawn = extract(self.sketch())
        circle = next(edge for edge in drawn.edges if len(edge.points) > 2)
        for x, y in circle.points:
            self.assertAlmostEqual(math.hypot(x - 4, y - 3), 2, places=12)
        self.assertEqual(circle.points[0], circle.points[-1])

    def test_a_sketch_in_a_moved_part_gives_the_models_plane(self):
        part = self.document.addObject("App::Part", "Part")
        part.Placement = FreeCAD.Placement(V(0, 0, 7), FreeCAD.Rotation())
        sketch = self.sketch(FreeCAD.Placement(V(5, 0, 0), FreeCAD.Rotation()))
        part.addObject(sketch)
        self.document.recompute()
        drawn = extract(sketch)
        self.assertTrue(drawn.placement.Base.isEqual(V(5, 0, 7), 1e-9))
        line = next(edge for edge in drawn.edges if len(edge.points) == 2)
        self.assertAlmostEqual(line.points[1][0], 10)

    def test_edges_of_a_solid_in_one_plane_are_a_drawing(self):
        box = self.document.addObject("Part::Box", "Box")
        self.document.recompute()
        top = [
            f"Edge{k}"
            for k, edge in enumerate(box.Shape.Edges, 1)
            if all(abs(vertex.Z - 10) < 1e-9 for vertex in edge.Vertexes)
        ]
        drawn = extract((box, top))
        self.assertEqual([edge.name for edge in drawn.edges], top)
        self.assertAlmostEqual(drawn.placement.Base.z, 10)

    def test_edges_of_several_objects_are_named_after_their_objects(self):
        first, second = self.sketch(), self.sketch()
        names = [edge.name for edge in extract([first, (second, "Edge1")]).edges]
        self.assertIn(f"{second.Label}.Edge1", names)
        self.assertEqual(len(names), 3)

    def test_a_shape_of_edges_needs_no_document(self):
        wire = Part.makePolygon([V(0, 0, 2), V(3, 0, 2), V(3, 3, 2)])
        self.assertEqual(len(extract(wire).edges), 2)

    def test_the_edge_list_is_json(self):
        data = json.loads(extract(self.sketch()).to_json())
        self.assertEqual({tuple(sorted(edge)) for edge in data["edges"]}, {("name", "points")})

    def test_edges_that_lie_in_no_plane_are_refused_by_name(self):
        wire = Part.makePolygon([V(0, 0, 0), V(30, 0, 0), V(30, 30, 0), V(0, 30, 0), V(9, 9, 5)])
        with self.assertRaisesRegex(BadInput, "Edge4 is .* off the plane"):
            extract(wire)

    def test_edges_on_one_line_are_refused(self):
        with self.assertRaisesRegex(BadInput, "one straight line"):
            extract(Part.makePolygon([V(0, 0, 0), V(1, 1, 0), V(2, 2, 0)]))

    def test_a_solid_is_refused_with_the_way_to_draw_it(self):
        with self.assertRaisesRegex(BadInput, "Wireframe from Solid"):
            extract(Part.makeBox(1, 1, 1))

    def test_a_filled_draft_wire_is_a_drawing(self):
        import Draft

        wire = Draft.make_wire([V(0, 0), V(4, 0), V(4, 3)], closed=True, face=True)
        self.document.recompute()
        self.assertEqual(len(wire.Shape.Faces), 1)
        self.assertEqual(len(extract(wire).edges), 3)

    def test_coordinates_that_are_no_numbers_are_refused_by_name(self):
        sketch = self.sketch()
        sketch.Placement = FreeCAD.Placement(V(math.nan, 0, 0), FreeCAD.Rotation())
        with self.assertRaisesRegex(BadInput, "Edge1 has a coordinate"):
            extract(sketch)

    def test_an_empty_sketch_is_refused(self):
        empty = self.document.addObject("Sketcher::SketchObject", "Empty")
        self.document.recompute()
        with self.assertRaises(BadInput):
            extract(empty)

    def test_a_missing_edge_is_refused_by_name(self):
        with self.assertRaisesRegex(BadInput, "Edge99 is not there"):
            extract((self.sketch(), "Edge99"))

    def test_a_spline_is_sampled_span_by_span(self):
        curve = Part.BSplineCurve()
        curve.interpolate([V(0, 0), V(3, 4), V(8, 1), V(12, 5)])
        edge = curve.toShape()
        points = sample(edge)
        self.assertGreater(len(points), 48)
        self.assertLess(max(curve.toShape().distToShape(Part.Vertex(p))[0] for p in points), 1e-7)

    def test_a_spline_that_is_a_segment_has_two_points(self):
        curve = Part.LineSegment(V(0, 0), V(5, 5)).toBSpline()
        self.assertEqual(len(sample(curve.toShape())), 2)


class NormaliseTest(DocumentTest):
    def test_every_form_of_a_source_is_one_list(self):
        sketch = self.sketch()
        whole = [(sketch, ())]
        for source in (sketch, [sketch], (sketch, ""), [(sketch, ("",))], (sketch, [])):
            self.assertEqual(normalise(source), whole, source)
        self.assertEqual(normalise((sketch, "Edge1")), [(sketch, ("Edge1",))])
        pairs = [(sketch, "Edge1"), (sketch, ["Edge2", "Edge1"])]
        self.assertEqual(normalise(pairs), [(sketch, ("Edge1", "Edge2"))])

    def test_faces_and_vertices_are_refused_by_name(self):
        for name in ("Face1", "Vertex2"):
            with self.assertRaisesRegex(BadInput, f"{name} is not an edge"):
                normalise((self.sketch(), name))

    def test_an_empty_selection_is_refused(self):
        for source in (None, [], ()):
            with self.assertRaisesRegex(BadInput, "Nothing is selected"):
                normalise(source)

    def test_what_is_no_source_is_refused(self):
        with self.assertRaisesRegex(BadInput, "taken from int"):
            normalise(5)
