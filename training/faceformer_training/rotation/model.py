"""The network: a Transformer over edges, and two small heads.

Encoder: pre-norm (Xiong et al. 2020, "On Layer Normalization in the Transformer Architecture"),
with a learned bias for each relation between two edges added to the attention (Shaw et al. 2018,
"Self-Attention with Relative Position Representations"; Ying et al. 2021, "Do Transformers Really
Perform Bad for Graph Representation?"). There are no positions: edges have no order.

core/src/identify/rotation/network.rs is the same in candle; names of weights are the same in both,
and fixtures in core/tests compare the two.
"""

from __future__ import annotations

import torch
import torch.nn.functional as F
from torch import nn

from .config import ModelConfig
from .data import Batch


class Layer(nn.Module):
    """Self-attention and two linear maps, each added to what comes in; ``[B, M, width]``."""

    def __init__(self, config: ModelConfig):
        super().__init__()
        width = config.width
        self.heads = config.heads
        self.attention_norm = nn.LayerNorm(width)
        self.qkv = nn.Linear(width, 3 * width)
        self.out = nn.Linear(width, width)
        self.hidden_norm = nn.LayerNorm(width)
        self.up = nn.Linear(width, config.hidden)
        self.down = nn.Linear(config.hidden, width)

    def forward(self, x: torch.Tensor, bias: torch.Tensor) -> torch.Tensor:
        """``bias`` is ``[B, heads, M, M]``."""
        b, m, width = x.shape
        qkv = self.qkv(self.attention_norm(x)).view(b, m, 3, self.heads, width // self.heads)
        q, k, v = qkv.permute(2, 0, 3, 1, 4)
        mixed = F.scaled_dot_product_attention(q, k, v, attn_mask=bias.to(q.dtype))
        x = x + self.out(mixed.transpose(1, 2).reshape(b, m, width))
        return x + self.down(F.relu(self.up(self.hidden_norm(x))))


class RotationModel(nn.Module):
    """Scores of triples and kinds of loops."""

    def __init__(self, config: ModelConfig):
        super().__init__()
        self.config = config
        width = config.width
        self.embed = nn.Linear(config.edge, width)
        self.embed_out = nn.Linear(width, width)
        self.relation = nn.Linear(config.relations, config.layers * config.heads, bias=False)
        self.layers = nn.ModuleList(Layer(config) for _ in range(config.layers))
        self.norm = nn.LayerNorm(width)
        self.outer = nn.Linear(width, width)
        self.middle = nn.Linear(width, width, bias=False)
        self.corner = nn.Linear(config.corner, width, bias=False)
        self.sum = nn.Linear(width, width)
        self.product = nn.Linear(width, width, bias=False)
        self.triple = nn.Linear(config.triple, width, bias=False)
        self.score = nn.Linear(width, 1)
        self.hand = nn.Parameter(torch.ones(1))
        self.loop = nn.Linear(2 * width + 1, width)
        self.kind = nn.Linear(width, config.kinds)
        # At first the network scores as the hand-made rules do, and learns what they lack.
        nn.init.zeros_(self.score.weight)
        nn.init.zeros_(self.score.bias)
        nn.init.zeros_(self.relation.weight)

    def encode(self, batch: Batch) -> torch.Tensor:
        """Edges in their context, ``[B * M, width]``."""
        x = self.embed_out(F.relu(self.embed(batch.edges)))
        shifts = torch.arange(self.config.relations, device=x.device, dtype=torch.int32)
        bits = ((batch.relations[..., None] >> shifts) & 1).to(x.dtype)
        bias = self.relation(bits)
        b, m, _ = x.shape
        bias = bias.view(b, m, m, len(self.layers), self.config.heads).permute(3, 0, 4, 1, 2)
        absent = batch.padding[:, None, None, :]
        for layer, own in zip(self.layers, bias, strict=True):
            x = layer(x, own.masked_fill(absent, -1e4))
        return self.norm(x).flatten(0, 1)

    def triple_states(self, edges: torch.Tensor, batch: Batch) -> torch.Tensor:
        """Triples, the same with their ends swapped, ``[T, width]``."""
        outer, middle = self.outer(edges), self.middle(edges)
        at = batch.corner_edges
        corners = F.relu(outer[at[:, 0]] + middle[at[:, 1]] + self.corner(batch.corners))
        a, b = corners[batch.triple_corners[:, 0]], corners[batch.triple_corners[:, 1]]
        return F.relu(self.sum(a + b) + self.product(a * b) + self.triple(batch.triples))

    def scores(self, states: torch.Tensor, batch: Batch) -> torch.Tensor:
        """Log-odds of the triples, ``[T]``."""
        return self.hand * batch.hand + self.score(states)[:, 0].float()

    def kinds(self, edges: torch.Tensor, states: torch.Tensor, batch: Batch) -> torch.Tensor:
        """Logits of the loops' kinds, ``[L, kinds]``."""
        steps, loop = batch.loop_steps, batch.loop_of_step
        middle = batch.corner_edges[batch.triple_corners[steps, 0], 1]
        seen = torch.cat([states[steps], edges[middle]], 1).float()
        count = len(batch.loop_kinds)
        total = seen.new_zeros(count, seen.shape[1]).index_add(0, loop, seen)
        size = seen.new_zeros(count, 1).index_add(0, loop, seen.new_ones(len(loop), 1))
        pooled = torch.cat([total / size.clamp_min(1), size.log()], 1)
        return self.kind(F.relu(self.loop(pooled))).float()

    def forward(self, batch: Batch) -> tuple[torch.Tensor, torch.Tensor]:
        """Log-odds of triples ``[T]`` and logits of loops' kinds ``[L, kinds]``."""
        edges = self.encode(batch)
        states = self.triple_states(edges, batch)
        return self.scores(states, batch), self.kinds(edges, states, batch)


def order_logits(scores: torch.Tensor, orders: dict[int, torch.Tensor]) -> list[torch.Tensor]:
    """For each degree the logits of the orders at its vertices, ``[V, (d - 1)!]``.

    Pseudo-likelihood (Besag 1975): the probability of the order at a vertex given the true orders
    of its neighbours. It is what decoding by conditional modes compares.
    """
    return [scores[index].sum(-1) for index in orders.values() if len(index)]


def flip_logits(scores: torch.Tensor, flips: torch.Tensor) -> torch.Tensor:
    """Log-odds that each edge holds its two ends together the right way, ``[F]``."""
    chosen = scores[flips]
    return chosen[:, :2].sum(1) - chosen[:, 2:].sum(1)
