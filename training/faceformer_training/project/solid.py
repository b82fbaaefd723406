"""From a solid and a view to a drawing with its true faces."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from OCP.TopoDS import TopoDS_Shape
from scipy.spatial import cKDTree

from ..drawing import DECIMALS, Drawing, Edge, Face, Truth
from .brep import Brep
from .errors import ProjectionError, ViewError, kernel_errors, require
from .merge import Wireframe
from .normalise import normalise, volume
from .options import ProjectOptions
from .split import Split, split_solid
from .views import ISOMETRIC, View, isometric_view, random_view

ROUNDING = 5e-5
"""Margin over the least distances, so that rounded coordinates still keep them."""


class PreparedSolid:
    """A solid read, normalised, copied and meshed once, to be drawn in many views.

    Raises ``ProjectionError`` where the solid cannot be drawn from anywhere.
    """

    def __init__(self, shape: TopoDS_Shape, options: ProjectOptions | None = None) -> None:
        self.options = options or ProjectOptions()
        with kernel_errors():
            self.shape = normalise(shape, self.options)
            self.brep = Brep(self.shape, self.options)
            self.volume = volume(self.shape)
        faces = len(self.brep.faces)
        most = self.options.max_large_faces
        require(faces <= most, "too-many-faces", f"{faces} faces")

    def draw(self, view: View, name: str = "", source: str = "", tilt: float = 0.0) -> Drawing:
        """The drawing in one view; ``tilt`` is the least |normal . view| of a plane.

        Raises ``ViewError`` if the view is not generic, else ``ProjectionError``.
        """
        self._refuse_early(view, tilt)
        with kernel_errors():
            split = split_solid(self.brep, view, lambda points: self._refuse_near(view, points))
            wireframe = Wireframe(self.brep, split)
        return self._drawing(view, split, wireframe, name, source)

    def draw_generic(
        self, kind: str, rng: np.random.Generator, name: str = "", source: str = ""
    ) -> Drawing:
        """A drawing in a generic view of a kind: ``ortho``, ``iso`` or ``persp``.

        Random views are drawn again until one is generic; the isometric view gives way to its
        three sisters. Raises what the last try raised.
        """
        last: ProjectionError | None = None
        for view, tilt in self._views(kind, rng):
            try:
                return self.draw(view, name, source, tilt)
            except ProjectionError as error:
                last = error
                if error.code in ("too-few-faces", "too-many-faces", "touching"):
                    raise
        if last is None:
            raise ViewError("view-coincident", "not one generic view at a glance")
        raise last

    def _views(self, kind: str, rng: np.random.Generator) -> Iterator[tuple[View, float]]:
        """Views to try in turn, each with its least tilt of planes."""
        options = self.options
        if kind == "iso":
            for number in range(len(ISOMETRIC)):
                yield isometric_view(number), options.min_tilt_late / 5
            return
        drawn = 0
        for look in range(options.looks):
            late = look > options.looks // 2 or drawn > options.tries // 2
            tilt = options.min_tilt_late if late else options.min_tilt
            view = random_view(rng, kind, options)
            try:
                self._refuse_early(view, tilt)
            except ViewError:
                continue
            yield view, tilt
            drawn += 1
            if drawn == options.tries:
                return

    def is_large(self, drawing: Drawing) -> bool:
        """Whether a drawing belongs in the bucket of large solids."""
        assert drawing.truth is not None
        faces = drawing.truth.faces
        most = max(sum(len(loop) for loop in face.loops) for face in faces)
        return self.options.is_large(len(faces), most)

    def _refuse_early(self, view: View, tilt: float) -> None:
        """Refuse what needs no silhouettes to be seen."""
        facing = view.facing(self.brep.plane_points, self.brep.plane_normals)
        if len(facing) and float(np.abs(facing).min()) <= tilt:
            raise ViewError("view-edge-on")
        self._refuse_near(view, self.brep.vertices[self.brep.firm])

    def _refuse_near(self, view: View, points: np.ndarray) -> None:
        self._refuse_coincident(view.draw(view.camera(points)))

    def _refuse_coincident(self, drawn: np.ndarray) -> None:
        pairs = cKDTree(drawn).query_pairs(self.options.min_vertex_distance + ROUNDING)
        if len(drawn) > 1 and pairs:
            raise ViewError("view-coincident")

    def _drawing(
        self, view: View, split: Split, wireframe: Wireframe, name: str, source: str
    ) -> Drawing:
        options = self.options
        faces = len(split.parts)
        require(faces >= options.min_faces, "too-few-faces", f"{faces} faces")
        require(faces <= options.max_large_faces, "too-many-faces", f"{faces} faces")
        characteristic = (
            len(wireframe.vertices)
            - len(wireframe.edges)
            + sum(2 - len(loops) for loops in wireframe.loops)
        )
        expected = self.brep.characteristic
        require(characteristic == expected, "euler", f"{characteristic}, solid {expected}")

        vertices3d = np.round(view.camera(wireframe.vertices), DECIMALS)
        vertices = np.round(view.draw(vertices3d), DECIMALS)
        self._refuse_coincident(vertices)
        edges, edges3d = [], []
        for tail, head, points in wireframe.edges:
            points3d = np.round(view.camera(_distinct(points)), DECIMALS)
            points3d[0], points3d[-1] = vertices3d[tail], vertices3d[head]
            drawn = np.round(view.draw(points3d), DECIMALS)
            drawn[0], drawn[-1] = vertices[tail], vertices[head]
            length = float(np.linalg.norm(np.diff(drawn, axis=0), axis=1).sum())
            if length < options.min_edge_length + ROUNDING:
                raise ViewError("view-short-edge")
            edges.append(Edge((tail, head), drawn))
            edges3d.append(points3d)
        for part, loops in zip(split.parts, wireframe.loops, strict=True):
            area = sum(_area(edges, loop) for loop in loops)
            if abs(area) < options.min_face_area:
                raise ViewError("view-no-area")
            require((area > 0) == part.front, "orientation", f"face {part.face + 1}")
        truth = Truth(
            [
                Face(part.label, loops)
                for part, loops in zip(split.parts, wireframe.loops, strict=True)
            ],
            vertices3d,
            edges3d,
            view.rotation.T,
        )
        return Drawing(name, source, view.projection, vertices, edges, truth)


def _distinct(points: np.ndarray) -> np.ndarray:
    """A curve's polyline without doubled points, as long as nine points are left."""
    if len(points) <= 9:
        return points
    keep = np.r_[True, np.linalg.norm(np.diff(points, axis=0), axis=1) > 2e-5]
    keep[-1] = True
    return points[keep] if keep.sum() >= 9 else points


def _area(edges: list[Edge], loop: list[int]) -> float:
    total = 0.0
    for k in loop:
        p = edges[abs(k) - 1].points
        twice = float((p[:-1, 0] * p[1:, 1] - p[1:, 0] * p[:-1, 1]).sum())
        total += 0.5 * twice if k > 0 else -0.5 * twice
    return total


def project_solid(
    shape: TopoDS_Shape,
    view: View,
    options: ProjectOptions | None = None,
    name: str = "",
    source: str = "",
) -> Drawing:
    """The drawing of one solid in one view.

    Raises ``ProjectionError``, whose ``code`` is one of ``errors.REASONS``. For several views of
    one solid make a ``PreparedSolid`` once.
    """
    return PreparedSolid(shape, options).draw(view, name, source)
