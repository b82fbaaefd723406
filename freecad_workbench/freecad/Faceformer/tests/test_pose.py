# SPDX-License-Identifier: LGPL-2.1-or-later
import unittest

from ..pose import turn

POINTS = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 3.0), (1.0, 1.0, 1.0)]


class PoseTest(unittest.TestCase):
    def test_a_turn_with_scale_and_shift_is_found(self):
        # x -> y, y -> z, z -> x
        moved = [(5 + 2 * z, 6 + 2 * x, 7 + 2 * y) for x, y, z in POINTS]
        found = turn(POINTS, moved)
        for axis, expected in zip(found, ((0, 1, 0), (0, 0, 1), (1, 0, 0)), strict=True):
            for value, wanted in zip(axis, expected, strict=True):
                self.assertAlmostEqual(value, wanted)

    def test_points_that_fix_no_turn_give_none(self):
        self.assertIsNone(turn([], []))
        self.assertIsNone(turn(POINTS, POINTS[:2]))
        line = [(k, 2.0 * k, 0.0) for k in range(4)]
        self.assertIsNone(turn(line, line))
