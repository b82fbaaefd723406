"""Cross-check of silhouettes: their total length by OCCT's hidden-line removal.

Only the length is compared: hidden-line removal cuts its outlines where they change
visibility, so its pieces are not ours.
"""

from __future__ import annotations

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepLib import BRepLib
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.HLRAlgo import HLRAlgo_Projector
from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from .solid import PreparedSolid
from .split import split_solid
from .views import View


def outline_lengths(prepared: PreparedSolid, view: View) -> tuple[float, float]:
    """Total drawn length of the silhouettes, ours and hidden-line removal's."""
    return _ours(prepared, view), _kernels(prepared, view)


def _ours(prepared: PreparedSolid, view: View) -> float:
    total = 0.0
    for arc in split_solid(prepared.brep, view).arcs:
        if arc.face is not None and arc.points is not None:
            drawn = view.draw(view.camera(arc.points))
            total += float(np.linalg.norm(np.diff(drawn, axis=0), axis=1).sum())
    return total


def _kernels(prepared: PreparedSolid, view: View) -> float:
    axes = gp_Ax2(
        gp_Pnt(0, 0, 0), gp_Dir(*view.direction.tolist()), gp_Dir(*view.rotation[0].tolist())
    )
    if view.distance is None:
        projector = HLRAlgo_Projector(axes)
    else:
        projector = HLRAlgo_Projector(axes, view.distance)
    algorithm = HLRBRep_Algo()
    algorithm.Add(prepared.shape, 0)
    algorithm.Projector(projector)
    algorithm.Update()
    algorithm.Hide()
    result = HLRBRep_HLRToShape(algorithm)
    total = 0.0
    for compound in (result.OutLineVCompound(), result.OutLineHCompound()):
        if compound is None or compound.IsNull():
            continue
        BRepLib.BuildCurves3d_s(compound)
        edges = TopExp_Explorer(compound, TopAbs_EDGE)
        while edges.More():
            curve = BRepAdaptor_Curve(TopoDS.Edge_s(edges.Current()))
            total += GCPnts_AbscissaPoint.Length_s(curve)
            edges.Next()
    return total
