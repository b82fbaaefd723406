"""``python -m faceformer_training.faceformer.train CONFIG.json`` trains one of the paper's models.

The configuration is that of :class:`.config.TrainConfig`; training/configs/faceformer has the three
models at the paper's size and at a smaller one. Each ``--train`` is the shards of one epoch. The
folder ``output`` gets ``curve.csv`` and ``last.ckpt``, from which ``--resume`` goes on; ``.export``
turns that into what the program loads. The same command runs on one CPU, one GPU, several GPUs or
several machines. The same seed gives the same batches and first weights whatever the device.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from lightning_fabric import Fabric
from tqdm import tqdm

from ..rotation.data import batches
from ..rotation.train import Curve
from .config import PAD, TrainConfig
from .data import Batch, Place, Shard, collate, prefetched
from .model import PointerModel


def losses(model: torch.nn.Module, batch: Batch) -> dict[str, torch.Tensor]:
    """Cross-entropy a token, and the shares of tokens and of whole sequences that are right.

    A sequence all of whose tokens are the likeliest ones is what greedy decoding gives.
    """
    logits = model(batch)
    targets = batch.sequences[..., 1:]
    loss = F.cross_entropy(logits.flatten(0, 2), targets.flatten(), ignore_index=PAD)
    there = targets != PAD
    right = (logits.argmax(-1) == targets) | ~there
    sequences = there.any(-1)
    return {
        "loss": loss,
        "tokens_right": (right & there).sum() / there.sum(),
        "sequences_right": (right.all(-1) & sequences).sum() / sequences.sum(),
    }


def rate(config: TrainConfig, step: int) -> float:
    """Learning rate: linear up, then constant or half a cosine down to a hundredth."""
    if step < config.warmup:
        return config.learning_rate * (step + 1) / config.warmup
    if config.schedule == "constant":
        return config.learning_rate
    done = (step - config.warmup) / max(1, config.steps - config.warmup)
    return config.learning_rate * (0.01 + 0.99 * 0.5 * (1 + math.cos(math.pi * min(1.0, done))))


class Source:
    """Batches without end; epoch k reads the shards of list k modulo their number."""

    def __init__(self, config: TrainConfig, rank: int, world: int):
        self.config, self.rank, self.world = config, rank, world
        self.network = config.network()
        self.loaded: tuple[int, list[Shard]] | None = None

    def shards(self, epoch: int) -> list[Shard]:
        which = epoch % len(self.config.train)
        if self.loaded is None or self.loaded[0] != which:
            self.loaded = None
            self.loaded = (which, [Shard(Path(p)) for p in self.config.train[which]])
        return self.loaded[1]

    def places(self, shards: list[Shard]) -> list[Place]:
        """The drawings that the network has positions for and that are not too large."""
        return [
            (shard, i)
            for shard in shards
            for i in range(len(shard))
            if shard.sizes[i] <= self.config.max_edges and shard.fits(i, self.network)
        ]

    def groups(self, places: list[Place], seed: int) -> Iterator[list[Place]]:
        size = self.config.batch_drawings
        if size == 0:
            yield from batches(places, self.config.batch_edges, seed)
            return
        order = np.random.default_rng(seed).permutation(len(places))
        for first in range(0, len(order), size):
            yield [places[k] for k in order[first : first + size]]

    def collate(self, group: list[Place], *seed: int) -> Batch:
        return collate(group, self.network, self.config.starts, np.random.default_rng(seed))

    def validation(self) -> list[Batch]:
        """The same drawings and starts whenever it is asked."""
        places = self.places([Shard(Path(p)) for p in self.config.validation])
        step = max(1, len(places) // max(1, self.config.validate_drawings))
        groups = list(batches(places[::step], self.config.batch_edges, 0))
        return [self.collate(group, 0, k) for k, group in enumerate(groups)]

    def batches(self, skip: int) -> Iterator[tuple[int, Batch, int]]:
        """Epoch, batch and its number of drawings, beginning after ``skip`` batches."""
        if not self.config.train:
            raise ValueError("no shards to train on: name them in the configuration or by --train")
        epoch = seen = 0
        while True:
            places = self.places(self.shards(epoch))
            if not places:
                raise ValueError("the shards hold no drawing to train on")
            seed = self.config.seed * 1_000_003 + epoch
            for k, group in enumerate(self.groups(places, seed)):
                if k % self.world != self.rank:
                    continue
                seen += 1
                if seen > skip:
                    yield epoch, self.collate(group, seed, k), len(group)
            epoch += 1


@torch.no_grad()
def validate(model: torch.nn.Module, batch_list: list[Batch], fabric: Fabric) -> dict[str, float]:
    """Means over the validation batches, each weighed by its drawings."""
    model.eval()
    sums: dict[str, float] = {}
    drawings = sum(len(batch.points) for batch in batch_list)
    for batch in batch_list:
        with fabric.autocast():
            parts = losses(model, batch.to(fabric.device))
        for name, value in parts.items():
            sums[name] = sums.get(name, 0.0) + float(value) * len(batch.points)
    model.train()
    return {name: value / drawings for name, value in sums.items()}


def train(config: TrainConfig, resume: bool, stop: int | None = None) -> Path:
    """Trains, up to step ``stop`` if given, and returns the path of the last checkpoint."""
    torch.set_num_threads(config.threads)
    fabric = Fabric(
        accelerator=config.accelerator,
        devices=config.devices,
        num_nodes=config.nodes,
        precision=config.precision,
    )
    fabric.launch()
    torch.manual_seed(config.seed)
    output = Path(config.output)
    last = output / "last.ckpt"
    if fabric.is_global_zero:
        output.mkdir(parents=True, exist_ok=True)
    network = config.network()
    model = PointerModel(network, config.dropout)
    average = PointerModel(network)
    average.load_state_dict(model.state_dict())
    optimizer = torch.optim.Adam(model.parameters(), config.learning_rate)
    model, optimizer = fabric.setup(model, optimizer)
    average = fabric.to_device(average)
    state = {"model": model, "optimizer": optimizer, "average": average, "step": 0, "drawings": 0}
    if resume:
        fabric.load(last, state)
    source = Source(config, fabric.global_rank, fabric.world_size)
    held_out = source.validation() if fabric.is_global_zero else []
    curve = Curve(output / "curve.csv", resume) if fabric.is_global_zero else None
    bar = tqdm(total=config.steps, initial=state["step"], disable=not fabric.is_global_zero)
    started = time.monotonic()
    last_step = config.steps if stop is None else min(stop, config.steps)
    for epoch, batch, count in prefetched(source.batches(skip=state["step"])):
        step = state["step"]
        if step >= last_step:
            break
        for group in optimizer.param_groups:
            group["lr"] = rate(config, step)
        # Dropout of a step is the same whether or not the run was stopped before it.
        torch.manual_seed((config.seed << 32) + step * fabric.world_size + fabric.global_rank)
        parts = losses(model, batch.to(fabric.device))
        optimizer.zero_grad(set_to_none=True)
        fabric.backward(parts["loss"])
        fabric.clip_gradients(model, optimizer, max_norm=config.clip)
        optimizer.step()
        # The mean begins short, so that the first weights are soon forgotten.
        keep = min(config.average, (step + 1) / (step + 10))
        with torch.no_grad():
            for mean, new in zip(average.parameters(), model.parameters(), strict=True):
                mean.lerp_(new.detach().to(mean.dtype), 1 - keep)
        state["step"] += 1
        state["drawings"] += count * fabric.world_size
        bar.update()
        bar.set_postfix(loss=f"{parts['loss'].item():.4f}", epoch=epoch, refresh=False)
        done = state["step"] == last_step
        if state["step"] % config.validate_every == 0 or done:
            if curve is not None:
                row = {"step": state["step"], "epoch": epoch, "drawings": state["drawings"]}
                row["seconds"] = round(time.monotonic() - started, 1)
                row |= {f"train_{name}": round(v.item(), 5) for name, v in parts.items()}
                measured = validate(average, held_out, fabric) if held_out else {}
                curve.add(row | {name: round(value, 5) for name, value in measured.items()})
            fabric.save(last, state | {"config": dataclasses.asdict(network)})
    bar.close()
    return last


def main() -> None:
    parser = argparse.ArgumentParser(prog="faceformer_training.faceformer.train")
    parser.description = __doc__
    parser.add_argument("config", type=Path)
    parser.add_argument(
        "--train", nargs="+", action="append", metavar="SHARD", help="shards of one epoch"
    )
    parser.add_argument("--validation", nargs="+", metavar="SHARD", help="shards to measure on")
    parser.add_argument("--output", metavar="DIR", help="folder of the run")
    parser.add_argument("--resume", action="store_true", help="go on from the last checkpoint")
    options = parser.parse_args()
    config = TrainConfig.read(options.config)
    for name in ("train", "validation", "output"):
        if (value := getattr(options, name)) is not None:
            setattr(config, name, value)
    if not config.output:
        parser.error("no folder for the run: name it in the configuration or by --output")
    train(config, options.resume)


if __name__ == "__main__":
    main()
