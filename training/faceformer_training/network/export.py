"""``python -m faceformer_training.network.export RUN/last.ckpt OUT.safetensors [--float32]``

Writes the running mean of the weights, and beside it ``OUT.json``: the network's configuration and
the SHA-256 of the weights, which the program checks before it uses them.
"""

from __future__ import annotations

import argparse
import hashlib
import json
from pathlib import Path
from typing import Any

import torch
from safetensors.torch import save_file


def write(weights: dict[str, torch.Tensor], config: dict[str, Any], output: Path) -> Path:
    """Writes weights and their configuration; returns the path of the latter."""
    plain = {name: tensor.detach().cpu().contiguous() for name, tensor in weights.items()}
    save_file(plain, output)
    described = {"model": config, "sha256": hashlib.sha256(output.read_bytes()).hexdigest()}
    beside = output.with_suffix(".json")
    beside.write_text(json.dumps(described, indent=2) + "\n")
    return beside


def main() -> None:
    parser = argparse.ArgumentParser(prog="faceformer_training.network.export", description=__doc__)
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
