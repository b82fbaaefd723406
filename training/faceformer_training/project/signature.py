"""What tells solids apart and what makes them one family; none of it depends on a view.

Three keys, each a short hash:

- ``shape``: topology and size. Faces coloured by type, loops and edges, refined three times by
  their neighbours' colours (Weisfeiler and Leman 1968); lengths of all edges, and the volume, to
  1e-3. Equal keys: the same solid, perhaps moved or mirrored.
- ``views``: the drawn lines of the views along the three axes on a grid, up to mirroring and
  swapping axes, as the paper compares three orthogonal views; with three digits of extents and
  volume, since boxes of different sizes look alike on a grid. It finds duplicates whose B-reps
  differ (a circle in one arc or in two).
- ``family``: topology alone, and of a repeated feature only that it is there: the set of
  faces' neighbourhoods, not their numbers. A pin header with four pins and one with five are of
  one family, and so are two sizes of a screw. Families are split into train, valid and test as a
  whole.
"""

from __future__ import annotations

import hashlib

import numpy as np

from .solid import PreparedSolid

GRID = 127
CELL = 2.0 / 126.6
"""An odd number of cells puts the planes of symmetry in the middle of a cell, and the odd size
keeps round coordinates off the cells' borders."""


def _hash(data: object) -> str:
    return hashlib.blake2b(repr(data).encode(), digest_size=8).hexdigest()


def _neighbours(solid: PreparedSolid) -> list[list[int]]:
    faces: list[list[int]] = [[] for _ in solid.brep.faces]
    for edge in solid.brep.edges:
        if edge.curve is not None and not edge.seam:
            (a, _), (b, _) = edge.uses
            faces[a].append(b)
            faces[b].append(a)
    return faces


def _drawn_edges(solid: PreparedSolid, face: int) -> int:
    edges = solid.brep.edges
    wires = solid.brep.faces[face].wires
    return sum(
        edges[c.edge].curve is not None and not edges[c.edge].seam for wire in wires for c in wire
    )


def shape_key(solid: PreparedSolid) -> str:
    """Key of a solid's topology and size."""
    neighbours = _neighbours(solid)
    colours = [
        _hash((face.surface.label, len(face.wires), _drawn_edges(solid, i)))
        for i, face in enumerate(solid.brep.faces)
    ]
    for _ in range(3):
        colours = [
            _hash((colour, sorted(colours[j] for j in around)))
            for colour, around in zip(colours, neighbours, strict=True)
        ]
    lengths = sorted(round(float(_length(line)), 3) for line in _lines(solid))
    return _hash((sorted(colours), lengths, round(solid.volume, 3)))


def family_key(solid: PreparedSolid) -> str:
    """Key of a solid's family: its faces' kinds and their neighbours' kinds, as sets."""
    neighbours = _neighbours(solid)
    colours = [
        _hash((face.surface.label, len(face.wires) > 1, min(6, _drawn_edges(solid, i))))
        for i, face in enumerate(solid.brep.faces)
    ]
    for _ in range(2):
        colours = [
            _hash((colour, sorted({colours[j] for j in around})))
            for colour, around in zip(colours, neighbours, strict=True)
        ]
    return _hash(sorted(set(colours)))


def views_key(solid: PreparedSolid) -> str:
    """Key of the three orthogonal views."""
    # A whole sphere or torus has no lines at all.
    dense = np.vstack([np.zeros((0, 3)), *(_dense(line) for line in _lines(solid))])
    cells = np.floor(dense / CELL + GRID / 2).astype(int).clip(0, GRID - 1)
    images = []
    for a, b in ((0, 1), (1, 2), (2, 0)):
        image = np.zeros((GRID, GRID), dtype=bool)
        image[cells[:, a], cells[:, b]] = True
        variants = [
            np.packbits(turned[:: flip[0], :: flip[1]]).tobytes()
            for turned in (image, image.T)
            for flip in ((1, 1), (1, -1), (-1, 1), (-1, -1))
        ]
        images.append(min(variants))
    extents = sorted(round(float(x), 3) for x in np.ptp(dense, axis=0)) if len(dense) else []
    return _hash((b"".join(sorted(images)), extents, f"{solid.volume:.2e}"))


def _lines(solid: PreparedSolid) -> list[np.ndarray]:
    chord_error = solid.options.chord_error
    return [
        edge.curve.polyline(edge.curve.first, edge.curve.last, chord_error)
        for edge in solid.brep.edges
        if edge.curve is not None and not edge.seam
    ]


def _length(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _dense(points: np.ndarray) -> np.ndarray:
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    along = np.linspace(0, length[-1], 2 + int(length[-1] / (0.3 * CELL)))
    return np.stack([np.interp(along, length, points[:, i]) for i in range(3)], axis=1)


def split_of(family: str, shares: tuple[float, float, float] = (0.9, 0.05, 0.05)) -> str:
    """``train``, ``valid`` or ``test`` for a family: by its key alone, the same in every run."""
    place = int(hashlib.blake2b(family.encode(), digest_size=8).hexdigest(), 16) / 2.0**64
    if place < shares[0]:
        return "train"
    return "valid" if place < shares[0] + shares[1] else "test"
