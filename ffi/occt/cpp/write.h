// Shapes to BREP text.
#pragma once

#include <string>

#include <TopoDS_Shape.hxx>

namespace faceformer::occt {

// A shape as BREP text, version 1, without triangles.
std::string brep_text(const TopoDS_Shape &shape);

} // namespace faceformer::occt
