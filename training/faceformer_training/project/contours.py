"""Silhouettes of one curved face: traced over its mesh by signs, placed on its exact surface.

The sign of normal . view at the mesh nodes alone decides the topology: every triangle with
both signs holds one piece of a contour, and the pieces of neighbouring triangles join. A contour
runs with the front side (sign +) on its left, seen against the natural normal, so it starts
where the boundary, walked with the face on the left, goes from front to back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from .curves import LEAST_POINTS
from .errors import require
from .mesh import FaceMesh
from .surfaces import FaceSurface
from .views import View

ROOT = 1e-7
"""What counts as zero of normal . view on a surface evaluated by OCCT."""


@dataclass
class Contour:
    """A traced contour: mesh edges ``entries`` and ``exits`` (n, 2), one pair a triangle.

    ``start`` and ``end`` are keys of the mesh edges where it begins and ends; ``front`` and
    ``back`` the regions on its left and right.
    """

    entries: np.ndarray
    exits: np.ndarray
    start: int
    end: int
    closed: bool
    front: int
    back: int


@dataclass
class FaceSigns:
    """Signs (n,) at a face's nodes, the region (n,) each node lies in, and the contours.

    ``regions`` maps a region to whether it is seen from the front.
    """

    signs: np.ndarray
    region: np.ndarray
    regions: dict[int, bool]
    contours: list[Contour]


def edge_key(mesh: FaceMesh, a: int, b: int) -> int:
    """One number for the mesh edge between two nodes, the same on both sides of a seam."""
    low, high = sorted((int(mesh.key[a]), int(mesh.key[b])))
    return low * len(mesh.uv) + high


def trace(mesh: FaceMesh, signs: np.ndarray) -> FaceSigns:
    """Regions and contours of a face with the given signs (True: front) at its nodes.

    Raises ``ProjectionError("contour")`` where the mesh is no manifold.
    """
    triangles = mesh.triangles
    size = len(mesh.uv)
    used = np.unique(triangles)
    corner = signs[triangles]
    if corner.all() or not corner.any():
        region = np.zeros(size, dtype=int)
        return FaceSigns(signs, region, {0: bool(corner[0, 0])}, [])

    a = triangles[:, [0, 1, 2]].ravel()
    b = triangles[:, [1, 2, 0]].ravel()
    same = signs[a] == signs[b]
    rows, columns = mesh.key[a[same]], mesh.key[b[same]]
    ones = np.ones(len(rows), dtype=np.int8)
    graph = coo_matrix((ones, (rows, columns)), shape=(size, size))
    region = connected_components(graph, directed=False)[1][mesh.key]
    regions = dict(zip(region[used].tolist(), signs[used].tolist(), strict=True))

    following: dict[int, tuple[int, tuple[int, int], tuple[int, int]]] = {}
    reached: set[int] = set()
    mixed = triangles[corner.any(1) & ~corner.all(1)]
    for triangle in mixed.tolist():
        entry = leave = None
        for i, j in zip(triangle, triangle[1:] + triangle[:1], strict=True):
            if signs[i] and not signs[j]:
                entry = (i, j)
            elif signs[j] and not signs[i]:
                leave = (i, j)
        assert entry is not None and leave is not None
        here, there = edge_key(mesh, *entry), edge_key(mesh, *leave)
        require(here not in following and there not in reached, "contour", "mesh is no manifold")
        following[here] = (there, entry, leave)
        reached.add(there)

    contours = []
    seen: set[int] = set()
    for first in [k for k in following if k not in reached] + list(following):
        if first in seen:
            continue
        entries, exits = [], []
        key = first
        while key in following and key not in seen:
            seen.add(key)
            key, entry, leave = following[key]
            entries.append(entry)
            exits.append(leave)
        front, back = (int(region[node]) for node in entries[0])
        contours.append(
            Contour(np.array(entries), np.array(exits), first, key, key == first, front, back)
        )
    return FaceSigns(signs, region, regions, contours)


def contour_polyline(
    surface: FaceSurface, mesh: FaceMesh, view: View, contour: Contour, chord_error: float
) -> np.ndarray:
    """Polyline (m, 3) of a contour on the exact surface, from start to end.

    An open contour's end points lie on the mesh's boundary edges; the caller puts the exact
    boundary points in their place. The contour of a cylinder or cone is straight: two points.
    """
    start = _roots(surface, view, mesh.uv[contour.entries[:, 0]], mesh.uv[contour.entries[:, 1]])
    end = _roots(surface, view, mesh.uv[contour.exits[-1:, 0]], mesh.uv[contour.exits[-1:, 1]])
    if surface.label in ("cylinder", "cone"):
        require(not contour.closed, "contour", "a closed silhouette on a cylinder or cone")
        return surface.evaluate(np.vstack([start[:1], end]))[0]
    if surface.label == "sphere":
        crossings = surface.evaluate(np.vstack([start, end]))[0]
        return _sphere_arc(surface, view, crossings, contour.closed, chord_error)
    return _free_contour(surface, mesh, view, contour, start, end, chord_error)


def _roots(surface: FaceSurface, view: View, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Zeros of normal . view on (n,) segments in (u, v); Illinois' false position, guarded.

    Where the two ends have one sign after all (a sign taken from a neighbour, or rounding),
    the end nearer to zero stands for the root.
    """
    ends = view.facing(*surface.evaluate(np.vstack([a, b])))
    at_low, at_high = ends[: len(a)].copy(), ends[len(a) :].copy()
    t = np.where(np.abs(at_low) <= np.abs(at_high), 0.0, 1.0)
    low, high = np.zeros(len(a)), np.ones(len(a))
    active = np.flatnonzero((at_low >= 0) != (at_high >= 0))
    for _ in range(20):
        if not len(active):
            break
        share = at_low[active] / (at_low[active] - at_high[active])
        share = np.clip(share, 0.01, 0.99)
        t[active] = low[active] + share * (high[active] - low[active])
        inner = a[active] + t[active, None] * (b[active] - a[active])
        value = view.facing(*surface.evaluate(inner))
        left = (value >= 0) == (at_low[active] >= 0)
        lefts, rights = active[left], active[~left]
        low[lefts], at_low[lefts] = t[lefts], value[left]
        at_high[lefts] *= 0.5
        high[rights], at_high[rights] = t[rights], value[~left]
        at_low[rights] *= 0.5
        active = active[np.abs(value) > ROOT]
    return a + t[:, None] * (b - a)


def _sphere_arc(
    surface: FaceSurface, view: View, crossings: np.ndarray, closed: bool, chord_error: float
) -> np.ndarray:
    """Arc of the circle in which a sphere's silhouette lies, through the crossings in order."""
    sphere = surface.quadric
    assert sphere is not None
    if view.distance is None:
        axis, centre, radius = view.direction, sphere.origin, sphere.radius
    else:
        towards = view.distance * view.direction - sphere.origin
        far = float(np.linalg.norm(towards))
        axis = towards / far
        # The tangent cone from the eye touches in a circle in front of the centre.
        centre = sphere.origin + axis * sphere.radius**2 / far
        radius = sphere.radius * np.sqrt(1 - (sphere.radius / far) ** 2)
    x = np.cross(axis, [1.0, 0.0, 0.0] if abs(axis[0]) < 0.6 else [0.0, 1.0, 0.0])
    x /= np.linalg.norm(x)
    y = np.cross(axis, x)
    offset = crossings - centre
    angles = np.unwrap(np.arctan2(offset @ y, offset @ x))
    sweep = angles[-1] - angles[0]
    if closed:
        sweep = np.sign(sweep) * 2 * np.pi
    largest = 2 * np.arccos(max(0.0, 1 - min(1.0, chord_error / radius)))
    count = max(LEAST_POINTS, int(np.ceil(abs(sweep) / largest)) + 1)
    along = angles[0] + np.linspace(0, sweep, count)
    return centre + radius * (np.cos(along)[:, None] * x + np.sin(along)[:, None] * y)


def _free_contour(surface, mesh, view, contour, start, end, chord_error) -> np.ndarray:
    """Crossings of the mesh edges, and between them points brought onto the contour."""
    ends = np.vstack([start[1:], end])
    # Where a contour crosses a seam, it leaves one triangle elsewhere than it enters the next.
    jumps = np.flatnonzero((np.sort(contour.exits[:-1]) != np.sort(contour.entries[1:])).any(1))
    if len(jumps):
        sides = (mesh.uv[contour.exits[jumps, i]] for i in (0, 1))
        ends[jumps] = _roots(surface, view, *sides)
    scale = np.maximum(np.ptp(mesh.uv, axis=0), 1e-12)
    pieces = len(start)
    parts = max(2, -(-(LEAST_POINTS - 1) // pieces))
    while True:
        share = np.arange(parts) / parts
        uv = start[:, None] + share[None, :, None] * (ends - start)[:, None]
        inner = uv[:, 1:].reshape(-1, 2)
        uv[:, 1:] = _onto_contour(surface, view, inner, scale).reshape(pieces, parts - 1, 2)
        points = surface.evaluate(np.vstack([uv.reshape(-1, 2), ends[-1:]]))[0]
        sag = np.linalg.norm(0.5 * (points[:-2] + points[2:]) - points[1:-1], axis=1)
        # A chord between neighbours is half as long as the one measured: a quarter of its sag.
        if sag.max() < 2 * chord_error or parts >= 16:
            return thinned(points, 0.5 * chord_error)
        parts *= 2


def _onto_contour(surface, view, uv: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Steps along the gradient of normal . view, (u, v) scaled to the face's extent.

    One gradient a point, then chords (a simplified Newton's method): evaluating the surface is
    what costs. A point that gets no nearer to zero stays where it was.
    """
    step = 1e-5
    stack = np.vstack([uv, uv + [step * scale[0], 0], uv + [0, step * scale[1]]])
    value, plus_u, plus_v = view.facing(*surface.evaluate(stack)).reshape(3, -1)
    gradient = np.stack([plus_u - value, plus_v - value], axis=1) / step
    square = (gradient * gradient).sum(1)
    inverse = (gradient / np.where(square > 1e-18, square, np.inf)[:, None]) * scale
    best, best_value = uv.copy(), np.abs(value)
    moved = uv.copy()
    active = np.flatnonzero(best_value > ROOT)
    for _ in range(5):
        if not len(active):
            break
        moved[active] -= value[active, None] * inverse[active]
        value[active] = view.facing(*surface.evaluate(moved[active]))
        inside = np.abs((moved[active] - uv[active]) / scale).max(1) < 0.3
        better = inside & (np.abs(value[active]) < best_value[active])
        active = active[better]
        best[active], best_value[active] = moved[active], np.abs(value[active])
        active = active[best_value[active] > ROOT]
    return best


def thinned(points: np.ndarray, tolerance: float) -> np.ndarray:
    """A polyline with fewer points within a tolerance (Douglas and Peucker 1973), 9 at least."""
    keep = np.zeros(len(points), dtype=bool)
    keep[[0, -1]] = True
    open_spans = [(0, len(points) - 1)]
    while open_spans:
        a, b = open_spans.pop()
        if b - a < 2:
            continue
        chord = points[b] - points[a]
        aside = points[a + 1 : b] - points[a]
        square = float(chord @ chord)
        if square > 1e-20:
            share = np.clip(aside @ chord / square, 0, 1)
            aside = aside - share[:, None] * chord
        distance = (aside * aside).sum(1)
        worst = int(distance.argmax())
        if distance[worst] > tolerance * tolerance:
            middle = a + 1 + worst
            keep[middle] = True
            open_spans += [(a, middle), (middle, b)]
    if keep.sum() < LEAST_POINTS:
        length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
        for along in np.linspace(0, length[-1], LEAST_POINTS):
            keep[int(np.abs(length - along).argmin())] = True
    if keep.sum() < LEAST_POINTS:
        keep[:] = True
    return points[keep]
