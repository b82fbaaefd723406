# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a solid was turned on its way from the drawing, so that the view can show it as drawn."""

from __future__ import annotations

from collections.abc import Sequence

from .plane import Vector, cross, norm, scale, sub, widest


def turn(drawn: Sequence[Vector], model: Sequence[Vector]) -> tuple[Vector, Vector, Vector] | None:
    """Where the x, y and z axis of the drawing's frame went.

    ``drawn`` and ``model`` are the same points in both frames, which differ by a turn, a scale
    and a shift. None if the points are too few or on one line.
    """
    corners = widest(drawn)
    if corners is None or len(drawn) != len(model):
        return None
    first, second = (_frame(*(points[k] for k in corners)) for points in (drawn, model))
    if first is None or second is None:
        return None
    axes = [
        tuple(sum(f[k] * s[i] for f, s in zip(first, second, strict=True)) for i in range(3))
        for k in range(3)
    ]
    return axes[0], axes[1], axes[2]


def _frame(a: Vector, b: Vector, c: Vector) -> tuple[Vector, Vector, Vector] | None:
    """Orthonormal axes that three points fix."""
    along, across = sub(b, a), sub(c, a)
    normal = cross(along, across)
    if norm(along) == 0.0 or norm(normal) == 0.0:
        return None
    x, z = scale(along, 1 / norm(along)), scale(normal, 1 / norm(normal))
    return x, cross(z, x), z
