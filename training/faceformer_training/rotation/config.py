"""Settings of the network and of a training run."""

from __future__ import annotations

import dataclasses

from ..network.config import RunConfig

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
class TrainConfig(RunConfig):
    """A training run; see :class:`..network.config.RunConfig` for what is not here."""

    weight_decay: float = 0.02
    # Weights of the losses: triples, edges turned over, orders at vertices, kinds of loops.
    triple_weight: float = 1.0
    flip_weight: float = 1.0
    order_weight: float = 0.1
    kind_weight: float = 0.2

    def network(self) -> ModelConfig:
        return dataclasses.replace(ModelConfig.preset(self.preset), **self.model)
