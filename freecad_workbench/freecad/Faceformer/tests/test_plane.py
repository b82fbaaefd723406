# SPDX-License-Identifier: LGPL-2.1-or-later
import math
import unittest

from ..plane import fit_plane


class PlaneTest(unittest.TestCase):
    def test_the_xy_plane_keeps_the_models_coordinates(self):
        frame = fit_plane([(0, 0, 0), (4, 0, 0), (4, 3, 0), (1, 2, 0)])
        expected = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
        for got, wanted in zip(frame, expected, strict=True):
            self.assertEqual(tuple(got), wanted)

    def test_the_order_of_the_points_does_not_turn_the_plane_over(self):
        points = [(0, 0, 5), (4, 0, 5), (4, 3, 5)]
        self.assertEqual(fit_plane(points), fit_plane(points[::-1]))

    def test_a_front_plane_has_its_z_axis_to_the_front_and_y_up(self):
        origin, x, y, z = fit_plane([(0, 2, 0), (4, 2, 0), (4, 2, 3)])
        self.assertEqual((x, y, z), ((1, 0, 0), (0, 0, 1), (0, -1, 0)))
        self.assertEqual(origin, (0, 2, 0))

    def test_a_tilted_plane_has_a_right_handed_orthonormal_frame(self):
        origin, x, y, z = fit_plane([(1, 0, 0), (0, 1, 0), (0, 0, 1)])
        for a, b in ((x, y), (y, z), (z, x)):
            self.assertAlmostEqual(sum(p * q for p, q in zip(a, b, strict=True)), 0)
        for a in (x, y, z):
            self.assertAlmostEqual(math.hypot(*a), 1)
        self.assertAlmostEqual(x[0] * y[1] - x[1] * y[0], z[2])
        self.assertAlmostEqual(sum(origin), 1)

    def test_points_on_one_line_span_no_plane(self):
        self.assertIsNone(fit_plane([(0, 0, 0), (1, 1, 1), (3, 3, 3)]))
        self.assertIsNone(fit_plane([(2, 2, 2), (2, 2, 2)]))
