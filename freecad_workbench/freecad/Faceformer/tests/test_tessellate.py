# SPDX-License-Identifier: LGPL-2.1-or-later
import math
import unittest

from ..tessellate import area, contains, fill

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]


class TessellateTest(unittest.TestCase):
    def test_a_square_is_one_piece(self):
        self.assertEqual(len(fill([SQUARE])), 1)
        self.assertAlmostEqual(area([SQUARE]), 16)

    def test_holes_are_left_out_whichever_way_they_are_walked(self):
        hole = [(1, 1), (3, 1), (3, 2), (1, 2)]
        self.assertAlmostEqual(area([SQUARE, hole]), 14)
        self.assertAlmostEqual(area([SQUARE, hole[::-1]]), 14)

    def test_a_concave_outline_is_filled_exactly(self):
        bracket = [(0, 0), (6, 1), (5, 2), (2, 1.5), (1, 6), (0, 5)]
        shoelace = 0.0
        for (x0, y0), (x1, y1) in zip(bracket, bracket[1:] + bracket[:1], strict=True):
            shoelace += x0 * y1 - x1 * y0
        self.assertAlmostEqual(area([bracket]), abs(shoelace) / 2)

    def test_an_outline_that_crosses_itself_is_filled_on_both_sides(self):
        self.assertAlmostEqual(area([[(0, 0), (4, 0), (0, 4), (4, 4)]]), 8)

    def test_a_round_outline_has_its_area(self):
        steps = [2 * math.pi * k / 90 for k in range(90)]
        circle = [(3 * math.cos(t), 3 * math.sin(t)) for t in steps]
        self.assertAlmostEqual(area([circle]), 45 * 9 * math.sin(2 * math.pi / 90))

    def test_nothing_and_a_flat_line_have_no_pieces(self):
        self.assertEqual(fill([]), [])
        self.assertEqual(fill([[(0, 0), (1, 0), (2, 0)]]), [])

    def test_points_are_inside_or_not(self):
        hole = [(1, 1), (3, 1), (3, 2), (1, 2)]
        self.assertTrue(contains([SQUARE, hole], (0.5, 1.5)))
        self.assertFalse(contains([SQUARE, hole], (2, 1.5)))
        self.assertFalse(contains([SQUARE, hole], (5, 1)))
