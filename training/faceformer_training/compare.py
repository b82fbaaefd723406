"""Does our projection agree with drawings that another program made of the same solids?

``python -m faceformer_training.compare --solids DIR DRAWINGS... [--sample 300] [--hlr]``

Each drawing's ``truth.directions`` and focal length give its view; its id ``SOURCE/NAME#VIEW``
the solid, member ``NAME`` of ``DIR/SOURCE.tar``. Both must have the same graph and the same
faces, up to numbering. ``--hlr`` also holds the total length of our silhouettes against that of
OCCT's hidden-line removal.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections import Counter
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from tqdm import tqdm

from .drawing import Drawing, read_drawings
from .project.errors import ProjectionError
from .project.hlr import outline_lengths
from .project.read import ItemReader, list_items
from .project.solid import PreparedSolid
from .project.views import View

VERTEX_GAP = 2e-3
EDGE_GAP = 8e-3
"""Farthest that matched vertices and edges may be apart: silhouettes on free surfaces are found
by different means, and both polylines have a chord error."""


def difference(ours: Drawing, theirs: Drawing) -> str | None:
    """What is different between two drawings of one solid in one view; None if nothing is.

    The vertex of a closed edge that no other edge meets is free to be anywhere on it.
    """
    if len(ours.edges) != len(theirs.edges):
        return f"edges: {len(ours.edges)} instead of {len(theirs.edges)}"
    if len(ours.vertices) != len(theirs.vertices):
        return f"vertices: {len(ours.vertices)} instead of {len(theirs.vertices)}"
    free = [_free_vertices(d) for d in (ours, theirs)]
    vertex = _match_vertices(ours.vertices, theirs.vertices, free)
    if isinstance(vertex, str):
        return vertex
    edge = _match_edges(ours, theirs, vertex, free)
    if isinstance(edge, str):
        return edge
    assert ours.truth is not None and theirs.truth is not None
    mine, other = Counter(), Counter()
    for face in ours.truth.faces:
        loops = [[edge[abs(k)] * (1 if k > 0 else -1) for k in loop] for loop in face.loops]
        mine[_canonical(loops)] += 1
    for face in theirs.truth.faces:
        other[_canonical(face.loops)] += 1
    if mine != other:
        return f"faces: {sum((mine - other).values())} of {len(ours.truth.faces)}"
    return None


def type_difference(ours: Drawing, theirs: Drawing) -> str | None:
    """Difference of the numbers of faces of each type, as words; None if there is none."""
    assert ours.truth is not None and theirs.truth is not None
    mine = Counter(f.type for f in ours.truth.faces)
    other = Counter(f.type for f in theirs.truth.faces)
    if mine == other:
        return None
    return f"{dict(mine - other)} instead of {dict(other - mine)}"


def _free_vertices(drawing: Drawing) -> set[int]:
    degree = Counter(v for edge in drawing.edges for v in edge.v)
    return {e.v[0] for e in drawing.edges if e.v[0] == e.v[1] and degree[e.v[0]] == 2}


def _match_vertices(ours, theirs, free) -> dict[int, int] | str:
    mine = [i for i in range(len(ours)) if i not in free[0]]
    other = [i for i in range(len(theirs)) if i not in free[1]]
    if len(mine) != len(other):
        return "vertices: free ones differ"
    if not mine:
        return {}
    distance, nearest = cKDTree(theirs[other]).query(ours[mine])
    if float(distance.max()) > VERTEX_GAP:
        return f"vertices: one is {distance.max():.2g} away"
    if len(set(nearest.tolist())) != len(mine):
        return "vertices: not one to one"
    return {i: other[j] for i, j in zip(mine, nearest.tolist(), strict=True)}


def _match_edges(ours, theirs, vertex, free) -> dict[int, int] | str:
    """Signed number of their edge for each number of ours."""
    open_edges: dict[tuple, list[int]] = {}
    for number, edge in enumerate(theirs.edges, 1):
        ends = (-1, -1) if edge.v[0] in free[1] else tuple(sorted(edge.v))
        open_edges.setdefault(ends, []).append(number)
    matched = {}
    for number, edge in enumerate(ours.edges, 1):
        is_free = edge.v[0] in free[0]
        ends = (-1, -1) if is_free else tuple(sorted(vertex[v] for v in edge.v))
        gaps = [
            (_distance(edge.points, theirs.edges[k - 1].points), k)
            for k in open_edges.get(ends, [])
        ]
        if not gaps:
            return "edges: other ends"
        gap, other = min(gaps)
        if gap > EDGE_GAP:
            return f"edges: one is {gap:.2g} away"
        open_edges[ends].remove(other)
        partner = theirs.edges[other - 1]
        if edge.v[0] == edge.v[1]:
            same = (_area(edge.points) > 0) == (_area(partner.points) > 0)
        else:
            same = vertex[edge.v[0]] == partner.v[0]
        matched[number] = other if same else -other
    return matched


def _distance(a: np.ndarray, b: np.ndarray) -> float:
    """Largest distance of either polyline's dense points from the other's."""
    a, b = _dense(a), _dense(b)
    return max(float(cKDTree(a).query(b)[0].max()), float(cKDTree(b).query(a)[0].max()))


def _dense(points: np.ndarray, step: float = 2e-3) -> np.ndarray:
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    along = np.linspace(0, length[-1], max(2, int(length[-1] / step)))
    return np.stack([np.interp(along, length, points[:, i]) for i in (0, 1)], axis=1)


def _area(p: np.ndarray) -> float:
    return 0.5 * float((p[:-1, 0] * p[1:, 1] - p[1:, 0] * p[:-1, 1]).sum())


def _canonical(loops: list[list[int]]) -> tuple:
    out = []
    for loop in loops:
        start = loop.index(min(loop))
        out.append(tuple(loop[start:] + loop[:start]))
    return tuple(sorted(out))


def main(arguments: list[str] | None = None) -> int:
    """Compare and print; 0 if at least ``--least`` percent agree, else 1."""
    parser = argparse.ArgumentParser(
        prog="python -m faceformer_training.compare", description=__doc__.split("\n\n")[0]
    )
    parser.add_argument("drawings", nargs="+", type=Path)
    parser.add_argument("--solids", type=Path, required=True, help="directory of SOURCE.tar files")
    parser.add_argument("--sample", type=int, default=300, help="drawings compared, 0 for all")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--least", type=float, default=99.0, help="agreement asked for, in percent")
    parser.add_argument("--hlr", action="store_true", help="cross-check the outlines' length")
    parser.add_argument("--verbose", action="store_true", help="name every drawing that differs")
    options = parser.parse_args(arguments)

    drawings = [d for path in options.drawings for d in read_drawings(path)]
    if options.sample and options.sample < len(drawings):
        drawings = random.Random(options.seed).sample(drawings, options.sample)
    drawings.sort(key=lambda d: d.id)
    sources = sorted({d.id.split("/")[0] for d in drawings})
    items = {item.name: item for item in list_items([options.solids / f"{s}.tar" for s in sources])}
    tally, types, outlines = Counter(), Counter(), []
    reader = ItemReader()
    for theirs in tqdm(drawings, unit="drawing", disable=None):
        found: str | None
        try:
            solids = reader.read(items[theirs.id.split("#")[0]])
            prepared = PreparedSolid(solids[0])
            assert theirs.truth is not None
            view = View.of_directions(theirs.truth.directions, theirs.projection.get("focal"))
            ours = prepared.draw(view)
            found = difference(ours, theirs)
        except ProjectionError as error:
            found = f"refused: {error}"
            ours = None
        tally["agree" if found is None else found.split(":")[0]] += 1
        if found is not None and options.verbose:
            tqdm.write(f"{theirs.id}: {found}")
        if ours is None:
            continue
        if found is None and (other := type_difference(ours, theirs)):
            types["other types"] += 1
            if options.verbose:
                tqdm.write(f"{theirs.id}: types {other}")
        if options.hlr:
            outlines.append((theirs.id, *outline_lengths(prepared, view)))
    share = 100.0 * tally["agree"] / max(1, len(drawings))
    print(f"{len(drawings)} drawings, {share:.2f}% agree: {dict(tally)}; {dict(types)}")
    if outlines:
        _report_outlines(outlines, options.verbose)
    return 0 if share >= options.least else 1


def _report_outlines(outlines: list[tuple[str, float, float]], verbose: bool) -> None:
    near = 0
    for name, ours, kernel in outlines:
        good = abs(ours - kernel) <= 0.01 + 0.01 * max(ours, kernel)
        near += good
        if verbose and not good:
            print(f"{name}: outlines {ours:.4f} long, by hidden-line removal {kernel:.4f}")
    print(f"outlines' length within 1% of hidden-line removal's: {near} of {len(outlines)}")


if __name__ == "__main__":
    sys.exit(main())
