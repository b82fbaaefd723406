"""The drawing's JSON form and its files."""

import json

import numpy as np
import pytest

from faceformer_training.drawing import (
    Drawing,
    DrawingFormatError,
    DrawingWriter,
    Edge,
    Face,
    Truth,
    read_drawings,
)


def triangle(name: str) -> Drawing:
    """A flat triangle with both sides as faces: small, but with every field."""
    points = np.array([[0.0, 0.0, 0.1], [1.0, 0.0, 0.1], [0.0, 0.123456789, 0.1]])
    edges = [(0, 1), (1, 2), (2, 0)]
    truth = Truth(
        [Face("plane", [[1, 2, 3]]), Face("plane", [[-3, -2, -1]])],
        points,
        [points[list(e)] for e in edges],
        np.eye(3),
    )
    kind = {"kind": "orthographic"}
    drawn = [Edge(e, points[list(e), :2]) for e in edges]
    return Drawing(name, "made here", kind, points[:, :2], drawn, truth)


def test_json_round_trip_rounds_to_six_decimals():
    data = triangle("a").to_json()
    assert data["vertices"][2] == [0.0, 0.123457]
    assert Drawing.from_json(json.loads(json.dumps(data))).to_json() == data


def test_only_vertices_and_edges_are_required():
    drawing = Drawing.from_json({"vertices": [[0, 0], [1, 0]], "edges": []})
    assert drawing.truth is None and drawing.projection["kind"] == "orthographic"


@pytest.mark.parametrize("data", [{}, {"vertices": [[1]], "edges": []}, {"vertices": 3}, [1]])
def test_other_data_are_refused(data):
    with pytest.raises(DrawingFormatError):
        Drawing.from_json(data)


@pytest.mark.parametrize("name", ["d.jsonl", "d.jsonl.zst"])
def test_a_writer_resumes_at_a_flush(tmp_path, name):
    path = tmp_path / name
    with DrawingWriter(path) as writer:
        writer.write(triangle("a"))
        length = writer.flush()
        writer.write(triangle("lost"))
    with DrawingWriter(path, resume_at=length) as writer:
        writer.write(triangle("b").to_line())
    assert [d.id for d in read_drawings(path)] == ["a", "b"]


def test_a_single_json_file(tmp_path):
    path = tmp_path / "d.json"
    path.write_text(triangle("a").to_line())
    assert [d.id for d in read_drawings(path)] == ["a"]
