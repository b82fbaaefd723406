"""Runs over archives: counted failures, resuming, repeatability, shards, ended workers."""

import json
import tarfile
import time

import pytest
from OCP.BinTools import BinTools
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeSphere
from OCP.gp import gp_Pnt

from faceformer_training.check import Fault, check_drawing
from faceformer_training.drawing import read_drawings
from faceformer_training.project import work
from faceformer_training.project.__main__ import _identity, main, parse_shard, parse_views
from faceformer_training.project.output import OtherRunError, RunOutput
from faceformer_training.project.pool import LocalPool
from faceformer_training.project.read import ItemReader, list_items
from faceformer_training.project.work import Plan, SolidResult, work_on
from faceformer_training.split import SPLITS, gather


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    """A box, the box again elsewhere, a file of rubbish, a sphere (too simple), a cylinder."""
    folder = tmp_path_factory.mktemp("archive")
    shapes = {
        "0.bin": BRepPrimAPI_MakeBox(3, 2, 1).Solid(),
        "1.bin": BRepPrimAPI_MakeBox(gp_Pnt(7, 7, 7), 6, 4, 2).Solid(),
        "3.bin": BRepPrimAPI_MakeSphere(2).Shape(),
        "4.bin": BRepPrimAPI_MakeCylinder(1, 4).Shape(),
    }
    for name, shape in shapes.items():
        BinTools.Write_s(shape, str(folder / name))
    (folder / "2.bin").write_bytes(b"rubbish")
    path = folder / "few.tar"
    with tarfile.open(path, "w") as tar:
        for number in range(5):
            tar.add(folder / f"{number}.bin", f"{number}.bin")
    return path


def results_of(archive, plan):
    reader = ItemReader()
    return [
        [m for m in work_on(item, plan, reader) if isinstance(m, SolidResult)]
        for item in list_items([archive])
    ]


def test_failures_are_counted_and_duplicates_left_out(archive, tmp_path):
    plan = Plan((("ortho", 2), ("persp", 1)))
    output = RunOutput(tmp_path / "o.jsonl", {})
    for results in results_of(archive, plan):
        output.add(results)
    output.close()
    report = json.loads((tmp_path / "o.report.json").read_text())
    assert report["solids"] == 5 and report["drawn"] == 2
    reasons = {code: entry["solids"] for code, entry in report["not_drawn"].items()}
    assert reasons == {"duplicate": 1, "unreadable": 1, "too-few-faces": 1} or reasons == {
        "duplicate": 1,
        "no-solid": 1,
        "too-few-faces": 1,
    }
    drawings = list(read_drawings(tmp_path / "o.jsonl"))
    assert [d.id for d in drawings] == [
        f"few/{n}#{view}" for n in (0, 4) for view in ("o0", "o1", "p0")
    ]
    assert all(check_drawing(d) == [] for d in drawings)
    rows = [json.loads(line) for line in (tmp_path / "o.solids.jsonl").read_text().splitlines()]
    assert {row["split"] for row in rows if row["outcome"] == "ok"} <= {"train", "valid", "test"}


def test_a_resumed_run_equals_an_unbroken_one(archive, tmp_path):
    whole, broken = tmp_path / "whole.jsonl.zst", tmp_path / "broken.jsonl.zst"
    everything = results_of(archive, Plan())
    output = RunOutput(whole, {"a": 1})
    for results in everything:
        output.add(results)
    output.close()
    output = RunOutput(broken, {"a": 1})
    for results in everything[:2]:
        output.add(results)
    output.save()
    output.add(everything[2])
    # Stopped here: what came after the last save is in the files, or lost.
    output._writer.flush()
    output._index.close()
    output = RunOutput(broken, {"a": 1})
    assert output.done == 2
    for results in everything[2:]:
        output.add(results)
    output.close()
    lines = [[d.to_line() for d in read_drawings(p)] for p in (whole, broken)]
    assert lines[0] == lines[1] and lines[0]
    rows = [(tmp_path / f"{n}.solids.jsonl").read_text() for n in ("whole", "broken")]
    assert rows[0] == rows[1]
    with pytest.raises(OtherRunError):
        RunOutput(broken, {"a": 2})


def test_two_runs_are_gathered_into_splits_once(archive, tmp_path):
    runs = [tmp_path / "a.jsonl.zst", tmp_path / "b.jsonl.zst"]
    for path in runs:
        output = RunOutput(path, {})
        for results in results_of(archive, Plan()):
            output.add(results)
        output.close()
    counts = gather(runs, tmp_path / "split")
    kept = [d.id for s in SPLITS for d in read_drawings(tmp_path / "split" / f"{s}.jsonl.zst")]
    assert sorted(kept) == sorted(d.id for d in read_drawings(runs[0]))
    assert counts["duplicate"] == len(kept)


def test_runs_are_repeatable_and_seeds_differ(archive):
    a, b, c = (
        [line for r in results_of(archive, Plan(seed=s)) for x in r for _, _, line in x.drawings]
        for s in (0, 0, 1)
    )
    assert a == b != c


def test_a_drawing_that_the_checker_refuses_is_counted(archive, monkeypatch):
    monkeypatch.setattr(work, "check_drawing", lambda _: [Fault("not flat", "face 3")])
    plan = Plan((("ortho", 1),))
    first = results_of(archive, plan)[0][0]
    assert first.outcome == "check" and first.drawings == []
    assert first.detail == "check: not flat: face 3"


def test_options_are_parsed():
    assert parse_views("ortho=2,iso") == (("ortho", 2), ("iso", 1))
    assert parse_shard("2/3") == (2, 3)
    for wrong in ("front", "ortho=0", "iso=2", "ortho=x"):
        with pytest.raises(Exception, match="iso|KIND"):
            parse_views(wrong)
    for wrong in ("0/3", "4/3", "x"):
        with pytest.raises(Exception, match="i"):
            parse_shard(wrong)


def test_the_identity_is_plain_json(archive):
    identity = _identity(list_items([archive]), Plan())
    assert identity == json.loads(json.dumps(identity))


def test_bad_usage_is_told(tmp_path, archive):
    assert main([str(archive), str(tmp_path / "o.txt")]) == 2
    assert main([str(tmp_path / "none.tar"), str(tmp_path / "o.jsonl")]) == 2


@pytest.mark.slow
def test_the_command_with_shards(archive, tmp_path):
    found = []
    for shard in ("1/2", "2/2"):
        path = tmp_path / f"o{shard[0]}.jsonl.zst"
        assert main([str(archive), str(path), "--shard", shard, "--processes", "1"]) == 0
        # A second call finds nothing left to do.
        assert main([str(archive), str(path), "--shard", shard, "--processes", "1"]) == 0
        found += [d.id.split("#")[0] for d in read_drawings(path)]
    assert sorted(set(found)) == ["few/0", "few/1", "few/4"]


def _sleep_or_die(item, plan, reader, first=0):
    """Stands in for the work: a solid that hangs, one that ends its process, one that is fine."""
    yield -1
    for number in range(first, 3):
        yield number
        if number == 0:
            time.sleep(60)
        if number == 1:
            import os

            os._exit(1)
        yield SolidResult(number, item.name, item.source)


def _serve_badly(pipe, plan):
    from faceformer_training.project import pool

    pool.work_on = _sleep_or_die
    pool._serve(pipe, plan)


@pytest.mark.slow
def test_a_solid_that_hangs_or_crashes_costs_only_itself(archive, monkeypatch):
    import multiprocessing

    from faceformer_training.project import pool

    context = multiprocessing.get_context("spawn")

    class Context:
        Pipe = staticmethod(context.Pipe)

        @staticmethod
        def Process(target, args, daemon):
            return context.Process(target=_serve_badly, args=args, daemon=daemon)

    monkeypatch.setattr(pool.multiprocessing, "get_context", lambda _: Context)
    items = list_items([archive])[:1]
    with LocalPool(Plan(), 1, limit=2.0) as workers:
        ((number, results),) = workers.run(enumerate(items))
    assert number == 0
    assert [r.outcome for r in results] == ["time-limit", "crash", "ok"]
