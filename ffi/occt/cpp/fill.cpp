#include "fill.h"

#include <algorithm>

#include <GeomAdaptor_Curve.hxx>
#include <GeomConvert.hxx>
#include <GeomFill_BSplineCurves.hxx>
#include <GeomPlate_BuildPlateSurface.hxx>
#include <GeomPlate_CurveConstraint.hxx>
#include <GeomPlate_MakeApprox.hxx>
#include <GeomPlate_Surface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>

namespace faceformer::occt {
namespace {

// The plate passes its edges at so many points of all together, at least and at most so many of
// each; its approximation stays within these inner units of it.
constexpr int kPlateDegree = 3;
constexpr int kPlatePoints = 200;
constexpr int kFewPoints = 8;
constexpr int kManyPoints = 40;
constexpr int kPlateIterations = 2;
constexpr double kPlateTolerance = 1e-4;
constexpr int kApproximationPieces = 30;
constexpr int kApproximationDegree = 8;

Handle(Geom_TrimmedCurve) trimmed(std::int32_t coedge, const Topology &topology) {
  const Segment segment = segment_of(topology.edges[edge_index(coedge)]);
  Handle(Geom_TrimmedCurve) curve =
      new Geom_TrimmedCurve(segment.curve, segment.first, segment.last);
  if (coedge < 0) {
    curve->Reverse();
  }
  return curve;
}

Handle(Geom_BSplineSurface) coons(const Loop &loop, const Topology &topology) {
  Handle(Geom_BSplineCurve) sides[4];
  for (int i = 0; i < 4; ++i) {
    sides[i] = GeomConvert::CurveToBSplineCurve(trimmed(loop.coedges[i], topology));
  }
  const GeomFill_BSplineCurves filling(sides[0], sides[1], sides[2], sides[3],
                                       GeomFill_CoonsStyle);
  return filling.Surface();
}

Handle(Geom_BSplineSurface) plate(const Face &face, const Topology &topology) {
  std::size_t edges = 0;
  for (const Loop &loop : face.loops) {
    edges += loop.coedges.size();
  }
  const int points =
      std::clamp(kPlatePoints / static_cast<int>(edges), kFewPoints, kManyPoints);
  GeomPlate_BuildPlateSurface builder(kPlateDegree, points, kPlateIterations);
  for (const Loop &loop : face.loops) {
    for (const std::int32_t coedge : loop.coedges) {
      const Segment segment = segment_of(topology.edges[edge_index(coedge)]);
      const Handle(GeomAdaptor_Curve) curve =
          new GeomAdaptor_Curve(segment.curve, segment.first, segment.last);
      builder.Add(new GeomPlate_CurveConstraint(curve, 0, points));
    }
  }
  builder.Perform();
  if (!builder.IsDone()) {
    throw std::domain_error("no surface can be laid through its edges");
  }
  const GeomPlate_MakeApprox approximation(builder.Surface(), kPlateTolerance,
                                           kApproximationPieces, kApproximationDegree,
                                           kPlateTolerance, 0);
  return approximation.Surface();
}

} // namespace

Handle(Geom_BSplineSurface) fill(const Face &face, const Topology &topology) {
  if (face.loops.size() == 1 && face.loops.front().coedges.size() == 4) {
    try {
      return coons(face.loops.front(), topology);
    } catch (const Standard_Failure &) {
      // Sides that meet in a wide tolerance only; the plate does not mind.
    }
  }
  return plate(face, topology);
}

} // namespace faceformer::occt
