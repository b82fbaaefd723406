# SPDX-License-Identifier: LGPL-2.1-or-later
import unittest

from ..errors import BadInput, Failed
from ..model import Drawing, Identification
from ..pipeline import (
    SolidOptions,
    Store,
    chosen_faces,
    names_in_errors,
    offered_faces,
    told_conflicts,
    with_names,
    with_numbers,
)
from .test_model import NAMES, REPORT

TWO = [{"type": "plane", "loops": [[1, 2, -3]]}, {"type": "cylinder", "loops": [[1, -1]]}]


class PipelineTest(unittest.TestCase):
    def setUp(self):
        data = {"engine": "varley", "faces": TWO, "alternatives": [{"faces": TWO[:1]}]}
        self.identification = Identification.parse(data, Drawing.parse(REPORT, NAMES))

    def test_faces_that_are_switched_off_are_left_out(self):
        off = (self.identification.faces[0].key,)
        chosen = chosen_faces(self.identification, SolidOptions(off=off))
        self.assertEqual(chosen, {"engine": "varley", "faces": TWO[1:]})

    def test_alternatives_are_offered_until_the_user_chooses(self):
        offered = offered_faces(self.identification, SolidOptions())
        self.assertEqual(offered["alternatives"], [{"faces": TWO[:1]}])
        self.assertGreater(SolidOptions().native()["alternatives"], 0)
        off = (self.identification.faces[0].key,)
        for options in (SolidOptions(reading=1), SolidOptions(off=off)):
            self.assertNotIn("alternatives", offered_faces(self.identification, options))
            self.assertEqual(options.native()["alternatives"], 0)

    def test_faces_in_messages_have_the_numbers_of_the_list(self):
        text = "face 1 conflicts with faces 2, 3 and 7 more at vertices 1 and 3"
        told = with_numbers(text, (2, 4, 5))
        self.assertEqual(told, "face 2 conflicts with faces 4, 5 and 7 more at vertices 1 and 3")
        told = with_numbers("edge 1 lies off the surface of face 3", (2, 4, 5))
        self.assertEqual(told, "edge 1 lies off the surface of face 5")

    def test_a_conflict_knows_its_faces_and_vertices(self):
        lift = {
            "conflicts": [
                {
                    "face": 0,
                    "others": [],
                    "vertices": [1],
                    "residual": 0.1,
                    "message": "face 1 conflicts with itself at vertex 1",
                }
            ]
        }
        off = (self.identification.faces[0].key,)
        (found,) = told_conflicts(lift, self.identification, SolidOptions(off=off))
        self.assertEqual(found.message, "Face 2 conflicts with itself at vertex 1")
        self.assertEqual((found.severity, found.faces), ("warning", (1,)))
        self.assertEqual(found.points, (self.identification.drawing.vertices[1],))
        self.assertEqual(found.detail, "Edge1, Edge2, Edge4")

    def test_a_reading_is_chosen_by_its_number(self):
        chosen = chosen_faces(self.identification, SolidOptions(reading=1))
        self.assertEqual(chosen["faces"], TWO[:1])

    def test_a_reading_that_is_not_there_is_refused(self):
        with self.assertRaisesRegex(BadInput, "no reading 3.*has 2"):
            chosen_faces(self.identification, SolidOptions(reading=2))

    def test_a_solid_without_faces_is_refused(self):
        off = tuple(face.key for face in self.identification.faces)
        with self.assertRaisesRegex(BadInput, "switched off"):
            chosen_faces(self.identification, SolidOptions(off=off))

    def test_the_store_forgets_what_was_used_longest_ago(self):
        store, made = Store(2), []

        def get(key):
            return store.get(key, lambda: made.append(key) or key)

        for key in ("a", "b", "a", "c", "a", "b"):
            self.assertEqual(get(key), key)
        self.assertEqual(made, ["a", "b", "c", "b"])

    def test_the_store_keeps_nothing_of_work_that_failed(self):
        store = Store(2)
        with self.assertRaises(ZeroDivisionError):
            store.get("a", lambda: 1 // 0)
        self.assertEqual(store.get("a", lambda: 5), 5)

    def test_errors_name_the_edges_of_the_source(self):
        drawing = self.identification.drawing
        text = with_names("edge 1 and edge 2 do not fit; edge 99 does", drawing)
        self.assertEqual(text, "Edge1, Edge4 and Edge2 do not fit; edge 99 does")

    def test_errors_name_corners_by_their_edges(self):
        drawing = self.identification.drawing
        text = with_names("2 edges meet at vertex 1", drawing)
        self.assertEqual(text, "2 edges meet at the corner of Edge1, Edge2, Edge4")
        text = with_names("the depth of vertices [0, 1, 2] is open", drawing)
        self.assertEqual(text, "the depth of corners of Edge1, Edge2, Edge3, Edge4 is open")
        self.assertEqual(with_names("vertex 77", drawing), "vertex 77")

    def test_a_fault_of_the_drawing_is_said_before_its_consequences(self):
        drawing = self.identification.drawing
        with self.assertRaisesRegex(Failed, "Edge2 ends freely"), names_in_errors(drawing):
            raise Failed("edge 3 has no faces")
