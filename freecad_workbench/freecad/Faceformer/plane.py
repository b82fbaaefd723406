# SPDX-License-Identifier: LGPL-2.1-or-later
"""The plane of a cloud of points, and a frame in it that stands the way people draw."""

from __future__ import annotations

import math

Vector = tuple[float, float, float]

COLLINEAR = 1e-6
"""Points closer than this share of their extent to one line span no plane."""


def fit_plane(points: list[Vector]) -> tuple[Vector, Vector, Vector, Vector] | None:
    """Origin, x, y and z axis of the plane that the points span; None if they are collinear.

    The plane goes through three points far apart, so points in one plane give it exactly, and
    the caller finds the others' distances from it. The z axis points up, or towards negative y
    for a vertical plane, or along x, as FreeCAD's own sketch planes do. The origin is the
    model's origin dropped on the plane, so the XY plane gets the model's coordinates.
    """
    first = points[0]
    second = max(points, key=lambda p: _distance(p, first))
    along = _sub(second, first)
    extent = _norm(along)
    if extent == 0.0:
        return None
    along = _scale(along, 1 / extent)
    third = max(points, key=lambda p: _norm(_cross(along, _sub(p, first))))
    normal = _cross(along, _sub(third, first))
    if _norm(normal) <= COLLINEAR * extent:
        return None
    z = _viewer_side(_scale(normal, 1 / _norm(normal)))
    origin = _scale(z, _dot(z, first))
    horizontal = _cross((0.0, 0.0, 1.0), z)
    if _norm(horizontal) < 1e-9:
        x: Vector = (1.0, 0.0, 0.0)
    else:
        x = _scale(horizontal, 1 / _norm(horizontal))
    return origin, x, _cross(z, x), z


def _viewer_side(z: Vector) -> Vector:
    """The normal or its opposite: up, else to the front, else to the right."""
    for value in (z[2], -z[1], z[0]):
        if abs(value) > 1e-9:
            return z if value > 0 else _scale(z, -1.0)
    return z


def _sub(a: Vector, b: Vector) -> Vector:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _scale(a: Vector, s: float) -> Vector:
    return (a[0] * s, a[1] * s, a[2] * s)


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def _norm(a: Vector) -> float:
    return math.sqrt(_dot(a, a))


def _distance(a: Vector, b: Vector) -> float:
    return _norm(_sub(a, b))
