// Curves of edges in space.
#pragma once

#include <Geom_Curve.hxx>
#include <gp_Pnt.hxx>

#include "faceformer-occt/src/bridge.rs.h"

namespace faceformer::occt {

// A curve and the parameters where the edge begins and ends on it.
struct Segment {
  Handle(Geom_Curve) curve;
  double first = 0.0;
  double last = 0.0;
};

// The curve of an edge between its two vertices: line, circle, ellipse, or a cubic B-spline with
// continuous curvature through the given points.
Segment make_curve(const Edge &edge, const gp_Pnt &start, const gp_Pnt &end);

} // namespace faceformer::occt
