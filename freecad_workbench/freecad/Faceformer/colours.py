# SPDX-License-Identifier: LGPL-2.1-or-later
"""Colours of faces: neighbours in the list are far apart on the colour circle."""

from __future__ import annotations

import colorsys

Colour = tuple[float, float, float]

GOLDEN = 0.6180339887498949
"""Steps of this share of the circle never come close to an earlier colour soon."""

EDGE: Colour = (0.11, 0.14, 0.18)
HIGHLIGHT: Colour = (1.0, 0.55, 0.0)
ERROR: Colour = (0.85, 0.1, 0.15)


def face(number: int) -> Colour:
    """Red, green and blue (0 to 1) of a face, counted from 0."""
    value = (0.95, 0.75, 0.85)[number % 3]
    return colorsys.hsv_to_rgb((0.58 + number * GOLDEN) % 1.0, 0.72, value)
