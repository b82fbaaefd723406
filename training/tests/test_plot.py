"""Pictures of drawings."""

import pytest
from test_statistics import prism

from faceformer_training import plot
from faceformer_training.drawing import DrawingWriter


@pytest.fixture
def data(tmp_path):
    path = tmp_path / "d.jsonl.zst"
    with DrawingWriter(path) as writer:
        for n in range(3, 12):
            writer.write(prism(n, n % 2 == 0))
    return path


def test_faces_that_look_away_have_negative_area():
    d = prism(4, False)
    areas = [plot.signed_area(plot.boundary(d, f)) for f in d.truth.faces]
    assert sum(a > 0 for a in areas) == 3
    assert sum(areas) == pytest.approx(0, abs=1e-9)
    assert len(plot.facing_edges(d)) == 9


def test_a_hole_is_taken_off_its_face():
    d = prism(4, True)
    cap = max(d.truth.faces, key=lambda f: len(f.loops))
    outer, inner = (plot.signed_area([p]) for p in plot.boundary(d, cap))
    assert outer * inner < 0
    assert abs(inner / outer) == pytest.approx(0.16)


def test_a_sample_is_drawn_by_its_seed(data):
    ids = [d.id for d in plot.chosen(str(data), 4, 1)]
    assert ids == [d.id for d in plot.chosen(str(data), 4, 1)] and len(set(ids)) == 4
    assert len(plot.chosen(str(data), 99, 1)) == 9


def test_one_is_found_by_its_id(data):
    assert [d.id for d in plot.chosen(f"{data}#prism5False", 4, 0)] == ["prism5False"]
    with pytest.raises(LookupError, match="no drawing 'x'"):
        plot.chosen(f"{data}#x", 4, 0)


def test_the_command(data, tmp_path):
    pytest.importorskip("matplotlib")
    png, svg = tmp_path / "a.png", tmp_path / "a.svg"
    assert plot.main([str(data), "-o", str(png), "--sheet", "2x3", "--dpi", "40"]) == 0
    assert png.read_bytes().startswith(b"\x89PNG")
    assert plot.main([f"{data}#prism4True", "-o", str(svg)]) == 0
    assert "<svg" in svg.read_text()
    assert plot.main([f"{data}#x", "-o", str(svg)]) == 2
    with pytest.raises(SystemExit):
        plot.main([str(data), "-o", str(tmp_path / "a.gif")])
