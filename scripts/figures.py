#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures the engines and the solids on a data set and prints the tables of the README.

python3 scripts/figures.py [DATA.jsonl.zst] [--program target/release/faceformer]
"""

import argparse
import json
import subprocess

ENGINES = ("rotation", "faceformer", "varley", "shortest")
SHAPES = {
    "all": "all",
    "polyhedra": "polyhedra",
    "polyhedra-single": "polyhedra without inner loops",
    "planes-cylinders": "planes and cylinders",
}


def measure(program, data, *options):
    """The figures that `eval` prints as one JSON object."""
    run = subprocess.run(
        [program, "eval", data, "--json", *options], check=True, capture_output=True, text=True
    )
    return json.loads(run.stdout)


def table(heads, rows):
    """A Markdown table; numbers with one decimal, or two below ten milliseconds."""
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines)


def pair(figures, first, second):
    return f"{figures[first]:.1f} / {figures[second]:.1f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", nargs="?", default="tests/corpus/sample.jsonl.zst")
    parser.add_argument("--program", default="target/release/faceformer")
    arguments = parser.parse_args()
    rows = []
    for shapes in ("polyhedra-single", "polyhedra", "all"):
        for engine in ENGINES:
            f = measure(arguments.program, arguments.data, "--engine", engine, "--shapes", shapes)
            rows.append(
                (
                    SHAPES[shapes],
                    f["drawings"],
                    f"`{engine}`",
                    pair(f, "precision", "recall"),
                    f"{f['type_rate']:.1f}",
                    pair(f, "exact", "exact_top3"),
                    pair(f, "loop_precision", "loop_recall"),
                    f"{f['loops_exact']:.1f}",
                    f["refused"],
                    f"{f['ms_median']:.2f}",
                )
            )
    heads = (
        "shapes",
        "drawings",
        "engine",
        "faces, precision / recall",
        "types",
        "exact / in first 3",
        "loops, precision / recall",
        "loops exact",
        "refused",
        "ms",
    )
    print(table(heads, rows), end="\n\n")
    rows = []
    for shapes in ("planes-cylinders", "all"):
        for faces in (("--faces", "truth"), ("--engine", "rotation")):
            f = measure(arguments.program, arguments.data, "--solids", "--shapes", shapes, *faces)
            rows.append(
                (
                    SHAPES[shapes],
                    f["drawings"],
                    "true" if faces[1] == "truth" else f"`{faces[1]}`",
                    f"{f['lifted']:.1f}",
                    f"{f['valid']:.1f}",
                    f"{f['lift_ms_median']:.1f}",
                    f"{f['solid_ms_median']:.1f}",
                )
            )
    heads = ("shapes", "drawings", "faces", "lifted", "valid", "ms lift", "ms plan and solid")
    print(table(heads, rows))


main()
