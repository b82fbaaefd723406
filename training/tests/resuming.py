"""What every run of training must do, whatever is trained."""

from collections.abc import Callable
from pathlib import Path

import torch


def averages(path: Path) -> dict[str, torch.Tensor]:
    """The weights that a checkpoint keeps."""
    return torch.load(path, weights_only=True)["average"]


def check_resumed_equals_unbroken(train: Callable, config, whole: Path, parts: Path) -> None:
    """Trains in two parts of three steps and compares with the run that gave ``whole``.

    The second part has its batches from two processes, which must change nothing.
    """
    config.output = str(parts)
    train(config, resume=False, stop=3)
    assert torch.load(parts / "last.ckpt", weights_only=True)["step"] == 3
    config.workers = 2
    resumed = averages(train(config, resume=True))
    for name, value in averages(whole).items():
        torch.testing.assert_close(resumed[name], value)
