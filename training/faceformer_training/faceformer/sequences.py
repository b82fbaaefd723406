"""The sequences that the networks learn (paper, sections 4.1 and 4.3).

A face is a list of loops, and a loop the places of its co-edges, or of its edges, among the
drawing's tokens, which are in the order of their coordinates.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .config import EOS, FIRST_TYPE, SEP, SOS, TOKENS

Face = tuple[int, list[np.ndarray]]  # type (0 plane, 1 cylinder, 2 other), loops


def from_start(face: Face, loop: int, first: int, further_loops: str) -> np.ndarray:
    """Tokens of a face that begin with co-edge ``first`` of loop ``loop``, its type at the end.

    The start's loop is walked from the start. The other loops follow, the one with the lowest
    co-edge first; their co-edges are sorted, or walked from the lowest.
    """
    kind, loops = face
    own = np.roll(loops[loop], -first)
    rest = [further(other, further_loops) for k, other in enumerate(loops) if k != loop]
    rest.sort(key=lambda walk: walk[0])
    places = np.concatenate([own, *rest])
    return np.append(places + TOKENS, FIRST_TYPE + kind)


def further(loop: np.ndarray, further_loops: str) -> np.ndarray:
    if further_loops == "sorted":
        return np.sort(loop)
    return np.roll(loop, -int(loop.argmin()))


def every_start(faces: Sequence[Face]) -> list[tuple[int, int, int]]:
    """Face, loop and place in the loop of every co-edge: where Faceformer's sequences begin."""
    return [
        (f, k, first)
        for f, (_, loops) in enumerate(faces)
        for k, loop in enumerate(loops)
        for first in range(len(loop))
    ]


def all_at_once(faces: Sequence[Face], further_loops: str) -> np.ndarray:
    """All faces in one sequence, each begun with its lowest co-edge, in the order of these:
    seq2seq + co-edge."""
    walks = []
    for face in faces:
        lowest = min(range(len(face[1])), key=lambda k: face[1][k].min())
        first = int(face[1][lowest].argmin())
        walks.append(from_start(face, lowest, first, further_loops)[:-1])
    return joined(walks)


def sets_at_once(faces: Sequence[Face]) -> np.ndarray:
    """All faces in one sequence, each as its sorted edges: seq2seq. Loops hold edges' places."""
    return joined([np.unique(np.concatenate(loops)) + TOKENS for _, loops in faces])


def joined(faces: list[np.ndarray]) -> np.ndarray:
    faces.sort(key=lambda face: face.tolist())
    parts: list[np.ndarray] = [np.array([SOS])]
    for face in faces:
        parts += [face, np.array([SEP])]
    parts[-1] = np.array([EOS])
    return np.concatenate(parts)
