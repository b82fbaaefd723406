"""``python -m faceformer_training.rotation.fixture SHARD OUT`` writes the parity fixture.

OUT gets ``model.safetensors`` and ``model.json``, a small network of random weights, and
``expected.safetensors`` with what it makes of the shard's drawings: log-odds of every
``STRIDE``-th triple and logits of every ``STRIDE``-th loop's kinds, drawing after drawing. The test
core/tests/rotation_parity.rs compares the program's own network with them.
"""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

import torch
from safetensors.torch import save_file

from ..network.export import write
from ..network.fixture import with_random_weights
from .config import ModelConfig
from .data import Shard, collate
from .model import RotationModel

STRIDE = 7


@torch.no_grad()
def main() -> None:
    parser = argparse.ArgumentParser(
        prog="faceformer_training.rotation.fixture", description=__doc__
    )
    parser.add_argument("shard", type=Path)
    parser.add_argument("output", type=Path)
    options = parser.parse_args()
    config = dataclasses.replace(ModelConfig.preset("tiny"), width=16, hidden=24)
    model = with_random_weights(RotationModel(config), 0)
    shard = Shard(options.shard)
    scores, kinds = [], []
    for i in range(len(shard)):
        score, kind = model(collate([shard.drawing(i)]))
        scores.append(score[::STRIDE])
        kinds.append(kind[::STRIDE])
    options.output.mkdir(parents=True, exist_ok=True)
    write(model.state_dict(), dataclasses.asdict(config), options.output / "model.safetensors")
    expected = {"scores": torch.cat(scores), "kinds": torch.cat(kinds)}
    save_file(expected, options.output / "expected.safetensors")


if __name__ == "__main__":
    main()
