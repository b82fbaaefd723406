"""The JSON of the Faceformer release (manycore-research/faceformer), read and written.

``python -m faceformer_training.release IN OUT`` converts either way:

- IN a folder of release files, or one such file: OUT is a data set (``.jsonl``, ``.jsonl.zst``);
- IN a data set: OUT is a folder that gets one release file a drawing, named by its id.

A release file lists CO-EDGES: ``edges`` holds each edge twice, once in each direction, sorted by
coordinates; ``pairings`` says which two are mates; ``faces_indices`` holds ``[type, loops]`` with
OCCT's ``GeomAbs_SurfaceType``, or loops alone; ``edges3d`` and ``dominant_directions`` are in the
camera frame. There are no vertices: end points within 2e-4 are one.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree
from tqdm import tqdm

from .drawing import Drawing, DrawingFormatError, DrawingWriter, Edge, Face, Truth, read_drawings

# The release's own distance; the half diagonal is 1.
SAME_VERTEX = 2e-4
# Place in the list = GeomAbs_SurfaceType; written `other` is GeomAbs_OtherSurface.
TYPES = ("plane", "cylinder", "cone", "sphere", "torus")
OTHER = 10


def is_release(data: Any) -> bool:
    return isinstance(data, dict) and "pairings" in data


# Reading


def from_release(data: dict[str, Any], name: str = "", source: str = "") -> Drawing:
    """The drawing of a release file; ``name`` is its id where the file has none.

    Edge ``n`` (from 1) is the n-th pair of mates by the smaller co-edge number, and runs as that
    co-edge does. Faces without a type are planes if all their edges are straight, else ``other``.
    Raises ``DrawingFormatError`` naming the co-edge or face that is wrong.
    """
    name = str(data.get("id", name))
    try:
        lines = [np.asarray(p, dtype=float).reshape(-1, 2) for p in data["edges"]]
        coedges = _numbered(data["pairings"], len(lines))
        first = {abs(k): i for i, k in reversed(list(enumerate(coedges))) if k > 0}
        kept = [first[n] for n in range(1, len(first) + 1)]
        vertices, ends = _vertices([lines[i] for i in kept])
        for i, mate in zip(kept, _mates(coedges, kept), strict=True):
            same = lines[i].shape == lines[mate].shape
            if not same or np.abs(lines[i] - lines[mate][::-1]).max() > SAME_VERTEX:
                raise ValueError(f"co-edges {i} and {mate} are mates, but not the same curve")
        edges = []
        for i, v in zip(kept, ends, strict=True):
            points = lines[i].copy()
            points[0], points[-1] = vertices[v[0]], vertices[v[1]]
            edges.append(Edge((int(v[0]), int(v[1])), points))
        truth = None
        if data.get("faces_indices"):
            faces = [_face(f, coedges, edges) for f in data["faces_indices"]]
            truth = _truth(data, faces, kept, ends, len(vertices))
        projection = dict(data.get("projection", {"kind": "orthographic"}))
        return Drawing(name, str(data.get("source", source)), projection, vertices, edges, truth)
    except DrawingFormatError:
        raise
    except (KeyError, TypeError, IndexError, ValueError, AttributeError) as error:
        raise DrawingFormatError(f"release file {name or '?'}: {error!r}") from error


def _numbered(pairings: dict[str, int], count: int) -> list[int]:
    """The signed edge number of each polyline."""
    mate = [-1] * count
    for key, j in pairings.items():
        i = int(key)
        if not (0 <= i < count and 0 <= j < count) or i == j or mate[i] != -1 or mate[j] != -1:
            raise ValueError(f"pairings: {i} and {j} are no mates")
        mate[i], mate[j] = j, i
    if -1 in mate:
        raise ValueError(f"co-edge {mate.index(-1)} has no mate")
    out, n = [0] * count, 0
    for i, j in enumerate(mate):
        if i < j:
            n += 1
            out[i], out[j] = n, -n
    return out


def _mates(coedges: list[int], kept: list[int]) -> list[int]:
    place = {k: i for i, k in enumerate(coedges)}
    return [place[-coedges[i]] for i in kept]


def _vertices(lines: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """(N, 2) vertices and (E, 2) their numbers at the edges' ends: clusters of end points."""
    ends = np.array([p[[0, -1]] for p in lines]).reshape(-1, 2)
    near = cKDTree(ends).query_pairs(SAME_VERTEX, output_type="ndarray")
    graph = coo_array((np.ones(len(near)), near.T), shape=(len(ends), len(ends)))
    count, label = connected_components(graph, directed=False)
    sums = np.zeros((count, 2))
    np.add.at(sums, label, ends)
    return sums / np.bincount(label)[:, None], label.reshape(-1, 2)


def _face(entry: Any, coedges: list[int], edges: list[Edge]) -> Face:
    typed = len(entry) == 2 and isinstance(entry[0], int)
    loops = [[coedges[i] for i in loop] for loop in (entry[1] if typed else entry)]
    if typed:
        kind = TYPES[entry[0]] if 0 <= entry[0] < len(TYPES) else "other"
    else:
        straight = all(len(edges[abs(k) - 1].points) == 2 for loop in loops for k in loop)
        kind = "plane" if straight else "other"
    return Face(kind, loops)


def _truth(
    data: dict[str, Any], faces: list[Face], kept: list[int], ends: np.ndarray, count: int
) -> Truth:
    curves = [np.asarray(data["edges3d"][i], dtype=float).reshape(-1, 3) for i in kept]
    sums, hits = np.zeros((count, 3)), np.zeros(count)
    for v, p in zip(ends, curves, strict=True):
        np.add.at(sums, v, p[[0, -1]])
        np.add.at(hits, v, 1)
    directions = data.get("dominant_directions")
    return Truth(
        faces,
        sums / hits[:, None],
        curves,
        None if not directions else np.asarray(directions, dtype=float).reshape(3, 3),
    )


# Writing


def to_release(drawing: Drawing) -> dict[str, Any]:
    """A drawing in the release's form.

    Keys that the release does not have (``id``, ``source``, and ``projection`` where it is a
    perspective one) are added; its readers ignore them.
    """
    walks = {}
    for n, edge in enumerate(drawing.edges, 1):
        space = None if drawing.truth is None else drawing.truth.edges3d[n - 1]
        walks[n] = (edge.points, space)
        walks[-n] = (edge.points[::-1], None if space is None else space[::-1])
    order = sorted(walks, key=lambda k: _sort_key(*walks[k]))
    place = {k: i for i, k in enumerate(order)}
    out: dict[str, Any] = {"id": drawing.id, "source": drawing.source}
    if drawing.projection.get("kind") != "orthographic":
        out["projection"] = dict(drawing.projection)
    out["edges"] = [walks[k][0].tolist() for k in order]
    out["pairings"] = {str(i): place[-k] for i, k in enumerate(order) if i < place[-k]}
    if drawing.truth is not None:
        out["edges3d"] = [walks[k][1].tolist() for k in order]
        out["faces_indices"] = [
            [
                TYPES.index(f.type) if f.type in TYPES else OTHER,
                [[place[k] for k in loop] for loop in f.loops],
            ]
            for f in drawing.truth.faces
        ]
        if drawing.truth.directions is not None:
            out["dominant_directions"] = drawing.truth.directions.tolist()
    return out


def _sort_key(points: np.ndarray, space: np.ndarray | None) -> tuple:
    """By coordinates along the curve; depth parts edges that coincide in the drawing."""
    return points.tolist(), [] if space is None else space.tolist()


# The command


def release_files(path: Path) -> list[Path]:
    """The JSON files in a folder and below, in order, or the one file that ``path`` is."""
    return sorted(path.rglob("*.json")) if path.is_dir() else [path]


def read_release(path: Path) -> Iterator[Drawing]:
    """The drawings of a folder of release files; an id is the file's path in the folder."""
    for file in tqdm(release_files(path), unit=" files", disable=None):
        data = json.loads(file.read_text("utf-8"))
        if not is_release(data):
            raise DrawingFormatError(f"{file} has no `pairings`: it is no file of the release")
        name = file.relative_to(path) if path.is_dir() else Path(file.name)
        yield from_release(data, name.with_suffix("").as_posix(), "faceformer release")


def file_name(drawing_id: str) -> str:
    """An id as a file name: whatever is not plain becomes an underscore."""
    return re.sub(r"[^A-Za-z0-9.\-]+", "_", drawing_id) + ".json"


def convert(source: Path, target: Path) -> int:
    """Converts, and returns the number of drawings."""
    if source.suffix in (".jsonl", ".zst"):
        target.mkdir(parents=True, exist_ok=True)
        count = 0
        for drawing in tqdm(read_drawings(source), unit=" drawings", disable=None):
            text = json.dumps(to_release(drawing), separators=(",", ":"))
            (target / file_name(drawing.id)).write_text(text, "utf-8")
            count += 1
        return count
    with DrawingWriter(target) as writer:
        for drawing in read_release(source):
            writer.write(drawing)
        return writer.written


def main(arguments: list[str] | None = None) -> int:
    p = argparse.ArgumentParser(prog="python -m faceformer_training.release", description=__doc__)
    p.add_argument("source", type=Path, metavar="IN", help="folder or file of the release, or data")
    p.add_argument("target", type=Path, metavar="OUT", help="data set, or folder")
    a = p.parse_args(arguments)
    try:
        print(f"{convert(a.source, a.target)} drawings in {a.target}", file=sys.stderr)
    except (OSError, json.JSONDecodeError, DrawingFormatError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
