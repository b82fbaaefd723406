"""The authors' released checkpoint, converted: on one of the same structure, made here."""

import json
import sys
import types

import numpy as np
import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("safetensors")

from safetensors.torch import load_file  # noqa: E402
from torch import nn  # noqa: E402

from faceformer_training.faceformer.config import TOKENS, ModelConfig  # noqa: E402
from faceformer_training.faceformer.convert import convert, main  # noqa: E402
from faceformer_training.faceformer.model import PointerModel  # noqa: E402

WIDTH, HEADS, HIDDEN, POINTS, INPUTS, STEPS = 16, 4, 24, 50, 30, 9


class Layer(nn.Module):
    """A layer with the released network's names, of PyTorch's own parts."""

    def __init__(self, cross: bool):
        super().__init__()
        self.self_attn = nn.MultiheadAttention(WIDTH, HEADS)
        if cross:
            self.multihead_attn = nn.MultiheadAttention(WIDTH, HEADS)
        self.linear1, self.linear2 = nn.Linear(WIDTH, HIDDEN), nn.Linear(HIDDEN, WIDTH)
        for k in range(3 if cross else 2):
            setattr(self, f"norm{k + 1}", nn.LayerNorm(WIDTH))

    def own(self, x, position, mask=None):
        seen = self.norm1(x)
        placed = seen + position
        return x + self.self_attn(placed, placed, seen, attn_mask=mask)[0]

    def feed(self, x, norm):
        return x + self.linear2(torch.relu(self.linear1(norm(x))))


class Stack(nn.Module):
    def __init__(self, cross: bool, layers: int):
        super().__init__()
        self.layers = nn.ModuleList(Layer(cross) for _ in range(layers))
        self.norm = nn.LayerNorm(WIDTH)


def embedding(count: int) -> nn.Module:
    module = nn.Module()
    module.pos_embed = nn.Embedding(count, WIDTH)
    module.register_buffer("position", torch.arange(count)[None])
    return module


class Released(nn.Module):
    """A network of the released structure; tokens come first, sequences second."""

    def __init__(self):
        super().__init__()
        self.val_enc = nn.Module()
        self.val_enc.embedding_token = nn.Embedding(TOKENS, WIDTH)
        self.val_enc.embedding_value = nn.Sequential(
            nn.Linear(2 * POINTS, WIDTH), nn.ReLU(), nn.Linear(WIDTH, WIDTH)
        )
        self.pos_enc, self.query_pos_enc = embedding(INPUTS + TOKENS), embedding(STEPS)
        self.encoder, self.decoder = Stack(False, 2), Stack(True, 3)
        self.project = nn.Linear(WIDTH, WIDTH)

    def forward(self, points, sequence):
        values = self.val_enc.embedding_value(points)
        x = torch.cat([self.val_enc.embedding_token.weight, values])[:, None]
        position = self.pos_enc.pos_embed.weight[: len(x), None]
        for layer in self.encoder.layers:
            x = layer.feed(layer.own(x, position), layer.norm2)
        memory = self.encoder.norm(x)
        x = memory[sequence]
        steps = self.query_pos_enc.pos_embed.weight[: len(x), None]
        later = torch.ones(len(x), len(x), dtype=torch.bool).triu(1)
        for layer in self.decoder.layers:
            x = layer.own(x, steps, later)
            asked = layer.norm2(x) + steps
            x = x + layer.multihead_attn(asked, memory + position, memory)[0]
            x = layer.feed(x, layer.norm3)
        return self.project(self.decoder.norm(x))[:, 0] @ memory[:, 0].T


@pytest.fixture
def released(tmp_path, monkeypatch):
    """A network with random weights, and its Lightning checkpoint, whose settings are of a class
    that is not there when it is converted."""
    torch.manual_seed(0)
    network = Released()
    with torch.no_grad():
        for weight in network.parameters():
            weight.normal_(0.0, 0.3)
    foreign = types.ModuleType("fvcore_stand_in")

    class CfgNode(dict):
        def __init__(self, *entries):
            super().__init__(*entries)
            self.__dict__["frozen"] = True

    CfgNode.__module__, CfgNode.__qualname__ = foreign.__name__, "CfgNode"
    foreign.CfgNode = CfgNode
    monkeypatch.setitem(sys.modules, foreign.__name__, foreign)
    model = CfgNode({"num_head": HEADS, "token": CfgNode({"PAD": 0, "len": 4})})
    settings = CfgNode({"model_class": "SurfaceFormer_Parallel", "model": model})
    checkpoint = {
        "epoch": 3,
        "pytorch-lightning_version": "1.4.0",
        "state_dict": {f"model.{k}": v for k, v in network.state_dict().items()},
        "optimizer_states": [{"state": {}, "param_groups": []}],
        "callbacks": {CfgNode: {"best_model_score": torch.tensor(0.5)}},
        "hyper_parameters": settings,
    }
    path = tmp_path / "released.ckpt"
    torch.save(checkpoint, path)
    monkeypatch.delitem(sys.modules, foreign.__name__)
    return network, path


def test_the_converted_network_gives_the_same_logits(released, tmp_path):
    network, path = released
    output = tmp_path / "converted.safetensors"
    config = convert(path, output)
    assert config == ModelConfig(
        variant="faceformer",
        width=WIDTH,
        heads=HEADS,
        encoder_layers=2,
        decoder_layers=3,
        hidden=HIDDEN,
        points=POINTS,
        inputs=INPUTS,
        steps=STEPS,
        frame="drawn",
        further_loops="walked",
    )
    assert json.loads(output.with_suffix(".json").read_text())["model"]["frame"] == "drawn"
    ours = PointerModel(config)
    ours.load_state_dict(load_file(output))
    ours.eval()
    random = np.random.default_rng(0)
    points = torch.from_numpy(random.normal(size=(12, 2 * POINTS)).astype(np.float32))
    sequence = torch.tensor([6, 9, 4, 15, 7])
    with torch.no_grad():
        expected = network(points, sequence)
        encoded = ours.encode(points[None], torch.zeros(1, 12, dtype=torch.bool))
        logits = ours.decode_sequences(encoded, sequence[None, None])[0, 0]
    assert torch.isinf(logits[:, 0]).all()
    torch.testing.assert_close(logits[:, 1:], expected[:, 1:], atol=1e-4, rtol=1e-4)


def test_what_is_not_the_released_network_is_refused(released, tmp_path, monkeypatch):
    network, path = released
    state = {f"model.{k}": v for k, v in network.state_dict().items()}
    bare = tmp_path / "bare.ckpt"
    torch.save({"state_dict": state}, bare)
    output = tmp_path / "o.safetensors"
    with pytest.raises(ValueError, match="--variant"):
        convert(bare, output)
    assert convert(bare, output, "seq2seq", HEADS, half=True).variant == "seq2seq"
    torch.save({"state_dict": state | {"model.more.weight": torch.zeros(1)}}, bare)
    with pytest.raises(ValueError, match=r"more\.weight"):
        convert(bare, output, "seq2seq")
    monkeypatch.setattr(sys, "argv", ["convert", str(bare), str(output)])
    with pytest.raises(SystemExit, match="more"):
        main()
