"""Where the viewer is: orthographic and perspective views, random and fixed ones."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from .options import ProjectOptions

VIEW_KINDS = ("ortho", "iso", "persp")
ISOMETRIC = [(1, 1, 1), (-1, 1, 1), (1, -1, 1), (-1, -1, 1)]
"""The fixed isometric view, and the three that stand in where a solid has no generic one."""


@dataclass
class View:
    """A view from ``direction`` (unit, from the solid's centre towards the viewer).

    ``distance`` is None for an orthographic view, else the camera's distance from the centre,
    which is also the focal length. ``rotation`` (3, 3) has the camera's x, y, z as rows.
    """

    direction: np.ndarray
    distance: float | None = None
    rotation: np.ndarray | None = field(default=None)

    def __post_init__(self) -> None:
        self.direction = np.asarray(self.direction, float)
        self.direction = self.direction / np.linalg.norm(self.direction)
        if self.rotation is None:
            up = np.array([0.0, 0.0, 1.0])
            if abs(self.direction[2]) > 1 - 1e-9:
                up = np.array([0.0, 1.0, 0.0])
            right = np.cross(up, self.direction)
            right /= np.linalg.norm(right)
            self.rotation = np.array([right, np.cross(self.direction, right), self.direction])

    @classmethod
    def of_directions(cls, directions: np.ndarray, focal: float | None = None) -> View:
        """The view of a drawing whose ``truth.directions`` and ``focal`` are given.

        The rows of ``directions``, rounded in files, are made orthonormal again.
        """
        left, _, right = np.linalg.svd(np.asarray(directions, float).T)
        rotation = left @ right
        return cls(rotation[2], focal, rotation)

    @property
    def projection(self) -> dict:
        """The drawing format's ``projection``."""
        if self.distance is None:
            return {"kind": "orthographic"}
        return {"kind": "perspective", "focal": round(self.distance, 6)}

    def facing(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """normal . towards the viewer, (n,); its sign says front or back, its zeros silhouette."""
        if self.distance is None:
            return normals @ self.direction
        towards = self.distance * self.direction - points
        return np.einsum("ij,ij->i", towards, normals)

    def camera(self, points: np.ndarray) -> np.ndarray:
        """Points (n, 3) in the camera frame."""
        turned = points @ self.rotation.T
        if self.distance is not None:
            turned = turned - np.array([0.0, 0.0, self.distance])
        return turned

    def draw(self, camera_points: np.ndarray) -> np.ndarray:
        """Points (n, 2) in the drawing, of points in the camera frame."""
        if self.distance is None:
            return camera_points[:, :2]
        return self.distance * camera_points[:, :2] / -camera_points[:, 2:]


def random_view(rng: np.random.Generator, kind: str, options: ProjectOptions) -> View:
    """A direction uniform over the upper hemisphere; ``kind`` is ``ortho`` or ``persp``."""
    height = rng.uniform(0.0, 1.0)
    angle = rng.uniform(0.0, 2 * math.pi)
    reach = math.sqrt(1 - height * height)
    direction = np.array([reach * math.cos(angle), reach * math.sin(angle), height])
    if kind == "persp":
        return View(
            direction, rng.uniform(options.min_camera_distance, options.max_camera_distance)
        )
    return View(direction)


def isometric_view(number: int) -> View:
    """One of the four fixed isometric views, 0 the first choice."""
    return View(np.array(ISOMETRIC[number], float))
