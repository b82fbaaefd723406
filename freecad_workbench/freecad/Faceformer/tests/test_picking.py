# SPDX-License-Identifier: LGPL-2.1-or-later
import unittest
from unittest import mock

import FreeCAD

from ..picking import Picker

LARGE = [[(0, 0), (4, 0), (4, 4), (0, 4)]]
SMALL = [[(1, 1), (3, 1), (3, 3), (1, 3)]]


class PickingTest(unittest.TestCase):
    def setUp(self):
        self.view = mock.Mock()
        self.picked = []
        placement = FreeCAD.Placement(FreeCAD.Vector(10, 0, 0), FreeCAD.Rotation())
        self.picker = Picker(self.view, placement, self.picked.append)
        self.picker.show([LARGE, SMALL])
        self.click = self.view.addEventCallback.call_args.args[1]

    def test_clicks_in_one_place_go_from_small_to_large_and_round(self):
        self.assertEqual([self.picker.at((2, 2)) for _ in range(3)], [1, 0, 1])
        self.assertEqual(self.picker.at((0.5, 0.5)), 0)
        self.assertIsNone(self.picker.at((9, 9)))
        self.assertEqual(self.picker.at((2, 2)), 1)

    def test_a_click_meets_the_plane_of_the_drawing(self):
        self.view.projectPointToLine.return_value = ((12, 2, 5), (12, 2, -5))
        self.click({"Button": "BUTTON1", "State": "DOWN", "Position": (3, 4)})
        self.click({"Button": "BUTTON1", "State": "UP", "Position": (3, 4)})
        self.click({"Button": "BUTTON2", "State": "DOWN", "Position": (3, 4)})
        self.assertEqual(self.picked, [1])

    def test_a_line_of_sight_along_the_plane_picks_nothing(self):
        self.view.projectPointToLine.return_value = ((12, 2, 0), (12, 9, 0))
        self.click({"Button": "BUTTON1", "State": "DOWN", "Position": (3, 4)})
        self.assertEqual(self.picked, [])
