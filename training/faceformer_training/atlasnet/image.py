"""Drawings as images."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

SIZE = 224


def image(polylines: Sequence[np.ndarray], size: int = SIZE, margin: int = 8) -> np.ndarray:
    """The lines in white on black, ``[size, size]`` of bytes, y upwards being up.

    The bounding box is fitted into the image but for its margin. Lines are one pixel wide, their
    brightness shared between the pixels that they lie between.
    """
    points = np.concatenate([np.asarray(p, float) for p in polylines])
    low, high = points.min(0), points.max(0)
    unit = (size - 1 - 2 * margin) / max(float((high - low).max()), 1e-12)
    canvas = np.zeros((size, size))
    for polyline in polylines:
        p = (np.asarray(polyline, float) - (low + high) / 2) * unit
        p = p * [1, -1] + (size - 1) / 2
        steps = np.linalg.norm(np.diff(p, axis=0), axis=1)
        for a, b, length in zip(p[:-1], p[1:], steps, strict=True):
            along = np.linspace(0, 1, int(np.ceil(2 * length)) + 1)[:, None]
            splat(canvas, a + (b - a) * along)
    return (255 * canvas).round().astype(np.uint8)


def splat(canvas: np.ndarray, points: np.ndarray) -> None:
    """Brightens the four pixels around each point, up to the share of it that is theirs."""
    corner = np.floor(points).astype(int)
    share = points - corner
    for dx in (0, 1):
        for dy in (0, 1):
            weight = np.abs(1 - dx - share[:, 0]) * np.abs(1 - dy - share[:, 1])
            x, y = corner[:, 0] + dx, corner[:, 1] + dy
            there = (x >= 0) & (y >= 0) & (x < canvas.shape[1]) & (y < canvas.shape[0])
            np.maximum.at(canvas, (y[there], x[there]), weight[there])
