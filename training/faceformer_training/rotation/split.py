"""Which solids are trained on, by a hash of their names: every view of a solid is in one part.

``python -m faceformer_training.rotation.split DATA... --part test -o OUT.jsonl.zst`` writes the
drawings of a part, as they are.
"""

from __future__ import annotations

import argparse
import hashlib
import io
from collections.abc import Iterator
from pathlib import Path

import zstandard

PARTS = ("train", "validation", "test")


def part_of(name: str) -> str:
    """Part of a drawing by its id, ``source/solid#view``: 85, 5 and 10 of 100 solids."""
    solid = name.split("#", 1)[0]
    place = int.from_bytes(hashlib.sha256(solid.encode()).digest()[:8], "big") % 20
    return {0: "validation", 1: "test", 2: "test"}.get(place, "train")


def lines(path: Path) -> Iterator[str]:
    """Lines of a data set, compressed or not."""
    with path.open("rb") as file:
        zst = path.suffix == ".zst"
        raw = zstandard.ZstdDecompressor().stream_reader(file) if zst else file
        yield from io.TextIOWrapper(raw, encoding="utf-8")


def name_of(line: str) -> str:
    """The id in a line. It is the first key by the format's custom; else all of it is parsed."""
    import json

    return json.loads(line)["id"]


def main() -> None:
    parser = argparse.ArgumentParser(prog="faceformer_training.rotation.split", description=__doc__)
    parser.add_argument("data", nargs="+", type=Path)
    parser.add_argument("--part", choices=PARTS, required=True)
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    with options.output.open("wb") as file, zstandard.ZstdCompressor().stream_writer(file) as out:
        for path in options.data:
            for line in lines(path):
                if line.strip() and part_of(name_of(line)) == options.part:
                    out.write(line.rstrip("\n").encode() + b"\n")


if __name__ == "__main__":
    main()
