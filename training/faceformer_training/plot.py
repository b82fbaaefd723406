"""Pictures of drawings with their faces in colours, one or a contact sheet.

``python -m faceformer_training.plot DATA.jsonl.zst[#ID] -o OUT.{png,svg} [--sheet 4x6] [--seed S]``

Faces that look at the viewer are filled by surface type, the farthest first; edges between two
faces that both look away are dashed. Needs matplotlib (the extra ``plot``).
"""

from __future__ import annotations

import argparse
import random
import re
import sys
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from .drawing import Drawing, DrawingFormatError, Face, read_drawings

COLOURS = {
    "plane": "#8fb8de",
    "cylinder": "#f2b36b",
    "cone": "#8ccf8a",
    "sphere": "#e58a8a",
    "torus": "#b99ad6",
    "other": "#b59a86",
}
SHEET = (4, 6)
INCHES = 2.6


def boundary(drawing: Drawing, face: Face) -> list[np.ndarray]:
    """One (n, 2) closed polygon a loop, walked with the material of the face on the left."""
    loops = []
    for loop in face.loops:
        pieces = []
        for k in loop:
            points = drawing.edges[abs(k) - 1].points
            pieces.append((points if k > 0 else points[::-1])[:-1])
        loops.append(np.concatenate(pieces))
    return loops


def signed_area(loops: Iterable[np.ndarray]) -> float:
    """Area of a face as drawn; negative if it looks away from the viewer."""
    area = 0.0
    for p in loops:
        x, y = p.T
        area += float(x @ np.roll(y, -1) - np.roll(x, -1) @ y) / 2
    return area


def depth(drawing: Drawing, face: Face) -> float:
    """Mean z of a face's edges, larger nearer."""
    assert drawing.truth is not None
    ks = [abs(k) - 1 for loop in face.loops for k in loop]
    return float(np.mean([drawing.truth.edges3d[k][:, 2].mean() for k in ks]))


def facing_edges(drawing: Drawing) -> set[int]:
    """Numbers (from 0) of the edges of which at least one face looks at the viewer."""
    if drawing.truth is None:
        return set(range(len(drawing.edges)))
    return {
        abs(k) - 1
        for face in drawing.truth.faces
        if signed_area(boundary(drawing, face)) > 0
        for loop in face.loops
        for k in loop
    }


def draw(axes, drawing: Drawing, caption: bool = True) -> None:
    """Draws into matplotlib axes."""
    from matplotlib.collections import LineCollection
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    if drawing.truth is not None:
        for face in sorted(drawing.truth.faces, key=lambda f: depth(drawing, f)):
            loops = boundary(drawing, face)
            if signed_area(loops) <= 0:
                continue
            points = np.concatenate([np.concatenate([p, p[:1]]) for p in loops])
            codes = [
                code
                for p in loops
                for code in [Outline.MOVETO, *[Outline.LINETO] * (len(p) - 1), Outline.CLOSEPOLY]
            ]
            colour = COLOURS.get(face.type, COLOURS["other"])
            axes.add_patch(PathPatch(Outline(points, codes), fc=colour, alpha=0.6, ec="none"))
    near = facing_edges(drawing)
    lines = [e.points for e in drawing.edges]
    front = [p for i, p in enumerate(lines) if i in near]
    back = [p for i, p in enumerate(lines) if i not in near]
    axes.add_collection(LineCollection(back, colors="#888888", linewidths=0.5, linestyles="--"))
    axes.add_collection(LineCollection(front, colors="black", linewidths=0.8))
    axes.plot(*np.asarray(drawing.vertices).T, ".", color="#c02020", ms=2)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.axis("off")
    if caption:
        faces = "" if drawing.truth is None else f", {len(drawing.truth.faces)} faces"
        text = f"{drawing.id[-36:]}\n{len(drawing.edges)} edges{faces}"
        axes.set_title(text, fontsize=5, pad=1)


def sheet(drawings: list[Drawing], rows: int, columns: int):
    """A matplotlib figure with up to ``rows * columns`` drawings."""
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    figure = Figure(figsize=(INCHES * columns, INCHES * rows + 0.3), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False)
    for axes in grid.flat:
        axes.axis("off")
    for axes, drawing in zip(grid.flat, drawings, strict=False):
        draw(axes, drawing)
    keys = [Line2D([], [], color=c, lw=6, label=t) for t, c in COLOURS.items()]
    figure.legend(handles=keys, loc="outside lower center", ncols=6, frameon=False, fontsize=7)
    return figure


def chosen(name: str, count: int, seed: int) -> list[Drawing]:
    """The drawing that ``DATA#ID`` names, or a sample of ``count`` from a file.

    Raises ``LookupError`` if there is no such drawing or the file is empty.
    """
    named = re.fullmatch(r"(.+?\.jsonl?(?:\.zst)?)#(.+)", name)
    if named:
        path, wanted = named.groups()
        for drawing in read_drawings(path):
            if drawing.id == wanted:
                return [drawing]
        raise LookupError(f"{path} has no drawing {wanted!r}")
    # Reservoir sampling: a data set need not fit in memory.
    rng, sample = random.Random(seed), []
    for i, drawing in enumerate(read_drawings(name)):
        if len(sample) < count:
            sample.append(drawing)
        elif (j := rng.randrange(i + 1)) < count:
            sample[j] = drawing
    if not sample:
        raise LookupError(f"{name} has no drawings")
    return sample


def _grid(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"([1-9]\d*)x([1-9]\d*)", text)
    if not match:
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form ROWSxCOLUMNS")
    return int(match[1]), int(match[2])


def main(arguments: list[str] | None = None) -> int:
    p = argparse.ArgumentParser(prog="python -m faceformer_training.plot", description=__doc__)
    p.add_argument("data", metavar="DATA[#ID]", help="drawings, or one of them")
    p.add_argument("-o", "--output", required=True, type=Path, help="picture: .png or .svg")
    p.add_argument("--sheet", type=_grid, metavar="ROWSxCOLUMNS", help="default 4x6")
    p.add_argument("--seed", type=int, default=0, help="chooses the drawings of a sheet")
    p.add_argument("--dpi", type=int, default=110, help="of a .png (default 110)")
    a = p.parse_args(arguments)
    if a.output.suffix not in (".png", ".svg"):
        p.error("the picture's name must end in .png or .svg")
    rows, columns = a.sheet or SHEET
    try:
        drawings = chosen(a.data, rows * columns, a.seed)
    except (OSError, LookupError, DrawingFormatError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    if len(drawings) == 1 and a.sheet is None:
        rows = columns = 1
    sheet(drawings, rows, columns).savefig(a.output, dpi=a.dpi)
    return 0


if __name__ == "__main__":
    sys.exit(main())
