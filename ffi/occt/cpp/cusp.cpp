#include "cusp.h"

#include <BRep_Builder.hxx>

namespace faceformer::occt {
namespace {

// Edges that leave a vertex at a smaller angle (its sine) make a cusp.
constexpr double kCusp = 0.02;

// Tolerance of such a vertex, as a share of the largest one allowed.
constexpr double kWide = 0.4;

// Unit direction in which a co-edge leaves the vertex that it begins at; null if there is none.
gp_Vec leaving(std::int32_t coedge, const Topology &topology) {
  const Segment segment = segment_of(topology.edges[edge_index(coedge)]);
  gp_Pnt point;
  gp_Vec along;
  segment.curve->D1(coedge > 0 ? segment.first : segment.last, point, along);
  const double length = along.Magnitude();
  if (length <= Precision::Confusion()) {
    return gp_Vec();
  }
  return along * ((coedge > 0 ? 1.0 : -1.0) / length);
}

} // namespace

void widen_cusps(const Model &model, const Face &face, const Topology &topology) {
  for (const Loop &loop : face.loops) {
    const std::size_t count = loop.coedges.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t out = loop.coedges[i];
      const std::int32_t in = loop.coedges[(i + count - 1) % count];
      // A seam goes back on itself.
      if (in == -out) {
        continue;
      }
      const gp_Vec ahead = leaving(out, topology);
      const gp_Vec back = leaving(-in, topology);
      if (ahead.Dot(back) > 0.0 && ahead.Crossed(back).Magnitude() < kCusp) {
        const Edge &edge = model.edges[edge_index(out)];
        BRep_Builder().UpdateVertex(topology.vertices[out > 0 ? edge.first : edge.last],
                                    kWide * model.tolerance);
      }
    }
  }
}

} // namespace faceformer::occt
