#include "topology.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Precision.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>

#include "guard.h"

namespace faceformer::occt {
bool has_filled(const Model &model) {
  return std::any_of(model.faces.begin(), model.faces.end(),
                     [](const Face &face) { return face.kind == SurfaceType::Filled; });
}

void raise_vertices(const Model &model, std::size_t edge, double tolerance,
                    const Topology &topology) {
  BRep_Builder builder;
  builder.UpdateVertex(topology.vertices[model.edges[edge].first], tolerance);
  builder.UpdateVertex(topology.vertices[model.edges[edge].last], tolerance);
}

Segment segment_of(const TopoDS_Edge &edge) {
  Segment segment;
  segment.curve = BRep_Tool::Curve(edge, segment.first, segment.last);
  return segment;
}

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
