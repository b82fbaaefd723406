# SPDX-License-Identifier: LGPL-2.1-or-later
"""Vectors as plain tuples, and the plane of a cloud of points with a frame as people draw it."""

from __future__ import annotations

import math
from collections.abc import Sequence

Vector = tuple[float, float, float]

COLLINEAR = 1e-6
"""Points closer than this share of their extent to one line span no plane."""


def widest(points: Sequence[Vector]) -> tuple[int, int, int] | None:
    """Three points far apart, as indices; None if all lie on one line."""
    if not points:
        return None
    indices = range(len(points))
    second = max(indices, key=lambda k: distance(points[k], points[0]))
    along = sub(points[second], points[0])
    extent = norm(along)
    if extent == 0.0:
        return None
    along = scale(along, 1 / extent)
    away = [norm(cross(along, sub(p, points[0]))) for p in points]
    third = max(indices, key=away.__getitem__)
    return (0, second, third) if away[third] > COLLINEAR * extent else None


def fit_plane(points: Sequence[Vector]) -> tuple[Vector, Vector, Vector, Vector] | None:
    """Origin, x, y and z axis of the plane that the points span; None if they are collinear.

    The plane goes through three points far apart, so points in one plane give it exactly, and
    the caller finds the others' distances from it. The z axis points up, or towards negative y
    for a vertical plane, or along x, as FreeCAD's own sketch planes do. The origin is the
    model's origin dropped on the plane, so the XY plane gets the model's coordinates.
    """
    corners = widest(points)
    if corners is None:
        return None
    first, second, third = (points[k] for k in corners)
    normal = cross(sub(second, first), sub(third, first))
    z = _viewer_side(scale(normal, 1 / norm(normal)))
    origin = scale(z, dot(z, first))
    horizontal = cross((0.0, 0.0, 1.0), z)
    if norm(horizontal) < 1e-9:
        x: Vector = (1.0, 0.0, 0.0)
    else:
        x = scale(horizontal, 1 / norm(horizontal))
    return origin, x, cross(z, x), z


def _viewer_side(z: Vector) -> Vector:
    """The normal or its opposite: up, else to the front, else to the right."""
    for value in (z[2], -z[1], z[0]):
        if abs(value) > 1e-9:
            return z if value > 0 else scale(z, -1.0)
    return z


def sub(a: Vector, b: Vector) -> Vector:
    """Difference."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a: Vector, s: float) -> Vector:
    """Multiple."""
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a: Vector, b: Vector) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Vector product."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def norm(a: Vector) -> float:
    """Length."""
    return math.sqrt(dot(a, a))


def distance(a: Vector, b: Vector) -> float:
    """Length of the difference."""
    return norm(sub(a, b))
