"""``python -m faceformer_training.faceformer.fixture SHARD OUT`` writes the parity fixture.

OUT gets a small network of random weights for each variant, and ``expected.safetensors`` with what
it makes of the shard's drawings: every ``STRIDE``-th row of the memory, and the sequences that it
decodes greedily, with and without the causal mask. The test core/tests/faceformer_parity.rs
compares the program's own networks with them.
"""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

import torch
from safetensors.torch import save_file

from ..rotation.export import write
from .config import VARIANTS, ModelConfig
from .data import Shard
from .decode import greedy
from .model import PointerModel

STRIDE = 7
# No token may win by less, or rounding could decide.
MARGIN = 3e-4


def random_model(config: ModelConfig, seed: int) -> PointerModel:
    """A network none of whose weights is zero or one, so that none can be forgotten."""
    torch.manual_seed(seed)
    model = PointerModel(config)
    with torch.no_grad():
        for name, weight in model.named_parameters():
            fan = weight.shape[-1] if weight.dim() > 1 else 4
            weight.normal_(0.0, fan**-0.5)
            if "norm.weight" in name:
                weight.add_(1.0)
    return model.eval()


def expected(model: PointerModel, shard: Shard, name: str) -> tuple[dict, float]:
    """What the network makes of the drawings, and the least margin of its tokens."""
    memory: list[torch.Tensor] = []
    modes: dict[str, list] = {"causal": [], "non-causal": []}
    for i in range(len(shard)):
        points = torch.from_numpy(shard.points(i, model.config.variant)).float().flatten(1)
        absent = torch.zeros(1, len(points), dtype=torch.bool)
        with torch.no_grad():
            memory.append(model.encode(points[None], absent)[0][0, ::STRIDE])
        for mode, decoded in modes.items():
            decoded += greedy(model, points, causal=mode == "causal")
    tables = {f"{name}.memory": torch.cat(memory)}
    for mode, decoded in modes.items():
        tokens = [t for d in decoded for t in d.tokens]
        lengths = [len(d.tokens) for d in decoded]
        sums = [d.log_probability for d in decoded]
        tables[f"{name}.{mode}.tokens"] = torch.tensor(tokens, dtype=torch.int32)
        tables[f"{name}.{mode}.lengths"] = torch.tensor(lengths, dtype=torch.int32)
        tables[f"{name}.{mode}.log_probability"] = torch.tensor(sums)
    margin = min(d.margin for decoded in modes.values() for d in decoded)
    return tables, margin


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
    for variant in VARIANTS:
        config = dataclasses.replace(ModelConfig.preset("tiny", variant), inputs=512, steps=12)
        for seed in range(1000):
            model = random_model(config, seed)
            made, margin = expected(model, shard, variant)
            if margin > MARGIN:
                break
        else:
            raise SystemExit(f"{variant}: no network is sure of its tokens")
        tables |= made
        path = options.output / f"{variant}.safetensors"
        write(model.state_dict(), dataclasses.asdict(config), path)
    save_file(tables, options.output / "expected.safetensors")


if __name__ == "__main__":
    main()
