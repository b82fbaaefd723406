"""Plain greedy decoding in PyTorch, to compare the program's own with.

Every step computes all sequences anew; the program keeps keys and values instead.
"""

from __future__ import annotations

import dataclasses

import torch

from .config import EOS, SOS, TOKENS
from .model import PointerModel


@dataclasses.dataclass
class Decoded:
    """A sequence, the log-probability of what follows its first token, and by how much the surest
    token was ahead where it was least so."""

    tokens: list[int]
    log_probability: float
    margin: float


def starts(variant: str, tokens: int) -> list[int]:
    """First tokens of the sequences over a drawing of so many tokens."""
    return [SOS] if variant != "faceformer" else list(range(TOKENS, TOKENS + tokens))


def ends(variant: str, token: int) -> bool:
    return token == EOS if variant != "faceformer" else token < TOKENS


@torch.no_grad()
def greedy(model: PointerModel, points: torch.Tensor, causal: bool) -> list[Decoded]:
    """The likeliest token in every step, from every start; ``points`` is ``[N, 2 points]``.

    ``causal`` decodes as the network was trained; without it every token sees all others, as in the
    authors' released program.
    """
    config = model.config
    encoded = model.encode(points[None], torch.zeros(1, len(points), dtype=torch.bool))
    done = [Decoded([t], 0.0, float("inf")) for t in starts(config.variant, len(points))]
    alive = list(done)
    for _ in range(config.steps):
        if not alive:
            break
        sequences = torch.tensor([[d.tokens for d in alive]])
        logits = model.decode_sequences(encoded, sequences, causal)[0, :, -1]
        chances = logits.log_softmax(-1)
        top = chances.topk(2, -1)
        going_on = []
        for d, values, tokens in zip(alive, top.values.tolist(), top.indices.tolist(), strict=True):
            d.tokens.append(tokens[0])
            d.log_probability += values[0]
            d.margin = min(d.margin, values[0] - values[1])
            if not ends(config.variant, tokens[0]):
                going_on.append(d)
        alive = going_on
    return done
