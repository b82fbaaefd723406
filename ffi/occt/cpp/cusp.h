// Vertices at which two edges of a face leave in one direction.
#pragma once

#include "topology.h"

namespace faceformer::occt {

// Grows the tolerance of the vertices of cusps. Near one the two edges are closer to each other than
// any computation of where they meet is precise, and BRepCheck takes that for a crossing unless it
// is within the vertex.
void widen_cusps(const Model &model, const Face &face, const Topology &topology);

} // namespace faceformer::occt
