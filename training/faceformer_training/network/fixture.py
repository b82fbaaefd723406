"""Random weights for the fixtures by which the program's networks are compared with these."""

from __future__ import annotations

import torch


def with_random_weights(model: torch.nn.Module, seed: int) -> torch.nn.Module:
    """The same network, none of whose weights is zero or one, so that none can be forgotten."""
    torch.manual_seed(seed)
    with torch.no_grad():
        for name, weight in model.named_parameters():
            fan = weight.shape[-1] if weight.dim() > 1 else 4
            weight.normal_(0.0, fan**-0.5)
            if "norm.weight" in name:
                weight.add_(1.0)
    return model.eval()
