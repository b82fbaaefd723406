"""A solid made ready: centred, scaled to half diagonal 1, same-domain faces unified, valid."""

from __future__ import annotations

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.gp import gp_Pnt, gp_Trsf, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Shape, TopoDS_Solid
from OCP.TopTools import TopTools_IndexedMapOfShape

from .errors import require
from .options import ProjectOptions


def count(shape: TopoDS_Shape, kind) -> int:
    """Number of distinct sub-shapes of a kind (a ``TopAbs`` value)."""
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, kind, found)
    return found.Extent()


def bounding_box(shape: TopoDS_Shape) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest corner of the exact bounding box, without tolerances."""
    box = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape, box, False, False)
    require(not box.IsVoid(), "size", "void bounding box")
    corners = box.Get()
    return np.array(corners[:3]), np.array(corners[3:])


def volume(shape: TopoDS_Shape) -> float:
    """Signed volume; negative where the solid is inside out."""
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    return properties.Mass()


def normalise(shape: TopoDS_Shape, options: ProjectOptions) -> TopoDS_Solid:
    """The clean solid: one shell, centred, half diagonal 1, unified, valid, right side out.

    A shell's Closed flag says nothing (many readers leave it unset); closedness is shown by the
    co-edges when the B-rep is copied. Raises ``ProjectionError``.
    """
    faces = count(shape, TopAbs_FACE)
    require(faces > 0, "no-faces")
    # Unifying may halve the faces of a part whose cylinders come in halves, hardly more.
    require(faces <= 2 * options.max_large_faces, "too-many-faces", f"{faces} faces")
    require(count(shape, TopAbs_SOLID) == 1, "no-solid", "not one solid")
    shells = count(shape, TopAbs_SHELL)
    require(shells == 1, "several-shells", f"{shells} shells")
    low, high = bounding_box(shape)
    half = 0.5 * float(np.linalg.norm(high - low))
    require(1e-6 < half < 1e9, "size", f"half diagonal {half:g}")
    require(float((high - low).min()) > options.min_thickness * half, "too-thin")

    centre, scale = gp_Trsf(), gp_Trsf()
    centre.SetTranslation(gp_Vec(*(-(low + high) / 2).tolist()))
    scale.SetScale(gp_Pnt(0, 0, 0), 1.0 / half)
    moved = BRepBuilderAPI_Transform(shape, scale.Multiplied(centre), True).Shape()
    unifier = ShapeUpgrade_UnifySameDomain(moved, True, True, False)
    unifier.Build()
    result = unifier.Shape()
    if result.ShapeType() != TopAbs_SOLID:
        solids = TopTools_IndexedMapOfShape()
        TopExp.MapShapes_s(result, TopAbs_SOLID, solids)
        require(solids.Extent() == 1, "unify", f"{solids.Extent()} solids")
        result = solids.FindKey(1)
    solid = TopoDS.Solid_s(result)
    require(BRepCheck_Analyzer(solid).IsValid(), "invalid")
    amount = volume(solid)
    require(abs(amount) > options.min_volume, "no-volume", f"volume {amount:g}")
    return solid if amount > 0 else TopoDS.Solid_s(solid.Reversed())
