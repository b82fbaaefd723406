"""Tables and plots of what ``faceformer eval --each`` wrote.

``python -m faceformer_training.study [LABEL=]EACH.jsonl... [--calibration PNG] [--time PNG]``

Each file is one engine or one set of drawings, under its label or its name. The table has a row for
all drawings of a file, for polyhedra, curved parts and parts with faces of several loops, and for
each source. The plots need matplotlib (the extra ``plot``).
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

Row = dict[str, Any]

HEADS = (
    "",
    "shapes",
    "drawings",
    "loops, precision / recall",
    "faces, precision / recall",
    "kinds",
    "exact / in first 3",
    "ms",
)


def source(row: Row) -> str:
    """The source of a drawing: what is before the stroke in its id."""
    return row["id"].partition("/")[0]


def groups(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """The drawings by shape and source; groups that are empty, or everything, are left out."""
    shapes: dict[str, Callable[[Row], bool]] = {
        "polyhedra": lambda r: not r["curved"],
        "curved": lambda r: r["curved"],
        "faces of several loops": lambda r: r["multi_loop"],
    }
    found = {"all": list(rows)}
    found |= {name: [r for r in rows if has(r)] for name, has in shapes.items()}
    for name in sorted({source(r) for r in rows}):
        found[name] = [r for r in rows if source(r) == name]
    return {k: v for k, v in found.items() if k == "all" or 0 < len(v) < len(rows)}


def share(part: float, whole: float) -> float:
    return part / whole if whole else 0.0


def figures(rows: Sequence[Row]) -> dict[str, float]:
    """The figures of ``eval`` for some drawings: shares in percent, the median in milliseconds."""

    def mean(part: str, whole: str) -> float:
        return 100 * float(np.mean([share(r[part], r[whole]) for r in rows]))

    def right(key: str) -> float:
        return 100 * float(np.mean([r[key] for r in rows]))

    times = [r["ms"] for r in rows if not r["refused"]]
    return {
        "loop_precision": mean("loops_matched", "loops_predicted"),
        "loop_recall": mean("loops_matched", "loops"),
        "precision": mean("matched", "predicted"),
        "recall": mean("matched", "faces"),
        "type_rate": 100 * share(sum(r["typed"] for r in rows), sum(r["matched"] for r in rows)),
        "exact": right("exact"),
        "exact_top3": right("exact_top3"),
        "ms": median(times) if times else float("nan"),
    }


def table(files: dict[str, list[Row]]) -> str:
    """A Markdown table, a row for each group of each file."""
    lines = ["| " + " | ".join(HEADS) + " |", "|---" * len(HEADS) + "|"]
    for label, rows in files.items():
        for name, group in groups(rows).items():
            f = figures(group)
            cells = (
                label,
                name,
                str(len(group)),
                f"{f['loop_precision']:.2f} / {f['loop_recall']:.2f}",
                f"{f['precision']:.1f} / {f['recall']:.1f}",
                f"{f['type_rate']:.1f}",
                f"{f['exact']:.1f} / {f['exact_top3']:.1f}",
                f"{f['ms']:.1f}",
            )
            lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def calibration(rows: Iterable[Row], key: str) -> np.ndarray:
    """Mean confidence, share that is right and number of items of every bin that has some."""
    total = np.zeros((0, 3))
    for row in rows:
        bins = np.array([[b["confidence"], b["right"], b["count"]] for b in row[key]])
        total = bins if not len(total) else total + bins
    total = total[total[:, 2] > 0]
    return np.column_stack([total[:, 0] / total[:, 2], total[:, 1] / total[:, 2], total[:, 2]])


def draw_calibration(files: dict[str, list[Row]], path: Path) -> None:
    """Confidence against the share that is right, loops beside faces, a line a file.

    The area of a point grows with the share of the items that it stands for.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 4.2), layout="constrained")
    for axes, key, what in zip(
        figure.subplots(1, 2), ("loop_bins", "face_bins"), ("loops", "faces"), strict=True
    ):
        axes.plot([0, 1], [0, 1], color="#999999", linestyle=":", linewidth=1)
        for label, rows in files.items():
            bins = calibration(rows, key)
            if not len(bins):  # An engine that tells no confidences.
                continue
            error = float(np.abs(bins[:, 0] - bins[:, 1]) @ bins[:, 2] / bins[:, 2].sum())
            (line,) = axes.plot(bins[:, 0], bins[:, 1], label=f"{label} (error {error:.3f})")
            areas = 8 + 200 * bins[:, 2] / bins[:, 2].sum()
            axes.scatter(bins[:, 0], bins[:, 1], areas, color=line.get_color(), alpha=0.7)
        axes.set(xlabel=f"confidence of {what}", ylabel="share that is right")
        axes.set(xlim=(0, 1.01), ylim=(0, 1.01), aspect="equal")
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="lower right", fontsize=8)
    figure.savefig(path, dpi=120)


def draw_time(files: dict[str, list[Row]], path: Path) -> None:
    """Time of identification against the number of edges, a point a drawing."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 4.2), layout="constrained")
    axes = figure.subplots()
    for label, rows in files.items():
        done = [r for r in rows if not r["refused"]]
        axes.scatter([r["edges"] for r in done], [r["ms"] for r in done], s=7, label=label)
    axes.set(xlabel="edges of the drawing", ylabel="milliseconds, one core")
    axes.set(xscale="log", yscale="log")
    axes.grid(True, which="major", linewidth=0.4)
    axes.legend(fontsize=8)
    figure.savefig(path, dpi=120)


def read(arguments: Sequence[str]) -> dict[str, list[Row]]:
    """The rows of every ``[LABEL=]FILE``; files of one label are put together.

    Raises ``OSError``, ``ValueError`` for a line that is no JSON, or a file without lines.
    """
    files: dict[str, list[Row]] = {}
    for argument in arguments:
        label, _, name = argument.rpartition("=")
        lines = Path(name).read_text("utf-8").splitlines()
        if not lines:
            raise ValueError(f"{name} has no drawings")
        files.setdefault(label or Path(name).stem, []).extend(map(json.loads, lines))
    return files


def main(arguments: list[str] | None = None) -> int:
    """Print the table and draw what is asked for; 0 done, 2 bad input."""
    parser = argparse.ArgumentParser(
        prog="python -m faceformer_training.study", description=__doc__.split("\n\n")[0]
    )
    parser.add_argument("files", nargs="+", metavar="[LABEL=]EACH.jsonl")
    parser.add_argument("--calibration", type=Path, metavar="PNG", help="confidences against truth")
    parser.add_argument("--time", type=Path, metavar="PNG", help="time against edges")
    given = parser.parse_args(arguments)
    try:
        files = read(given.files)
        for draw, path in ((draw_calibration, given.calibration), (draw_time, given.time)):
            if path:
                draw(files, path)
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    print(table(files))
    return 0


if __name__ == "__main__":
    sys.exit(main())
