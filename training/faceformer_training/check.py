"""The independent checker of drawings with truth: ``python -m faceformer_training.check FILE...``.

It uses nothing of the projector. Every rule is a function that yields what breaks it; a drawing
is good if none does. Tolerances are in units of the half diagonal, which is 1.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from tqdm import tqdm

from .drawing import FACE_TYPES, Drawing, DrawingFormatError, Truth, read_drawings
from .sight import flat_thickness, vector_area, walk

VERTEX_DISTANCE = 2e-3
EDGE_LENGTH = 1e-3
LEAST_CURVE_POINTS = 9
ON_PROJECTION = 1e-5
"""Points are rounded to 1e-6, and a perspective drawing magnifies that."""
ON_PLANE = 2e-3
"""Farthest that a plane face's boundary may be off its plane: chord error and CAD tolerances."""
CHORD = 3e-3
"""Largest sagitta between neighbouring pieces of a curve."""
LEAST_AREA = 1e-6
SIGHT_ERROR = 1e-4
"""How far below zero the mean thickness may be, by rounding on lines along edges."""
FAN_ERROR = 0.4
"""How far below zero the estimated volume may be where no line of sight meets plane faces only:
the bulge of curved faces is unknown here."""


@dataclass(frozen=True)
class Fault:
    """A broken rule, by its name, and where."""

    rule: str
    detail: str = ""

    def __str__(self) -> str:
        return f"{self.rule}: {self.detail}" if self.detail else self.rule


def check_drawing(drawing: Drawing) -> list[Fault]:
    """All faults of a drawing with truth; without truth that is a fault itself.

    Rules about geometry are tried only if the indices make sense, rules about faces only if
    every co-edge is used once.
    """
    faults = list(_header(drawing)) + list(_indices(drawing))
    if faults:
        return faults
    truth = drawing.truth
    assert truth is not None
    faults += list(_graph(drawing)) + list(_points(drawing, truth))
    broken = list(_coedges(drawing, truth))
    faults += broken
    if not broken:
        faults += list(_vertex_cycles(drawing, truth))
        faults += list(_topology(drawing, truth))
        faults += list(_faces(drawing, truth))
    return faults


def _header(drawing: Drawing) -> Iterator[Fault]:
    if not drawing.id:
        yield Fault("no id")
    kind = drawing.projection.get("kind")
    if kind not in ("orthographic", "perspective"):
        yield Fault("projection", f"kind {kind!r}")
    focal = drawing.projection.get("focal", 1.0 if kind == "orthographic" else None)
    if not isinstance(focal, (int, float)) or focal <= 0:
        yield Fault("projection", f"focal {focal!r}")
    truth = drawing.truth
    if truth is None:
        yield Fault("no truth")
        return
    axes = truth.directions
    if axes is None:
        yield Fault("directions", "none")
    elif not np.allclose(axes @ axes.T, np.eye(3), atol=1e-5) or np.linalg.det(axes) < 0.999:
        yield Fault("directions", "no right-handed orthonormal frame")


def _indices(drawing: Drawing) -> Iterator[Fault]:
    truth = drawing.truth
    if truth is None:
        return
    count = len(drawing.vertices)
    if truth.vertices3d.shape != (count, 3) or len(truth.edges3d) != len(drawing.edges):
        yield Fault("sizes", "truth has other numbers of vertices or edges")
        return
    arrays = [drawing.vertices, truth.vertices3d, *truth.edges3d]
    arrays += [edge.points for edge in drawing.edges]
    if not all(np.isfinite(a).all() for a in arrays):
        yield Fault("not finite")
    for number, (edge, points3d) in enumerate(zip(drawing.edges, truth.edges3d, strict=True), 1):
        if not all(0 <= v < count for v in edge.v):
            yield Fault("vertex index", f"edge {number}")
        if len(edge.points) < 2 or len(edge.points) != len(points3d):
            yield Fault("sizes", f"edge {number}'s points")
    for number, face in enumerate(truth.faces, 1):
        if face.type not in FACE_TYPES:
            yield Fault("face type", f"face {number}: {face.type!r}")
        if not face.loops or not all(face.loops):
            yield Fault("loop", f"face {number} has an empty one")
        if any(k == 0 or abs(k) > len(drawing.edges) for loop in face.loops for k in loop):
            yield Fault("edge index", f"face {number}")


def _graph(drawing: Drawing) -> Iterator[Fault]:
    used = {v for edge in drawing.edges for v in edge.v}
    for v in sorted(set(range(len(drawing.vertices))) - used):
        yield Fault("unused vertex", f"vertex {v}")
    for a, b in sorted(cKDTree(drawing.vertices).query_pairs(VERTEX_DISTANCE)):
        yield Fault("coincident vertices", f"vertices {a} and {b}")


def _project(drawing: Drawing, points: np.ndarray) -> np.ndarray:
    if drawing.projection["kind"] == "orthographic":
        return points[:, :2]
    return drawing.projection["focal"] * points[:, :2] / -points[:, 2:]


def _points(drawing: Drawing, truth: Truth) -> Iterator[Fault]:
    """Ends on vertices, three dimensions over two, lengths, fineness, the solid's size."""
    perspective = drawing.projection["kind"] == "perspective"
    centre = np.array([0.0, 0.0, -drawing.projection["focal"] if perspective else 0.0])
    if perspective and float(truth.vertices3d[:, 2].max()) >= 0:
        yield Fault("behind the camera")
        return
    if _off(_project(drawing, truth.vertices3d), drawing.vertices) > ON_PROJECTION:
        yield Fault("projection", "a vertex is not under its 3D point")
    for number, (edge, points3d) in enumerate(zip(drawing.edges, truth.edges3d, strict=True), 1):
        where = f"edge {number}"
        a, b = edge.v
        ends = drawing.vertices[[a, b]], truth.vertices3d[[a, b]]
        gap = max(_off(edge.points[[0, -1]], ends[0]), _off(points3d[[0, -1]], ends[1]))
        if gap > 1e-9:
            yield Fault("edge end", f"{where} is {gap:.2g} from its vertex")
        if _off(_project(drawing, points3d), edge.points) > ON_PROJECTION:
            yield Fault("projection", where)
        if float(np.linalg.norm(points3d - centre, axis=1).max()) > 1.01:
            yield Fault("size", f"{where} leaves the unit ball")
        length = float(np.linalg.norm(np.diff(edge.points, axis=0), axis=1).sum())
        if length < EDGE_LENGTH:
            yield Fault("short edge", where)
        if len(points3d) == 2:
            if a == b:
                yield Fault("closed straight edge", where)
        elif len(points3d) < LEAST_CURVE_POINTS:
            yield Fault("few points", where)
        elif (sag := _largest_sagitta(points3d)) > CHORD:
            yield Fault("coarse curve", f"{where}: {sag:.2g}")


def _off(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.abs(a - b).max(initial=0.0))


def _largest_sagitta(points: np.ndarray) -> float:
    """Height of the arc over the shorter piece at each bend, from the bend's angle."""
    pieces = np.diff(points, axis=0)
    length = np.linalg.norm(pieces, axis=1)
    pieces, length = pieces[length > 1e-9], length[length > 1e-9]
    cosine = (pieces[:-1] * pieces[1:]).sum(1) / (length[:-1] * length[1:])
    bend = np.arccos(np.clip(cosine, -1, 1))
    return float((bend * np.minimum(length[:-1], length[1:]) / 8).max(initial=0.0))


def _coedges(drawing: Drawing, truth: Truth) -> Iterator[Fault]:
    """Each co-edge in one loop of one face, no face with both of an edge, loops closed."""
    uses = Counter(k for face in truth.faces for loop in face.loops for k in loop)
    for number in range(1, len(drawing.edges) + 1):
        for k in (number, -number):
            if uses[k] != 1:
                yield Fault("co-edge", f"{k} is used {uses[k]} times")
    for number, face in enumerate(truth.faces, 1):
        members = [k for loop in face.loops for k in loop]
        if len({abs(k) for k in members}) != len(members):
            yield Fault("both co-edges", f"face {number}")
        for loop in face.loops:
            for k, following in zip(loop, loop[1:] + loop[:1], strict=True):
                if _tail(drawing, -k) != _tail(drawing, following):
                    yield Fault("open loop", f"face {number}, {k} to {following}")


def _tail(drawing: Drawing, k: int) -> int:
    """The vertex where co-edge ``k`` starts."""
    return drawing.edges[abs(k) - 1].v[0 if k > 0 else 1]


def _vertex_cycles(drawing: Drawing, truth: Truth) -> Iterator[Fault]:
    """Around each vertex the faces make one cycle."""
    following = {
        k: n
        for face in truth.faces
        for loop in face.loops
        for k, n in zip(loop, loop[1:] + loop[:1], strict=True)
    }
    leaving: dict[int, list[int]] = defaultdict(list)
    for k in following:
        leaving[_tail(drawing, k)].append(k)
    for v, members in leaving.items():
        k, steps = members[0], 0
        while True:
            k, steps = following[-k], steps + 1
            if k == members[0] or steps > len(members):
                break
        if steps != len(members):
            yield Fault("vertex cycle", f"vertex {v}: {steps} of {len(members)} edges")


def _topology(drawing: Drawing, truth: Truth) -> Iterator[Fault]:
    """One shell, and a whole genus of zero or more."""
    owner = {k: i for i, face in enumerate(truth.faces) for loop in face.loops for k in loop}
    reached, open_faces = {0}, [0]
    while open_faces:
        face = truth.faces[open_faces.pop()]
        for other in {owner[-k] for loop in face.loops for k in loop} - reached:
            reached.add(other)
            open_faces.append(other)
    if len(reached) != len(truth.faces):
        yield Fault("several shells", f"{len(reached)} of {len(truth.faces)} faces are connected")
    characteristic = (
        len(drawing.vertices)
        - len(drawing.edges)
        + sum(2 - len(face.loops) for face in truth.faces)
    )
    if characteristic % 2 or characteristic > 2:
        yield Fault("euler", f"characteristic {characteristic}")


def _faces(drawing: Drawing, truth: Truth) -> Iterator[Fault]:
    """Areas, flatness, inner loops, roundness of spheres, and which side is outside."""
    perspective = drawing.projection["kind"] == "perspective"
    total = volume = 0.0
    for number, face in enumerate(truth.faces, 1):
        where = f"face {number}"
        areas = [_drawn_area(walk(loop, [e.points for e in drawing.edges])) for loop in face.loops]
        boundary = [walk(loop, truth.edges3d) for loop in face.loops]
        area = sum(areas)
        total += area
        volume += _fan_volume(boundary)
        if abs(area) < LEAST_AREA:
            yield Fault("no area", where)
        elif face.type == "plane":
            yield from _plane(boundary, areas, perspective, where)
        elif face.type == "sphere":
            yield from _sphere(np.vstack(boundary), where)
    if abs(total) > 1e-4:
        yield Fault("areas", f"front and back differ by {total:.2g}")
    thickness = flat_thickness(drawing, truth)
    if (thickness is None and volume < -FAN_ERROR) or (
        thickness is not None and thickness < -SIGHT_ERROR
    ):
        yield Fault("inside out", f"volume about {volume:.2g}, thickness {thickness}")


def _drawn_area(p: np.ndarray) -> float:
    return 0.5 * float((p[:-1, 0] * p[1:, 1] - p[1:, 0] * p[:-1, 1]).sum())


def _fan_volume(boundary: list[np.ndarray]) -> float:
    """Volume under fans spanned over a face's loops: exact for a plane, rough for the rest."""
    total = 0.0
    for p in boundary:
        middle = p[:-1].mean(0)
        total += float(np.einsum("ij,ij->i", np.cross(p[:-1], p[1:]), middle[None]).sum()) / 6
    return total


def _plane(boundary, areas: list[float], perspective: bool, where: str) -> Iterator[Fault]:
    area = sum(vector_area(p) for p in boundary)
    size = float(np.linalg.norm(area))
    if size < LEAST_AREA:
        yield Fault("no area", where)
        return
    normal = area / size
    off = max(float(np.abs((p - boundary[0][0]) @ normal).max()) for p in boundary)
    if off > ON_PLANE:
        yield Fault("not flat", f"{where}: {off:.2g}")
    facing = float(normal @ -boundary[0][0]) if perspective else float(normal[2])
    if (facing > 0) != (sum(areas) > 0):
        yield Fault("orientation", where)
    outer = [a for a in areas if (a > 0) == (sum(areas) > 0)]
    if len(outer) != 1:
        yield Fault("inner loops", f"{where}: {len(outer)} loops run as an outer one")


def _sphere(points: np.ndarray, where: str) -> Iterator[Fault]:
    """All boundary points on one sphere: |p|^2 = 2 c . p + k, linear in centre and k."""
    system = np.c_[2 * points, np.ones(len(points))]
    square = (points * points).sum(1)
    solution = np.linalg.lstsq(system, square, rcond=None)[0]
    centre = solution[:3]
    radius = np.sqrt(max(0.0, solution[3] + float(centre @ centre)))
    off = float(np.abs(np.linalg.norm(points - centre, axis=1) - radius).max())
    if off > ON_PLANE:
        yield Fault("not a sphere", f"{where}: {off:.2g}")


def main(arguments: list[str] | None = None) -> int:
    """Check files and print counts; 0 if all is well, 1 if not, 2 for what is no drawing."""
    parser = argparse.ArgumentParser(
        prog="python -m faceformer_training.check", description="Check drawings with truth."
    )
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--show", type=int, default=12, help="how many bad drawings to name")
    options = parser.parse_args(arguments)
    count, bad, rules = 0, 0, Counter()
    seen: set[str] = set()
    try:
        for path in options.files:
            for drawing in tqdm(read_drawings(path), unit="drawing", desc=path.name, disable=None):
                count += 1
                faults = check_drawing(drawing)
                if drawing.id in seen:
                    faults.append(Fault("id twice", drawing.id))
                seen.add(drawing.id)
                if faults:
                    bad += 1
                    rules.update({fault.rule for fault in faults})
                    if bad <= options.show:
                        tqdm.write(f"{drawing.id}: {'; '.join(map(str, faults[:4]))}")
    except (DrawingFormatError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    print(f"{count} drawings, {bad} bad {dict(rules) if rules else ''}".rstrip())
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
