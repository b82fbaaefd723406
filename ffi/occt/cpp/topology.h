// The B-rep while it grows: OCCT shapes by the numbers they have in the model.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <Precision.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Pnt.hxx>

#include "curve.h"
#include "faceformer-occt/src/bridge.rs.h"

namespace faceformer::occt {

// A fault that has a place: caught in build(), it becomes the outcome. `number` counts from 1.
struct BuildFault : std::runtime_error {
  BuildFault(Fault fault, std::size_t number, const std::string &message)
      : std::runtime_error(message), fault(fault), number(number) {}

  Fault fault;
  std::size_t number;
};

// Thrown when the caller asked to stop.
struct Cancelled {};

// A length in words, in the model's own units: "1.2e-05".
std::string length_text(double inner_length, const Model &model);

struct Topology {
  std::vector<TopoDS_Vertex> vertices;
  std::vector<TopoDS_Edge> edges;
  std::vector<TopoDS_Face> faces;

  // What there is so far, for inspection: the faces as a compound.
  TopoDS_Shape partial() const;
};

inline std::size_t edge_index(std::int32_t coedge) {
  return static_cast<std::size_t>(std::abs(coedge)) - 1;
}

// Whether some face of a model is filled.
bool has_filled(const Model &model);

// Largest tolerance allowed at a filled face, or at another one.
inline double limit(const Model &model, bool filled) {
  return filled ? model.filled_tolerance : model.tolerance;
}

// A tolerance that covers a measured distance with some room.
inline double covering(double distance) {
  return std::max(Precision::Confusion(), distance * 1.05);
}

// The curve of an edge and its range.
Segment segment_of(const TopoDS_Edge &edge);

// Grows the tolerance of an edge's vertices.
void raise_vertices(const Model &model, std::size_t edge, double tolerance,
                    const Topology &topology);

inline gp_Pnt to_point(const Point &p) { return gp_Pnt(p.x, p.y, p.z); }
inline gp_Dir to_dir(const Point &p) { return gp_Dir(p.x, p.y, p.z); }

// Makes every vertex and edge once; faces then share them.
void make_edges(const Model &model, Topology &topology);

// The shells of all faces as one solid, not yet checked.
TopoDS_Shape make_solid(const Model &model, const Topology &topology);

} // namespace faceformer::occt
