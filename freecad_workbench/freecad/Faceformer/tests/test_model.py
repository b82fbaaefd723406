# SPDX-License-Identifier: LGPL-2.1-or-later
import unittest

from ..model import Drawing, Identification

REPORT = {
    "drawing": {
        "vertices": [[0, 0], [2, 0], [1, 1]],
        "edges": [
            {"v": [0, 1], "points": [[0, 0], [2, 0]], "curve": {"kind": "line"}},
            {"v": [1, 2], "points": [[2, 0], [1, 1]], "curve": {"kind": "line"}},
            {
                "v": [0, 2],
                "points": [[0, 0], [0.3, 0.7], [1, 1]],
                "curve": {
                    "kind": "ellipse",
                    "center": [1, 0],
                    "major": [1, 0],
                    "ratio": 1.0,
                    "start": 3.14159,
                    "sweep": -1.5708,
                    "residual": 0.0,
                },
            },
        ],
    },
    "sources": [[0, 3], [1], [2]],
    "findings": [
        {
            "severity": "error",
            "kind": "dangling",
            "message": "Edge2 ends freely",
            "edges": [1],
            "vertices": [2],
            "points": [[1, 1]],
        }
    ],
}
NAMES = ["Edge1", "Edge2", "Edge3", "Edge4"]
FACES = [{"type": "plane", "loops": [[1, 2, -3]], "confidence": 0.75}]


class ModelTest(unittest.TestCase):
    def setUp(self):
        self.drawing = Drawing.parse(REPORT, NAMES)
        data = {"engine": "rotation", "faces": FACES, "alternatives": [{"faces": []}]}
        self.identification = Identification.parse(data, self.drawing)

    def test_curves_and_findings_are_read(self):
        self.assertEqual([edge.straight for edge in self.drawing.edges], [True, True, False])
        self.assertAlmostEqual(self.drawing.edges[2].ellipse.sweep, -1.5708)
        finding = self.drawing.findings[0]
        self.assertEqual((finding.severity, finding.edges), ("error", (1,)))

    def test_a_face_names_the_edges_of_the_source(self):
        face = self.identification.faces[0]
        self.assertEqual(face.number, 1)
        self.assertEqual(face.edges, ("Edge1", "Edge2", "Edge3", "Edge4"))
        self.assertEqual(face.edge_indices, (0, 1, 2))
        self.assertEqual(face.confidence, 0.75)

    def test_the_outline_walks_reversed_edges_backwards(self):
        outline = self.identification.faces[0].outline(self.drawing)
        self.assertEqual(outline, [[(0, 0), (2, 0), (1, 1), (0.3, 0.7)]])

    def test_alternatives_are_readings_after_the_best_one(self):
        self.assertEqual([len(r.faces) for r in self.identification.readings], [1, 0])
