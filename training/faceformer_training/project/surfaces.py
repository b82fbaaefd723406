"""Points and natural unit normals (du x dv) of a face's surface, for many (u, v) at once.

Planes, cylinders, cones, spheres and tori are evaluated in closed form. On any other surface
OCCT gives point and derivatives; where such a surface really is a plane or a quadric, the
normal is that quadric's, so that its silhouettes come out exact. Left-handed axis systems flip
``du x dv`` (``hand``); so do a cone beyond its apex, and a torus with R < r where
R + r cos v < 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import (
    GeomAbs_Cone,
    GeomAbs_Cylinder,
    GeomAbs_Plane,
    GeomAbs_Sphere,
    GeomAbs_Torus,
)
from OCP.gp import gp_Cone, gp_Cylinder, gp_Pln, gp_Pnt, gp_Sphere, gp_Vec
from OCP.ShapeAnalysis import ShapeAnalysis_CanonicalRecognition
from OCP.TopoDS import TopoDS_Face

from .errors import require


def xyz(item) -> tuple[float, float, float]:
    """Coordinates of a gp point, vector or direction."""
    return item.Coord()


@dataclass
class Quadric:
    """A plane, cylinder, cone, sphere or torus in its axis system.

    ``radius`` is the cylinder's or sphere's, the cone's at v = 0, the torus' minor one;
    ``angle`` the cone's half angle; ``major`` the torus' major radius.
    """

    kind: str
    origin: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    radius: float = 0.0
    angle: float = 0.0
    major: float = 0.0

    @classmethod
    def of(cls, kind: str, shape) -> Quadric:
        """From gp_Pln, gp_Cylinder, gp_Cone, gp_Sphere or gp_Torus."""
        axes = shape.Position()
        frame = [
            np.array(xyz(part))
            for part in (axes.Location(), axes.XDirection(), axes.YDirection(), axes.Direction())
        ]
        if kind == "plane":
            return cls(kind, *frame)
        if kind == "cone":
            return cls(kind, *frame, radius=shape.RefRadius(), angle=shape.SemiAngle())
        if kind == "torus":
            return cls(kind, *frame, radius=shape.MinorRadius(), major=shape.MajorRadius())
        return cls(kind, *frame, radius=shape.Radius())

    def __post_init__(self) -> None:
        # 1 for a right-handed axis system, -1 for a left-handed one.
        self.hand = float(np.sign(np.dot(np.cross(self.x, self.y), self.z)))

    def evaluate(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points and unit ``du x dv`` at (n, 2) parameters, both (n, 3)."""
        u, v = uv[:, :1], uv[:, 1:]
        if self.kind == "plane":
            normal = np.broadcast_to(self.hand * self.z, (len(uv), 3))
            return self.origin + u * self.x + v * self.y, normal
        radial = np.cos(u) * self.x + np.sin(u) * self.y
        if self.kind == "cylinder":
            return self.origin + self.radius * radial + v * self.z, self.hand * radial
        if self.kind == "cone":
            sin, cos = np.sin(self.angle), np.cos(self.angle)
            reach = self.radius + v * sin
            flip = np.where(reach >= -1e-9, self.hand, -self.hand)
            point = self.origin + reach * radial + v * cos * self.z
            return point, flip * (cos * radial - sin * self.z)
        outward = np.cos(v) * radial + np.sin(v) * self.z
        if self.kind == "sphere":
            return self.origin + self.radius * outward, self.hand * outward
        flip = np.where(self.major + self.radius * np.cos(v) >= 0, self.hand, -self.hand)
        point = self.origin + self.major * radial + self.radius * outward
        return point, flip * outward

    def normals_at(self, points: np.ndarray) -> np.ndarray:
        """Unit normals, away from axis or centre, of the plane or quadric next to (n, 3) points."""
        offset = points - self.origin
        if self.kind == "plane":
            return np.broadcast_to(self.z, offset.shape)
        if self.kind == "sphere":
            return _unit(offset)
        height = offset @ self.z
        radial = _unit(offset - height[:, None] * self.z)
        if self.kind == "cylinder":
            return radial
        sin, cos = np.sin(self.angle), np.cos(self.angle)
        beyond = np.where(self.radius + height * np.tan(self.angle) >= 0, 1.0, -1.0)[:, None]
        return cos * radial - beyond * sin * self.z


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.where(length > 1e-12, length, 1.0)


_ANALYTIC = {
    GeomAbs_Plane: ("plane", "Plane"),
    GeomAbs_Cylinder: ("cylinder", "Cylinder"),
    GeomAbs_Cone: ("cone", "Cone"),
    GeomAbs_Sphere: ("sphere", "Sphere"),
    GeomAbs_Torus: ("torus", "Torus"),
}


class FaceSurface:
    """The surface of a face (taken FORWARD), in the solid's frame.

    ``label`` is the drawing format's face type. ``quadric`` is the closed form, or the one the
    surface was recognised as, or None.
    """

    def __init__(self, face: TopoDS_Face, recognition: float) -> None:
        self._adaptor = BRepAdaptor_Surface(face)
        analytic = _ANALYTIC.get(self._adaptor.GetType())
        self._closed_form = analytic is not None
        self._flip = 1.0
        if analytic is not None:
            self.label = analytic[0]
            self.quadric: Quadric | None = Quadric.of(
                self.label, getattr(self._adaptor, analytic[1])()
            )
            return
        adaptor = self._adaptor
        self._middle = np.array(
            [
                0.5 * (adaptor.FirstUParameter() + adaptor.LastUParameter()),
                0.5 * (adaptor.FirstVParameter() + adaptor.LastVParameter()),
            ]
        )
        self.quadric = _recognise(face, recognition)
        self.label = "other" if self.quadric is None else self.quadric.kind
        if self.quadric is not None:
            point, normal = self._evaluate_free(self._middle[None])
            self._flip = 1.0 if float(self.quadric.normals_at(point)[0] @ normal[0]) > 0 else -1.0

    def evaluate(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points and natural unit normals at (n, 2) parameters, both (n, 3).

        Raises ``ProjectionError("no-normal")`` at a singular point with no normal beside it.
        """
        if self._closed_form:
            assert self.quadric is not None
            return self.quadric.evaluate(uv)
        if self.quadric is not None:
            point = self._points(uv)
            return point, self._flip * self.quadric.normals_at(point)
        return self._evaluate_free(uv)

    def natural_normal(self) -> np.ndarray:
        """Natural normal of a plane (or of what was recognised as one)."""
        assert self.quadric is not None and self.label == "plane"
        return self.quadric.z * (self.quadric.hand if self._closed_form else self._flip)

    def _points(self, uv: np.ndarray) -> np.ndarray:
        value = self._adaptor.Value
        return np.array([xyz(value(u, v)) for u, v in uv.tolist()]).reshape(-1, 3)

    def _evaluate_free(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        points, normals = self._derivatives(uv)
        length = np.sqrt((normals * normals).sum(1))
        for row in np.flatnonzero(length < 1e-9).tolist():
            # At a pole one derivative vanishes: the limit from inside the face stands for it.
            for step in (1e-4, 1e-3, 1e-2):
                near = uv[row] + step * (self._middle - uv[row])
                normals[row] = self._derivatives(near[None])[1][0]
                length[row] = np.linalg.norm(normals[row])
                if length[row] > 1e-9:
                    break
        require(bool((length > 1e-12).all()), "no-normal")
        return points, normals / length[:, None]

    def _derivatives(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points and du x dv, not of unit length. The innermost loop of the whole projection."""
        point, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
        d1 = self._adaptor.D1
        flat: list[float] = []
        for u, v in uv.tolist():
            d1(u, v, point, du, dv)
            flat += point.Coord()
            flat += du.Coord()
            flat += dv.Coord()
        p, a, b = np.array(flat).reshape(-1, 3, 3).transpose(1, 0, 2)
        normal = a[:, [1, 2, 0]] * b[:, [2, 0, 1]] - a[:, [2, 0, 1]] * b[:, [1, 2, 0]]
        return p, normal


def _recognise(face: TopoDS_Face, tolerance: float) -> Quadric | None:
    recognition = ShapeAnalysis_CanonicalRecognition(face)
    for kind, shape in (
        ("plane", gp_Pln()),
        ("cylinder", gp_Cylinder()),
        ("cone", gp_Cone()),
        ("sphere", gp_Sphere()),
    ):
        if getattr(recognition, f"Is{kind.capitalize()}")(tolerance, shape):
            return Quadric.of(kind, shape)
    return None
