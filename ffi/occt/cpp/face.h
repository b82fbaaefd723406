// Faces from shared edges.
#pragma once

#include "topology.h"

namespace faceformer::occt {

// Makes face `index` (from 0) from the shared edges and adds it. Its edges get a curve in the
// parameter plane of a curved surface; tolerances grow to what the geometry needs. A filled face
// is noted in the outcome with its deviation.
void make_face(const Model &model, std::size_t index, Topology &topology, Outcome &outcome);

} // namespace faceformer::occt
