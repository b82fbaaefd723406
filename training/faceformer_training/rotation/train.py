"""``python -m faceformer_training.rotation.train CONFIG.json [--resume]`` trains the model.

The configuration is that of :class:`.config.TrainConfig`. The folder ``output`` gets ``curve.csv``
and ``last.ckpt``, from which ``--resume`` goes on; ``network.export`` turns that into what the
program loads. The same command runs on one CPU, one GPU, several GPUs or several machines, see the
configuration's ``accelerator``, ``devices``, ``nodes`` and ``precision``. The same seed gives the
same batches and first weights whatever the device; sums are rounded as the device likes.
"""

from __future__ import annotations

import math
from pathlib import Path

import torch
import torch.nn.functional as F
from lightning_fabric import Fabric

from ..network.batches import Place, Source
from ..network.run import command, cosine, run
from .config import TrainConfig
from .data import Batch, Shard, collate
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


class RotationSource(Source):
    """Batches of the rotation engine's tables."""

    def open(self, path: Path) -> Shard:
        return Shard(path)

    def collate(self, group: list[Place], *seed: int) -> Batch:
        return collate([shard.drawing(i) for shard, i in group])


class RotationTask:
    """See :class:`..network.run.Task`."""

    def __init__(self, config: TrainConfig):
        self.config = config
        self.network = config.network()

    def models(self) -> tuple[RotationModel, RotationModel]:
        return RotationModel(self.network), RotationModel(self.network)

    def optimizer(self, model: torch.nn.Module) -> torch.optim.Optimizer:
        decay = self.config.weight_decay
        rate = self.config.learning_rate
        return torch.optim.AdamW(model.parameters(), rate, (0.9, 0.98), weight_decay=decay)

    def source(self, rank: int, world: int) -> Source:
        return RotationSource(self.config, rank, world)

    def rate(self, step: int) -> float:
        return cosine(self.config, step)

    def losses(self, model: torch.nn.Module, batch: Batch) -> dict[str, torch.Tensor]:
        parts = losses(model, batch)
        return {"loss": weighted(parts, self.config)} | parts

    @torch.no_grad()
    def validate(
        self, model: torch.nn.Module, held_out: list[Batch], fabric: Fabric
    ) -> dict[str, float]:
        """Means over the validation batches that have what is measured."""
        model.eval()
        seen: dict[str, list[float]] = {}
        for batch in held_out:
            for name, value in losses(model, batch.to(fabric.device)).items():
                values = seen.setdefault(name, [])
                if not math.isnan(value):
                    values.append(float(value))
        model.train()
        return {name: sum(values) / max(1, len(values)) for name, values in seen.items()}


def train(config: TrainConfig, resume: bool, stop: int | None = None) -> Path:
    """Trains, up to step ``stop`` if given, and returns the path of the last checkpoint."""
    return run(RotationTask(config), resume, stop)


if __name__ == "__main__":
    command("faceformer_training.rotation.train", __doc__, TrainConfig, train)
