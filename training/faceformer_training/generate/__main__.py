"""``python -m faceformer_training.generate N OUT.tar --seed S [--shard i/n]``."""

import argparse
import sys
from collections import Counter
from pathlib import Path

from tqdm import tqdm

from .archive import ArchiveWriter, index_path
from .finish import Limits
from .recipes import MIXES
from .workers import Pool

DUPLICATE = "the same as an earlier solid"


def shard(text: str) -> tuple[int, int]:
    """``i/n``, i from 1 to n."""
    i, slash, n = text.partition("/")
    if not (slash and i.isdigit() and n.isdigit() and 1 <= int(i) <= int(n)):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form i/n with 1 <= i <= n")
    return int(i), int(n)


def parser() -> argparse.ArgumentParser:
    p = argparse.ArgumentParser(
        prog="python -m faceformer_training.generate",
        description="Writes an archive of random mechanical solids. A run that was stopped goes on "
        "when it is started again with the same arguments.",
    )
    p.add_argument("count", type=int, metavar="N", help="number of solids, over all shards")
    p.add_argument("out", type=Path, metavar="OUT.tar")
    p.add_argument("--seed", type=int, default=0, help="default 0")
    p.add_argument(
        "--mix", choices=MIXES, default=MIXES[0], help="like real parts (default), or curved only"
    )
    p.add_argument("--shard", type=shard, default=(1, 1), metavar="i/n", help="every n-th, from i")
    p.add_argument("--jobs", type=int, default=1, help="worker processes (default 1)")
    p.add_argument(
        "--seconds", type=float, default=10.0, help="processor time of one draw (default 10)"
    )
    p.add_argument("--max-faces", type=int, default=Limits.faces, help=f"default {Limits.faces}")
    return p


def main(arguments: list[str] | None = None) -> int:
    a = parser().parse_args(arguments)
    if a.out.suffix != ".tar" or a.count < 1 or a.jobs < 1:
        parser().error("N and --jobs must be positive, and OUT must end in .tar")
    numbers = range(a.shard[0] - 1, a.count, a.shard[1])
    reasons: Counter[str] = Counter()
    limits = Limits(faces=a.max_faces)
    with (
        ArchiveWriter(a.out) as archive,
        Pool(a.seed, limits, a.mix, a.jobs, a.seconds) as pool,
        tqdm(total=len(numbers), unit=" solids", disable=None) as bar,
    ):
        if any((r["seed"], r["mix"]) != (a.seed, a.mix) for r in archive.records):
            parser().error(f"{a.out} is there already, made with another seed or mix")
        seen = {r["hash"] for r in archive.records}
        # Numbers are written in order; what was given up before stays so.
        after = archive.records[-1]["n"] if archive.records else -1
        left = [k for k in numbers if k > after]
        bar.update(len(numbers) - len(left))
        for result in pool.run(left):
            bar.update()
            reasons.update(result.reasons)
            if result.data is None:
                continue
            if result.record["hash"] in seen:
                reasons[DUPLICATE] += 1
                continue
            seen.add(result.record["hash"])
            record = {"source": "generated", "seed": a.seed, "mix": a.mix, **result.record}
            archive.add(f"{result.k:05d}.bin.zst", result.data, record)
        kept = len(archive.records)
    print(f"{kept} solids in {a.out}, index {index_path(a.out)}", file=sys.stderr)
    for reason, n in reasons.most_common():
        print(f"  drawn anew {n:6d}: {reason}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
