"""What drawings are like: counts of faces, edges, types, degrees, loops, genus; with comparison.

``python -m faceformer_training.statistics FILES... -o REPORT.md|html [--against FILES...]``

The files are pooled into one set, those after ``--against`` into another; ``--each`` gives every
file a column of its own. Two sets are compared by the total variation distance of each figure's
distribution: the share of one set that would have to change to become as the other, 0 to 100%.
"""

from __future__ import annotations

import argparse
import base64
import html
import io
import itertools
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tqdm import tqdm

from .drawing import FACE_TYPES, Drawing, DrawingFormatError, read_drawings

# Name, what is counted, and the lower ends of its bins (None: the values themselves).
WIDE = (0, 4, 5, 6, 7, 9, 11, 14, 17, 20, 24, 28, 33, 43, 80)
EDGES = (0, 6, 9, 12, 16, 20, 25, 30, 40, 50, 60, 75, 90, 120, 250)
FIGURES = {
    "faces": ("faces a drawing", WIDE),
    "edges": ("edges a drawing", EDGES),
    "types": ("faces by surface type", None),
    "degrees": ("vertices by degree", (0, 2, 3, 4, 5, 6)),
    "face_edges": ("edges a face", (0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 16, 24, 38)),
    "face_loops": ("loops a face", (0, 1, 2, 3, 4, 6, 10)),
    "inner_loops": ("inner loops a drawing", (0, 1, 2, 3, 4, 5, 6, 8, 12, 20)),
    "genus": ("genus", (0, 1, 2, 3, 4, 6, 10)),
    "curved": ("drawings by share of curved faces, in tenths", tuple(range(11))),
    "high_degree": ("drawings by vertices of degree 4 and more", (0, 1, 2, 3, 5, 9, 17)),
}


@dataclass
class Statistics:
    """Counts over a set of drawings with truth, one counter a figure."""

    name: str
    drawings: int = 0
    counts: dict[str, Counter] = field(default_factory=lambda: {k: Counter() for k in FIGURES})

    def add(self, drawing: Drawing) -> None:
        """Counts a drawing; raises ``DrawingFormatError`` if it has no truth."""
        if drawing.truth is None:
            raise DrawingFormatError(f"drawing {drawing.id} has no truth to count")
        faces, c = drawing.truth.faces, self.counts
        degrees = Counter(v for e in drawing.edges for v in e.v)
        inner = sum(len(f.loops) - 1 for f in faces)
        curved = sum(f.type != "plane" for f in faces)
        self.drawings += 1
        c["faces"][len(faces)] += 1
        c["edges"][len(drawing.edges)] += 1
        c["types"].update(f.type for f in faces)
        c["degrees"].update(degrees.values())
        c["face_edges"].update(sum(map(len, f.loops)) for f in faces)
        c["face_loops"].update(len(f.loops) for f in faces)
        c["inner_loops"][inner] += 1
        c["genus"][genus(drawing, inner)] += 1
        c["curved"][10 * curved // max(1, len(faces))] += 1
        c["high_degree"][sum(d > 3 for d in degrees.values())] += 1

    def binned(self, figure: str) -> dict[str, float]:
        """Share of each bin, 0 to 1, in order."""
        counts, bins = self.counts[figure], FIGURES[figure][1]
        total = max(1, counts.total())
        if bins is None:
            return {t: counts[t] / total for t in FACE_TYPES}
        out = {}
        for low, high in itertools.pairwise((*bins, None)):
            label = f"{low}+" if high is None else str(low)
            if high is not None and high - low > 1:
                label = f"{low}-{high - 1}"
            out[label] = sum(
                n for x, n in counts.items() if x >= low and (high is None or x < high)
            )
        return {label: n / total for label, n in out.items()}

    def quantiles(self, figure: str, shares: Sequence[float] = (0.1, 0.5, 0.9)) -> list[int]:
        """Values below which these shares of the set lie."""
        values = sorted(self.counts[figure].elements())
        return [values[min(len(values) - 1, int(s * len(values)))] for s in shares]

    def mean(self, figure: str) -> float:
        counts = self.counts[figure]
        return sum(x * n for x, n in counts.items()) / max(1, counts.total())


def genus(drawing: Drawing, inner_loops: int) -> int:
    """Genus of the solid, summed over its shells, from Euler's formula.

    V - E + F - (inner loops) = 2 (shells - genus). Faces joined by edges make up a shell.
    """
    faces = drawing.truth.faces
    parent = list(range(len(faces)))

    def find(a: int) -> int:
        while parent[a] != a:
            parent[a] = parent[parent[a]]
            a = parent[a]
        return a

    owner: dict[int, int] = {}
    for i, face in enumerate(faces):
        for loop in face.loops:
            for k in loop:
                parent[find(i)] = find(owner.setdefault(abs(k), i))
    shells = len({find(i) for i in range(len(faces))})
    used = {v for e in drawing.edges for v in e.v}
    chi = len(used) - len(drawing.edges) + len(faces) - inner_loops
    return shells - chi // 2


def distance(a: dict[str, float], b: dict[str, float]) -> float:
    """Total variation distance of two distributions over the same bins, 0 to 1."""
    return sum(abs(a[k] - b[k]) for k in a) / 2


def collect(name: str, files: Iterable[str | Path], limit: int | None = None) -> Statistics:
    """The statistics of all drawings in the files, or of the first ``limit`` of each."""
    out = Statistics(name)
    for file in files:
        drawings = itertools.islice(read_drawings(file), limit)
        for drawing in tqdm(drawings, desc=Path(file).name, unit=" drawings", disable=None):
            out.add(drawing)
    if not out.drawings:
        raise LookupError(f"no drawings in {', '.join(map(str, files))}")
    return out


# The report


def tables(sets: Sequence[Statistics]) -> list[tuple[str, list[list[str]]]]:
    """Title and rows of each table; the first row is the heading."""
    head = ["", *(s.name for s in sets)]
    if len(sets) == 2:
        head.append("distance")
    overview = [head, ["drawings", *(str(s.drawings) for s in sets)]]
    for figure in ("faces", "edges", "inner_loops", "genus", "high_degree"):
        row = [f"{FIGURES[figure][0]}: 10%, median, 90%; mean"]
        for s in sets:
            low, middle, high = s.quantiles(figure)
            row.append(f"{low}, {middle}, {high}; {s.mean(figure):.1f}")
        overview.append(row)
    out = [("Overview", overview)]
    for figure, (title, _) in FIGURES.items():
        shares = [s.binned(figure) for s in sets]
        rows = [head]
        for label in shares[0]:
            rows.append([label, *(f"{100 * x[label]:.1f}" for x in shares)])
        if len(sets) == 2:
            rows[1] = [*rows[1], f"{100 * distance(*shares):.1f}"]
        out.append((f"{title[0].upper()}{title[1:]}, percent", rows))
    width = len(head)
    return [(t, [r + [""] * (width - len(r)) for r in rows]) for t, rows in out]


def plot(sets: Sequence[Statistics]):
    """A matplotlib figure: one panel of bars a figure."""
    from matplotlib.figure import Figure

    columns = 2
    rows = -(-len(FIGURES) // columns)
    sheet = Figure(figsize=(12, 2.6 * rows), layout="constrained")
    for axes, figure in zip(sheet.subplots(rows, columns).flat, FIGURES, strict=False):
        width = 0.84 / len(sets)
        for i, s in enumerate(sets):
            shares = s.binned(figure)
            xs = [j + (i - (len(sets) - 1) / 2) * width for j in range(len(shares))]
            axes.bar(xs, [100 * x for x in shares.values()], width, label=s.name)
        axes.set_xticks(range(len(shares)), list(shares), fontsize=7)
        axes.set_title(FIGURES[figure][0], fontsize=9)
        axes.set_ylabel("%", fontsize=8)
    sheet.axes[0].legend(fontsize=8)
    return sheet


def write_report(path: Path, sets: Sequence[Statistics]) -> None:
    """Writes ``.md`` with the plots in a ``.png`` beside it, or ``.html`` with them inside."""
    picture = io.BytesIO()
    plot(sets).savefig(picture, format="png", dpi=90)
    if path.suffix == ".md":
        path.with_suffix(".png").write_bytes(picture.getvalue())
        path.write_text(_markdown(sets, path.with_suffix(".png").name), "utf-8")
    else:
        path.write_text(_html(sets, base64.b64encode(picture.getvalue()).decode()), "utf-8")


def _markdown(sets: Sequence[Statistics], picture: str) -> str:
    parts = ["# Statistics of drawings", "", f"![distributions]({picture})", ""]
    for title, rows in tables(sets):
        lines = ["| " + " | ".join(row) + " |" for row in rows]
        lines.insert(1, "|---" * len(rows[0]) + "|")
        parts += [f"## {title}", "", *lines, ""]
    return "\n".join(parts)


def _html(sets: Sequence[Statistics], picture: str) -> str:
    style = "body{font:15px sans-serif;max-width:70em;margin:2em auto}"
    style += "td,th{padding:1px 12px;text-align:right}td:first-child{text-align:left}"
    parts = ["<!doctype html><meta charset=utf-8><title>Statistics of drawings</title>"]
    parts.append(f"<style>{style}</style><h1>Statistics of drawings</h1>")
    parts.append(f'<img alt="distributions" src="data:image/png;base64,{picture}">')
    for title, rows in tables(sets):
        parts.append(f"<h2>{html.escape(title)}</h2><table>")
        for i, row in enumerate(rows):
            tag = "td" if i else "th"
            cells = "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in row)
            parts.append(f"<tr>{cells}</tr>")
        parts.append("</table>")
    return "\n".join(parts)


def main(arguments: list[str] | None = None) -> int:
    p = argparse.ArgumentParser(
        prog="python -m faceformer_training.statistics", description=__doc__
    )
    p.add_argument("files", nargs="+", metavar="FILES", help="drawings with truth")
    p.add_argument("-o", "--output", type=Path, required=True, help="report: .md or .html")
    p.add_argument("--against", nargs="+", default=[], metavar="FILES", help="the set to compare")
    p.add_argument("--names", nargs=2, default=["generated", "real"], help="of the two sets")
    p.add_argument("--each", action="store_true", help="one column a file")
    p.add_argument("--limit", type=int, help="read the first so many drawings of a file only")
    a = p.parse_args(arguments)
    if a.output.suffix not in (".md", ".html"):
        p.error("the report's name must end in .md or .html")
    try:
        if a.each:
            every = [*a.files, *a.against]
            sets = [collect(Path(f).name.partition(".")[0], [f], a.limit) for f in every]
        else:
            sets = [collect(a.names[0], a.files, a.limit)]
            if a.against:
                sets.append(collect(a.names[1], a.against, a.limit))
        write_report(a.output, sets)
    except (OSError, LookupError, DrawingFormatError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    if len(sets) == 2:
        for figure, (title, _) in FIGURES.items():
            gap = distance(sets[0].binned(figure), sets[1].binned(figure))
            print(f"{100 * gap:5.1f}%  {title}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
