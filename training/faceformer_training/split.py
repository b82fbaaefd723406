"""Runs gathered into train, valid and test: by solid family, without duplicates between runs.

``python -m faceformer_training.split RUN.jsonl.zst... --out DIR [--large]``

Each run is an output of ``faceformer_training.project`` or of one shard; the index beside it
(``RUN.solids.jsonl``) names every solid's family and keys. A family's split follows from its key
alone (see ``project.signature``), so no view of a solid, and no sister of it, is ever in two
splits, and splits made at different times agree.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from contextlib import ExitStack
from pathlib import Path

from tqdm import tqdm

from .drawing import DrawingWriter, read_lines
from .project.output import beside, large_output
from .project.signature import split_of

SPLITS = ("train", "valid", "test")


def gather(
    runs: list[Path],
    out: Path,
    large: bool = False,
    shares: tuple[float, float, float] | None = None,
) -> Counter[str]:
    """Write ``train``, ``valid`` and ``test`` ``.jsonl.zst`` into a directory; drawings by split.

    Of solids with equal shape or views keys only the first is taken. Raises ``OSError`` where a
    run or its index is missing, ``ValueError`` for a drawing whose solid is not in the index.
    """
    out.mkdir(parents=True, exist_ok=True)
    shapes: set[str] = set()
    views: set[str] = set()
    counts: Counter[str] = Counter()
    with ExitStack() as stack:
        writers = {
            name: stack.enter_context(DrawingWriter(out / f"{name}.jsonl.zst")) for name in SPLITS
        }
        for run in runs:
            split_of_solid: dict[str, str | None] = {}
            for line in read_lines(beside(run, "solids.jsonl")):
                row = json.loads(line)
                if row["outcome"] != "ok":
                    continue
                if row["shape"] in shapes or row["views"] in views:
                    split_of_solid[row["name"]] = None
                    continue
                shapes.add(row["shape"])
                views.add(row["views"])
                family = row["family"]
                split_of_solid[row["name"]] = (
                    row["split"] if shares is None else split_of(family, shares)
                )
            path = large_output(run) if large else run
            for line in tqdm(read_lines(path), unit="drawing", desc=path.name, disable=None):
                name = json.loads(line)["id"].rsplit("#", 1)[0]
                if name not in split_of_solid:
                    raise ValueError(f"{path}: {name} is not in {beside(run, 'solids.jsonl')}")
                split = split_of_solid[name]
                if split is None:
                    counts["duplicate"] += 1
                    continue
                writers[split].write(line.rstrip("\n"))
                counts[split] += 1
    return counts


def main(arguments: list[str] | None = None) -> int:
    """Gather and print counts; 0 done, 2 bad input."""
    parser = argparse.ArgumentParser(
        prog="python -m faceformer_training.split", description=__doc__.split("\n\n")[0]
    )
    parser.add_argument("runs", nargs="+", type=Path, help="outputs of faceformer_training.project")
    parser.add_argument("--out", type=Path, required=True, help="directory for the three files")
    parser.add_argument("--large", action="store_true", help="the runs' buckets of large solids")
    parser.add_argument(
        "--shares",
        type=float,
        nargs=3,
        metavar=("TRAIN", "VALID", "TEST"),
        help="shares of families, 0.9 0.05 0.05 unless given",
    )
    given = parser.parse_args(arguments)
    try:
        shares = tuple(given.shares) if given.shares else None
        counts = gather(given.runs, given.out, given.large, shares)
    except (OSError, ValueError, KeyError) as error:
        print(error, file=sys.stderr)
        return 2
    print(", ".join(f"{counts[name]} {name}" for name in (*SPLITS, "duplicate")))
    return 0


if __name__ == "__main__":
    sys.exit(main())
