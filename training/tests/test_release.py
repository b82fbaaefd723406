"""The Faceformer release's JSON: a file in that form, and drawings there and back."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from faceformer_training import release
from faceformer_training.drawing import (
    Drawing,
    DrawingFormatError,
    DrawingWriter,
    Edge,
    Face,
    Truth,
    read_drawings,
)

# A triangle drawn twice over: a flat two-faced thing, enough to follow every number. Co-edges 0/2,
# 1/4 and 3/5 are mates, and the ends meet within the release's 2e-4 only.
SMALL = {
    "edges": [
        [[0, 0], [0.5, 1]],
        [[0, 0], [1, 0]],
        [[0.5, 1.0001], [0, 0]],
        [[0.5, 1], [0.9, 0.7], [1, 0]],
        [[1, 0], [0, 0]],
        [[1, 0], [0.9, 0.7], [0.5, 1]],
    ],
    "edges3d": [
        [[0, 0, -1], [0.5, 1, 0]],
        [[0, 0, -1], [1, 0, 0]],
        [[0.5, 1, 0], [0, 0, -1]],
        [[0.5, 1, 0], [0.9, 0.7, 0], [1, 0, 0]],
        [[1, 0, 0], [0, 0, -1]],
        [[1, 0, 0], [0.9, 0.7, 0], [0.5, 1, 0]],
    ],
    "pairings": {"0": 2, "1": 4, "3": 5},
    "faces_indices": [[0, [[1, 5, 2]]], [7, [[0, 3, 4]]]],
    "dominant_directions": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
}


def test_a_small_file():
    d = release.from_release(SMALL, "small")
    assert d.id == "small"
    assert [e.v for e in d.edges] == [(0, 1), (0, 2), (1, 2)]
    assert len(d.vertices) == 3
    assert [(f.type, f.loops) for f in d.truth.faces] == [
        ("plane", [[2, -3, -1]]),
        ("other", [[1, 3, -2]]),
    ]
    assert np.allclose(d.truth.vertices3d, [[0, 0, -1], [0.5, 1, 0], [1, 0, 0]])
    assert [len(p) for p in d.truth.edges3d] == [2, 2, 3]


def test_faces_without_types_are_told_by_their_edges():
    bare = SMALL | {"faces_indices": [loops for _, loops in SMALL["faces_indices"]]}
    assert [f.type for f in release.from_release(bare).truth.faces] == ["other", "other"]


def test_without_faces_there_is_no_truth():
    assert release.from_release({k: SMALL[k] for k in ("edges", "pairings")}).truth is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pairings": {"0": 2}}, "co-edge 1 has no mate"),
        ({"pairings": {"0": 0, "1": 4, "3": 5}}, "0 and 0 are no mates"),
        ({"pairings": {"0": 2, "1": 5, "3": 4}}, "not the same curve"),
        ({"faces_indices": [[0, [[1, 99]]]]}, "IndexError"),
        ({"edges": None}, "TypeError"),
    ],
)
def test_what_does_not_fit_is_refused(change, message):
    with pytest.raises(DrawingFormatError, match=message):
        release.from_release(SMALL | change, "bad")


def tetrahedron() -> Drawing:
    space = np.array([[0, 0, 0.5], [0.8, 0.1, 0], [0.3, 0.7, -0.2], [0.4, 0.3, 0.9]])
    ends = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    curves = [space[list(v)] for v in ends]
    loops = [[-1, -3, -2], [1, 5, -4], [2, 6, -5], [3, 4, -6]]
    return Drawing(
        "t/1#o",
        "made",
        {"kind": "orthographic"},
        space[:, :2],
        [Edge(v, p[:, :2]) for v, p in zip(ends, curves, strict=True)],
        Truth([Face("plane", [loop]) for loop in loops], space, curves, np.eye(3)),
    )


def coordinates(d: Drawing) -> list:
    """The faces with edges named by their points, free of all numbering."""
    return sorted(
        (
            f.type,
            sorted(
                sorted(tuple(map(tuple, np.round(d.edges[abs(k) - 1].points, 9)[:: np.sign(k)])))
                for loop in f.loops
                for k in loop
            ),
        )
        for f in d.truth.faces
    )


def test_there_and_back():
    d = tetrahedron()
    written = release.to_release(d)
    assert written["edges"] == sorted(written["edges"])
    assert len(written["pairings"]) == 6 and len(written["edges"]) == 12
    back = release.from_release(json.loads(json.dumps(written)))
    assert back.id == d.id
    assert coordinates(back) == coordinates(d)
    starts = {tuple(np.round(p, 9)) for p in back.truth.vertices3d}
    assert starts == {tuple(np.round(p, 9)) for p in d.truth.vertices3d}


def test_the_command_both_ways(tmp_path):
    first, folder, second = tmp_path / "a.jsonl", tmp_path / "files", tmp_path / "b.jsonl.zst"
    with DrawingWriter(first) as writer:
        writer.write(tetrahedron())
    assert release.main([str(first), str(folder)]) == 0
    assert [f.name for f in folder.iterdir()] == ["t_1_o.json"]
    assert release.main([str(folder), str(second)]) == 0
    (back,) = read_drawings(second)
    assert coordinates(back) == coordinates(tetrahedron())


def test_a_drawing_of_another_form_is_refused(tmp_path):
    (tmp_path / "x.json").write_text("{}")
    assert release.main([str(tmp_path), str(tmp_path / "out.jsonl")]) == 2


COMMAND = Path(__file__).parents[2] / "target/release/faceformer"


@pytest.mark.slow
@pytest.mark.skipif(not COMMAND.exists(), reason="the command line is not built")
def test_the_command_line_reads_what_is_written(tmp_path):
    sample = Path(__file__).parents[2] / "tests/corpus/sample.jsonl.zst"
    assert release.main([str(sample), str(tmp_path / "files")]) == 0
    assert release.main([str(tmp_path / "files"), str(tmp_path / "back.jsonl.zst")]) == 0

    def figures(data) -> dict:
        run = [str(COMMAND), "eval", str(data), "--faces", "truth", "--json"]
        return json.loads(subprocess.run(run, check=True, capture_output=True).stdout)

    before, after = figures(sample), figures(tmp_path / "back.jsonl.zst")
    for key in ("drawings", "faces", "precision", "recall", "type_rate", "exact", "loops_exact"):
        assert after[key] == before[key]
    one = next((tmp_path / "files").iterdir())
    solid = [str(COMMAND), "solid", str(one), "--faces", "truth", "-o", str(tmp_path / "x.step")]
    subprocess.run(solid, check=True)
