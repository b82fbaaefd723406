"""Sequences, dataset, network, decoding, training and export of the paper's models."""

import dataclasses
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("lightning_fabric")
pytest.importorskip("safetensors")

from resuming import averages, check_resumed_equals_unbroken  # noqa: E402

from faceformer_training.faceformer.config import (  # noqa: E402
    EOS,
    PAD,
    SEP,
    SOS,
    TOKENS,
    VARIANTS,
    ModelConfig,
    TrainConfig,
)
from faceformer_training.faceformer.data import Shard, collate  # noqa: E402
from faceformer_training.faceformer.decode import greedy  # noqa: E402
from faceformer_training.faceformer.model import PointerModel  # noqa: E402
from faceformer_training.faceformer.sequences import (  # noqa: E402
    all_at_once,
    every_start,
    from_start,
    sets_at_once,
)
from faceformer_training.faceformer.train import losses, train  # noqa: E402
from faceformer_training.network.batches import prefetched  # noqa: E402
from faceformer_training.network.fixture import with_random_weights  # noqa: E402

ROOT = Path(__file__).parents[2]
PROGRAM = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "faceformer"
CONFIGS = sorted((ROOT / "training/configs/faceformer").glob("*.json"))


def face(kind: int, *loops: list[int]):
    return kind, [np.array(loop) for loop in loops]


def test_a_face_begins_at_its_start_and_ends_with_its_type():
    two = face(1, [3, 9, 6, 8], [5, 2, 7])
    walked = from_start(two, 0, 2, "walked") - TOKENS
    assert walked.tolist() == [6, 8, 3, 9, 2, 7, 5, 2 - TOKENS]
    sorted_ = from_start(two, 0, 2, "sorted") - TOKENS
    assert sorted_.tolist() == [6, 8, 3, 9, 2, 5, 7, 2 - TOKENS]
    inner = from_start(two, 1, 0, "walked") - TOKENS
    assert inner.tolist() == [5, 2, 7, 3, 9, 6, 8, 2 - TOKENS]
    every = [two[1][loop][first] for _, loop, first in every_start([two])]
    assert sorted(every) == [2, 3, 5, 6, 7, 8, 9]


def test_all_faces_are_in_the_order_of_their_lowest():
    faces = [face(0, [9, 4, 7], [8, 6, 5]), face(2, [3, 1, 2])]
    expected = [SOS, 5, 6, 7, SEP, 8, 11, 13, 9, 12, 10, EOS]
    assert all_at_once(faces, "walked").tolist() == expected
    expected[9:11] = [10, 12]
    assert all_at_once(faces, "sorted").tolist() == [*expected[:8], 9, 10, 12, EOS]
    sets = sets_at_once([face(0, [2, 0, 1]), face(0, [0, 3], [1, 4])])
    assert sets.tolist() == [SOS, 4, 5, 6, SEP, 4, 5, 7, 8, EOS]


def test_items_are_prefetched_in_their_order_and_errors_come_through():
    assert list(prefetched(iter(range(50)))) == list(range(50))

    def failing():
        yield 1
        raise ValueError("spoilt")

    items = prefetched(failing())
    assert next(items) == 1
    with pytest.raises(ValueError, match="spoilt"):
        next(items)


@pytest.mark.parametrize("path", CONFIGS, ids=lambda path: path.stem)
def test_every_configuration_can_be_read(path):
    config = TrainConfig.read(path)
    network = config.network()
    assert network.width % network.heads == 0
    if config.preset == "small":
        weights = sum(p.numel() for p in PointerModel(network).parameters())
        assert 2.5e6 < weights < 3.5e6


@pytest.fixture(scope="module")
def shard_path(tmp_path_factory) -> Path:
    if not PROGRAM.exists():
        pytest.skip("the program faceformer is not built")
    path = tmp_path_factory.mktemp("shards") / "sample.safetensors"
    corpus = ROOT / "tests/corpus/sample.jsonl.zst"
    command = [PROGRAM, "features", corpus, "--for", "faceformer", "--limit", "40", "-o", path]
    subprocess.run(command, check=True)
    return path


@pytest.fixture(scope="module")
def shard(shard_path) -> Shard:
    return Shard(shard_path)


def tiny(variant: str = "faceformer", **changes) -> ModelConfig:
    return dataclasses.replace(ModelConfig.preset("tiny", variant), **({"inputs": 512} | changes))


def test_tables_of_another_model_are_refused(shard_path, tmp_path):
    corpus = ROOT / "tests/corpus/sample.jsonl.zst"
    other = tmp_path / "rotation.safetensors"
    subprocess.run([PROGRAM, "features", corpus, "--limit", "1", "-o", other], check=True)
    with pytest.raises(ValueError, match="--for faceformer"):
        Shard(other)


def test_points_are_ordered_and_loops_are_walks(shard):
    for i in range(len(shard)):
        points = shard.points(i, "faceformer").astype(float)
        # By x alone: rounded to half precision, two of them may be equal that were not.
        assert (np.diff(points[:, 0, 0]) >= 0).all()
        half = np.concatenate([points.min((0, 1)), points.max((0, 1))]).reshape(2, 2)
        assert np.linalg.norm(half[1] - half[0]) / 2 == pytest.approx(1, abs=0.02)
        places = []
        for _, loops in shard.true_faces(i, "faceformer"):
            for loop in loops:
                places += loop.tolist()
                after = np.roll(loop, -1)
                np.testing.assert_array_equal(points[loop, -1], points[after, 0])
        assert sorted(places) == list(range(len(points)))


def test_edges_are_in_two_faces(shard):
    for i in range(len(shard)):
        faces = shard.true_faces(i, "seq2seq")
        used = np.concatenate([loop for _, loops in faces for loop in loops])
        assert (np.bincount(used) == 2).all()
        points = shard.points(i, "seq2seq").astype(float)
        assert len(points) == shard.sizes[i]
        assert (points[:, 0, 0] <= points[:, -1, 0]).all()


@pytest.mark.parametrize("variant", VARIANTS)
def test_drawings_in_a_batch_do_not_see_each_other(shard, variant):
    config = tiny(variant)
    model = with_random_weights(PointerModel(config), 1)
    random = np.random.default_rng(0)
    places = [(shard, i) for i in range(5)]
    with torch.no_grad():
        together = collate(places, config, 0, random)
        logits = model(together)
        for b, place in enumerate(places):
            alone = collate([place], config, 0, random)
            own = model(alone)[0]
            t, n = own.shape
            assert (together.targets[b, t:] == PAD).all()
            torch.testing.assert_close(logits[b, :t, :n], own, atol=1e-4, rtol=1e-4)
            assert torch.isinf(logits[b, :t, n:]).all()


def test_later_tokens_are_not_seen(shard):
    config = tiny()
    model = with_random_weights(PointerModel(config), 2)
    batch = collate([(shard, 0)], config, 4, np.random.default_rng(0))
    changed = (batch.parts == 1) & (batch.steps == 2)
    later = (batch.parts == 1) & (batch.steps >= 2)
    with torch.no_grad():
        before = model(batch)
        batch.tokens[changed] = TOKENS + 1
        after = model(batch)
    torch.testing.assert_close(before[~later], after[~later])
    assert not torch.allclose(before[later], after[later])


def test_greedy_decoding_follows_the_logits(shard):
    config = tiny(steps=6)
    model = with_random_weights(PointerModel(config), 3)
    points = torch.from_numpy(shard.points(0, "faceformer")).float().flatten(1)
    encoded = model.encode(points[None], torch.zeros(1, len(points), dtype=torch.bool))
    decoded = greedy(model, points, causal=True)
    assert [d.tokens[0] for d in decoded] == list(range(TOKENS, TOKENS + len(points)))
    for d in decoded[::5]:
        with torch.no_grad():
            logits = model.decode_sequences(encoded, torch.tensor([[d.tokens[:-1]]]))[0, 0]
        assert logits.argmax(-1).tolist() == d.tokens[1:]
    other = greedy(model, points, causal=False)
    assert any(
        a.log_probability != pytest.approx(b.log_probability, abs=1e-3)
        for a, b in zip(decoded, other, strict=True)
    )


@pytest.mark.parametrize("variant", VARIANTS)
def test_losses_are_those_of_a_guess_at_first(shard, variant):
    torch.manual_seed(0)
    config = tiny(variant)
    batch = collate([(shard, i) for i in range(3)], config, 8, np.random.default_rng(0))
    parts = losses(PointerModel(config), batch)
    assert 1.5 < parts["loss"].item() < 9
    assert 0 <= parts["sequences_right"] <= parts["tokens_right"] <= 1


@pytest.fixture(params=VARIANTS)
def config(shard_path, tmp_path, request) -> TrainConfig:
    return TrainConfig(
        train=[[str(shard_path)]],
        output=str(tmp_path / "run"),
        validation=[str(shard_path)],
        variant=request.param,
        preset="tiny",
        steps=6,
        batch_edges=256,
        starts=5,
        dropout=0.1,
        learning_rate=1e-2,
        validate_every=3,
        validate_drawings=6,
        accelerator="cpu",
    )


def test_training_learns_is_reproducible_and_resumes(config, tmp_path):
    whole = train(config, resume=False)
    rows = (tmp_path / "run/curve.csv").read_text().splitlines()
    curve = [dict(zip(rows[0].split(","), row.split(","), strict=True)) for row in rows[1:]]
    assert [row["step"] for row in curve] == ["3", "6"]
    assert float(curve[1]["loss"]) < float(curve[0]["loss"])
    check_resumed_equals_unbroken(train, config, whole, tmp_path / "parts")


def test_the_program_runs_what_is_exported(config, tmp_path):
    config.steps = 1
    config.average = 0
    last = train(config, resume=False)
    model = tmp_path / "m.safetensors"
    module = "faceformer_training.network.export"
    subprocess.run([sys.executable, "-m", module, last, model], check=True, env=environment())
    described = json.loads(model.with_suffix(".json").read_text())
    assert described["model"]["variant"] == config.variant
    config.initial, config.steps, config.learning_rate = str(model), 2, 0.0
    begun = averages(train(config, resume=False))
    for name, value in averages(last).items():
        torch.testing.assert_close(begun[name], value, atol=1e-3, rtol=1e-3)
    corpus = ROOT / "tests/corpus/sample.jsonl.zst"
    command = [PROGRAM, "eval", corpus, "--limit", "3", "--json"]
    command += ["--engine", config.variant, "--model", model, "--failures", tmp_path / "failures"]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    assert json.loads(done.stdout)["drawings"] == 3
    assert "cannot use its model" not in (tmp_path / "failures").read_text()


def environment() -> dict[str, str]:
    return os.environ | {"PYTHONPATH": str(ROOT / "training")}
