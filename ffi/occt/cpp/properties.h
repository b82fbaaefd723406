// Figures of a finished solid.
#pragma once

#include <TopoDS_Shape.hxx>

#include "faceformer-occt/src/bridge.rs.h"

namespace faceformer::occt {

// Fills in volume, area, box, counts and largest tolerance.
void measure(const TopoDS_Shape &solid, Outcome &outcome);

} // namespace faceformer::occt
