// Loops of a face in the parameter plane of its surface.
#pragma once

#include <vector>

#include <gp_Pnt2d.hxx>

#include "chart.h"
#include "topology.h"

namespace faceformer::occt {

// Where a loop passes an apex or a pole: all u between two are one point there.
struct Pole {
  std::size_t before = 0; // the co-edge that it is passed before
  gp_Pnt2d from;
  double turn = 0.0; // what u changes by
};

// A loop, unrolled.
struct Unrolled {
  std::vector<gp_Pnt2d> starts; // where each co-edge's edge begins (not where the co-edge does)
  std::vector<Pole> poles;
  gp_Pnt2d low;
  gp_Pnt2d high;
  double area = 0.0; // signed, in the parameter plane
};

// Unrolls loop `index` of a face. Throws a BuildFault if it does not close in the parameter plane.
Unrolled unroll(const Chart &chart, const Face &face, std::size_t index, std::size_t face_index,
                const Topology &topology);

} // namespace faceformer::occt
