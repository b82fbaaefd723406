"""Shards that ``faceformer features`` wrote, and batches of their drawings."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch
from safetensors import safe_open

from .config import FORMAT

# Degrees of vertices whose orders are in the loss.
DEGREES = (4, 5)


class Shard:
    """One file of tables in memory, cut into drawings by its ``*_start`` arrays."""

    def __init__(self, path: Path):
        with safe_open(path, framework="numpy") as file:
            metadata = file.metadata() or {}
            if metadata.get("format") != str(FORMAT):
                raise ValueError(f"{path}: not tables of format {FORMAT}; write them again")
            self.ids: list[str] = json.loads(metadata["ids"])
            # An offset-based view of what does not exist would be empty without a word.
            self.tables = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118
        start = self.tables["edge_start"].astype(np.int64)
        self.sizes = np.diff(start)
        self.relation_start = np.concatenate([[0], np.cumsum(self.sizes**2)])

    def __len__(self) -> int:
        return len(self.ids)

    def rows(self, name: str, start: str, i: int) -> np.ndarray:
        first, last = self.tables[start][i : i + 2]
        return self.tables[name][first:last]

    def drawing(self, i: int) -> dict[str, np.ndarray]:
        """The tables of one drawing, indices from 0."""
        d = {
            "edges": self.rows("edges", "edge_start", i),
            "corners": self.rows("corners", "corner_start", i),
            "corner_edges": self.rows("corner_edges", "corner_start", i),
            "triples": self.rows("triples", "triple_start", i),
            "triple_corners": self.rows("triple_corners", "triple_start", i),
            "hand": self.rows("hand", "triple_start", i),
            "follows": self.rows("follows", "triple_start", i),
            "loop_kinds": self.rows("loop_kinds", "loops_start", i),
        }
        first, last = self.relation_start[i : i + 2]
        n = self.sizes[i]
        d["relations"] = self.tables["relations"][first:last].reshape(n, n)
        first, last = self.tables["loops_start"][i : i + 2]
        start = self.tables["loop_start"][first : last + 1].astype(np.int64)
        d["loop_steps"] = self.tables["loop_steps"][start[0] : start[-1]]
        d["loop_sizes"] = np.diff(start)
        d["flips"] = flips(d["triple_corners"], d["corner_edges"], d["follows"])
        for degree in DEGREES:
            d[f"orders{degree}"] = self.rows(f"orders{degree}", f"orders{degree}_start", i)
        return d


def flips(triple_corners: np.ndarray, corner_edges: np.ndarray, follows: np.ndarray) -> np.ndarray:
    """The two true triples of each edge, and the two it would have were one end turned over.

    A drawing's parts can be turned over in depth one against the other; what holds them together
    are the edges between them. With true triples (a, b) and (c, d) at an edge, turning one of its
    ends over gives (a, d) and (c, b). Edges at which that changes nothing are left out. ``[F, 4]``.
    """
    true = np.flatnonzero(follows)
    edge = corner_edges[triple_corners[true, 0], 1]
    order = np.argsort(edge, kind="stable")
    true, edge = true[order], edge[order]
    first = np.flatnonzero(edge[:-1] == edge[1:])
    t, u = true[first], true[first + 1]
    (a, b), (c, d) = triple_corners[t].T, triple_corners[u].T
    keep = (a != c) & (b != d)
    t, u, a, b, c, d = (x[keep].astype(np.int64) for x in (t, u, a, b, c, d))
    # A block of triples lists the second corner first; both are numbered in a row.
    shift = d - b
    return np.stack([t, u, t + shift, u - shift], 1)


@dataclasses.dataclass
class Batch:
    """Drawings side by side: B of them padded to M edges, C corners, T triples and S loop steps.

    Indices into edges count through the padded ``[B * M]``, those into corners and triples through
    all of the batch.
    """

    edges: torch.Tensor  # [B, M, edge]
    padding: torch.Tensor  # [B, M], true where there is no edge
    relations: torch.Tensor  # [B, M, M], bits
    corners: torch.Tensor  # [C, corner]
    corner_edges: torch.Tensor  # [C, 2]
    triples: torch.Tensor  # [T, triple]
    triple_corners: torch.Tensor  # [T, 2]
    hand: torch.Tensor  # [T]
    follows: torch.Tensor  # [T], 0 or 1
    loop_steps: torch.Tensor  # [S], triples
    loop_of_step: torch.Tensor  # [S]
    loop_kinds: torch.Tensor  # [L]
    flips: torch.Tensor  # [F, 4], triples: two true ones, two of the edge turned over
    orders: dict[int, torch.Tensor]  # by degree d: [V, (d - 1)!, 2 d], triples, true order first

    def to(self, device: torch.device) -> Batch:
        def move(x):
            if isinstance(x, dict):
                return {k: move(v) for k, v in x.items()}
            return x.to(device, non_blocking=True)

        fields = dataclasses.fields(self)
        return Batch(**{f.name: move(getattr(self, f.name)) for f in fields})


def collate(drawings: Sequence[dict[str, np.ndarray]]) -> Batch:
    """Puts drawings into one batch; edges are padded to the longest."""
    longest = max(len(d["edges"]) for d in drawings)
    shape = (len(drawings), longest)
    edges = np.zeros((*shape, drawings[0]["edges"].shape[1]), np.float32)
    padding = np.ones(shape, bool)
    relations = np.zeros((*shape, longest), np.int32)
    parts: dict[str, list[np.ndarray]] = {}
    corners = triples = loops = 0
    for b, d in enumerate(drawings):
        n = len(d["edges"])
        edges[b, :n] = d["edges"]
        padding[b, :n] = False
        relations[b, :n, :n] = d["relations"]

        def put(name: str, x: np.ndarray) -> None:
            parts.setdefault(name, []).append(x)

        for name in ("corners", "triples", "hand", "follows", "loop_kinds"):
            put(name, d[name])
        put("corner_edges", d["corner_edges"].astype(np.int64) + b * longest)
        put("triple_corners", d["triple_corners"].astype(np.int64) + corners)
        put("loop_steps", d["loop_steps"].astype(np.int64) + triples)
        put("loop_of_step", np.repeat(np.arange(len(d["loop_sizes"])), d["loop_sizes"]) + loops)
        put("flips", d["flips"] + triples)
        for degree in DEGREES:
            put(f"orders{degree}", d[f"orders{degree}"].astype(np.int64) + triples)
        corners += len(d["corners"])
        triples += len(d["triples"])
        loops += len(d["loop_kinds"])
    joined = {name: torch.from_numpy(np.concatenate(list_)) for name, list_ in parts.items()}
    return Batch(
        edges=torch.from_numpy(edges),
        padding=torch.from_numpy(padding),
        relations=torch.from_numpy(relations),
        corners=joined["corners"].float(),
        corner_edges=joined["corner_edges"],
        triples=joined["triples"].float(),
        triple_corners=joined["triple_corners"],
        hand=joined["hand"],
        follows=joined["follows"].float(),
        loop_steps=joined["loop_steps"],
        loop_of_step=joined["loop_of_step"],
        loop_kinds=joined["loop_kinds"].long(),
        flips=joined["flips"],
        orders={degree: joined[f"orders{degree}"] for degree in DEGREES},
    )
