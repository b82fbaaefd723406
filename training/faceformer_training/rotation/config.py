"""Settings of the network and of a training run."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

# Widths of the tables that `faceformer features` writes, format 1.
FORMAT = 1
EDGE, CORNER, TRIPLE, RELATIONS, KINDS = 87, 36, 54, 15, 6


@dataclasses.dataclass(frozen=True)
class ModelConfig:
    """Size of the network; the defaults of the inputs are those of the tables."""

    width: int = 128
    heads: int = 4
    layers: int = 4
    hidden: int = 384
    format: int = FORMAT
    edge: int = EDGE
    corner: int = CORNER
    triple: int = TRIPLE
    relations: int = RELATIONS
    kinds: int = KINDS

    @classmethod
    def preset(cls, name: str) -> ModelConfig:
        """``tiny`` is for tests and quick trials, ``small`` is meant to be shipped."""
        return cls(**PRESETS[name])


PRESETS: dict[str, dict[str, int]] = {
    "tiny": {"width": 32, "heads": 2, "layers": 2, "hidden": 64},
    "small": {"width": 96, "heads": 4, "layers": 4, "hidden": 288},
    "base": {"width": 192, "heads": 6, "layers": 6, "hidden": 768},
}


@dataclasses.dataclass
class TrainConfig:
    """A training run; the file is JSON with these keys, all but the shards optional."""

    # Epoch k takes list k modulo their number: variations of the same drawings.
    train: list[list[str]]
    output: str
    # Shards of other solids, on which the curve is measured; none, no measurement.
    validation: list[str] = dataclasses.field(default_factory=list)
    preset: str = "small"
    # Added to the preset, for instance {"width": 112}.
    model: dict[str, int] = dataclasses.field(default_factory=dict)
    steps: int = 10_000
    # Edges in a batch, padding included.
    batch_edges: int = 1024
    # Drawings with more edges are not trained on.
    max_edges: int = 160
    learning_rate: float = 1e-3
    warmup: int = 200
    weight_decay: float = 0.02
    clip: float = 1.0
    # Weights of the losses: triples, edges turned over, orders at vertices, kinds of loops.
    triple_weight: float = 1.0
    flip_weight: float = 1.0
    order_weight: float = 0.1
    kind_weight: float = 0.2
    # Share of the old value in the running mean of the weights, which is what is kept.
    average: float = 0.995
    seed: int = 0
    validate_every: int = 500
    validate_drawings: int = 400
    # See lightning-fabric: "cpu", "cuda", "auto"; "32-true", "bf16-mixed".
    accelerator: str = "auto"
    devices: int | str = 1
    nodes: int = 1
    precision: str = "32-true"
    threads: int = 1

    @classmethod
    def read(cls, path: Path) -> TrainConfig:
        data: dict[str, Any] = json.loads(path.read_text())
        known = {field.name for field in dataclasses.fields(cls)}
        unknown = sorted(set(data) - known)
        if unknown:
            raise ValueError(f"{path}: unknown keys {', '.join(unknown)}")
        return cls(**data)

    def network(self) -> ModelConfig:
        return dataclasses.replace(ModelConfig.preset(self.preset), **self.model)
