"""The committed sample: its drawings come out of its solids again."""

from pathlib import Path

import pytest

from faceformer_training import check, compare
from faceformer_training.drawing import read_drawings

SAMPLE = Path(__file__).parent / "sample"
DRAWINGS = SAMPLE / "drawings.jsonl.zst"


@pytest.mark.slow
def test_the_drawings_are_those_of_the_solids():
    everything = ["--sample", "0", "--least", "100"]
    assert compare.main([str(DRAWINGS), "--solids", str(SAMPLE), *everything]) == 0


def test_the_drawings_pass_the_checker(capsys):
    assert check.main([str(DRAWINGS)]) == 0
    assert capsys.readouterr().out.startswith("133 drawings, 0 bad")


def test_every_drawing_names_its_source_and_licence():
    for drawing in read_drawings(DRAWINGS):
        assert drawing.source.startswith("generated, seed ") or "(" in drawing.source
        assert "unknown" not in drawing.source
