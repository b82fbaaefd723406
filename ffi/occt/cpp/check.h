// The final checks of a solid.
#pragma once

#include <TopoDS_Shape.hxx>

#include "topology.h"

namespace faceformer::occt {

// Checks that the solid of the model is valid, closed, one body, right side out and tight.
// Throws a BuildFault that names the edge or face of the model.
void check_model(const Model &model, const Topology &topology, const TopoDS_Shape &solid);

// Largest tolerance of a vertex, edge or face.
double largest_tolerance(const TopoDS_Shape &shape);

} // namespace faceformer::occt
