"""``python -m faceformer_training.faceformer.export RUN/last.ckpt OUT.safetensors [--float32]``

Writes the weights, or their running mean, and beside it ``OUT.json``: the network's size and
conventions and the SHA-256 of the weights, which the program checks before it uses them.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import torch

from ..rotation.export import write


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="faceformer_training.faceformer.export", description=__doc__
    )
    parser.add_argument("checkpoint", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--float32", action="store_true", help="whole instead of half precision")
    options = parser.parse_args()
    state = torch.load(options.checkpoint, map_location="cpu", weights_only=True)
    dtype = torch.float32 if options.float32 else torch.float16
    weights = {name: tensor.to(dtype) for name, tensor in state["average"].items()}
    write(weights, state["config"], options.output)


if __name__ == "__main__":
    main()
