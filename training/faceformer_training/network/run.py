"""A run of training: steps, checkpoints, the curve, the command line."""

from __future__ import annotations

import argparse
import csv
import dataclasses
import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

import torch
from lightning_fabric import Fabric
from safetensors.torch import load_file
from tqdm import tqdm

from .batches import Source, made_ahead
from .config import RunConfig


class Task(Protocol):
    """What is trained: the two networks, of which one becomes the running mean, and how."""

    config: RunConfig
    # Written into the checkpoint beside the weights.
    network: Any

    def models(self) -> tuple[torch.nn.Module, torch.nn.Module]: ...

    def optimizer(self, model: torch.nn.Module) -> torch.optim.Optimizer: ...

    def source(self, rank: int, world: int) -> Source: ...

    def rate(self, step: int) -> float: ...

    def losses(self, model: torch.nn.Module, batch: Any) -> dict[str, torch.Tensor]:
        """What is made small, ``loss``, and whatever else the curve should show."""
        ...

    def validate(
        self, model: torch.nn.Module, held_out: list, fabric: Fabric
    ) -> dict[str, float]: ...


def cosine(config: RunConfig, step: int) -> float:
    """Learning rate: linear up, then half a cosine down to a hundredth."""
    if step < config.warmup:
        return config.learning_rate * (step + 1) / config.warmup
    done = (step - config.warmup) / max(1, config.steps - config.warmup)
    return config.learning_rate * (0.01 + 0.99 * 0.5 * (1 + math.cos(math.pi * min(1.0, done))))


def run(task: Task, resume: bool, stop: int | None = None) -> Path:
    """Trains, up to step ``stop`` if given, and returns the path of the last checkpoint."""
    config = task.config
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
    model, average = task.models()
    if config.initial:
        # Names and shapes must agree; `load_state_dict` says which do not.
        weights = load_file(config.initial)
        model.load_state_dict({name: weight.float() for name, weight in weights.items()})
    average.load_state_dict(model.state_dict())
    model, optimizer = fabric.setup(model, task.optimizer(model))
    average = fabric.to_device(average)
    state = {"model": model, "optimizer": optimizer, "average": average, "step": 0, "drawings": 0}
    if resume:
        fabric.load(last, state)
    source = task.source(fabric.global_rank, fabric.world_size)
    held_out = source.validation() if fabric.is_global_zero else []
    curve = Curve(output / "curve.csv", resume) if fabric.is_global_zero else None
    bar = tqdm(total=config.steps, initial=state["step"], disable=not fabric.is_global_zero)
    started = time.monotonic()
    last_step = config.steps if stop is None else min(stop, config.steps)
    for epoch, batch, count in made_ahead(source, skip=state["step"]):
        step = state["step"]
        if step >= last_step:
            break
        for group in optimizer.param_groups:
            group["lr"] = task.rate(step)
        # Dropout of a step is the same whether or not the run was stopped before it.
        torch.manual_seed((config.seed << 32) + step * fabric.world_size + fabric.global_rank)
        parts = task.losses(model, batch.to(fabric.device))
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
        if state["step"] % 20 == 0:  # A GPU is waited for where a number is read.
            bar.set_postfix(loss=f"{parts['loss'].item():.4f}", epoch=epoch, refresh=False)
        done = state["step"] == last_step
        if state["step"] % config.validate_every == 0 or done:
            if curve is not None:
                row = {"step": state["step"], "epoch": epoch, "drawings": state["drawings"]}
                row["seconds"] = round(time.monotonic() - started, 1)
                row |= {f"train_{name}": round(v.item(), 5) for name, v in parts.items()}
                measured = task.validate(average, held_out, fabric) if held_out else {}
                curve.add(row | {name: round(value, 5) for name, value in measured.items()})
            fabric.save(last, state | {"config": dataclasses.asdict(task.network)})
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


def command(name: str, text: str | None, config: type[RunConfig], train: Callable) -> None:
    """The command line of a training module: ``CONFIG.json [--train ...] [--resume]``."""
    parser = argparse.ArgumentParser(prog=name, description=text)
    parser.add_argument("config", type=Path)
    parser.add_argument(
        "--train", nargs="+", action="append", metavar="SHARD", help="shards of one epoch"
    )
    parser.add_argument("--validation", nargs="+", metavar="SHARD", help="shards to measure on")
    parser.add_argument("--output", metavar="DIR", help="folder of the run")
    parser.add_argument("--resume", action="store_true", help="go on from the last checkpoint")
    options = parser.parse_args()
    settings = config.read(options.config)
    for key in ("train", "validation", "output"):
        if (value := getattr(options, key)) is not None:
            setattr(settings, key, value)
    if not settings.output:
        parser.error("no folder for the run: name it in the configuration or by --output")
    train(settings, options.resume)
