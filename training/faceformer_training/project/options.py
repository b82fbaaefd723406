"""Limits and resolutions of the projection."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ProjectOptions:
    """Lengths are relative to the half diagonal, which is 1; angles in radians.

    The paper's filter is ``max_faces`` and ``max_face_edges``; a drawing beyond either is large,
    and refused beyond ``max_large_faces``.
    """

    max_faces: int = 42
    max_face_edges: int = 37
    max_large_faces: int = 300
    min_faces: int = 4
    min_vertex_distance: float = 2e-3
    min_edge_length: float = 1e-3
    min_face_area: float = 1e-5
    min_tilt: float = 0.02
    """Least |normal . towards the viewer| of a plane in a random view."""
    min_tilt_late: float = 5e-3
    """The same in the last tries, and in the fixed isometric view a fifth of it."""
    tries: int = 16
    """Random views drawn in full before a solid is given up."""
    looks: int = 400
    """Random views looked at in all; most that are not generic are refused at a glance."""
    min_thickness: float = 4e-3
    min_volume: float = 1e-6
    mesh_deflection: float = 0.02
    mesh_angle: float = 0.2
    chord_error: float = 5e-4
    recognition: float = 1e-5
    """Farthest that a B-spline face may be from the plane or quadric it is taken for."""
    min_camera_distance: float = 2.5
    max_camera_distance: float = 3.5

    def is_large(self, faces: int, face_edges: int) -> bool:
        """Whether a drawing of so many faces, at most so many edges a face, is a large one."""
        return faces > self.max_faces or face_edges > self.max_face_edges
