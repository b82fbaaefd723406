"""Settings that every run of training has."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from typing import Self


@dataclasses.dataclass
class RunConfig:
    """A training run; the file is JSON with these keys, all of them optional.

    The shards and the output may as well be named on the command line.
    """

    # Epoch k takes list k modulo their number: variations of the same drawings.
    train: list[list[str]] = dataclasses.field(default_factory=list)
    output: str = ""
    # Shards of other solids, on which the curve is measured; none, no measurement.
    validation: list[str] = dataclasses.field(default_factory=list)
    # Weights to begin with, as `network.export` wrote them for the same network; none, random ones.
    initial: str = ""
    preset: str = "small"
    # Added to the preset, for instance {"width": 112}.
    model: dict[str, Any] = dataclasses.field(default_factory=dict)
    steps: int = 10_000
    # Edges in a batch, padding included.
    batch_edges: int = 1024
    # Drawings with more edges are not trained on.
    max_edges: int = 160
    learning_rate: float = 1e-3
    warmup: int = 200
    clip: float = 1.0
    # Share of the old value in the running mean of the weights, which is what is kept; 0, no mean.
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
    # Processes that make batches; 0, a thread does. A fast GPU needs several.
    workers: int = 0

    @classmethod
    def read(cls, path: Path) -> Self:
        """The settings in a file. Raises ``ValueError`` for a key that is none."""
        data: dict[str, Any] = json.loads(path.read_text())
        known = {field.name for field in dataclasses.fields(cls)}
        unknown = sorted(set(data) - known)
        if unknown:
            raise ValueError(f"{path}: unknown keys {', '.join(unknown)}")
        return cls(**data)
