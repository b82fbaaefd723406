"""Free round spots on the planar faces of a solid: where a feature has room."""

import math
from dataclasses import dataclass

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_CurveType, GeomAbs_SurfaceType
from OCP.gp import gp_Ax2, gp_Lin
from OCP.IntCurvesFace import IntCurvesFace_ShapeIntersector
from OCP.TopAbs import TopAbs_Orientation
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape

from .dice import Dice
from .kernel import Refused, Vector, direction, edges, faces, frame, point

# Points per curved edge of a face's outline: a full circle is 3% short of its true radius.
CURVE_POINTS = 14


@dataclass(frozen=True)
class Spot:
    """A disc of radius ``room`` on a planar face, free of the face's edges.

    ``normal`` points out of the solid, ``along`` follows the face's longest straight edge,
    ``depth`` is the thickness of the material below the centre.
    """

    centre: np.ndarray
    normal: np.ndarray
    along: np.ndarray
    room: float
    depth: float

    def frame(self, above: float = 0.0, turn: float = 0.0) -> gp_Ax2:
        """Axis system at height ``above`` over the face, z outwards, turned by ``turn``."""
        side = np.cross(self.normal, self.along)
        x = math.cos(turn) * self.along + math.sin(turn) * side
        return frame(self.centre + above * self.normal, self.normal, x)


@dataclass(frozen=True)
class Flat:
    """A planar face in its own coordinates.

    ``segments`` is (n, 2, 2): its boundary as straight pieces; ``origin``, ``x``, ``y`` and
    ``normal`` give the way back to space.
    """

    segments: np.ndarray
    origin: np.ndarray
    x: np.ndarray
    y: np.ndarray
    normal: np.ndarray

    def clearance(self, points: np.ndarray) -> np.ndarray:
        """Distance of (m, 2) points from the boundary, negative outside of the face."""
        a, b = self.segments[:, 0], self.segments[:, 1]
        d = b - a
        rel = points[:, None] - a
        t = np.clip((rel * d).sum(-1) / (d * d).sum(-1), 0, 1)
        gap = np.linalg.norm(rel - t[..., None] * d, axis=-1).min(1)
        # Even-odd rule on a ray to the right.
        above_a, above_b = a[:, 1] > points[:, None, 1], b[:, 1] > points[:, None, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            x = a[:, 0] + d[:, 0] * (points[:, None, 1] - a[:, 1]) / d[:, 1]
        hits = (above_a != above_b) & (points[:, None, 0] < x)
        return np.where(hits.sum(1) % 2 == 1, gap, -gap)

    def space(self, p: np.ndarray) -> np.ndarray:
        return self.origin + p[0] * self.x + p[1] * self.y


def polyline(edge) -> np.ndarray:
    """(n, 3) points on an edge; two for a straight one."""
    curve = BRepAdaptor_Curve(edge)
    n = 2 if curve.GetType() == GeomAbs_CurveType.GeomAbs_Line else CURVE_POINTS
    ts = np.linspace(curve.FirstParameter(), curve.LastParameter(), n)
    return np.array([curve.Value(float(t)).Coord() for t in ts])


def flat(face: TopoDS_Face) -> Flat | None:
    """A planar face's boundary, or None if the face is curved."""
    surface = BRepAdaptor_Surface(face, True)
    if surface.GetType() != GeomAbs_SurfaceType.GeomAbs_Plane:
        return None
    normal = np.array(surface.Plane().Axis().Direction().Coord())
    if not surface.Plane().Direct():
        normal = -normal
    if face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED:
        normal = -normal
    lines = [polyline(edge) for edge in edges(face)]
    pieces = np.concatenate([np.stack([p[:-1], p[1:]], 1) for p in lines])
    pieces = pieces[np.linalg.norm(pieces[:, 1] - pieces[:, 0], axis=1) > 1e-9]
    straight = [p[1] - p[0] for p in lines if len(p) == 2]
    x = max(straight, key=np.linalg.norm) if straight else pieces[0, 1] - pieces[0, 0]
    x = x - (x @ normal) * normal
    x = x / np.linalg.norm(x)
    y = np.cross(normal, x)
    origin = pieces[0, 0]
    return Flat((pieces - origin) @ np.stack([x, y], 1), origin, x, y, normal)


def flats(shape: TopoDS_Shape) -> list[Flat]:
    return [f for f in map(flat, faces(shape)) if f is not None]


class Board:
    """The free spots of a solid; what was taken stays taken."""

    def __init__(self, shape: TopoDS_Shape) -> None:
        self.flats = flats(shape)
        if not self.flats:
            raise Refused("no planar face for a feature")
        self.rays = IntCurvesFace_ShapeIntersector()
        self.rays.Load(shape, 1e-7)
        self.taken: list[tuple[int, np.ndarray, float]] = []

    def depth(self, centre: np.ndarray, inward: np.ndarray) -> float:
        """Thickness of the material from a point on a face inwards."""
        line = gp_Lin(point(centre), direction(inward))
        self.rays.PerformNearest(line, 1e-5, 1e9)
        if not self.rays.IsDone() or self.rays.NbPnt() == 0:
            raise Refused("no material below a spot")
        return float(self.rays.WParameter(1))

    def facing(self, towards: Vector) -> list[int]:
        """Numbers of the planar faces whose outward normal is ``towards``."""
        return [i for i, f in enumerate(self.flats) if f.normal @ np.asarray(towards) > 0.999]

    def spot(self, dice: Dice, which: int | None = None, share: float = 1.0) -> Spot:
        """A free spot on face ``which``, or on any, the larger the likelier.

        A spot takes ``share`` of the room there is around it.
        """
        if which is None:
            sizes = [np.ptp(f.segments.reshape(-1, 2), axis=0).prod() for f in self.flats]
            which = dice.choices(range(len(sizes)), weights=[s + 1e-12 for s in sizes])[0]
        face = self.flats[which]
        corners = face.segments.reshape(-1, 2)
        low, high = corners.min(0), corners.max(0)
        tries = np.array([[dice.random(), dice.random()] for _ in range(12)])
        if dice.chance(0.5):  # on an axis of symmetry, or in the middle
            tries[:4, dice.randrange(2)] = 0.5
            tries[0] = 0.5
        points = low + tries * (high - low)
        room = face.clearance(points)
        for number, centre, radius in self.taken:
            if number == which:
                room = np.minimum(room, np.linalg.norm(points - centre, axis=1) - radius)
        middle = dice.chance(0.3) and room[0] > 0.3 * room.max()
        best = 0 if middle else int(room.argmax())
        r = float(room[best])
        if r < 0.02 * float(np.linalg.norm(high - low)):
            raise Refused("no room for a feature")
        self.taken.append((which, points[best], r * share))
        centre = face.space(points[best])
        return Spot(centre, face.normal, face.x, r * share, self.depth(centre, -face.normal))
