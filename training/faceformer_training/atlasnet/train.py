"""``python -m faceformer_training.atlasnet.train CONFIG.json [--resume]`` trains AtlasNet.

The configuration is that of :class:`TrainConfig`. The folder ``output`` gets ``curve.csv``, with
the Chamfer distances of the validation drawings, see :func:`measure`, and ``last.ckpt``, from which
``--resume`` goes on. ``--measure TABLES`` measures the last checkpoint on other drawings instead.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import time
from pathlib import Path

import numpy as np
import torch
from lightning_fabric import Fabric
from safetensors import safe_open
from tqdm import tqdm

from ..network.run import Curve
from .model import AtlasConfig, AtlasNet, either_way


@dataclasses.dataclass
class TrainConfig:
    """A training run; the file is JSON with these keys. Tables are those of :mod:`.points`."""

    train: list[str]
    output: str
    validation: list[str] = dataclasses.field(default_factory=list)
    model: dict[str, int] = dataclasses.field(default_factory=dict)
    steps: int = 100_000
    batch: int = 32
    # Points on all patches together, shared evenly, and as many of the solid's in each step.
    points: int = 2500
    learning_rate: float = 1e-3
    # Steps after which the rate is a tenth.
    drops: list[int] = dataclasses.field(default_factory=lambda: [80_000, 95_000])
    # Whether drawings and solids are mirrored, left and right, half of the time.
    mirror: bool = False
    seed: int = 0
    validate_every: int = 1000
    # See lightning-fabric.
    accelerator: str = "auto"
    precision: str = "32-true"
    threads: int = 1

    def rate(self, step: int) -> float:
        return self.learning_rate * 0.1 ** sum(step >= drop for drop in self.drops)


class Clouds:
    """Images and points of files, in memory."""

    def __init__(self, paths: list[str]):
        images, points = [], []
        for path in paths:
            with safe_open(path, framework="numpy") as file:
                images.append(file.get_tensor("images"))
                points.append(file.get_tensor("points"))
        self.images = np.concatenate(images) if images else np.zeros((0, 1, 1), np.uint8)
        self.points = np.concatenate(points) if points else np.zeros((0, 1, 3), np.float32)

    def __len__(self) -> int:
        return len(self.images)

    def batch(self, which: np.ndarray, device) -> tuple[torch.Tensor, torch.Tensor]:
        """Images from 0 to 1 and points."""
        images = torch.from_numpy(self.images[which]).to(device).float() / 255
        return images, torch.from_numpy(self.points[which]).to(device)


def squares(config: TrainConfig, network: AtlasConfig, count: int, seed: int) -> torch.Tensor:
    """Random points of the unit square for every patch of so many drawings."""
    random = torch.Generator().manual_seed(seed)
    each = config.points // network.patches
    return torch.rand(count, network.patches, each, 2, generator=random)


def mirrored(
    images: torch.Tensor, points: torch.Tensor, which: torch.Tensor
) -> tuple[torch.Tensor, torch.Tensor]:
    """Images ``[B, H, W]`` and points ``[B, P, 3]``, those drawings mirrored left and right that
    ``which``, ``[B]``, says."""
    which = which.to(images.device)[:, None, None]
    turned = points * points.new_tensor([-1, 1, 1])
    return torch.where(which, images.flip(2), images), torch.where(which, turned, points)


@torch.no_grad()
def measure(model, clouds: Clouds, config: TrainConfig, network: AtlasConfig, fabric) -> dict:
    """Chamfer distances of all drawings to all their points, in half diagonals.

    Mean and median of the sums of mean squares, mean, median and share below 1e-3 of the sums of
    mean distances.
    """
    model.eval()
    squared, plain = [], []
    for first in range(0, len(clouds), config.batch):
        which = np.arange(first, min(first + config.batch, len(clouds)))
        images, points = clouds.batch(which, fabric.device)
        square = squares(config, network, len(which), first).to(fabric.device)
        of_batch = either_way(model(images, square), points)
        squared += of_batch[0].tolist()
        plain += of_batch[1].tolist()
    model.train()
    return {
        "squared_mean": np.mean(squared),
        "squared_median": np.median(squared),
        "chamfer_mean": np.mean(plain),
        "chamfer_median": np.median(plain),
        "below_1e-3": np.mean(np.array(plain) < 1e-3),
    }


def train(config: TrainConfig, resume: bool, stop: int | None = None) -> Path:
    """Trains, up to step ``stop`` if given, and returns the path of the last checkpoint."""
    torch.set_num_threads(config.threads)
    fabric = Fabric(accelerator=config.accelerator, devices=1, precision=config.precision)
    fabric.launch()
    torch.manual_seed(config.seed)
    output = Path(config.output)
    output.mkdir(parents=True, exist_ok=True)
    last = output / "last.ckpt"
    network = AtlasConfig(**config.model)
    model = AtlasNet(network)
    optimizer = torch.optim.Adam(model.parameters(), config.learning_rate)
    model, optimizer = fabric.setup(model, optimizer)
    state = {"model": model, "optimizer": optimizer, "step": 0}
    if resume:
        fabric.load(last, state)
    clouds, held_out = Clouds(config.train), Clouds(config.validation)
    if not len(clouds):
        raise ValueError("the tables hold no drawing to train on")
    curve = Curve(output / "curve.csv", resume)
    started = time.monotonic()
    last_step = config.steps if stop is None else min(stop, config.steps)
    for step in tqdm(range(state["step"], last_step), initial=state["step"], total=config.steps):
        for group in optimizer.param_groups:
            group["lr"] = config.rate(step)
        random = np.random.default_rng((config.seed, step))
        which = random.choice(len(clouds), min(config.batch, len(clouds)), replace=False)
        images, points = clouds.batch(which, fabric.device)
        seed = config.seed * 1_000_003 + step
        square = squares(config, network, len(which), seed).to(fabric.device)
        some = random.permutation(points.shape[1])[: config.points]
        if config.mirror:
            turned = torch.from_numpy(random.random(len(which)) < 0.5)
            images, points = mirrored(images, points, turned)
        loss = either_way(model(images, square), points[:, some])[0].mean()
        optimizer.zero_grad(set_to_none=True)
        fabric.backward(loss)
        optimizer.step()
        state["step"] = step + 1
        if (step + 1) % config.validate_every == 0 or step + 1 == last_step:
            row = {"step": step + 1, "seconds": round(time.monotonic() - started, 1)}
            row["train_loss"] = round(loss.item(), 6)
            measured = measure(model, held_out, config, network, fabric) if len(held_out) else {}
            curve.add(row | {name: round(float(value), 6) for name, value in measured.items()})
            fabric.save(last, state | {"config": dataclasses.asdict(network)})
    return last


def measure_last(config: TrainConfig, tables: list[str]) -> dict[str, float]:
    """What :func:`measure` gives of the last checkpoint on the drawings of other tables."""
    torch.set_num_threads(config.threads)
    fabric = Fabric(accelerator=config.accelerator, devices=1, precision=config.precision)
    network = AtlasConfig(**config.model)
    model = fabric.setup(AtlasNet(network))
    fabric.load(Path(config.output) / "last.ckpt", {"model": model})
    measured = measure(model, Clouds(tables), config, network, fabric)
    return {name: round(float(value), 6) for name, value in measured.items()}


def main() -> None:
    parser = argparse.ArgumentParser(prog="faceformer_training.atlasnet.train", description=__doc__)
    parser.add_argument("config", type=Path)
    parser.add_argument("--resume", action="store_true", help="go on from the last checkpoint")
    parser.add_argument("--measure", nargs="+", metavar="TABLES", help="train nothing, measure")
    options = parser.parse_args()
    config = TrainConfig(**json.loads(options.config.read_text()))
    if options.measure:
        print(json.dumps(measure_last(config, options.measure)))
    else:
        train(config, options.resume)


if __name__ == "__main__":
    main()
