"""``python -m faceformer_training.faceformer.convert AUTHORS.ckpt OUT.safetensors`` converts a
checkpoint of the authors' released program (PyTorch Lightning; the public repository
manycore-research/faceformer).

``faceformer eval --engine faceformer --model OUT.safetensors --non-causal`` then runs it as that
program does. Their networks see coordinates as drawn, a solid's half diagonal being 1, and have the
loops after the first walked from their lowest co-edges; the description beside the weights says
so.
"""

from __future__ import annotations

import argparse
import dataclasses
import pickle
import re
import types
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import torch

from ..network.export import write
from .config import TOKENS, VARIANTS, ModelConfig

# Their names of modules, without the "model." of the Lightning module, and ours.
RENAMED = [
    (r"val_enc\.embedding_token\.", "token."),
    (r"val_enc\.embedding_value\.0\.", "embed."),
    (r"val_enc\.embedding_value\.2\.", "embed_out."),
    (r"query_pos_enc\.pos_embed\.", "step."),
    (r"pos_enc\.pos_embed\.", "position."),
    (r"(encoder|decoder)\.norm\.", r"\1_norm."),
    (r"(encoder|decoder)\.layers\.(\d+)\.self_attn\.in_proj_", r"\1.\2.self_qkv."),
    (r"(encoder|decoder)\.layers\.(\d+)\.self_attn\.out_proj\.", r"\1.\2.self_out."),
    (r"decoder\.layers\.(\d+)\.multihead_attn\.in_proj_", r"decoder.\1.cross_qkv."),
    (r"decoder\.layers\.(\d+)\.multihead_attn\.out_proj\.", r"decoder.\1.cross_out."),
    (r"(encoder|decoder)\.layers\.(\d+)\.linear1\.", r"\1.\2.up."),
    (r"(encoder|decoder)\.layers\.(\d+)\.linear2\.", r"\1.\2.down."),
    (r"(encoder|decoder)\.layers\.(\d+)\.norm1\.", r"\1.\2.self_norm."),
    (r"encoder\.layers\.(\d+)\.norm2\.", r"encoder.\1.hidden_norm."),
    (r"decoder\.layers\.(\d+)\.norm2\.", r"decoder.\1.cross_norm."),
    (r"decoder\.layers\.(\d+)\.norm3\.", r"decoder.\1.hidden_norm."),
    (r"project\.", "pointer."),
]
# Buffers that hold 0, 1, 2, ...
DROPPED = re.compile(r"(query_)?pos_enc\.position$")


class _Inert(dict):
    """Stands for any object that a checkpoint holds beside its tensors: what it would do to come
    into being is not done; of a mapping the entries remain."""

    def __init__(self, *_: Any, **__: Any):
        super().__init__()

    def __setstate__(self, state: Any) -> None:
        if isinstance(state, Mapping):
            self.update(state)

    def append(self, _: Any) -> None:
        pass

    def extend(self, _: Any) -> None:
        pass


class _Unpickler(pickle.Unpickler):
    """Makes tensors and plain containers, and puts :class:`_Inert` for everything else: a
    checkpoint is somebody else's file, and its settings are of classes that are not installed."""

    plain = {
        ("collections", "OrderedDict"),
        ("torch._utils", "_rebuild_tensor_v2"),
        ("torch._utils", "_rebuild_parameter"),
    }

    def find_class(self, module: str, name: str) -> Any:
        storage = module == "torch" and name.endswith("Storage")
        if storage or (module, name) in self.plain:
            return super().find_class(module, name)
        return _Inert


_pickle = types.ModuleType("checkpoint_pickle")
_pickle.Unpickler = _Unpickler
_pickle.load = lambda file, **options: _Unpickler(file, **options).load()


def read(path: Path) -> dict[str, Any]:
    """The checkpoint's tensors and plain settings; nothing of it is run."""
    return torch.load(path, map_location="cpu", pickle_module=_pickle, weights_only=False)


def settings(node: Any) -> Iterator[tuple[str, Any]]:
    """Names and values of all plain settings, however deep."""
    if not isinstance(node, Mapping):
        return
    for name, value in node.items():
        if isinstance(value, Mapping):
            yield from settings(value)
        elif isinstance(value, (str, int, float, bool)):
            yield str(name), value


def renamed(state: Mapping[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """The weights by our names. Raises ``ValueError`` for one that is none of the network's."""
    ours = {}
    for theirs, tensor in state.items():
        name = theirs.removeprefix("model.")
        if DROPPED.fullmatch(name):
            continue
        for pattern, replacement in RENAMED:
            if match := re.match(pattern, name):
                ours[match.expand(replacement) + name[match.end() :]] = tensor.float()
                break
        else:
            raise ValueError(f"{theirs!r} is no weight of the released network")
    return ours


def described(
    weights: Mapping[str, torch.Tensor], told: Mapping[str, Any], variant: str | None, heads: int
) -> ModelConfig:
    """Size and conventions, from the shapes and from what the settings tell.

    Raises ``ValueError`` if neither they nor ``variant`` tell which of the models it is.
    """
    if variant is None:
        if "model_class" not in told:
            raise ValueError("the checkpoint does not tell its model: name it by --variant")
        if str(told["model_class"]).endswith("Parallel"):
            variant = "faceformer"
        else:
            variant = "seq2seq-coedge" if told.get("is_coedge", True) else "seq2seq"

    def layers(stack: str) -> int:
        return len({name.split(".")[1] for name in weights if name.startswith(f"{stack}.")})

    width, points = weights["embed.weight"].shape
    return ModelConfig(
        variant=variant,
        width=width,
        heads=int(told.get("num_head", heads)),
        encoder_layers=layers("encoder"),
        decoder_layers=layers("decoder"),
        hidden=len(weights["encoder.0.up.weight"]),
        points=points // 2,
        inputs=len(weights["position.weight"]) - TOKENS,
        steps=len(weights["step.weight"]),
        frame="drawn",
        further_loops="walked",
    )


def convert(
    path: Path, output: Path, variant: str | None = None, heads: int = 8, half: bool = False
) -> ModelConfig:
    """Converts a checkpoint; returns what the network is. Raises ``ValueError``."""
    checkpoint = read(path)
    weights = renamed(checkpoint.get("state_dict", checkpoint))
    config = described(weights, dict(settings(checkpoint.get("hyper_parameters"))), variant, heads)
    if half:
        weights = {name: tensor.half() for name, tensor in weights.items()}
    write(weights, dataclasses.asdict(config), output)
    return config


def main() -> None:
    parser = argparse.ArgumentParser(prog="faceformer_training.faceformer.convert")
    parser.description = __doc__
    parser.add_argument("checkpoint", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--variant", choices=VARIANTS, help="if the checkpoint does not tell")
    parser.add_argument("--heads", type=int, default=8, help="if the checkpoint does not tell")
    parser.add_argument("--half", action="store_true", help="half instead of whole precision")
    options = parser.parse_args()
    try:
        config = convert(
            options.checkpoint, options.output, options.variant, options.heads, options.half
        )
    except ValueError as error:
        raise SystemExit(f"{parser.prog}: {error}") from None
    print(
        f"{config.variant}: width {config.width}, {config.encoder_layers} + "
        f"{config.decoder_layers} layers, {config.inputs} tokens, {config.steps} steps"
    )


if __name__ == "__main__":
    main()
