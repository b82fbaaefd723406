#include "topology.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Plane.hxx>
#include <Precision.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pln.hxx>

#include "chart.h"
#include "guard.h"

namespace faceformer::occt {
namespace {

constexpr double kTurn = 2.0 * M_PI;

// Points of an edge at which its distance from a surface is measured; BRepCheck looks at 23.
constexpr int kProbes = 46;

// Steps of a rough trace of an edge on a cylinder.
constexpr int kTraceSteps = 32;

// Curves in a cylinder's parameter plane are this precise, in inner units.
constexpr double kChartPrecision = 1e-7;

// A loop on a cylinder, unrolled.
struct Unrolled {
  std::vector<double> u_first; // u where each co-edge's edge begins (not where the co-edge does)
  double low = 0.0;
  double high = 0.0;
};

Segment segment_of(const TopoDS_Edge &edge) {
  Segment segment;
  segment.curve = BRep_Tool::Curve(edge, segment.first, segment.last);
  return segment;
}

std::size_t edge_index(std::int32_t coedge) { return static_cast<std::size_t>(std::abs(coedge)) - 1; }

// A tolerance that covers a measured distance with some room.
double covering(double distance) { return std::max(Precision::Confusion(), distance * 1.05); }

void raise_vertices(const Model &model, std::size_t edge, double tolerance,
                    const Topology &topology) {
  BRep_Builder builder;
  builder.UpdateVertex(topology.vertices[model.edges[edge].first], tolerance);
  builder.UpdateVertex(topology.vertices[model.edges[edge].last], tolerance);
}

// Grows the tolerance of an edge and its vertices to its distance from a face; a fault if too far.
void fit(const Model &model, std::size_t face, std::size_t edge, double distance,
         const Topology &topology) {
  if (distance > model.tolerance) {
    throw BuildFault(Fault::Edge, edge + 1,
                     "it lies " + length_text(distance, model) + " off the surface of face " +
                         std::to_string(face + 1));
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

Unrolled unroll(const Chart &chart, const Loop &loop, std::size_t face, const Topology &topology) {
  Unrolled out;
  double u = 0.0;
  double u_begin = 0.0;
  for (std::size_t i = 0; i < loop.coedges.size(); ++i) {
    const std::int32_t coedge = loop.coedges[i];
    const std::vector<gp_Pnt2d> places =
        chart.trace(segment_of(topology.edges[edge_index(coedge)]), kTraceSteps);
    const double begin = (coedge > 0 ? places.front() : places.back()).X();
    const double end = (coedge > 0 ? places.back() : places.front()).X();
    const double shift = i == 0 ? 0.0 : kTurn * std::round((u - begin) / kTurn);
    if (i == 0) {
      u_begin = begin;
      out.low = out.high = begin;
    }
    for (const gp_Pnt2d &place : places) {
      out.low = std::min(out.low, place.X() + shift);
      out.high = std::max(out.high, place.X() + shift);
    }
    out.u_first.push_back(places.front().X() + shift);
    u = end + shift;
  }
  if (std::abs(u - u_begin) > M_PI) {
    throw BuildFault(Fault::Face, face + 1,
                     "it runs all around its cylinder; draw the outlines that split it in two");
  }
  return out;
}

// Gives the edges of a cylinder face their curves in its parameter plane; returns the surface.
Handle(Geom_Surface) lay_on_cylinder(const Model &model, std::size_t index,
                                     const Topology &topology) {
  const Face &face = model.faces[index];
  const Chart raw(gp_Ax3(to_point(face.origin), to_dir(face.direction)), face.radius);
  std::vector<Unrolled> loops;
  for (const Loop &loop : face.loops) {
    loops.push_back(unroll(raw, loop, index, topology));
  }
  // The outer loop in the middle of the period, so that no face crosses u = 0.
  const double middle = (loops.front().low + loops.front().high) / 2.0;
  const double turn = middle - M_PI;
  const Chart chart = raw.turned(turn);
  const Handle(Geom_CylindricalSurface) surface = chart.surface();
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const double own = (loops[l].low + loops[l].high) / 2.0;
    const double shift = kTurn * std::round((middle - own) / kTurn) - turn;
    for (std::size_t i = 0; i < loops[l].u_first.size(); ++i) {
      const std::size_t e = edge_index(face.loops[l].coedges[i]);
      const Segment segment = segment_of(topology.edges[e]);
      const Handle(Geom2d_Curve) curve =
          chart.curve(segment, loops[l].u_first[i] + shift, kChartPrecision);
      BRep_Builder builder;
      builder.UpdateEdge(topology.edges[e], curve, surface, TopLoc_Location(),
                         Precision::Confusion());
      builder.Range(topology.edges[e], surface, TopLoc_Location(), segment.first, segment.last);
      double distance = 0.0;
      probe(segment, [&](const gp_Pnt &point, double t) {
        const gp_Pnt2d place = curve->Value(t);
        distance = std::max(distance, surface->Value(place.X(), place.Y()).Distance(point));
      });
      fit(model, index, e, distance, topology);
    }
  }
  return Handle(Geom_Surface)(surface);
}

Handle(Geom_Surface) lay_on_plane(const Model &model, std::size_t index,
                                  const Topology &topology) {
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
  return new Geom_Plane(plane);
}

void add_wires(const Face &face, const Topology &topology, TopoDS_Face &shape) {
  BRep_Builder builder;
  for (const Loop &loop : face.loops) {
    TopoDS_Wire wire;
    builder.MakeWire(wire);
    for (const std::int32_t coedge : loop.coedges) {
      const TopoDS_Edge &edge = topology.edges[edge_index(coedge)];
      builder.Add(wire, edge.Oriented(coedge > 0 ? TopAbs_FORWARD : TopAbs_REVERSED));
    }
    wire.Closed(Standard_True);
    builder.Add(shape, wire);
  }
}

} // namespace

std::string length_text(double inner_length, const Model &model) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", inner_length * model.scale);
  return text;
}

TopoDS_Shape Topology::partial() const {
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Face &face : faces) {
    builder.Add(compound, face);
  }
  if (faces.empty()) {
    for (const TopoDS_Edge &edge : edges) {
      builder.Add(compound, edge);
    }
  }
  return compound;
}

void make_edges(const Model &model, Topology &topology) {
  BRep_Builder builder;
  for (const Point &point : model.points) {
    TopoDS_Vertex vertex;
    builder.MakeVertex(vertex, to_point(point), Precision::Confusion());
    topology.vertices.push_back(vertex);
  }
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    const Edge &edge = model.edges[e];
    try {
      const gp_Pnt start = to_point(model.points.at(edge.first));
      const gp_Pnt end = to_point(model.points.at(edge.last));
      const Segment segment = make_curve(edge, start, end);
      const double gap = std::max(segment.curve->Value(segment.first).Distance(start),
                                  segment.curve->Value(segment.last).Distance(end));
      if (gap > model.tolerance) {
        throw std::domain_error("its curve misses its vertices by " + length_text(gap, model));
      }
      TopoDS_Edge shape;
      builder.MakeEdge(shape, segment.curve, Precision::Confusion());
      builder.Add(shape, topology.vertices[edge.first].Oriented(TopAbs_FORWARD));
      builder.Add(shape, topology.vertices[edge.last].Oriented(TopAbs_REVERSED));
      builder.Range(shape, segment.first, segment.last);
      topology.edges.push_back(shape);
      raise_vertices(model, e, covering(gap), topology);
    } catch (...) {
      throw BuildFault(Fault::Edge, e + 1, describe_current_exception());
    }
  }
}

void make_face(const Model &model, std::size_t index, Topology &topology) {
  const Face &face = model.faces[index];
  try {
    const bool cylinder = face.kind == SurfaceType::Cylinder;
    const Handle(Geom_Surface) surface =
        cylinder ? lay_on_cylinder(model, index, topology) : lay_on_plane(model, index, topology);
    TopoDS_Face shape;
    BRep_Builder().MakeFace(shape, surface, Precision::Confusion());
    // A cylinder's own normal points away from its axis.
    if (cylinder && face.hollow) {
      shape.Orientation(TopAbs_REVERSED);
    }
    add_wires(face, topology, shape);
    topology.faces.push_back(shape);
  } catch (const BuildFault &) {
    throw;
  } catch (...) {
    throw BuildFault(Fault::Face, index + 1, describe_current_exception());
  }
}

TopoDS_Shape make_solid(const Model &model, const Topology &topology) {
  BRep_Builder builder;
  std::vector<TopoDS_Shell> shells(model.shells);
  for (TopoDS_Shell &shell : shells) {
    builder.MakeShell(shell);
  }
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    builder.Add(shells.at(model.faces[f].shell), topology.faces[f]);
  }
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  for (TopoDS_Shell &shell : shells) {
    shell.Closed(BRep_Tool::IsClosed(shell));
    builder.Add(solid, shell);
  }
  return solid;
}

} // namespace faceformer::occt
