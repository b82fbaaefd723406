"""Tables and plots of what ``eval --each`` writes."""

import json

import pytest

from faceformer_training.study import calibration, figures, groups, main, read

EMPTY = [{"count": 0, "right": 0, "confidence": 0.0} for _ in range(10)]


def row(name: str, matched: int, **more) -> dict:
    """A drawing of four faces, of which four were predicted, each with a confidence of 0.9."""
    bins = [*EMPTY[:9], {"count": 4, "right": matched, "confidence": 3.6}]
    return {
        "id": name,
        "edges": 12,
        "curved": False,
        "multi_loop": False,
        "exact": matched == 4,
        "exact_top3": matched == 4,
        "refused": False,
        "faces": 4,
        "predicted": 4,
        "matched": matched,
        "typed": matched,
        "loops": 4,
        "loops_predicted": 4,
        "loops_matched": 4,
        "ms": 2.0,
        "face_bins": bins,
        "loop_bins": EMPTY,
    } | more


ROWS = [row("a/1#o0", 4), row("a/2#o0", 2, curved=True), row("b/1#o0", 4, multi_loop=True, ms=8.0)]


def test_figures_are_means_over_drawings():
    f = figures(ROWS)
    assert (f["precision"], f["loop_recall"], f["type_rate"]) == (pytest.approx(250 / 3), 100, 100)
    assert (f["exact"], f["ms"]) == (pytest.approx(200 / 3), 2.0)


def test_what_nothing_was_predicted_of_counts_as_zero():
    refused = row("a/3#o0", 0, predicted=0, refused=True, exact=False)
    assert figures([refused])["precision"] == 0
    assert figures([*ROWS, refused])["precision"] == pytest.approx(250 / 4)


def test_groups_leave_out_what_says_nothing():
    assert {k: len(v) for k, v in groups(ROWS).items()} == {
        "all": 3,
        "polyhedra": 2,
        "curved": 1,
        "faces of several loops": 1,
        "a": 2,
        "b": 1,
    }
    assert list(groups(ROWS[:1])) == ["all"]


def test_calibration_is_by_bin():
    assert calibration(ROWS, "face_bins").tolist() == [[pytest.approx(0.9), 10 / 12, 12]]
    assert len(calibration(ROWS, "loop_bins")) == 0


def test_the_command_prints_and_draws(tmp_path, capsys):
    pytest.importorskip("matplotlib")
    each = tmp_path / "each.jsonl"
    each.write_text("\n".join(map(json.dumps, ROWS)) + "\n")
    plots = [tmp_path / "calibration.png", tmp_path / "time.png"]
    names = [f"ours={each}", "--calibration", str(plots[0]), "--time", str(plots[1])]
    assert main(names) == 0
    assert "| ours | all | 3 | 100.00 / 100.00 | 83.3 / 83.3 |" in capsys.readouterr().out
    assert all(plot.stat().st_size > 5000 for plot in plots)


def test_files_of_one_label_are_one(tmp_path, capsys):
    for name, rows in (("one", ROWS[:1]), ("two", ROWS[1:])):
        (tmp_path / f"{name}.jsonl").write_text("\n".join(map(json.dumps, rows)))
    both = read([f"x={tmp_path / 'one.jsonl'}", f"x={tmp_path / 'two.jsonl'}"])
    assert {k: len(v) for k, v in both.items()} == {"x": 3}
    (tmp_path / "none.jsonl").write_text("")
    assert main([str(tmp_path / "none.jsonl")]) == 2
    assert "has no drawings" in capsys.readouterr().err
