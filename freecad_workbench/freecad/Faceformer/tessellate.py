# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fills closed polylines with trapezoids, by the even-odd rule.

A face of a drawing may have holes, and a wrong one may even cross itself. Slabs between the
heights of all corners and crossings handle every case alike, where a triangulation from a CAD
kernel would refuse some.
"""

from __future__ import annotations

from collections.abc import Sequence

Point = tuple[float, float]
Segment = tuple[Point, Point]
Trapezoid = tuple[Point, Point, Point, Point]


def fill(loops: Sequence[Sequence[Point]]) -> list[Trapezoid]:
    """Trapezoids that cover the inside of the loops, corners counter-clockwise from below."""
    segments = [segment for loop in loops for segment in _segments(loop)]
    heights = sorted({p[1] for segment in segments for p in segment} | _crossings(segments))
    pieces = []
    for low, high in zip(heights, heights[1:], strict=False):
        spans = sorted(
            (_at(segment, (low + high) / 2), _at(segment, low), _at(segment, high))
            for segment in segments
            if segment[0][1] <= low and segment[1][1] >= high
        )
        for left, right in zip(spans[::2], spans[1::2], strict=False):
            pieces.append(((left[1], low), (right[1], low), (right[2], high), (left[2], high)))
    return pieces


def area(loops: Sequence[Sequence[Point]]) -> float:
    """Area of the inside of the loops."""
    return sum((b[0] - a[0] + c[0] - d[0]) / 2 * (c[1] - b[1]) for a, b, c, d in fill(loops))


def contains(loops: Sequence[Sequence[Point]], point: Point) -> bool:
    """Whether a point is inside the loops."""
    x, y = point
    sides = [segment for loop in loops for segment in _segments(loop)]
    left = [side for side in sides if side[0][1] <= y < side[1][1] and _at(side, y) < x]
    return len(left) % 2 == 1


def _segments(loop: Sequence[Point]) -> list[Segment]:
    """The sides of a closed polyline that are not level, each from its lower end."""
    sides = zip(loop, [*loop[1:], *loop[:1]], strict=True)
    return [(a, b) if a[1] < b[1] else (b, a) for a, b in sides if a[1] != b[1]]


def _at(segment: Segment, y: float) -> float:
    (x0, y0), (x1, y1) = segment
    return x0 + (x1 - x0) * ((y - y0) / (y1 - y0))


def _crossings(segments: list[Segment]) -> set[float]:
    """Heights at which two sides cross."""
    found = set()
    by_height = sorted(segments, key=lambda s: s[0][1])
    for k, first in enumerate(by_height):
        for second in by_height[k + 1 :]:
            low, high = second[0][1], min(first[1][1], second[1][1])
            if low >= first[1][1]:
                break
            below = _at(first, low) - _at(second, low)
            above = _at(first, high) - _at(second, high)
            if below * above < 0:
                found.add(low + (high - low) * below / (below - above))
    return found
