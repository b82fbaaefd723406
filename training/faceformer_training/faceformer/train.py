"""``python -m faceformer_training.faceformer.train CONFIG.json`` trains one of the paper's models.

The configuration is that of :class:`.config.TrainConfig`; training/configs/faceformer has the three
models at the paper's size and at a smaller one. Each ``--train`` is the shards of one epoch. The
folder ``output`` gets ``curve.csv`` and ``last.ckpt``, from which ``--resume`` goes on;
``network.export`` turns that into what the program loads. The same command runs on one CPU, one
GPU, several GPUs or several machines. The same seed gives the same batches and first weights
whatever the device.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from lightning_fabric import Fabric

from ..network.batches import Place, Source
from ..network.run import command, cosine, run
from .config import PAD, TrainConfig
from .data import Batch, Shard, collate
from .model import PointerModel


def losses(model: torch.nn.Module, batch: Batch) -> dict[str, torch.Tensor]:
    """Cross-entropy a token, and the shares of tokens and of whole sequences that are right.

    A sequence all of whose tokens are the likeliest ones is what greedy decoding gives.
    """
    logits = model(batch)
    there = batch.targets != PAD
    loss = F.cross_entropy(logits.flatten(0, 1), batch.targets.flatten(), ignore_index=PAD)
    wrong = (logits.argmax(-1) != batch.targets) & there
    # Tokens of each sequence, and the wrong ones among them; what is no token counts as 0.
    parts = batch.parts.clamp(min=0)
    sequences = parts.new_zeros(len(parts), int(parts.max()) + 1)
    lengths = sequences.scatter_add(1, parts, there.long())
    mistakes = sequences.scatter_add(1, parts, wrong.long())
    return {
        "loss": loss,
        "tokens_right": 1 - wrong.sum() / there.sum(),
        "sequences_right": 1 - (mistakes > 0).sum() / (lengths > 0).sum(),
    }


class PointerSource(Source):
    """Batches of the paper's tables."""

    def __init__(self, config: TrainConfig, rank: int, world: int):
        super().__init__(config, rank, world)
        self.network = config.network()

    def open(self, path: Path) -> Shard:
        return Shard(path)

    def fits(self, shard: Shard, i: int) -> bool:
        """Whether the network has positions for a drawing, and it is not too large."""
        return super().fits(shard, i) and shard.fits(i, self.network)

    def groups(self, places: list[Place], seed: int) -> Iterator[list[Place]]:
        size = self.config.batch_drawings
        if size == 0:
            yield from super().groups(places, seed)
            return
        order = np.random.default_rng(seed).permutation(len(places))
        for first in range(0, len(order), size):
            yield [places[k] for k in order[first : first + size]]

    def collate(self, group: list[Place], *seed: int) -> Batch:
        return collate(group, self.network, self.config.starts, np.random.default_rng(seed))


class PointerTask:
    """See :class:`..network.run.Task`."""

    def __init__(self, config: TrainConfig):
        self.config = config
        self.network = config.network()

    def models(self) -> tuple[PointerModel, PointerModel]:
        return PointerModel(self.network, self.config.dropout), PointerModel(self.network)

    def optimizer(self, model: torch.nn.Module) -> torch.optim.Optimizer:
        return torch.optim.Adam(model.parameters(), self.config.learning_rate)

    def source(self, rank: int, world: int) -> Source:
        return PointerSource(self.config, rank, world)

    def rate(self, step: int) -> float:
        """Linear up, then constant or half a cosine down to a hundredth."""
        if self.config.schedule == "constant" and step >= self.config.warmup:
            return self.config.learning_rate
        return cosine(self.config, step)

    def losses(self, model: torch.nn.Module, batch: Batch) -> dict[str, torch.Tensor]:
        return losses(model, batch)

    @torch.no_grad()
    def validate(
        self, model: torch.nn.Module, held_out: list[Batch], fabric: Fabric
    ) -> dict[str, float]:
        """Means over the validation batches, each weighed by its drawings."""
        model.eval()
        sums: dict[str, float] = {}
        drawings = sum(len(batch.points) for batch in held_out)
        for batch in held_out:
            with fabric.autocast():
                parts = losses(model, batch.to(fabric.device))
            for name, value in parts.items():
                sums[name] = sums.get(name, 0.0) + float(value) * len(batch.points)
        model.train()
        return {name: value / drawings for name, value in sums.items()}


def train(config: TrainConfig, resume: bool, stop: int | None = None) -> Path:
    """Trains, up to step ``stop`` if given, and returns the path of the last checkpoint."""
    return run(PointerTask(config), resume, stop)


if __name__ == "__main__":
    command("faceformer_training.faceformer.train", __doc__, TrainConfig, train)
