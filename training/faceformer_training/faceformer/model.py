"""The network of the paper's three models: an encoder over tokens, a decoder that points at them.

Pre-norm Transformer layers (Xiong et al. 2020, "On Layer Normalization in the Transformer
Architecture") with ReLU; learned positions are added to the queries and keys of every attention,
not to the values (Carion et al. 2020, "End-to-End Object Detection with Transformers"). A decoder's
token is that token's embedding after the encoder, and the logit of what follows is a dot product
with these embeddings (Vinyals et al. 2015, "Pointer Networks"; paper, section 4.1).

core/src/identify/faceformer/network.rs is the same in candle; names of weights are the same in
both, and a fixture in core/tests compares the two.
"""

from __future__ import annotations

import torch
import torch.nn.functional as F
from torch import nn

from .config import PAD, SOS, TOKENS, ModelConfig
from .data import Batch


class EncoderLayer(nn.Module):
    """Self-attention and two linear maps, each added to what comes in; ``[B, N, width]``."""

    def __init__(self, config: ModelConfig, dropout: float):
        super().__init__()
        self.heads, self.dropout = config.heads, dropout
        self.add_attention("self", config.width)
        self.hidden_norm = nn.LayerNorm(config.width)
        self.up = nn.Linear(config.width, config.hidden)
        self.down = nn.Linear(config.hidden, config.width)

    def add_attention(self, name: str, width: int) -> None:
        setattr(self, f"{name}_norm", nn.LayerNorm(width))
        setattr(self, f"{name}_qkv", nn.Linear(width, 3 * width))
        setattr(self, f"{name}_out", nn.Linear(width, width))

    def part(self, qkv: nn.Linear, k: int, x: torch.Tensor) -> torch.Tensor:
        """Queries (0), keys (1) or values (2) by heads: ``[..., heads, M, size]``."""
        w = qkv.in_features
        x = F.linear(x, qkv.weight[k * w : (k + 1) * w], qkv.bias[k * w : (k + 1) * w])
        return x.unflatten(-1, (self.heads, -1)).transpose(-2, -3)

    def attend(self, out: nn.Linear, q, k, v, mask) -> torch.Tensor:
        drop = self.dropout if self.training else 0.0
        attention = F.scaled_dot_product_attention
        if q.device.type == "cpu":
            # In half precision its backward pass is many times slower on processors without AMX.
            with torch.autocast("cpu", enabled=False):
                q, k, v = (x.float() for x in (q, k, v))
                mixed = attention(q, k, v, mask, drop)
        else:
            mixed = attention(q, k, v, mask, drop)
        return self.drop(out(mixed.transpose(-2, -3).flatten(-2)))

    def drop(self, x: torch.Tensor) -> torch.Tensor:
        return F.dropout(x, self.dropout, self.training)

    def look_at_itself(self, x, position, mask) -> torch.Tensor:
        seen = self.self_norm(x)
        placed = seen + position
        q, k = (self.part(self.self_qkv, i, placed) for i in range(2))
        v = self.part(self.self_qkv, 2, seen)
        return x + self.attend(self.self_out, q, k, v, mask)

    def feed(self, x: torch.Tensor) -> torch.Tensor:
        hidden = self.drop(F.relu(self.up(self.hidden_norm(x))))
        return x + self.drop(self.down(hidden))

    def forward(self, x, position, mask) -> torch.Tensor:
        """``mask`` is true where a token may be looked at, ``[B, 1, 1, N]``."""
        return self.feed(self.look_at_itself(x, position, mask))


class DecoderLayer(EncoderLayer):
    """Attention inside a sequence, then to the drawing; ``[B, T, width]``.

    All sequences of a drawing ask the same memory, whose keys and values are made once.
    """

    def __init__(self, config: ModelConfig, dropout: float):
        super().__init__(config, dropout)
        self.add_attention("cross", config.width)

    def remember(self, memory, position) -> tuple[torch.Tensor, torch.Tensor]:
        """Keys and values of the memory, by heads."""
        return self.part(self.cross_qkv, 1, memory + position), self.part(self.cross_qkv, 2, memory)

    def forward(self, x, position, kept, own_mask, mask) -> torch.Tensor:
        """``kept`` is what :meth:`remember` gave; masks are true where a token may be looked at."""
        x = self.look_at_itself(x, position, own_mask)
        q = self.part(self.cross_qkv, 0, self.cross_norm(x) + position)
        return self.feed(x + self.attend(self.cross_out, q, *kept, mask))


class PointerModel(nn.Module):
    """Logits of what follows each token of each sequence."""

    def __init__(self, config: ModelConfig, dropout: float = 0.0):
        super().__init__()
        self.config = config
        width = config.width
        self.token = nn.Embedding(TOKENS, width)
        self.position = nn.Embedding(config.inputs + TOKENS, width)
        self.step = nn.Embedding(config.steps, width)
        self.embed = nn.Linear(2 * config.points, width)
        self.embed_out = nn.Linear(width, width)
        self.encoder = nn.ModuleList(
            EncoderLayer(config, dropout) for _ in range(config.encoder_layers)
        )
        self.encoder_norm = nn.LayerNorm(width)
        self.decoder = nn.ModuleList(
            DecoderLayer(config, dropout) for _ in range(config.decoder_layers)
        )
        self.decoder_norm = nn.LayerNorm(width)
        self.pointer = nn.Linear(width, width)
        for weight in self.parameters():
            if weight.dim() > 1:
                nn.init.xavier_uniform_(weight)

    def encode(self, points: torch.Tensor, absent: torch.Tensor):
        """Memory ``[B, TOKENS + N, width]``, its keys and values in each layer of the decoder, and
        where it may be looked at ``[B, TOKENS + N]``; see :class:`.data.Batch` for the inputs."""
        embedded = self.embed_out(F.relu(self.embed(points)))
        special = self.token.weight.to(embedded.dtype).expand(len(points), -1, -1)
        x = torch.cat([special, embedded], 1)
        present = F.pad(~absent, (TOKENS, 0), value=True)
        position = self.position.weight[: x.shape[1]]
        for layer in self.encoder:
            x = layer(x, position, present[:, None, None])
        memory = self.encoder_norm(x)
        kept = [layer.remember(memory, position) for layer in self.decoder]
        return memory, kept, present

    def decode(self, encoded, tokens, steps, parts, causal: bool = True) -> torch.Tensor:
        """Logits ``[B, T, TOKENS + N]`` of what follows each token; see :class:`.data.Batch`.

        A token sees those of its sequence, with ``causal`` only those before it and itself.
        """
        memory, kept, present = encoded
        x = memory.gather(1, tokens[..., None].expand(-1, -1, memory.shape[-1]))
        own_mask = parts[:, :, None] == parts[:, None, :]
        if causal:
            own_mask = own_mask.tril()
        position = self.step(steps)
        for layer, own in zip(self.decoder, kept, strict=True):
            x = layer(x, position, own, own_mask[:, None], present[:, None, None])
        pointers = self.pointer(self.decoder_norm(x))
        logits = (pointers @ memory.mT).float()
        allowed = present.clone()
        # Neither padding nor SOS ever follows.
        allowed[:, PAD] = False
        if self.config.variant != "faceformer":
            allowed[:, SOS] = False
        return logits.masked_fill(~allowed[:, None], -torch.inf)

    def decode_sequences(self, encoded, sequences, causal: bool = True) -> torch.Tensor:
        """Logits ``[B, S, T, TOKENS + N]`` of what follows each token of ``[B, S, T]``."""
        b, s, t = sequences.shape
        steps = torch.arange(t).repeat(b, s)
        parts = torch.arange(s).repeat_interleave(t).expand(b, -1)
        logits = self.decode(encoded, sequences.flatten(1), steps, parts, causal)
        return logits.unflatten(1, (s, t))

    def forward(self, batch: Batch) -> torch.Tensor:
        """Logits of what follows each token of the sequences, ``[B, T, TOKENS + N]``."""
        encoded = self.encode(batch.points, batch.absent)
        return self.decode(encoded, batch.tokens, batch.steps, batch.parts)
