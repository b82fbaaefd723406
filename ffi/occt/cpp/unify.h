// Removal of silhouettes.
#pragma once

#include <TopoDS_Shape.hxx>

#include "topology.h"

namespace faceformer::occt {

// The solid with the faces merged that only silhouettes part, and the pieces of circles merged
// that met at their ends: a hole becomes one cylinder face with a seam. Null if OCCT could not do
// it soundly; the solid given is as good as before then.
TopoDS_Shape unify(const Model &model, const Topology &topology, const TopoDS_Shape &solid);

} // namespace faceformer::occt
