"""Dataset, network, training and export of the rotation engine's model."""

import dataclasses
import json
import os
import subprocess
from pathlib import Path

import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("lightning_fabric")
pytest.importorskip("safetensors")

from resuming import check_resumed_equals_unbroken  # noqa: E402

from faceformer_training.network.batches import batches  # noqa: E402
from faceformer_training.network.export import write  # noqa: E402
from faceformer_training.network.fixture import with_random_weights  # noqa: E402
from faceformer_training.rotation.config import ModelConfig, TrainConfig  # noqa: E402
from faceformer_training.rotation.data import Shard, collate  # noqa: E402
from faceformer_training.rotation.model import RotationModel, flip_logits  # noqa: E402
from faceformer_training.rotation.train import train  # noqa: E402

ROOT = Path(__file__).parents[2]
PROGRAM = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "faceformer"


@pytest.fixture(scope="module")
def shard_path(tmp_path_factory) -> Path:
    if not PROGRAM.exists():
        pytest.skip("the program faceformer is not built")
    path = tmp_path_factory.mktemp("shards") / "sample.safetensors"
    corpus = ROOT / "tests/corpus/sample.jsonl.zst"
    subprocess.run([PROGRAM, "features", corpus, "--limit", "60", "-o", path], check=True)
    return path


@pytest.fixture(scope="module")
def shard(shard_path) -> Shard:
    return Shard(shard_path)


def test_true_triples_are_two_an_edge_and_flips_are_not_true(shard):
    for i in range(len(shard)):
        d = shard.drawing(i)
        flips, follows = d["flips"], d["follows"]
        assert (follows[flips[:, :2]] == 1).all()
        edges = d["corner_edges"][d["triple_corners"][flips, 0], 1]
        assert (edges == edges[:, :1]).all()
        turned = d["triple_corners"][flips]
        assert (turned[:, 2, 0] == turned[:, 0, 0]).all()
        assert (turned[:, 2, 1] == turned[:, 1, 1]).all()
        assert (turned[:, 3, 1] == turned[:, 0, 1]).all()


def test_the_untrained_network_scores_as_the_hand_made_rules(shard):
    torch.manual_seed(0)
    batch = collate([shard.drawing(i) for i in range(4)])
    scores, _ = RotationModel(ModelConfig.preset("tiny"))(batch)
    torch.testing.assert_close(scores, batch.hand)


def test_drawings_in_a_batch_do_not_see_each_other(shard):
    model = with_random_weights(RotationModel(ModelConfig.preset("tiny")), 1)
    drawings = [shard.drawing(i) for i in range(5)]
    with torch.no_grad():
        together = model(collate(drawings))
        alone = [model(collate([d])) for d in drawings]
    for k in range(2):
        torch.testing.assert_close(together[k], torch.cat([a[k] for a in alone]), atol=1e-4, rtol=0)


def test_swapping_a_triples_ends_changes_nothing(shard):
    model = with_random_weights(RotationModel(ModelConfig.preset("tiny")), 2)
    batch = collate([shard.drawing(0)])
    with torch.no_grad():
        before, _ = model(batch)
        batch.triple_corners = batch.triple_corners.flip(1)
        after, _ = model(batch)
    torch.testing.assert_close(before, after)


def test_flip_logits_weigh_true_against_turned():
    scores = torch.tensor([1.0, 2.0, 4.0, 8.0])
    assert flip_logits(scores, torch.tensor([[0, 1, 2, 3]])).item() == -9


def test_every_drawing_is_in_one_batch(shard):
    places = [(shard, i) for i in range(len(shard))]
    groups = list(batches(places, 256, 3))
    assert sorted(i for group in groups for _, i in group) == list(range(len(shard)))
    again = list(batches(places, 256, 3))
    assert [[i for _, i in g] for g in groups] == [[i for _, i in g] for g in again]
    for group in groups:
        longest = max(shard.sizes[i] for _, i in group)
        assert len(group) == 1 or len(group) * longest <= 256


@pytest.fixture
def config(shard_path, tmp_path) -> TrainConfig:
    return TrainConfig(
        train=[[str(shard_path)]],
        output=str(tmp_path / "run"),
        validation=[str(shard_path)],
        preset="tiny",
        steps=6,
        warmup=2,
        batch_edges=256,
        validate_every=3,
        accelerator="cpu",
    )


def test_the_configuration_for_a_gpu_begins_with_the_shipped_weights():
    config = TrainConfig.read(ROOT / "training/configs/rotation/rotation-gpu.json")
    shipped = json.loads((ROOT / config.initial).with_suffix(".json").read_text())
    assert dataclasses.asdict(config.network()) == shipped["model"]


def test_training_is_reproducible_and_resumes(config, tmp_path):
    whole = train(config, resume=False)
    assert (tmp_path / "run/curve.csv").read_text().count("\n") == 3
    check_resumed_equals_unbroken(train, config, whole, tmp_path / "parts")


def test_export_describes_its_weights(tmp_path):
    model = with_random_weights(RotationModel(ModelConfig.preset("tiny")), 0)
    beside = write(model.state_dict(), {"width": 32}, tmp_path / "m.safetensors")
    described = json.loads(beside.read_text())
    assert described["model"] == {"width": 32} and len(described["sha256"]) == 64
