"""Settings of the networks and of a training run."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

# Of the tables that `faceformer features --for faceformer` writes.
FORMAT = 1
POINTS = 50
# Special tokens before those of the drawing: padding, then the three types, or SOS, SEP and EOS.
TOKENS = 4
PAD, SOS, SEP, EOS = 0, 1, 2, 3
FIRST_TYPE = 1

VARIANTS = ("faceformer", "seq2seq-coedge", "seq2seq")


@dataclasses.dataclass(frozen=True)
class ModelConfig:
    """Size and conventions of a network; the description beside exported weights holds the same."""

    variant: str = "faceformer"
    width: int = 512
    heads: int = 8
    encoder_layers: int = 6
    decoder_layers: int = 6
    hidden: int = 1024
    points: int = POINTS
    # Most tokens of a drawing, and most tokens of a sequence without its end.
    inputs: int = 320
    steps: int = 64
    # "fitted" is what the tables have; "drawn" is the authors', see core/src/identify/faceformer.
    frame: str = "fitted"
    # Co-edges of a face's other loops: "sorted" as in the paper's text, "walked" as the authors'
    # released program has them.
    further_loops: str = "sorted"
    format: int = FORMAT

    @classmethod
    def preset(cls, name: str, variant: str = "faceformer") -> ModelConfig:
        """``paper`` is the paper's size, ``small`` a tenth of it, ``tiny`` is for tests.

        All faces at once make longer sequences: those variants have more steps.
        """
        if variant not in VARIANTS:
            raise ValueError(f"unknown variant {variant!r}: one of {', '.join(VARIANTS)}")
        steps = {} if variant == "faceformer" else {"steps": 640}
        return cls(variant=variant, **(PRESETS[name] | steps))


PRESETS: dict[str, dict[str, int]] = {
    "tiny": {"width": 16, "heads": 2, "encoder_layers": 2, "decoder_layers": 2, "hidden": 24},
    "small": {"width": 192, "heads": 6, "encoder_layers": 4, "decoder_layers": 4, "hidden": 384},
    "paper": {},
}


@dataclasses.dataclass
class TrainConfig:
    """A training run; the file is JSON with these keys, all of them optional.

    The shards and the output may as well be named on the command line.
    """

    # Epoch k takes list k modulo their number: variations of the same drawings.
    train: list[list[str]] = dataclasses.field(default_factory=list)
    output: str = ""
    # Shards of other solids, on which the curve is measured; none, no measurement.
    validation: list[str] = dataclasses.field(default_factory=list)
    variant: str = "faceformer"
    preset: str = "small"
    # Added to the preset, for instance {"further_loops": "walked"}.
    model: dict[str, Any] = dataclasses.field(default_factory=dict)
    steps: int = 20_000
    # Drawings in a batch, or with 0 as many as have `batch_edges` edges, padding included.
    batch_drawings: int = 0
    batch_edges: int = 512
    # Starts of each drawing in a batch, chosen anew each time; 0 takes all. Faceformer only.
    starts: int = 16
    # Drawings with more edges are not trained on.
    max_edges: int = 160
    learning_rate: float = 1e-4
    warmup: int = 0
    # "constant", or "cosine" down to a hundredth.
    schedule: str = "constant"
    dropout: float = 0.0
    clip: float = 1.0
    # Share of the old value in the running mean of the weights, which is what is kept; 0, no mean.
    average: float = 0.0
    seed: int = 0
    validate_every: int = 500
    validate_drawings: int = 200
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
        return dataclasses.replace(ModelConfig.preset(self.preset, self.variant), **self.model)
