"""Shards that ``faceformer features --for faceformer`` wrote, and batches of their drawings."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch
from safetensors import safe_open

from .config import FORMAT, PAD, TOKENS, ModelConfig
from .sequences import Face, all_at_once, every_start, from_start, sets_at_once


class Shard:
    """One file of tables in memory, cut into drawings by its ``*_start`` arrays."""

    def __init__(self, path: Path):
        with safe_open(path, framework="numpy") as file:
            metadata = file.metadata() or {}
            expected = {"format": str(FORMAT), "tables": "faceformer"}
            if {key: metadata.get(key) for key in expected} != expected:
                raise ValueError(
                    f"{path}: no tables of format {FORMAT} for faceformer; write them with "
                    "`faceformer features --for faceformer`"
                )
            self.ids: list[str] = json.loads(metadata["ids"])
            # An offset-based view of what does not exist would be empty without a word.
            self.tables = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118
        t = self.tables
        self.sizes = np.diff(t["edge_start"].astype(np.int64))
        # Co-edges of each face, and of each drawing the largest face.
        faces = np.diff(t["loop_start"].astype(np.int64)[t["face_start"]])
        self.faces = np.diff(t["faces_start"].astype(np.int64))
        self.largest = np.maximum.reduceat(faces, t["faces_start"][:-1])

    def __len__(self) -> int:
        return len(self.ids)

    def fits(self, i: int, config: ModelConfig) -> bool:
        """Whether the network has positions for the drawing and its sequences."""
        edges = int(self.sizes[i])
        if config.variant == "faceformer":
            return 2 * edges <= config.inputs and self.largest[i] <= config.steps
        tokens = edges if config.variant == "seq2seq" else 2 * edges
        return tokens <= config.inputs and 2 * edges + int(self.faces[i]) <= config.steps

    def points(self, i: int, variant: str) -> np.ndarray:
        """Points of the drawing's tokens, ``[tokens, points, 2]``."""
        first, last = self.tables["edge_start"][i : i + 2]
        own = self.tables["points"][first:last]
        order = self.order(i, variant)
        points = own[order >> 1]
        turned = (order & 1) == 1
        points[turned] = points[turned, ::-1]
        return points

    def order(self, i: int, variant: str) -> np.ndarray:
        """Indices ``2 edge + reversed`` of the drawing's tokens, in their order."""
        first, last = self.tables["edge_start"][i : i + 2].astype(np.int64)
        if variant == "seq2seq":
            return self.tables["edges"][first:last]
        return self.tables["coedges"][2 * first : 2 * last]

    def true_faces(self, i: int, variant: str) -> list[Face]:
        """The true faces; loops hold places among the drawing's tokens."""
        t = self.tables
        order = self.order(i, variant)
        place = np.empty(2 * int(self.sizes[i]), np.int64)
        place[order] = np.arange(len(order))
        if variant == "seq2seq":
            place[order ^ 1] = np.arange(len(order))
        faces: list[Face] = []
        for f in range(*t["faces_start"][i : i + 2]):
            starts = t["loop_start"][t["face_start"][f] : t["face_start"][f + 1] + 1]
            loops = [
                place[t["loop_coedges"][a:b]] for a, b in zip(starts, starts[1:], strict=False)
            ]
            faces.append((int(t["face_kinds"][f]), loops))
        return faces

    def sequences(
        self,
        i: int,
        config: ModelConfig,
        starts: int = 0,
        random: np.random.Generator | None = None,
    ) -> list[np.ndarray]:
        """What is to be learned from the drawing: one sequence a start, or one in all.

        With ``starts`` at most that many, chosen at random.
        """
        faces = self.true_faces(i, config.variant)
        if config.variant == "faceformer":
            places = every_start(faces)
            if random is not None and 0 < starts < len(places):
                picks = random.choice(len(places), starts, replace=False)
                places = [places[k] for k in picks]
            return [from_start(faces[f], *place, config.further_loops) for f, *place in places]
        if config.variant == "seq2seq-coedge":
            return [all_at_once(faces, config.further_loops)]
        return [sets_at_once(faces)]


@dataclasses.dataclass
class Batch:
    """B drawings side by side, padded to N tokens, and their sequences, one behind another.

    Most faces have four co-edges and few have many: side by side, half of the tokens would be
    padding. T is the number of tokens of all sequences of a drawing, padded.
    """

    points: torch.Tensor  # [B, N, 2 points]
    absent: torch.Tensor  # [B, N], true where there is no token
    tokens: torch.Tensor  # [B, T], all but the last of each sequence
    targets: torch.Tensor  # [B, T], what follows each, PAD where there is no token
    steps: torch.Tensor  # [B, T], its place in its sequence
    parts: torch.Tensor  # [B, T], the number of its sequence in the drawing

    def to(self, device: torch.device) -> Batch:
        fields = dataclasses.fields(self)
        moved = {f.name: getattr(self, f.name).to(device, non_blocking=True) for f in fields}
        return Batch(**moved)


Place = tuple[Shard, int]


def collate(
    places: Sequence[Place], config: ModelConfig, starts: int, random: np.random.Generator
) -> Batch:
    """Puts drawings into one batch; with ``starts`` at most that many sequences of each."""
    points = [shard.points(i, config.variant) for shard, i in places]
    chosen = [shard.sequences(i, config, starts, random) for shard, i in places]
    tokens = max(len(p) for p in points)
    padded = np.zeros((len(places), tokens, 2 * points[0].shape[1]), np.float32)
    absent = np.ones((len(places), tokens), bool)
    length = max(sum(len(s) - 1 for s in sequences) for sequences in chosen)
    # What is no token begins with a type, as good as any: it has no target.
    rows = np.zeros((4, len(places), length), np.int64)
    rows[0] = TOKENS - 1
    rows[1] = PAD
    rows[3] = -1
    for b, (own, sequences) in enumerate(zip(points, chosen, strict=True)):
        padded[b, : len(own)] = own.reshape(len(own), -1)
        absent[b, : len(own)] = False
        end = 0
        for s, sequence in enumerate(sequences):
            start, end = end, end + len(sequence) - 1
            rows[0, b, start:end] = sequence[:-1]
            rows[1, b, start:end] = sequence[1:]
            rows[2, b, start:end] = np.arange(end - start)
            rows[3, b, start:end] = s
    return Batch(*(torch.from_numpy(x) for x in (padded, absent, *rows)))
