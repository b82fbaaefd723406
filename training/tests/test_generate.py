"""The generator: reproducible, valid, normalised solids in an archive that can be resumed."""

import io
import json
import math
import signal
import subprocess
import sys
import tarfile

import numpy as np
import pytest
import zstandard
from OCP.BinTools import BinTools
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Builder
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.TopoDS import TopoDS_Shape, TopoDS_Shell

from faceformer_training.generate import kernel, workers
from faceformer_training.generate.__main__ import main
from faceformer_training.generate.archive import ArchiveWriter, index_path, packed
from faceformer_training.generate.dice import Dice
from faceformer_training.generate.dress import chamfer, fillet, inner_rims
from faceformer_training.generate.features import KINDS, add
from faceformer_training.generate.finish import Limits, check_closed, finish
from faceformer_training.generate.kernel import Refused, box, cut, cylinder, frame, fuse, shifted
from faceformer_training.generate.outline import circle, face, polygon, rounded
from faceformer_training.generate.recipes import draw, name_of, names
from faceformer_training.generate.sections import FREE, POLYGONS, rectangle_points, section
from faceformer_training.generate.solid import attempt, attempts
from faceformer_training.generate.spots import Board
from faceformer_training.generate.workers import GIVEN_UP, TIMED_OUT, Pool


def finished(seed: int, k: int):
    *_, last = attempts(seed, k, Limits())
    return last


def test_a_solid_depends_on_seed_and_number_only():
    one = [finished(3, k) for k in (4, 2)]
    other = [finished(3, k) for k in (2, 4)][::-1]
    assert [packed(a.solid.shape) for a in one] == [packed(b.solid.shape) for b in other]
    assert one[0].solid.signature != finished(4, 4).solid.signature


def test_a_mix_has_its_own_recipes():
    drawn = {name_of(draw(Dice(f"mix/{k}"), "curved")) for k in range(200)}
    assert not [n for n in drawn if n.startswith("blocks")] and len(drawn) > 15


def test_finished_solids_are_valid_centred_and_scaled():
    for k in range(6):
        solid = finished(5, k).solid
        assert BRepCheck_Analyzer(solid.shape).IsValid() and solid.volume > 0
        bounds = Bnd_Box()
        BRepBndLib.AddOptimal_s(solid.shape, bounds, False, False)
        low, high = (np.array(c.Coord()) for c in (bounds.CornerMin(), bounds.CornerMax()))
        assert np.linalg.norm(high - low) / 2 == pytest.approx(1, abs=1e-3)
        assert np.abs(low + high).max() < 1e-3
        assert sum(solid.types.values()) == solid.faces == len(kernel.faces(solid.shape))


def test_unification_merges_what_lies_in_one_surface():
    two = fuse(box(1, 1, 1), box(1, 1, 1, (1, 0, 0)))
    assert len(kernel.faces(two)) > 6
    done = finish(two, Limits())
    assert (done.faces, done.edges, done.types) == (6, 12, {"plane": 6})
    # Half diagonal 1 from sides 2, 1, 1.
    assert done.volume == pytest.approx(2 / (math.sqrt(6) / 2) ** 3)


def open_shell() -> TopoDS_Shape:
    shell, builder = TopoDS_Shell(), BRep_Builder()
    builder.MakeShell(shell)
    for side in kernel.faces(box(1, 1, 1))[:5]:
        builder.Add(shell, side)
    return shell


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        (lambda: shifted(open_shell(), (0, 0, 0)), "no solid"),
        (lambda: fuse(box(1, 1, 1), box(1, 1, 1, (3, 0, 0))), "more than one solid"),
        (lambda: cut(box(3, 3, 3), box(1, 1, 1, (1, 1, 1))), "a hollow without an opening"),
        (lambda: box(1, 1, 1e-3), "an edge too short"),
        (
            # Two towers on a plate that touch along an upright edge.
            lambda: fuse(box(2, 2, 1), box(1, 1, 2), box(1, 1, 2, (1, 1, 0))),
            "an edge of more than two faces",
        ),
    ],
)
def test_what_is_no_drawable_solid_is_refused_with_its_reason(body, reason):
    with pytest.raises(Refused, match=reason):
        finish(body(), Limits())


def test_an_open_shell_is_told():
    with pytest.raises(Refused, match="an open shell"):
        check_closed(open_shell())


def test_too_many_faces_are_refused():
    with pytest.raises(Refused, match="too many faces"):
        finish(box(1, 1, 1), Limits(faces=5))


def test_kernel_exceptions_become_refusals():
    with pytest.raises(Refused, match="cylinder"):
        cylinder(-1.0, 1.0)


def test_every_section_makes_a_face():
    dice = Dice("sections")
    for make in POLYGONS:
        for _ in range(3):
            assert not face(polygon(make(dice))).IsNull()
    for make in FREE:
        assert not face(make(dice)).IsNull()
    for _ in range(20):
        assert not face(section(dice, 1.0)).IsNull()


def test_a_corner_without_room_is_refused():
    with pytest.raises(Refused, match="no room"):
        rounded(rectangle_points(2, 1), [0.6] * 4)


def test_what_would_cross_itself_is_refused():
    with pytest.raises(Refused, match="crosses itself"):
        face(polygon([(0, 0), (1, 1), (1, 0), (0, 1)]))
    with pytest.raises(Refused, match="crosses itself"):
        face(circle(1.0), circle(0.5, (0.8, 0.0)))
    with pytest.raises(Refused, match="crosses its axis"):
        kernel.revolve(kernel.placed(face(circle(1.0, (0.5, 0.0))), kernel.UPRIGHT))


def test_spots_lie_free_on_their_face():
    body = cut(box(2, 2, 1), cylinder(0.5, 3, frame((1, 1, -1))))
    board, dice = Board(body), Dice("spots")
    top = board.facing((0, 0, 1))
    assert len(top) == 1
    for _ in range(5):
        spot = board.spot(dice, top[0])
        assert spot.normal == pytest.approx([0, 0, 1])
        assert spot.depth == pytest.approx(1)
        away = math.dist(spot.centre[:2], (1, 1))
        assert away + 1e-9 > 0.48 + spot.room  # the rim is taken as a polygon
        assert min(*spot.centre[:2], *(2 - spot.centre[:2])) + 1e-9 > spot.room


@pytest.mark.parametrize("kind", KINDS, ids=lambda k: k.__name__)
def test_every_feature_gives_a_valid_solid(kind):
    made = 0
    for k in range(4):
        try:
            body = add(Dice(f"{kind.__name__}/{k}"), box(2, 1.6, 1), 1, {kind: 1})
            made += finish(body, Limits()).faces > 6
        except Refused:
            continue
    assert made >= 2


def test_rims_can_be_dressed():
    body = cut(box(2, 2, 1), cylinder(0.5, 3, frame((1, 1, -1))))
    rims = inner_rims(body)
    assert [len(r) for r in rims] == [1, 1]
    assert finish(fillet(body, rims[0], 0.1), Limits()).types == {
        "plane": 6,
        "cylinder": 1,
        "torus": 1,
    }
    assert finish(chamfer(body, rims[0], 0.1), Limits()).types["cone"] == 1
    assert inner_rims(cylinder(1, 1)) == []


def test_holes_in_a_face_are_holes():
    plate = kernel.extrude(face(circle(1.0), circle(0.5)), (0, 0, 0.2))
    assert finish(plate, Limits()).volume == pytest.approx(
        math.pi * 0.75 * 0.2 / math.hypot(1, 1, 0.1) ** 3, rel=1e-3
    )


@pytest.mark.slow
@pytest.mark.parametrize("recipe", names())
def test_every_recipe_succeeds_more_often_than_not(recipe):
    results = [attempt(11, k, 0, Limits(), recipe=recipe) for k in range(12)]
    assert sum(r.solid is not None for r in results) >= 5
    assert not [r.reason for r in results if r.reason and r.reason.startswith("a fault")]


# Archives and workers


def members(path) -> dict[str, bytes]:
    with tarfile.open(path) as tar:
        return {m.name: tar.extractfile(m).read() for m in tar}


def test_an_archive_goes_on_where_both_files_agree(tmp_path):
    path = tmp_path / "made.tar"
    with ArchiveWriter(path) as archive:
        for k in range(3):
            archive.add(f"{k:05d}.bin.zst", bytes([k]) * 700, {"n": k})
    whole, lines = path.read_bytes(), index_path(path).read_text()
    # The run was stopped while it wrote the third member, or the third line.
    for cut_tar, cut_index in ((4000, len(lines)), (len(whole), len(lines) - 5)):
        path.write_bytes(whole[:cut_tar])
        index_path(path).write_text(lines[:cut_index])
        with ArchiveWriter(path) as archive:
            assert [r["n"] for r in archive.records] == [0, 1]
            archive.add("00002.bin.zst", bytes([2]) * 700, {"n": 2})
        assert path.read_bytes() == whole
        assert index_path(path).read_text() == lines


def test_a_foreign_index_is_refused(tmp_path):
    path = tmp_path / "made.tar"
    with ArchiveWriter(path) as archive:
        archive.add("00000.bin.zst", b"x", {"n": 0})
    index_path(path).write_text('{"id": "made/00007"}\n')
    with pytest.raises(ValueError, match="not the index"):
        ArchiveWriter(path)


@pytest.mark.slow
def test_the_command_resumes_and_shards(tmp_path):
    whole, parts = tmp_path / "a.tar", [tmp_path / f"b{i}.tar" for i in (1, 2)]
    assert main(["3", str(whole), "--seed", "9"]) == 0
    assert main(["6", str(whole), "--seed", "9", "--jobs", "2"]) == 0
    for i, part in enumerate(parts, 1):
        assert main(["6", str(part), "--seed", "9", "--shard", f"{i}/2"]) == 0
    everything = members(whole)
    assert everything == members(parts[0]) | members(parts[1])
    records = [json.loads(line) for line in index_path(whole).read_text().splitlines()]
    assert [r["n"] for r in records] == list(range(6))
    data = zstandard.ZstdDecompressor().stream_reader(io.BytesIO(everything["00000.bin.zst"]))
    (tmp_path / "one.bin").write_bytes(data.read())
    shape = TopoDS_Shape()
    BinTools.Read_s(shape, str(tmp_path / "one.bin"))
    assert len(kernel.faces(shape)) == records[0]["faces"]
    with pytest.raises(SystemExit):
        main(["6", str(whole), "--seed", "8"])


@pytest.mark.slow
def test_a_draw_over_the_time_limit_is_killed_and_counted(monkeypatch):
    monkeypatch.setattr(workers, "MOST_ATTEMPTS", 2)
    with Pool(1, Limits(), "real", 1, 0.0) as pool:
        (result,) = pool.run([0])
    assert result.data is None
    assert result.reasons == [TIMED_OUT, TIMED_OUT, GIVEN_UP]


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGXCPU"), reason="no limit of processor time here")
def test_processor_time_ends_a_process():
    code = (
        "from faceformer_training.generate.workers import limit_processor\n"
        "limit_processor(0.5)\nwhile True: pass"
    )
    assert subprocess.run([sys.executable, "-c", code]).returncode == -signal.SIGXCPU
