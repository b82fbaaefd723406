"""Which side of a drawing's faces is outside: lines of sight through its plane faces.

Part of the independent checker; it uses nothing of the projector.
"""

from __future__ import annotations

import numpy as np

from .drawing import Drawing, Truth


def walk(loop: list[int], polylines: list[np.ndarray]) -> np.ndarray:
    """The closed polyline of a loop, its first point once more at the end."""
    pieces = [polylines[abs(k) - 1][:: 1 if k > 0 else -1] for k in loop]
    return np.vstack([pieces[0], *(piece[1:] for piece in pieces[1:])])


def vector_area(p: np.ndarray) -> np.ndarray:
    return 0.5 * np.cross(p[:-1] - p[0], p[1:] - p[0]).sum(0)


def flat_thickness(drawing: Drawing, truth: Truth) -> float | None:
    """Mean length of material on lines of sight that meet plane faces only; None without any.

    A front face counts its depth towards the viewer once for the line, a back face against it,
    so the sum is the length inside the solid, and negative if the solid is inside out.
    """
    owner, starts, ends = [], [], []
    planes: dict[int, tuple[np.ndarray, float]] = {}
    tries = []
    for number, face in enumerate(truth.faces):
        for loop in face.loops:
            p = walk(loop, [e.points for e in drawing.edges])
            starts.append(p[:-1])
            ends.append(p[1:])
            owner += [number] * (len(p) - 1)
        if face.type == "plane":
            boundary = [walk(loop, truth.edges3d) for loop in face.loops]
            normal = sum(vector_area(p) for p in boundary)
            planes[number] = normal, float(normal @ boundary[0].mean(0))
            drawn = starts[-len(face.loops)]
            tries += [0.7 * drawn[0] + 0.3 * drawn[len(drawn) // 2], drawn.mean(0)]
            tries += [0.45 * drawn[0] + 0.55 * drawn[len(drawn) // 3]]
    if not tries:
        return None
    points = np.array(tries)
    winding = _winding(points, np.vstack(starts), np.vstack(ends), np.array(owner))
    found = []
    for point, around in zip(points, winding, strict=True):
        met = np.flatnonzero(around).tolist()
        # Next to a curve the chords may leave one of the two sheets out.
        if met and around.sum() == 0 and all(face in planes for face in met):
            found.append(sum(around[i] * _depth(drawing, point, *planes[i]) for i in met))
    return float(np.mean(found)) if found else None


def _winding(points, starts, ends, owner) -> np.ndarray:
    """Winding numbers (points, faces) of the faces' drawn loops, by signed crossings."""
    x, y = points[:, :1], points[:, 1:]
    rises = (starts[:, 1] <= y) & (ends[:, 1] > y)
    falls = (starts[:, 1] > y) & (ends[:, 1] <= y)
    height = np.where(ends[:, 1] == starts[:, 1], 1.0, ends[:, 1] - starts[:, 1])
    at = starts[:, 0] + (y - starts[:, 1]) / height * (ends[:, 0] - starts[:, 0])
    signed = (rises.astype(int) - falls.astype(int)) * (at > x)
    out = np.zeros((len(points), int(owner.max()) + 1), dtype=int)
    for row, crossings in zip(out, signed, strict=True):
        np.add.at(row, owner, crossings)
    return out


def _depth(drawing: Drawing, point: np.ndarray, normal: np.ndarray, offset: float) -> float:
    """z where the line of sight through a drawn point meets the plane normal . p = offset."""
    if drawing.projection["kind"] == "orthographic":
        return float((offset - normal[:2] @ point) / normal[2])
    focal = drawing.projection["focal"]
    return float(-focal * offset / (normal[:2] @ point - focal * normal[2]))
