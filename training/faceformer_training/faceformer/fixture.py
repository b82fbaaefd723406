"""``python -m faceformer_training.faceformer.fixture SHARD OUT`` writes the parity fixture.

OUT gets a small network of random weights for each variant, and ``expected.safetensors`` with what
it makes of the shard's drawings: every ``STRIDE``-th row of the memory, and how likely it finds
true sequences, with and without the causal mask. The test core/tests/faceformer_parity.rs compares
the program's own networks with them.
"""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

import torch
from safetensors.torch import save_file

from ..network.export import write
from ..network.fixture import with_random_weights
from .config import VARIANTS, ModelConfig
from .data import Shard
from .model import PointerModel

STRIDE = 7


def chances(model: PointerModel, encoded, sequences: torch.Tensor, causal: bool) -> torch.Tensor:
    """Log-probability of each token of ``[S, T]`` but the first, given those before it; without the
    causal mask a prefix is seen as a whole."""
    steps = []
    for t in range(1, sequences.shape[1]):
        logits = model.decode_sequences(encoded, sequences[None, :, :t], causal)[0, :, -1]
        steps.append(logits.log_softmax(-1).gather(1, sequences[:, t : t + 1]))
    return torch.cat(steps, 1)


@torch.no_grad()
def tables_of(model: PointerModel, shard: Shard, name: str) -> dict[str, torch.Tensor]:
    """The memory of the drawings, true sequences, and how likely the network finds each."""
    config = model.config
    memory, tokens, lengths = [], [], []
    sums: dict[str, list[float]] = {"causal": [], "non-causal": []}
    for i in range(len(shard)):
        points = torch.from_numpy(shard.points(i, config.variant)).float().flatten(1)
        encoded = model.encode(points[None], torch.zeros(1, len(points), dtype=torch.bool))
        memory.append(encoded[0][0, ::STRIDE])
        for sequence in shard.sequences(i, config)[::STRIDE]:
            sequence = torch.from_numpy(sequence[: config.steps + 1])
            tokens += sequence.tolist()
            lengths.append(len(sequence))
            for mode, list_ in sums.items():
                own = chances(model, encoded, sequence[None], mode == "causal")
                list_.append(own.sum().item())
    tables = {
        f"{name}.memory": torch.cat(memory),
        f"{name}.tokens": torch.tensor(tokens, dtype=torch.int32),
        f"{name}.lengths": torch.tensor(lengths, dtype=torch.int32),
    }
    return tables | {f"{name}.{mode}": torch.tensor(list_) for mode, list_ in sums.items()}


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="faceformer_training.faceformer.fixture", description=__doc__
    )
    parser.add_argument("shard", type=Path)
    parser.add_argument("output", type=Path)
    options = parser.parse_args()
    shard = Shard(options.shard)
    options.output.mkdir(parents=True, exist_ok=True)
    tables = {}
    for seed, variant in enumerate(VARIANTS):
        config = dataclasses.replace(ModelConfig.preset("tiny", variant), inputs=512, steps=12)
        model = with_random_weights(PointerModel(config), seed)
        tables |= tables_of(model, shard, variant)
        path = options.output / f"{variant}.safetensors"
        write(model.state_dict(), dataclasses.asdict(config), path)
    save_file(tables, options.output / "expected.safetensors")


if __name__ == "__main__":
    main()
