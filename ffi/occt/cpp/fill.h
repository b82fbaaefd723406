// Surfaces laid through the edges of a face.
#pragma once

#include <Geom_BSplineSurface.hxx>

#include "topology.h"

namespace faceformer::occt {

// A B-spline surface through all edges of a face, as far as it can be: a Coons patch between four
// edges (GeomFill_BSplineCurves), else the one that bends least (GeomPlate_BuildPlateSurface).
// Throws if none can be found.
Handle(Geom_BSplineSurface) fill(const Face &face, const Topology &topology);

} // namespace faceformer::occt
