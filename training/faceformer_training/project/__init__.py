"""CAD solids to wireframe drawings with their true faces.

A solid's way: ``read`` (files), ``normalise``, ``brep`` with ``mesh`` (a plain copy and the
meshes of its curved faces), then for every view ``contours`` and ``cuts`` (silhouettes and where
they meet the edges), ``split`` (half-edges), ``merge`` (edges that only a cut had parted) and
``solid`` (the drawing). ``python -m faceformer_training.project`` runs it over whole archives.
"""

from .errors import REASONS, ProjectionError, ViewError
from .options import ProjectOptions
from .solid import PreparedSolid, project_solid
from .views import View, isometric_view, random_view

__all__ = [
    "REASONS",
    "PreparedSolid",
    "ProjectOptions",
    "ProjectionError",
    "View",
    "ViewError",
    "isometric_view",
    "project_solid",
    "random_view",
]
