"""The whole set by one command."""

import json

import pytest

from faceformer_training import dataset
from faceformer_training.drawing import read_drawings
from faceformer_training.generate.__main__ import main as generate


@pytest.mark.slow
def test_a_small_set_is_made_checked_and_split_and_a_second_run_does_nothing(tmp_path, monkeypatch):
    source = tmp_path / "source.tar"
    generate(["3", str(source), "--seed", "9"])
    out = tmp_path / "set"
    arguments = [str(out), str(source), "--generated", "4", "--curved", "2"]
    assert dataset.main(arguments) == 0
    report = json.loads((out / "report.json").read_text())
    assert report["solids"] == 9
    assert set(report["sources"]) == {"generated", "curved", "source"}
    splits = [d for part in (out / "splits").iterdir() for d in read_drawings(part)]
    large = [d for part in (out / "splits-large").iterdir() for d in read_drawings(part)]
    assert len(splits) + len(large) == report["drawings"] >= 3 * 9
    assert (out / "statistics.html").exists()

    monkeypatch.setattr(dataset, "_run", lambda command: pytest.fail(str(command)))
    assert dataset.main(arguments) == 0
    assert json.loads((out / "report.json").read_text()) == report
    # Other settings would mix two sets.
    assert dataset.main([*arguments, "--seed", "5"]) == 1


def test_a_failed_step_ends_the_run_and_is_done_again(tmp_path, monkeypatch):
    monkeypatch.setattr(dataset, "_run", lambda command: 3)
    steps = dataset.Steps(tmp_path / "steps.json", {})
    with pytest.raises(dataset.StepError, match="draw failed"):
        steps.run("draw", ("project",))
    assert not steps.seconds


def test_solids_must_be_archives(tmp_path, capsys):
    with pytest.raises(SystemExit):
        dataset.main([str(tmp_path / "set"), str(tmp_path / "none.tar")])
    assert "none.tar is not an archive of solids" in capsys.readouterr().err
