#include "unroll.h"

#include <algorithm>
#include <cmath>

#include <BRep_Tool.hxx>

namespace faceformer::occt {
namespace {

constexpr double kTurn = 2.0 * M_PI;

// Steps of a rough trace of an edge.
constexpr int kTraceSteps = 32;

// Edges closer than this around a pole, in radians, are the same: a whole turn lies between.
constexpr double kSameSide = 1e-9;

gp_Pnt start_of(std::int32_t coedge, const Topology &topology) {
  const TopoDS_Edge &edge = topology.edges[edge_index(coedge)];
  const Segment segment = segment_of(edge);
  return segment.curve->Value(coedge > 0 ? segment.first : segment.last);
}

} // namespace

Unrolled unroll(const Chart &chart, const Face &face, std::size_t index, std::size_t face_index,
                const Topology &topology) {
  const Loop &loop = face.loops[index];
  Unrolled out;
  gp_Pnt2d cursor;
  gp_Pnt2d begin_of_all;
  // u from the cursor to a place beyond a pole: towards the side that the face is on.
  const auto around_pole = [&](const gp_Pnt &pole, double from, double to) {
    const double way = chart.is_low_pole(pole) != face.hollow ? 1.0 : -1.0;
    double turn = std::fmod(way * (to - from), kTurn);
    turn += turn < 0.0 ? kTurn : 0.0;
    turn += turn < kSameSide ? kTurn : 0.0;
    return way * turn;
  };
  for (std::size_t i = 0; i < loop.coedges.size(); ++i) {
    const std::int32_t coedge = loop.coedges[i];
    std::vector<gp_Pnt2d> places =
        chart.trace(segment_of(topology.edges[edge_index(coedge)]), kTraceSteps);
    const gp_Pnt2d begin = coedge > 0 ? places.front() : places.back();
    gp_Vec2d shift(0.0, 0.0);
    if (i == 0) {
      begin_of_all = out.low = out.high = begin;
    } else if (chart.is_periodic()) {
      const gp_Pnt start = start_of(coedge, topology);
      if (chart.is_pole(start)) {
        const double turn = around_pole(start, cursor.X(), begin.X());
        out.poles.push_back({i, cursor, turn});
        shift.SetX(cursor.X() + turn - begin.X());
      } else {
        shift.SetX(kTurn * std::round((cursor.X() - begin.X()) / kTurn));
      }
      if (chart.is_torus()) {
        shift.SetY(kTurn * std::round((cursor.Y() - begin.Y()) / kTurn));
      }
    }
    for (gp_Pnt2d &place : places) {
      place.Translate(shift);
      out.low.SetCoord(std::min(out.low.X(), place.X()), std::min(out.low.Y(), place.Y()));
      out.high.SetCoord(std::max(out.high.X(), place.X()), std::max(out.high.Y(), place.Y()));
    }
    out.starts.push_back(places.front());
    if (coedge < 0) {
      std::reverse(places.begin(), places.end());
    }
    for (std::size_t k = 0; k + 1 < places.size(); ++k) {
      out.area += (places[k].X() * places[k + 1].Y() - places[k + 1].X() * places[k].Y()) / 2.0;
    }
    cursor = places.back();
  }
  if (chart.is_periodic()) {
    const gp_Pnt start = start_of(loop.coedges.front(), topology);
    if (chart.is_pole(start)) {
      const double turn = around_pole(start, cursor.X(), begin_of_all.X());
      out.poles.push_back({0, cursor, turn});
      cursor.SetX(cursor.X() + turn);
    }
  }
  const bool closed = std::abs(cursor.X() - begin_of_all.X()) < M_PI &&
                      (!chart.is_torus() || std::abs(cursor.Y() - begin_of_all.Y()) < M_PI);
  if (chart.is_periodic() && !closed) {
    throw BuildFault(Fault::Face, face_index + 1,
                     "it runs all around its surface; draw the outlines that split it in two");
  }
  return out;
}

} // namespace faceformer::occt
