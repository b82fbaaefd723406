"""``python -m faceformer_training.project SOLIDS... OUT.jsonl.zst``: archives to drawings."""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from tqdm import tqdm

from .options import ProjectOptions
from .output import OtherRunError, RunOutput, beside
from .pool import LocalPool
from .read import Item, list_items
from .views import VIEW_KINDS
from .work import Plan, SolidResult


def parse_views(text: str) -> tuple[tuple[str, int], ...]:
    """``ortho=2,iso=1`` to (("ortho", 2), ("iso", 1)); there is one isometric view at the most."""
    views = []
    for part in text.split(","):
        kind, _, copies = part.partition("=")
        if kind not in VIEW_KINDS or not (copies or "1").isdigit() or int(copies or 1) < 1:
            raise argparse.ArgumentTypeError(f"{part!r}: {'|'.join(VIEW_KINDS)}, or KIND=NUMBER")
        if kind == "iso" and int(copies or 1) > 1:
            raise argparse.ArgumentTypeError("the isometric view is fixed: iso=1 at the most")
        views.append((kind, int(copies or 1)))
    return tuple(views)


def parse_shard(text: str) -> tuple[int, int]:
    """``i/n`` with i from 1 to n."""
    try:
        number, count = map(int, text.split("/"))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not i/n") from None
    if not 1 <= number <= count:
        raise argparse.ArgumentTypeError(f"{text!r}: i runs from 1 to n")
    return number, count


def parser() -> argparse.ArgumentParser:
    """The command line."""
    limits = ProjectOptions()
    out = argparse.ArgumentParser(
        prog="python -m faceformer_training.project",
        description="Project CAD solids to wireframe drawings with their true faces.",
    )
    out.add_argument(
        "solids",
        nargs="+",
        type=Path,
        help="STEP, BREP, FCStd or BinTools files, tar archives of them, or directories",
    )
    out.add_argument("output", type=Path, help="OUT.jsonl.zst or OUT.jsonl")
    out.add_argument(
        "--views", type=parse_views, default=Plan().views, help="ortho=1,iso=1,persp=1"
    )
    out.add_argument("--seed", type=int, default=0)
    out.add_argument("--processes", type=int, default=2)
    out.add_argument("--time-limit", type=float, default=60.0, help="seconds a solid")
    out.add_argument("--shard", type=parse_shard, default=(1, 1), metavar="i/n")
    out.add_argument("--ray", action="store_true", help="spread the work over a Ray cluster")
    out.add_argument("--ray-address", help="of a running cluster; a local one is started else")
    out.add_argument("--restart", action="store_true", help="begin anew, whatever was there")
    out.add_argument("--limit", type=int, help="only the first so many items")
    out.add_argument("--max-faces", type=int, default=limits.max_faces)
    out.add_argument("--max-face-edges", type=int, default=limits.max_face_edges)
    out.add_argument("--max-large-faces", type=int, default=limits.max_large_faces)
    out.add_argument("--min-faces", type=int, default=limits.min_faces)
    return out


def main(arguments: list[str] | None = None) -> int:
    """Run it; 0 done (whatever failed is counted), 2 bad input or usage, 130 interrupted."""
    given = parser().parse_args(arguments)
    try:
        if not given.output.name.endswith((".jsonl", ".jsonl.zst")):
            raise ValueError(f"{given.output}: the output is OUT.jsonl or OUT.jsonl.zst")
        items = list_items(given.solids)
        number, count = given.shard
        items = items[number - 1 :: count][: given.limit]
        options = ProjectOptions(
            max_faces=given.max_faces,
            max_face_edges=given.max_face_edges,
            max_large_faces=given.max_large_faces,
            min_faces=given.min_faces,
        )
        plan = Plan(given.views, given.seed, options)
        given.output.parent.mkdir(parents=True, exist_ok=True)
        output = RunOutput(given.output, _identity(items, plan), restart=given.restart)
    except (OtherRunError, OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    try:
        with _pool(given, plan) as pool:
            _run(items, pool, output)
    except KeyboardInterrupt:
        output.close()
        print(f"stopped after {output.done} of {len(items)} items; the same command goes on")
        return 130
    output.close()
    _tell(output)
    return 0


def _identity(items: list[Item], plan: Plan) -> dict:
    """What a resumed run must have in common with the one before, as plain JSON."""
    names = hashlib.blake2b(repr([i.name for i in items]).encode(), digest_size=8).hexdigest()
    return json.loads(json.dumps({"items": len(items), "names": names, "plan": asdict(plan)}))


def _pool(given: argparse.Namespace, plan: Plan):
    if given.ray:
        from .ray_pool import RayPool

        return RayPool(plan, 0, given.time_limit, given.ray_address)
    return LocalPool(plan, given.processes, given.time_limit)


def _run(items: list[Item], pool, output: RunOutput) -> None:
    """Work through the items; results are written in the items' order, so runs are repeatable."""
    early: dict[int, list[SolidResult]] = {}

    def tasks() -> Iterator[tuple[int, Item]]:
        yield from list(enumerate(items))[output.done :]

    with tqdm(total=len(items), initial=output.done, unit="item", disable=None) as bar:
        for number, results in pool.run(tasks()):
            early[number] = results
            while output.done in early:
                output.add(early.pop(output.done))
                bar.update()
                bar.set_postfix(drawings=sum(output.drawn.values()), refresh=False)


def _tell(output: RunOutput) -> None:
    report = output.report()
    print(f"{report['drawn']} of {report['solids']} solids drawn, {report['drawings']} drawings")
    for code, entry in report["not_drawn"].items():
        print(f"  {entry['solids']:6d} {code}: {entry['meaning']}")
    rate = report["drawings_per_second"]
    print(f"{report['wall_seconds']} s, {rate} drawings a second")
    print(f"report: {beside(output.path, 'report.json')}")


if __name__ == "__main__":
    sys.exit(main())
