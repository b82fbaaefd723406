"""``python -m faceformer_training.atlasnet.points DATA.jsonl.zst OUT.safetensors`` samples solids.

Each drawing's solid is built from its true faces by the program ``faceformer``, and ``POINTS``
points are drawn evenly from its surface. OUT holds ``images`` u8 ``[N, 224, 224]`` and ``points``
f32 ``[N, POINTS, 3]`` in the camera frame, the centre of the solid's bounding box being 0 and half
its diagonal 1; its metadata hold the ``ids``. A drawing whose solid cannot be built is left out.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from safetensors.numpy import save_file
from tqdm import tqdm

from ..drawing import read_lines
from .image import image

POINTS = 2500


def triangles(stl: bytes) -> np.ndarray:
    """The triangles of a text or binary STL file, ``[T, 3, 3]``. Raises ``ValueError``."""
    if not stl.lstrip().startswith(b"solid"):
        count = int.from_bytes(stl[80:84], "little")
        record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
        return np.frombuffer(stl, record, count, 84)["corners"].astype(float)
    rows = [line.split()[1:] for line in stl.splitlines() if line.split()[:1] == [b"vertex"]]
    return np.array(rows, float).reshape(-1, 3, 3)


def sample(mesh: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """Points spread evenly over the area of triangles, ``[count, 3]``."""
    a, b, c = mesh[:, 0], mesh[:, 1], mesh[:, 2]
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    which = random.choice(len(mesh), count, p=area / area.sum())
    u, v = random.random((2, count, 1))
    over = u + v > 1
    u, v = np.where(over, 1 - u, u), np.where(over, 1 - v, v)
    return a[which] + u * (b - a)[which] + v * (c - a)[which]


def aligned(mesh: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """The mesh in the frame of the true vertices, its bounding box centred and of half diagonal 1.

    Of a solid and its mirror image in depth, which an orthographic drawing shows alike, it is the
    one whose corners are nearer to the true vertices.
    """

    def centred(p: np.ndarray) -> np.ndarray:
        flat = p.reshape(-1, 3)
        return p - (flat.min(0) + flat.max(0)) / 2

    def off(p: np.ndarray) -> float:
        corners, true = p.reshape(-1, 3), centred(vertices)
        return float(np.mean([np.linalg.norm(corners - v, axis=1).min() for v in true]))

    plain = centred(mesh)
    turned = plain * [1, 1, -1]
    best = min((plain, turned), key=off)
    return best / (np.linalg.norm(np.ptp(best.reshape(-1, 3), axis=0)) / 2)


def solid(drawing: dict[str, Any], program: Path, folder: Path) -> np.ndarray | None:
    """The mesh of a drawing's solid, or none if it cannot be built."""
    source, target = folder / "drawing.json", folder / "solid.stl"
    source.write_text(json.dumps(drawing))
    target.unlink(missing_ok=True)
    command = [program, "solid", source, "--faces", "truth", "--orientation", "drawn", "-o", target]
    done = subprocess.run(command, capture_output=True)
    if done.returncode != 0 or not target.exists():
        return None
    return aligned(triangles(target.read_bytes()), np.array(drawing["truth"]["vertices3d"], float))


def main() -> None:
    parser = argparse.ArgumentParser(prog="faceformer_training.atlasnet.points")
    parser.description = __doc__
    parser.add_argument("data", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--program", type=Path, default=Path("faceformer"))
    parser.add_argument("--limit", type=int, help="take the first N drawings only")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    ids, images, points = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for line in tqdm(islice(read_lines(options.data), options.limit), total=options.limit):
            drawing = json.loads(line)
            mesh = solid(drawing, options.program, Path(folder))
            if mesh is None:
                continue
            ids.append(drawing["id"])
            images.append(image([np.array(e["points"]) for e in drawing["edges"]]))
            points.append(sample(mesh, POINTS, random).astype(np.float32))
    if not ids:
        raise SystemExit("no solid could be built")
    tables = {"images": np.stack(images), "points": np.stack(points)}
    save_file(tables, options.output, {"ids": json.dumps(ids)})
    print(f"{len(ids)} solids")


if __name__ == "__main__":
    main()
