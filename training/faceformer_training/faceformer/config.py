"""Settings of the networks and of a training run."""

from __future__ import annotations

import dataclasses

from ..network.config import RunConfig

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
class TrainConfig(RunConfig):
    """A training run; see :class:`..network.config.RunConfig` for what is not here.

    ``batch_edges`` counts if ``batch_drawings`` is 0.
    """

    variant: str = "faceformer"
    steps: int = 20_000
    # Drawings in a batch, or with 0 as many as have `batch_edges` edges, padding included.
    batch_drawings: int = 0
    batch_edges: int = 512
    # Starts of each drawing in a batch, chosen anew each time; 0 takes all. Faceformer only.
    starts: int = 16
    learning_rate: float = 1e-4
    warmup: int = 0
    # "constant", or "cosine" down to a hundredth.
    schedule: str = "constant"
    dropout: float = 0.0
    average: float = 0.0
    validate_drawings: int = 200

    def network(self) -> ModelConfig:
        return dataclasses.replace(ModelConfig.preset(self.preset, self.variant), **self.model)
