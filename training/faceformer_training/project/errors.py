"""What can be wrong with a solid or a view, as typed errors with a reason code.

A reason code is a short stable word that a run's report counts; the detail is for people.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


class ProjectionError(Exception):
    """A solid that gives no drawing. ``code`` is one of the codes in ``REASONS``."""

    def __init__(self, code: str, detail: str = "") -> None:
        super().__init__(f"{code}: {detail}" if detail else code)
        self.code = code
        self.detail = detail


class ViewError(ProjectionError):
    """A view that is not generic for this solid; another view may do."""


REASONS = {
    "unreadable": "the file could not be read as what its name says",
    "no-solid": "the file holds no solid",
    "no-faces": "the solid has no faces",
    "several-shells": "the solid has more than one shell (a cavity)",
    "too-many-faces": "more faces than the large bucket takes",
    "too-few-faces": "fewer faces than the least",
    "size": "the bounding box is void, tiny or huge",
    "too-thin": "one side of the bounding box is next to nothing",
    "no-volume": "the volume is next to nothing",
    "unify": "unifying same-domain faces gave no single solid",
    "invalid": "OCCT's checker finds the solid invalid",
    "not-closed": "an edge is not used exactly once in each direction",
    "touching": "two sheets of the surface touch in a vertex: no manifold",
    "wire": "a wire is not a closed walk of its edges",
    "slit": "a face other than a periodic one has both co-edges of an edge",
    "sharp-seam": "a closed surface meets itself at an angle",
    "mesh": "a face could not be meshed, or its mesh does not fit its boundary",
    "no-normal": "a surface has no normal where one is needed",
    "contour": "a silhouette could not be traced or has no root where one must be",
    "split": "a face could not be split along its silhouettes",
    "loop": "the loops of the drawing do not close or do not use each co-edge once",
    "euler": "the drawing's Euler characteristic is not the solid's",
    "orientation": "a face's drawn orientation contradicts its normal",
    "check": "the independent checker found a fault in the drawing",
    "edge-end": "an edge ends away from its vertex",
    "view-edge-on": "in every view tried a face is seen edge-on",
    "view-coincident": "in every view tried two vertices coincide",
    "view-short-edge": "in every view tried an edge is shorter than the least",
    "view-no-area": "in every view tried a face has next to no area",
    "kernel": "OCCT raised an exception",
    "time-limit": "the time limit of a solid ran out; its process was ended",
    "crash": "the process that worked on the solid died",
    "internal": "an error of this program",
    "duplicate": "a solid of the same topology and shape came before",
    "duplicate-views": "a solid with the same three orthogonal views came before",
}


def require(condition: bool, code: str, detail: str = "") -> None:
    """Raise ``ProjectionError(code, detail)`` unless the condition holds."""
    if not condition:
        raise ProjectionError(code, detail)


@contextmanager
def kernel_errors(code: str = "kernel") -> Iterator[None]:
    """Turn OCCT's exceptions into a ``ProjectionError`` with this code; let others through."""
    try:
        yield
    except Exception as error:
        # Not all of OCCT's exceptions are bound as kinds of Standard_Failure.
        if not type(error).__module__.startswith("OCP."):
            raise
        raise ProjectionError(code, f"{type(error).__name__}: {error}".rstrip(": ")) from error
