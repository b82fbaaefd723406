"""Curves of a solid's edges: polylines within a chord error, and whether two go on smoothly."""

from __future__ import annotations

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GeomAbs import GeomAbs_Circle, GeomAbs_Ellipse, GeomAbs_Line
from OCP.gp import gp_Pnt, gp_Vec
from OCP.TopoDS import TopoDS_Edge

from .surfaces import xyz

LEAST_POINTS = 9
MOST_POINTS = 513
STRAIGHT = 1e-5
"""Farthest that a straight curve's points may be from its chord, the half diagonal being 1."""


class EdgeCurve:
    """The 3D curve of an edge (taken FORWARD) over ``first`` .. ``last``, in the solid's frame."""

    def __init__(self, edge: TopoDS_Edge) -> None:
        self._adaptor = BRepAdaptor_Curve(edge)
        self.first = self._adaptor.FirstParameter()
        self.last = self._adaptor.LastParameter()
        kind = self._adaptor.GetType()
        self.is_line = kind == GeomAbs_Line
        self.is_circle = kind == GeomAbs_Circle
        self._conic: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None
        if self.is_circle or kind == GeomAbs_Ellipse:
            conic = self._adaptor.Circle() if self.is_circle else self._adaptor.Ellipse()
            axes = conic.Position()
            radii = (
                (conic.Radius(), conic.Radius())
                if self.is_circle
                else (conic.MajorRadius(), conic.MinorRadius())
            )
            self._conic = (
                np.array(xyz(axes.Location())),
                radii[0] * np.array(xyz(axes.XDirection())),
                radii[1] * np.array(xyz(axes.YDirection())),
            )
        self._polylines: dict[tuple[float, float, float], np.ndarray] = {}

    def points(self, params: np.ndarray) -> np.ndarray:
        """Points (n, 3) at (n,) parameters."""
        if self._conic is not None:
            centre, x, y = self._conic
            return centre + np.cos(params)[:, None] * x + np.sin(params)[:, None] * y
        value = self._adaptor.Value
        return np.array([xyz(value(t)) for t in params.tolist()]).reshape(-1, 3)

    def tangent(self, param: float) -> np.ndarray:
        """Unit tangent in the direction of growing parameters; zero where the curve has none."""
        point, derivative = gp_Pnt(), gp_Vec()
        self._adaptor.D1(param, point, derivative)
        vector = np.array(xyz(derivative))
        length = float(np.linalg.norm(vector))
        return vector / length if length > 1e-12 else np.zeros(3)

    def same_carrier(self, other: EdgeCurve) -> bool:
        """Whether two circles are arcs of one circle (of either sense)."""
        a, b = self._adaptor.Circle(), other._adaptor.Circle()
        return (
            a.Location().Distance(b.Location()) < 1e-5
            and abs(a.Radius() - b.Radius()) < 1e-5
            and abs(a.Axis().Direction().Dot(b.Axis().Direction())) > 1 - 1e-8
        )

    def polyline(self, start: float, end: float, chord_error: float) -> np.ndarray:
        """Polyline from one parameter to a later one: two points if straight, else 9 at least."""
        key = (start, end, chord_error)
        if key not in self._polylines:
            self._polylines[key] = self._sample(start, end, chord_error)
        return self._polylines[key]

    def _sample(self, start: float, end: float, chord_error: float) -> np.ndarray:
        if self.is_line:
            return self.points(np.array([start, end]))
        spans = 2 * (LEAST_POINTS - 1)
        points = self.points(np.linspace(start, end, spans + 1))
        if is_straight(points, STRAIGHT):
            return points[[0, -1]]
        while True:
            # Every other point is tried as a chord's middle: what passes is kept at half density.
            middle = 0.5 * (points[:-2:2] + points[2::2])
            if np.linalg.norm(middle - points[1:-1:2], axis=1).max() < chord_error:
                return points[::2]
            if len(points) >= MOST_POINTS:
                return points
            spans *= 2
            points = self.points(np.linspace(start, end, spans + 1))


def is_straight(points: np.ndarray, tolerance: float) -> bool:
    """Whether a polyline runs along its chord, forwards, within a tolerance."""
    chord = points[-1] - points[0]
    length = float(np.linalg.norm(chord))
    if length < 1e-9:
        return False
    chord = chord / length
    along = (points - points[0]) @ chord
    aside = points - points[0] - along[:, None] * chord
    return float(np.linalg.norm(aside, axis=1).max()) < tolerance and bool(
        (np.diff(along) > 0).all()
    )
