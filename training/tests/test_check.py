"""The checker passes a good drawing and names what is wrong with spoilt ones."""

import copy

import numpy as np
import pytest

from faceformer_training.check import check_drawing, main
from faceformer_training.drawing import Drawing, DrawingWriter, Edge, Face, Truth

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / np.sqrt(3)
# Corners of each side, counter-clockwise seen from outside.
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def cube() -> Drawing:
    """A cube seen from a generic direction, made without the projector."""
    a, b = 0.5, 0.4
    turn = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    tip = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
    rotation = tip @ turn
    points = CORNERS @ rotation.T
    ends: list[tuple[int, int]] = []
    faces = []
    for side in SIDES:
        loop = []
        for u, v in zip(side, side[1:] + side[:1], strict=True):
            if (v, u) in ends:
                loop.append(-1 - ends.index((v, u)))
            else:
                ends.append((u, v))
                loop.append(len(ends))
        faces.append(Face("plane", [loop]))
    edges = [Edge(e, points[list(e), :2]) for e in ends]
    truth = Truth(faces, points, [points[list(e)] for e in ends], rotation.T)
    kind = {"kind": "orthographic"}
    return Drawing("cube", "made here", kind, points[:, :2].copy(), edges, truth)


def rules(drawing: Drawing) -> set[str]:
    return {fault.rule for fault in check_drawing(drawing)}


def test_a_good_drawing_has_no_faults():
    assert check_drawing(cube()) == []


def drop_coedge(d):
    d.truth.faces[0].loops[0].pop()


def turn_face(d):
    d.truth.faces[0].loops[0] = [-k for k in reversed(d.truth.faces[0].loops[0])]


def turn_all(d):
    for face in d.truth.faces:
        face.loops = [[-k for k in reversed(loop)] for loop in face.loops]


def move_vertex(d):
    d.vertices[3] += 0.01


def move_depth(d):
    """One corner nearer to the viewer: drawn alike, but its faces are no longer flat."""
    d.truth.vertices3d[0, 2] += 0.1
    for edge, points in zip(d.edges, d.truth.edges3d, strict=True):
        points[:] = d.truth.vertices3d[list(edge.v)]


def few_points(d):
    d.edges[0].points = np.linspace(*d.edges[0].points, 5)
    d.truth.edges3d[0] = np.linspace(*d.truth.edges3d[0], 5)


def swap_loops(d):
    """Two faces exchange an edge's two sides: each co-edge once, but the loops are open."""
    a, b = d.truth.faces[0].loops[0], d.truth.faces[1].loops[0]
    a[0], b[0] = b[0], a[0]


def no_truth(d):
    d.truth = None


def mirror_axes(d):
    d.truth.directions = -d.truth.directions


def loose_vertex(d):
    d.vertices = np.vstack([d.vertices, [[0.9, 0.9]]])
    d.truth.vertices3d = np.vstack([d.truth.vertices3d, [[0.9, 0.9, 0.0]]])


def rename_type(d):
    d.truth.faces[2].type = "blob"


@pytest.mark.parametrize(
    ("spoil", "rule"),
    [
        (drop_coedge, "co-edge"),
        (turn_face, "co-edge"),
        (turn_all, "inside out"),
        (move_vertex, "projection"),
        (move_depth, "not flat"),
        (few_points, "few points"),
        (swap_loops, "open loop"),
        (no_truth, "no truth"),
        (mirror_axes, "directions"),
        (loose_vertex, "unused vertex"),
        (rename_type, "face type"),
    ],
)
def test_each_fault_is_named(spoil, rule):
    drawing = copy.deepcopy(cube())
    spoil(drawing)
    assert rule in rules(drawing)


def test_a_merged_vertex_is_no_cycle():
    """Two cubes that touch in one corner: two cycles at it, and two shells."""
    a, b = cube(), cube()
    both = cube()
    count, edges = len(a.vertices), len(a.edges)
    shift = a.truth.vertices3d[7] - b.truth.vertices3d[0]
    new = {v: count + v - 1 if v else 7 for v in range(count)}
    points = np.vstack([a.truth.vertices3d, (b.truth.vertices3d + shift)[1:]])
    both.vertices, both.truth.vertices3d = points[:, :2], points
    for edge in b.edges:
        ends = (new[edge.v[0]], new[edge.v[1]])
        both.edges.append(Edge(ends, points[list(ends), :2]))
        both.truth.edges3d.append(points[list(ends)])
    for face in b.truth.faces:
        loops = [[k + edges if k > 0 else k - edges for k in loop] for loop in face.loops]
        both.truth.faces.append(Face("plane", loops))
    assert {"vertex cycle", "several shells"} <= rules(both)


def test_the_command_says_which_file_is_bad(tmp_path, capsys):
    path = tmp_path / "d.jsonl"
    bad = cube()
    turn_face(bad)
    with DrawingWriter(path) as writer:
        writer.write(cube())
        writer.write(bad)
    assert main([str(path)]) == 1
    assert "2 drawings, 1 bad" in capsys.readouterr().out
    path.write_text("{}\n")
    assert main([str(path)]) == 2
