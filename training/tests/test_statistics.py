"""Counts of a drawing that can be checked by hand, and the report."""

import numpy as np
import pytest

from faceformer_training.drawing import (
    Drawing,
    DrawingFormatError,
    DrawingWriter,
    Edge,
    Face,
    Truth,
)
from faceformer_training.statistics import Statistics, collect, distance, genus, main


def prism(count: int, hole: bool) -> Drawing:
    """A prism over a ``count``-gon, with a smaller one as a hole through it if ``hole``."""
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    ring = np.stack([np.cos(turn), np.sin(turn)], 1)
    rings = [(r, z) for r in ((1.0, 0.4) if hole else (1.0,)) for z in (0.0, 1.0)]
    space = np.concatenate([np.c_[r * ring, np.full(count, z)] for r, z in rings])
    space = space @ np.linalg.qr(np.arange(9).reshape(3, 3) + 3 * np.eye(3))[0].T
    ends, faces, caps = [], [], {0: [], 1: []}
    for wall in range(len(rings) // 2):
        start = len(ends)
        base = 2 * wall * count
        for i in range(count):
            j = (i + 1) % count
            ends += [(base + i, base + j), (base + count + i, base + count + j)]
            ends += [(base + i, base + count + i)]
        side = 1 if wall == 0 else -1
        for i in range(count):
            low, high, up = (start + 3 * i + n for n in (1, 2, 3))
            after = start + 3 * ((i + 1) % count) + 3
            loop = [low, after, -high, -up]
            faces.append(Face("plane", [loop if side > 0 else [-k for k in reversed(loop)]]))
        lows = [-side * (start + 3 * i + 1) for i in range(count)]
        highs = [side * (start + 3 * i + 2) for i in range(count)]
        caps[0].append(lows[::-1] if side > 0 else lows)
        caps[1].append(highs if side > 0 else highs[::-1])
    faces += [Face("plane", loops) for loops in caps.values()]
    curves = [space[list(v)] for v in ends]
    edges = [Edge(v, p[:, :2]) for v, p in zip(ends, curves, strict=True)]
    truth = Truth(faces, space, curves)
    return Drawing(f"prism{count}{hole}", "", {"kind": "orthographic"}, space[:, :2], edges, truth)


def test_counts_of_a_block_with_a_hole():
    s = Statistics("s")
    s.add(prism(4, True))
    assert s.counts["faces"] == {10: 1} and s.counts["edges"] == {24: 1}
    assert s.counts["types"] == {"plane": 10}
    assert s.counts["degrees"] == {3: 16}
    assert s.counts["face_edges"] == {4: 8, 8: 2}
    assert s.counts["face_loops"] == {1: 8, 2: 2}
    assert s.counts["inner_loops"] == {2: 1} and s.counts["genus"] == {1: 1}
    assert s.counts["curved"] == {0: 1} and s.counts["high_degree"] == {0: 1}


def test_genus():
    assert genus(prism(3, False), 0) == 0
    assert genus(prism(5, True), 2) == 1


def test_bins_hold_everything_once():
    s = Statistics("s")
    for n in range(3, 50):
        s.add(prism(n, n % 2 == 0))
    for figure in s.counts:
        assert sum(s.binned(figure).values()) == pytest.approx(1)
    assert s.quantiles("faces", (0.0, 1.0)) == [5, 2 * 48 + 2]


def test_distance():
    assert distance({"a": 0.5, "b": 0.5}, {"a": 0.5, "b": 0.5}) == 0
    assert distance({"a": 1.0, "b": 0.0}, {"a": 0.0, "b": 1.0}) == 1


def test_a_drawing_without_truth_is_refused():
    d = prism(3, False)
    d.truth = None
    with pytest.raises(DrawingFormatError, match="no truth"):
        Statistics("s").add(d)


@pytest.fixture
def files(tmp_path):
    out = []
    for hole in (False, True):
        path = tmp_path / f"{hole}.jsonl.zst"
        with DrawingWriter(path) as writer:
            for n in (3, 4, 5):
                writer.write(prism(n, hole))
        out.append(path)
    return out


def test_collecting_is_limited_a_file(files):
    assert collect("all", files, 2).drawings == 4
    with pytest.raises(LookupError):
        collect("none", files, 0)


def test_the_reports(files, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    a, b = map(str, files)
    assert main([a, "--against", b, "-o", str(tmp_path / "r.md")]) == 0
    text = (tmp_path / "r.md").read_text()
    assert (
        (tmp_path / "r.png").exists() and "| distance |" in text and "| 0 | 100.0 | 0.0 |" in text
    )
    assert "100.0%  genus" in capsys.readouterr().out
    assert main([a, b, "--each", "-o", str(tmp_path / "r.html")]) == 0
    assert "data:image/png;base64," in (tmp_path / "r.html").read_text()
    assert main([str(tmp_path / "none.jsonl"), "-o", str(tmp_path / "r.md")]) == 2
