"""AtlasNet for one image: ResNet-18 to a code of 1024 numbers, and 25 patches that are bent by it.

Groueix et al. 2018, "A Papier-Mache Approach to Learning 3D Surface Generation"; He et al. 2016,
"Deep Residual Learning for Image Recognition".
"""

from __future__ import annotations

import dataclasses

import torch
import torch.nn.functional as F
from torch import nn


@dataclasses.dataclass(frozen=True)
class AtlasConfig:
    """Size of the network; the defaults are AtlasNet's."""

    code: int = 1024
    patches: int = 25
    # Width of the first of ResNet's four stages; the others double it in turn.
    base: int = 64


class Block(nn.Module):
    """Two convolutions with a way around them."""

    def __init__(self, before: int, after: int, stride: int):
        super().__init__()
        self.conv1 = nn.Conv2d(before, after, 3, stride, 1, bias=False)
        self.norm1 = nn.BatchNorm2d(after)
        self.conv2 = nn.Conv2d(after, after, 3, 1, 1, bias=False)
        self.norm2 = nn.BatchNorm2d(after)
        self.around = nn.Identity()
        if stride != 1 or before != after:
            self.around = nn.Sequential(
                nn.Conv2d(before, after, 1, stride, bias=False), nn.BatchNorm2d(after)
            )

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        y = F.relu(self.norm1(self.conv1(x)))
        return F.relu(self.norm2(self.conv2(y)) + self.around(x))


class ResNet18(nn.Module):
    """An image ``[B, 1, H, W]`` to a code ``[B, code]``."""

    def __init__(self, config: AtlasConfig):
        super().__init__()
        base = config.base
        self.stem = nn.Sequential(
            nn.Conv2d(1, base, 7, 2, 3, bias=False),
            nn.BatchNorm2d(base),
            nn.ReLU(),
            nn.MaxPool2d(3, 2, 1),
        )
        blocks, before = [], base
        for stage in range(4):
            after = base << stage
            blocks += [Block(before, after, 1 if stage == 0 else 2), Block(after, after, 1)]
            before = after
        self.blocks = nn.Sequential(*blocks)
        self.out = nn.Linear(before, config.code)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return self.out(self.blocks(self.stem(x)).mean((2, 3)))


class Patch(nn.Module):
    """Points of the unit square with the code, ``[B, 2 + code, P]``, to points in space
    ``[B, 3, P]``."""

    def __init__(self, config: AtlasConfig):
        super().__init__()
        width = config.code + 2
        layers: list[nn.Module] = []
        for before, after in ((width, width), (width, width // 2), (width // 2, width // 4)):
            layers += [nn.Conv1d(before, after, 1), nn.BatchNorm1d(after), nn.ReLU()]
        self.layers = nn.Sequential(*layers, nn.Conv1d(width // 4, 3, 1), nn.Tanh())

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return self.layers(x)


class AtlasNet(nn.Module):
    """Images to points on all patches."""

    def __init__(self, config: AtlasConfig):
        super().__init__()
        self.config = config
        self.encoder = ResNet18(config)
        self.patches = nn.ModuleList(Patch(config) for _ in range(config.patches))

    def forward(self, images: torch.Tensor, squares: torch.Tensor) -> torch.Tensor:
        """Points in space, ``[B, patches * P, 3]``.

        ``images`` is ``[B, H, W]`` from 0 to 1, ``squares`` the points of the unit square for each
        patch, ``[B, patches, P, 2]``.
        """
        code = self.encoder(images[:, None])[..., None]
        points = []
        for k, patch in enumerate(self.patches):
            square = squares[:, k].transpose(1, 2)
            points.append(patch(torch.cat([square, code.expand(-1, -1, square.shape[-1])], 1)))
        return torch.cat(points, 2).transpose(1, 2)


def nearest(a: torch.Tensor, b: torch.Tensor) -> torch.Tensor:
    """Squared distance of each point of clouds ``a``, ``[B, P, 3]``, to the nearest of ``b``,
    ``[B, Q, 3]``; ``[B, P]``. Gradients flow to both."""
    with torch.no_grad():
        # Cloud by cloud, so that the table of distances stays in the cache.
        which = [
            (q.square().sum(1) - 2 * p @ q.T).argmin(1)
            for p, q in zip(a.float(), b.float(), strict=True)
        ]
        which = torch.stack(which)[..., None].expand(-1, -1, 3)
    return (a - b.gather(1, which)).float().square().sum(2)


def chamfer(a: torch.Tensor, b: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """Chamfer distances of clouds ``[B, P, 3]`` and ``[B, Q, 3]``, both ways added: of means of
    squares, which AtlasNet is trained with, and of means as they are, which ``faceformer eval``
    gives; ``[B]`` each."""
    ways = nearest(a, b), nearest(b, a)
    # Where two points coincide, the root has no slope.
    plain = sum(way.clamp(min=1e-12).sqrt().mean(1) for way in ways)
    return sum(way.mean(1) for way in ways), plain


def either_way(a: torch.Tensor, b: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """:func:`chamfer` to ``b`` or to its mirror image in depth, whichever is nearer: which of the
    two it shows, an orthographic drawing does not tell."""
    one, other = chamfer(a, b), chamfer(a, b * b.new_tensor([1, 1, -1]))
    return tuple(torch.minimum(x, y) for x, y in zip(one, other, strict=True))
