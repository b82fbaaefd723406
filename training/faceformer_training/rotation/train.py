"""``python -m faceformer_training.rotation.train CONFIG.json [--resume]`` trains the model.

The configuration is that of :class:`.config.TrainConfig`. The folder ``output`` gets ``curve.csv``
and ``last.ckpt``, from which ``--resume`` goes on; ``.export`` turns that into what the program
loads. The same command runs on one CPU, one GPU, several GPUs or several machines, see the
configuration's ``accelerator``, ``devices``, ``nodes`` and ``precision``. The same seed gives the
same batches and first weights whatever the device; sums are rounded as the device likes.
"""

from __future__ import annotations

import argparse
import csv
import dataclasses
import math
import time
from collections.abc import Iterator
from pathlib import Path

import torch
import torch.nn.functional as F
from lightning_fabric import Fabric
from tqdm import tqdm

from .config import TrainConfig
from .data import Batch, Place, Shard, batches, collate
from .model import RotationModel, flip_logits, order_logits


def losses(model: torch.nn.Module, batch: Batch) -> dict[str, torch.Tensor]:
    """The parts of the loss, and what share is right: triples, edges, orders at vertices, kinds."""
    scores, kinds = model(batch)
    orders = order_logits(scores, batch.orders)
    turned = flip_logits(scores, batch.flips)
    vertices = max(1, sum(len(logits) for logits in orders))
    order_loss = scores.new_zeros(())
    for logits in orders:
        target = logits.new_zeros(len(logits), dtype=torch.long)
        order_loss = order_loss + F.cross_entropy(logits, target, reduction="sum")
    by_hand = order_logits(batch.hand, batch.orders)
    return {
        "triple": F.binary_cross_entropy_with_logits(scores, batch.follows),
        "flip": F.softplus(-turned).mean() if len(turned) else scores.new_zeros(()),
        "order": order_loss / vertices,
        "kind": F.cross_entropy(kinds, batch.loop_kinds),
        "triples_right": ((scores > 0) == (batch.follows > 0.5)).float().mean(),
        "flips_right": share(turned > 0),
        "flips_right_by_hand": share(flip_logits(batch.hand, batch.flips) > 0),
        "orders_right": share(first_is_best(orders)),
        "orders_right_by_hand": share(first_is_best(by_hand)),
        "kinds_right": (kinds.argmax(1) == batch.loop_kinds).float().mean(),
    }


def share(right: torch.Tensor) -> torch.Tensor:
    """Mean; no number if there is nothing to be right about."""
    return right.float().mean()


def first_is_best(orders: list[torch.Tensor]) -> torch.Tensor:
    return torch.cat([logits.argmax(1) == 0 for logits in orders] or [torch.zeros(0)])


def weighted(parts: dict[str, torch.Tensor], config: TrainConfig) -> torch.Tensor:
    return (
        config.triple_weight * parts["triple"]
        + config.flip_weight * parts["flip"]
        + config.order_weight * parts["order"]
        + config.kind_weight * parts["kind"]
    )


def rate(config: TrainConfig, step: int) -> float:
    """Learning rate: linear up, then half a cosine down to a hundredth."""
    if step < config.warmup:
        return config.learning_rate * (step + 1) / config.warmup
    done = (step - config.warmup) / max(1, config.steps - config.warmup)
    return config.learning_rate * (0.01 + 0.99 * 0.5 * (1 + math.cos(math.pi * min(1.0, done))))


class Source:
    """Endless training batches, and the validation drawings, of the configured shards."""

    def __init__(self, config: TrainConfig, rank: int, world: int):
        self.config, self.rank, self.world = config, rank, world
        self.loaded: tuple[int, list[Shard]] | None = None

    def shards(self, epoch: int) -> list[Shard]:
        variation = epoch % len(self.config.train)
        if self.loaded is None or self.loaded[0] != variation:
            self.loaded = None
            self.loaded = (variation, [Shard(Path(p)) for p in self.config.train[variation]])
        return self.loaded[1]

    def places(self, shards: list[Shard]) -> list[Place]:
        """The drawings that are not too large."""
        return [
            (shard, i)
            for shard in shards
            for i in range(len(shard))
            if shard.sizes[i] <= self.config.max_edges
        ]

    def validation(self) -> list[Batch]:
        """The same drawings whenever it is asked."""
        places = self.places([Shard(Path(p)) for p in self.config.validation])
        step = max(1, len(places) // max(1, self.config.validate_drawings))
        groups = batches(places[::step], self.config.batch_edges, 0)
        return [collate([shard.drawing(i) for shard, i in group]) for group in groups]

    def batches(self, skip: int) -> Iterator[tuple[int, Batch, int]]:
        """Epoch, batch and its number of drawings, beginning after ``skip`` batches."""
        epoch = seen = 0
        while True:
            places = self.places(self.shards(epoch))
            if not places:
                raise ValueError("the shards hold no drawing to train on")
            seed = self.config.seed * 1_000_003 + epoch
            for k, group in enumerate(batches(places, self.config.batch_edges, seed)):
                if k % self.world != self.rank:
                    continue
                seen += 1
                if seen > skip:
                    yield epoch, collate([shard.drawing(i) for shard, i in group]), len(group)
            epoch += 1


@torch.no_grad()
def validate(model: torch.nn.Module, batch_list: list[Batch], device) -> dict[str, float]:
    """Means over the validation batches that have what is measured."""
    model.eval()
    seen: dict[str, list[float]] = {}
    for batch in batch_list:
        for name, value in losses(model, batch.to(device)).items():
            values = seen.setdefault(name, [])
            if not math.isnan(value):
                values.append(float(value))
    model.train()
    return {name: sum(values) / max(1, len(values)) for name, values in seen.items()}


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
    model = RotationModel(config.network())
    average = RotationModel(config.network())
    average.load_state_dict(model.state_dict())
    optimizer = torch.optim.AdamW(
        model.parameters(), config.learning_rate, (0.9, 0.98), weight_decay=config.weight_decay
    )
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
    for epoch, batch, count in source.batches(skip=state["step"]):
        step = state["step"]
        if step >= last_step:
            break
        for group in optimizer.param_groups:
            group["lr"] = rate(config, step)
        parts = losses(model, batch.to(fabric.device))
        loss = weighted(parts, config)
        optimizer.zero_grad(set_to_none=True)
        fabric.backward(loss)
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
        bar.set_postfix(loss=f"{loss.item():.4f}", epoch=epoch, refresh=False)
        done = state["step"] == last_step
        if state["step"] % config.validate_every == 0 or done:
            if curve is not None:
                row = {"step": state["step"], "epoch": epoch, "drawings": state["drawings"]}
                row["seconds"] = round(time.monotonic() - started, 1)
                row["train_loss"] = round(loss.item(), 5)
                measured = validate(average, held_out, fabric.device) if held_out else {}
                curve.add(row | {name: round(value, 5) for name, value in measured.items()})
            fabric.save(last, state | {"config": dataclasses.asdict(config.network())})
    bar.close()
    return last


class Curve:
    """Rows of a CSV file, one a validation."""

    def __init__(self, path: Path, resume: bool):
        self.path = path
        if not resume:
            path.unlink(missing_ok=True)

    def add(self, row: dict[str, float]) -> None:
        new = not self.path.exists()
        with self.path.open("a", newline="") as file:
            writer = csv.DictWriter(file, row)
            if new:
                writer.writeheader()
            writer.writerow(row)


def main() -> None:
    parser = argparse.ArgumentParser(prog="faceformer_training.rotation.train", description=__doc__)
    parser.add_argument("config", type=Path)
    parser.add_argument("--resume", action="store_true", help="go on from the last checkpoint")
    options = parser.parse_args()
    train(TrainConfig.read(options.config), options.resume)


if __name__ == "__main__":
    main()
