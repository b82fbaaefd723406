"""Images, sampled solids, network and training of the AtlasNet baseline."""

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

from safetensors.numpy import load_file, save_file  # noqa: E402

from faceformer_training.atlasnet.image import image  # noqa: E402
from faceformer_training.atlasnet.model import AtlasConfig, AtlasNet, chamfer, either_way  # noqa: E402
from faceformer_training.atlasnet.points import aligned, sample, triangles  # noqa: E402
from faceformer_training.atlasnet.train import TrainConfig, measure_last, mirrored, train  # noqa: E402

ROOT = Path(__file__).parents[2]
PROGRAM = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "faceformer"
CONFIGS = sorted((ROOT / "training/configs/atlasnet").glob("*.json"))
TETRAHEDRON = np.array(
    [
        [[0, 0, 0], [0, 1, 0], [1, 0, 0]],
        [[0, 0, 0], [1, 0, 0], [0, 0, 2]],
        [[0, 0, 0], [0, 0, 2], [0, 1, 0]],
        [[1, 0, 0], [0, 1, 0], [0, 0, 2]],
    ],
    float,
)


def test_lines_are_drawn_where_they_are():
    drawn = image([np.array([[0, 0], [10, 0]]), np.array([[0, 0], [0, 10]])], 64, 4)
    assert drawn.shape == (64, 64) and drawn.dtype == np.uint8
    rows, columns = (drawn > 100).sum(1), (drawn > 100).sum(0)
    # The foot of the L is below: y upwards is up.
    assert rows.argmax() > 50 and columns.argmax() < 10
    assert drawn[:40, 20:].max() == 0


def test_points_are_spread_by_area():
    points = sample(TETRAHEDRON, 4000, np.random.default_rng(0))
    on_floor = np.abs(points[:, 2]) < 1e-9
    area = np.linalg.norm(
        np.cross(TETRAHEDRON[:, 1] - TETRAHEDRON[:, 0], TETRAHEDRON[:, 2] - TETRAHEDRON[:, 0]),
        axis=1,
    )
    assert on_floor.mean() == pytest.approx(area[0] / area.sum(), abs=0.03)


def test_the_true_one_of_two_mirror_images_is_taken():
    true = TETRAHEDRON.reshape(-1, 3)
    for depth in (1, -1):
        mesh = aligned(TETRAHEDRON * [1, 1, depth] + [0, 0, 7], true)
        spread = np.ptp(mesh.reshape(-1, 3), axis=0)
        assert np.linalg.norm(spread) / 2 == pytest.approx(1)
        top = mesh.reshape(-1, 3)[mesh.reshape(-1, 3)[:, 2].argmax()]
        assert top[0] < 0 and top[1] < 0


def test_both_forms_of_stl_are_read():
    text = b"solid s\n"
    for t in TETRAHEDRON:
        text += b"facet normal 0 0 0\nouter loop\n"
        text += b"".join(b"vertex %g %g %g\n" % tuple(v) for v in t) + b"endloop\nendfacet\n"
    np.testing.assert_array_equal(triangles(text), TETRAHEDRON)
    records = b"".join(
        np.zeros(3, "<f4").tobytes() + t.astype("<f4").tobytes() + b"\0\0" for t in TETRAHEDRON
    )
    np.testing.assert_array_equal(triangles(bytes(80) + b"\4\0\0\0" + records), TETRAHEDRON)


def test_the_chamfer_distance_of_known_clouds():
    a = torch.tensor([[[0.0, 0, 0], [1, 0, 0]]])
    b = torch.tensor([[[0.0, 0, 0], [1, 2, 0], [0, 0, 3]]])
    squared, plain = chamfer(a, b)
    assert squared.tolist() == pytest.approx([(0 + 1) / 2 + (0 + 4 + 9) / 3])
    assert plain.tolist() == pytest.approx([(0 + 1) / 2 + (0 + 2 + 3) / 3], abs=1e-5)
    # The mirror image in depth counts as well.
    turned = either_way(a, b * torch.tensor([1, 1, -1]))
    assert turned[0].tolist() == pytest.approx(squared.tolist())


def test_gradients_of_the_chamfer_distance_are_those_of_all_distances():
    random = torch.Generator().manual_seed(0)
    a, b = (torch.rand(2, n, 3, generator=random) for n in (30, 40))
    a.requires_grad_()
    own = torch.autograd.grad(chamfer(a, b)[0].sum(), a)[0]
    off = (a[:, :, None] - b[:, None]).square().sum(3)
    whole = off.min(2).values.mean(1) + off.min(1).values.mean(1)
    torch.testing.assert_close(own, torch.autograd.grad(whole.sum(), a)[0])


def test_drawings_and_solids_are_mirrored_together():
    images = torch.tensor([[[1.0, 0], [0, 0]], [[1, 0], [0, 0]]])
    points = torch.tensor([[[-0.5, 0.5, 0.1]], [[-0.5, 0.5, 0.1]]])
    which = torch.tensor([True, False])
    images, points = mirrored(images, points, which)
    assert images.tolist() == [[[0, 1], [0, 0]], [[1, 0], [0, 0]]]
    assert points[:, 0, 0].tolist() == [0.5, -0.5]


def test_the_network_has_resnets_and_atlasnets_sizes():
    network = AtlasNet(AtlasConfig())
    resnet = sum(p.numel() for p in network.encoder.parameters())
    # ResNet-18 has 11,176,512 weights before its last layer, with three channels of colour.
    assert resnet - 512 * 1024 - 1024 == 11_176_512 - 2 * 64 * 49
    assert len(network.patches) == 25


def test_training_learns_and_resumes(tmp_path):
    random = np.random.default_rng(0)
    clouds = np.stack([sample(TETRAHEDRON * 0.4 * k, 200, random) for k in (1, 2)])
    images = np.stack([image([np.array([[0, 0], [k, 1.0], [1, 0]])], 32, 2) for k in (0.2, 0.8)])
    path = tmp_path / "clouds.safetensors"
    save_file({"images": images, "points": clouds.astype(np.float32)}, path)
    config = TrainConfig(
        train=[str(path)],
        output=str(tmp_path / "run"),
        validation=[str(path)],
        model={"code": 14, "patches": 5, "base": 8},
        steps=30,
        batch=2,
        points=100,
        mirror=True,
        validate_every=10,
        accelerator="cpu",
    )
    whole = torch.load(train(config, resume=False), weights_only=True)["model"]
    rows = (tmp_path / "run/curve.csv").read_text().splitlines()
    losses = [float(row.split(",")[2]) for row in rows[1:]]
    assert len(losses) == 3 and losses[-1] < losses[0]
    # The curve's last row is of the checkpoint.
    last = measure_last(config, [str(path)])
    assert last["squared_mean"] == pytest.approx(float(rows[-1].split(",")[3]), abs=2e-6)
    config.output = str(tmp_path / "parts")
    train(config, resume=False, stop=10)
    resumed = torch.load(train(config, resume=True), weights_only=True)["model"]
    for name, value in whole.items():
        torch.testing.assert_close(resumed[name], value)


def test_solids_of_the_corpus_are_sampled(tmp_path):
    if not PROGRAM.exists():
        pytest.skip("the program faceformer is not built")
    output = tmp_path / "clouds.safetensors"
    command = [sys.executable, "-m", "faceformer_training.atlasnet.points"]
    command += [ROOT / "tests/corpus/sample.jsonl.zst", output]
    command += ["--program", PROGRAM, "--limit", "4"]
    environment = os.environ | {"PYTHONPATH": str(ROOT / "training")}
    subprocess.run(command, check=True, env=environment)
    clouds = load_file(output)
    assert len(clouds["images"]) >= 3
    half = np.ptp(clouds["points"], axis=1)
    assert (np.linalg.norm(half, axis=1) / 2 > 0.8).all()


@pytest.mark.parametrize("path", CONFIGS, ids=lambda path: path.stem)
def test_configurations_are_read(path):
    config = TrainConfig(**json.loads(path.read_text()))
    assert config.rate(0) == config.learning_rate > config.rate(config.steps - 1)
    AtlasConfig(**config.model)
