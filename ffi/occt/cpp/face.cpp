#include "face.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_Plane.hxx>
#include <Precision.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pln.hxx>

#include "chart.h"
#include "cusp.h"
#include "fill.h"
#include "guard.h"
#include "unroll.h"

namespace faceformer::occt {
namespace {

constexpr double kTurn = 2.0 * M_PI;

// Steps along an edge at which its distance from a surface is measured: those of BRepCheck, which
// looks at 23 points, and between.
constexpr int kProbes = 5 * 22;

// Curves in a parameter plane are this precise, in inner units.
constexpr double kChartPrecision = 1e-7;

// The loops of a face as OCCT wants them: with an edge of no length at each pole.
using Walks = std::vector<std::vector<TopoDS_Edge>>;

// A surface and the walks on it, and whether its own normal points into the solid.
struct Laid {
  Handle(Geom_Surface) surface;
  Walks walks;
  bool reversed = false;
};

// Grows the tolerance of an edge and its vertices to its distance from a face; a fault if too far.
void fit(const Model &model, std::size_t face, std::size_t edge, double distance,
         const Topology &topology) {
  if (distance > limit(model, model.faces[face].kind == SurfaceType::Filled)) {
    throw BuildFault(Fault::Edge, edge + 1,
                     "it lies " + length_text(distance, model) + " off the surface of face " +
                         std::to_string(model.faces[face].source));
  }
  const double tolerance = covering(distance);
  const TopoDS_Edge &shape = topology.edges[edge];
  if (tolerance > BRep_Tool::Tolerance(shape)) {
    BRep_Builder().UpdateEdge(shape, tolerance);
    raise_vertices(model, edge, tolerance, topology);
  }
}

// Calls `visit` with points along an edge and their parameters.
template <typename Visit> void probe(const Segment &segment, Visit &&visit) {
  for (int i = 0; i <= kProbes; ++i) {
    const double t = segment.first + (segment.last - segment.first) * i / kProbes;
    visit(segment.curve->Value(t), t);
  }
}

TopoDS_Edge oriented(std::int32_t coedge, const Topology &topology) {
  const TopoDS_Edge &edge = topology.edges[edge_index(coedge)];
  return TopoDS::Edge(edge.Oriented(coedge > 0 ? TopAbs_FORWARD : TopAbs_REVERSED));
}

Walks plain_walks(const Face &face, const Topology &topology) {
  Walks walks;
  for (const Loop &loop : face.loops) {
    walks.emplace_back();
    for (const std::int32_t coedge : loop.coedges) {
      walks.back().push_back(oriented(coedge, topology));
    }
  }
  return walks;
}

// The edge of no length at a pole, where the loop goes from one u to another.
TopoDS_Edge degenerated(const Pole &pole, const gp_Pnt2d &from, const TopoDS_Vertex &vertex,
                        const Handle(Geom_Surface) & surface) {
  BRep_Builder builder;
  TopoDS_Edge edge;
  builder.MakeEdge(edge);
  const double length = std::abs(pole.turn);
  const Handle(Geom2d_Line) line = new Geom2d_Line(from, gp_Dir2d(pole.turn, 0.0));
  builder.UpdateEdge(edge, line, surface, TopLoc_Location(), Precision::Confusion());
  builder.Add(edge, vertex.Oriented(TopAbs_FORWARD));
  builder.Add(edge, vertex.Oriented(TopAbs_REVERSED));
  builder.Range(edge, surface, TopLoc_Location(), 0.0, length);
  builder.Degenerated(edge, Standard_True);
  return edge;
}

TopoDS_Vertex start_vertex(const Model &model, std::int32_t coedge, const Topology &topology) {
  const Edge &edge = model.edges[edge_index(coedge)];
  return topology.vertices[coedge > 0 ? edge.first : edge.last];
}

// Gives the edges of a face on a curved surface their curves in its parameter plane; `shifts` moves
// each loop there. Returns the largest distance of an edge from the surface.
double lay_edges(const Model &model, std::size_t index, const Topology &topology,
                 const Chart &chart, const std::vector<Unrolled> &loops,
                 const std::vector<gp_Vec2d> &shifts) {
  const Face &face = model.faces[index];
  const Handle(Geom_Surface) surface = chart.surface();
  const bool reversed = face.hollow;
  // For each edge its curve as a forward and as a reversed edge of the surface's own side.
  std::map<std::size_t, std::array<Handle(Geom2d_Curve), 2>> curves;
  double largest = 0.0;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    for (std::size_t i = 0; i < loops[l].starts.size(); ++i) {
      const std::int32_t coedge = face.loops[l].coedges[i];
      const std::size_t e = edge_index(coedge);
      const Segment segment = segment_of(topology.edges[e]);
      const gp_Pnt2d start = loops[l].starts[i].Translated(shifts[l]);
      const Handle(Geom2d_Curve) curve = chart.curve(segment, start, kChartPrecision);
      double distance = 0.0;
      probe(segment, [&](const gp_Pnt &point, double t) {
        const gp_Pnt2d place = curve->Value(t);
        distance = std::max(distance, surface->Value(place.X(), place.Y()).Distance(point));
      });
      largest = std::max(largest, distance);
      fit(model, index, e, distance, topology);
      curves[e][(coedge > 0) != reversed ? 0 : 1] = curve;
    }
  }
  BRep_Builder builder;
  for (const auto &[e, pair] : curves) {
    const TopoDS_Edge &edge = topology.edges[e];
    const Segment segment = segment_of(edge);
    if (pair[0].IsNull() || pair[1].IsNull()) {
      const Handle(Geom2d_Curve) &curve = pair[0].IsNull() ? pair[1] : pair[0];
      builder.UpdateEdge(edge, curve, surface, TopLoc_Location(), Precision::Confusion());
    } else {
      builder.UpdateEdge(edge, pair[0], pair[1], surface, TopLoc_Location(),
                         Precision::Confusion());
      builder.Continuity(edge, surface, surface, TopLoc_Location(), TopLoc_Location(), GeomAbs_CN);
    }
    builder.Range(edge, surface, TopLoc_Location(), segment.first, segment.last);
  }
  return largest;
}

Laid lay_on_round(const Model &model, std::size_t index, const Topology &topology) {
  const Face &face = model.faces[index];
  const Chart raw(face);
  std::vector<Unrolled> loops;
  for (std::size_t l = 0; l < face.loops.size(); ++l) {
    loops.push_back(unroll(raw, face, l, index, topology));
  }
  // The loop that is widest around in the middle of the period, so that no face crosses u = 0.
  const Unrolled &outer =
      *std::max_element(loops.begin(), loops.end(), [](const Unrolled &a, const Unrolled &b) {
        return a.high.X() - a.low.X() < b.high.X() - b.low.X();
      });
  const gp_Pnt2d middle((outer.low.X() + outer.high.X()) / 2.0,
                        (outer.low.Y() + outer.high.Y()) / 2.0);
  const double turn = middle.X() - M_PI;
  const Chart chart = raw.turned(turn);
  const double lift = chart.is_torus() ? -kTurn * std::floor(middle.Y() / kTurn) : 0.0;
  std::vector<gp_Vec2d> shifts;
  for (const Unrolled &loop : loops) {
    const double u = (loop.low.X() + loop.high.X()) / 2.0;
    const double v = (loop.low.Y() + loop.high.Y()) / 2.0;
    const double rise = chart.is_torus() ? kTurn * std::round((middle.Y() - v) / kTurn) : 0.0;
    shifts.emplace_back(kTurn * std::round((middle.X() - u) / kTurn) - turn, rise + lift);
  }
  lay_edges(model, index, topology, chart, loops, shifts);
  Laid laid{chart.surface(), {}, face.hollow};
  for (std::size_t l = 0; l < loops.size(); ++l) {
    laid.walks.emplace_back();
    for (std::size_t i = 0; i < face.loops[l].coedges.size(); ++i) {
      const std::int32_t coedge = face.loops[l].coedges[i];
      for (const Pole &pole : loops[l].poles) {
        if (pole.before == i) {
          laid.walks[l].push_back(degenerated(pole, pole.from.Translated(shifts[l]),
                                              start_vertex(model, coedge, topology),
                                              laid.surface));
        }
      }
      laid.walks[l].push_back(oriented(coedge, topology));
    }
  }
  return laid;
}

Laid lay_on_filled(const Model &model, std::size_t index, const Topology &topology,
                   Outcome &outcome) {
  const Face &face = model.faces[index];
  const Chart chart(fill(face, topology));
  std::vector<Unrolled> loops;
  double largest = 0.0;
  for (std::size_t l = 0; l < face.loops.size(); ++l) {
    loops.push_back(unroll(chart, face, l, index, topology));
    if (std::abs(loops[l].area) > std::abs(largest)) {
      largest = loops[l].area;
    }
  }
  const std::vector<gp_Vec2d> shifts(loops.size());
  const double deviation = lay_edges(model, index, topology, chart, loops, shifts);
  outcome.filled.push_back(static_cast<std::uint32_t>(index + 1));
  outcome.deviations.push_back(deviation * model.scale);
  // The face is on the left of its outer loop.
  return {chart.surface(), plain_walks(face, topology), largest < 0.0};
}

Laid lay_on_plane(const Model &model, std::size_t index, const Topology &topology) {
  const Face &face = model.faces[index];
  const gp_Pln plane(to_point(face.origin), to_dir(face.direction));
  for (const Loop &loop : face.loops) {
    for (const std::int32_t coedge : loop.coedges) {
      const std::size_t e = edge_index(coedge);
      double distance = 0.0;
      probe(segment_of(topology.edges[e]), [&](const gp_Pnt &point, double) {
        distance = std::max(distance, plane.Distance(point));
      });
      fit(model, index, e, distance, topology);
    }
  }
  return {new Geom_Plane(plane), plain_walks(face, topology), false};
}

// A whole sphere or torus: OCCT makes its seams and poles.
TopoDS_Face whole(const Face &face) {
  const Chart chart(face);
  TopoDS_Face shape = BRepBuilderAPI_MakeFace(chart.surface(), Precision::Confusion());
  if (face.hollow) {
    shape.Reverse();
  }
  return shape;
}

TopoDS_Face made(const Model &model, std::size_t index, const Topology &topology,
                 Outcome &outcome) {
  const Face &face = model.faces[index];
  if (face.loops.empty()) {
    return whole(face);
  }
  widen_cusps(model, face, topology);
  Laid laid;
  switch (face.kind) {
  case SurfaceType::Plane:
    laid = lay_on_plane(model, index, topology);
    break;
  case SurfaceType::Filled:
    laid = lay_on_filled(model, index, topology, outcome);
    break;
  default:
    laid = lay_on_round(model, index, topology);
  }
  BRep_Builder builder;
  TopoDS_Face shape;
  builder.MakeFace(shape, laid.surface, Precision::Confusion());
  if (laid.reversed) {
    shape.Orientation(TopAbs_REVERSED);
  }
  for (const std::vector<TopoDS_Edge> &walk : laid.walks) {
    TopoDS_Wire wire;
    builder.MakeWire(wire);
    for (const TopoDS_Edge &edge : walk) {
      builder.Add(wire, edge);
    }
    wire.Closed(Standard_True);
    builder.Add(shape, wire);
  }
  return shape;
}

} // namespace

void make_face(const Model &model, std::size_t index, Topology &topology, Outcome &outcome) {
  try {
    topology.faces.push_back(made(model, index, topology, outcome));
  } catch (const BuildFault &) {
    throw;
  } catch (...) {
    throw BuildFault(Fault::Face, index + 1, describe_current_exception());
  }
}

} // namespace faceformer::occt
