#include "fill.h"

#include <algorithm>
#include <functional>
#include <vector>

#include <GCPnts_AbscissaPoint.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <GeomConvert.hxx>
#include <GeomConvert_ApproxCurve.hxx>
#include <GeomConvert_CompCurveToBSplineCurve.hxx>
#include <GeomFill_BSplineCurves.hxx>
#include <GeomPlate_BuildPlateSurface.hxx>
#include <GeomPlate_CurveConstraint.hxx>
#include <GeomPlate_MakeApprox.hxx>
#include <GeomPlate_Surface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <gp_XYZ.hxx>

#include "project.h"

namespace faceformer::occt {
namespace {

// A surface whose edges lie this close to it, in inner units, is good enough.
constexpr double kClose = 1e-3;

// Points of each edge at which its distance from a surface is measured.
constexpr int kProbes = 16;

// A circle becomes a curve without weights within this, in inner units.
constexpr double kWeightless = 1e-5;
constexpr int kWeightlessPieces = 64;
constexpr int kWeightlessDegree = 8;

constexpr int kCoonsDegree = 3;

// Edges that meet within this, in inner units, make one side; a face of more edges than these has too
// winding a boundary to be seen as four sides.
constexpr double kJoint = 1e-2;
constexpr std::size_t kMostSides = 8;

// A plate passes its edges at so many points of all together, at least and at most so many of
// each; its approximation by so many pieces stays within these inner units of it.
struct Plating {
  int points;
  int few;
  int many;
  int iterations;
  double tolerance;
  int pieces;
};
constexpr Plating kCoarse{200, 8, 40, 2, 1e-4, 30};
constexpr Plating kFine{280, 12, 56, 2, 1e-5, 60};
constexpr int kPlateDegree = 3;
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

// Means of the knots that each pole of a direction belongs to (Greville 1967), from 0 to 1: poles that
// are linear in them make a linear function.
std::vector<double> means(const TColStd_Array1OfReal &flat, int degree, int poles) {
  std::vector<double> all;
  for (int i = 0; i < poles; ++i) {
    double sum = 0.0;
    for (int k = 1; k <= degree; ++k) {
      sum += flat(flat.Lower() + i + k);
    }
    all.push_back(sum / degree);
  }
  const double first = all.front();
  const double length = all.back() - first;
  for (double &mean : all) {
    mean = (mean - first) / length;
  }
  return all;
}

// Lays the poles between the sides of a surface anew: OCCT blends the sides by the poles' numbers, so
// that uneven knots bend what is ruled.
void blend(const Handle(Geom_BSplineSurface) & surface) {
  const int rows = surface->NbUPoles();
  const int columns = surface->NbVPoles();
  TColStd_Array1OfReal in_u(1, rows + surface->UDegree() + 1);
  TColStd_Array1OfReal in_v(1, columns + surface->VDegree() + 1);
  surface->UKnotSequence(in_u);
  surface->VKnotSequence(in_v);
  const std::vector<double> us = means(in_u, surface->UDegree(), rows);
  const std::vector<double> vs = means(in_v, surface->VDegree(), columns);
  const auto pole = [&](int i, int j) { return surface->Pole(i, j).XYZ(); };
  const auto between = [](const gp_XYZ &a, const gp_XYZ &b, double share) {
    return a * (1.0 - share) + b * share;
  };
  for (int i = 2; i < rows; ++i) {
    for (int j = 2; j < columns; ++j) {
      const double u = us[i - 1];
      const double v = vs[j - 1];
      const gp_XYZ across = between(pole(i, 1), pole(i, columns), v);
      const gp_XYZ along = between(pole(1, j), pole(rows, j), u);
      const gp_XYZ corners = between(between(pole(1, 1), pole(rows, 1), u),
                                     between(pole(1, columns), pole(rows, columns), u), v);
      surface->SetPole(i, j, gp_Pnt(across + along - corners));
    }
  }
}

using Side = Handle(Geom_BSplineCurve);

// The edges' own curves are rational where they are circles, and weights spoil the sum of Coons: it then
// bulges between its sides, and misses them if opposite ones have other weights.
Side weightless(std::int32_t coedge, const Topology &topology) {
  const Side side = GeomConvert::CurveToBSplineCurve(trimmed(coedge, topology));
  if (!side->IsRational()) {
    return side;
  }
  const GeomConvert_ApproxCurve approximation(side, kWeightless, GeomAbs_C1, kWeightlessPieces,
                                              kWeightlessDegree);
  return approximation.HasResult() ? approximation.Curve() : side;
}

double length(const Side &side) {
  return GCPnts_AbscissaPoint::Length(GeomAdaptor_Curve(side));
}

// The cosine of the angle by which a curve turns into the next one.
double smoothness(const Side &first, const Side &second) {
  gp_Pnt point;
  gp_Vec in;
  gp_Vec out;
  first->D1(first->LastParameter(), point, in);
  second->D1(second->FirstParameter(), point, out);
  const double lengths = in.Magnitude() * out.Magnitude();
  return lengths > 0.0 ? in.Dot(out) / lengths : -1.0;
}

// Four sides made of any number of edges: the smoothest corners go, or the longest sides are halved.
std::vector<Side> four_sides(const Loop &loop, const Topology &topology) {
  std::vector<Side> sides;
  for (const std::int32_t coedge : loop.coedges) {
    sides.push_back(weightless(coedge, topology));
  }
  while (sides.size() < 4) {
    const auto longest =
        std::max_element(sides.begin(), sides.end(),
                         [](const Side &a, const Side &b) { return length(a) < length(b); });
    const double middle = ((*longest)->FirstParameter() + (*longest)->LastParameter()) / 2.0;
    const Side second = Handle(Geom_BSplineCurve)::DownCast((*longest)->Copy());
    second->Segment(middle, second->LastParameter());
    (*longest)->Segment((*longest)->FirstParameter(), middle);
    sides.insert(longest + 1, second);
  }
  while (sides.size() > 4) {
    std::size_t best = 0;
    double most = -2.0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const double smooth = smoothness(sides[i], sides[(i + 1) % sides.size()]);
      if (smooth > most) {
        most = smooth;
        best = i;
      }
    }
    // Between the last side and the first: the two are made neighbours in the list.
    if (best + 1 == sides.size()) {
      std::rotate(sides.begin(), sides.begin() + 1, sides.end());
      --best;
    }
    GeomConvert_CompCurveToBSplineCurve joined(sides[best]);
    if (!joined.Add(sides[best + 1], kJoint, Standard_True)) {
      throw std::domain_error("its edges do not meet");
    }
    sides[best] = joined.BSplineCurve();
    sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(best) + 1);
  }
  return sides;
}

Handle(Geom_BSplineSurface) coons(const Loop &loop, const Topology &topology) {
  std::vector<Side> sides = four_sides(loop, topology);
  for (std::size_t i = 0; i < 4; ++i) {
    // Sides meet in a tolerance, and the sum of Coons wants them to meet exactly.
    if (i > 0) {
      sides[i]->SetPole(1, sides[i - 1]->EndPoint());
    }
    if (i == 3) {
      sides[i]->SetPole(sides[i]->NbPoles(), sides[0]->StartPoint());
    }
    // It wants four poles on every side; a line has two.
    sides[i]->IncreaseDegree(std::max(kCoonsDegree, sides[i]->Degree()));
  }
  const GeomFill_BSplineCurves filling(sides[0], sides[1], sides[2], sides[3],
                                       GeomFill_StretchStyle);
  const Handle(Geom_BSplineSurface) surface = filling.Surface();
  blend(surface);
  return surface;
}

Handle(Geom_BSplineSurface) plate(const Face &face, const Topology &topology,
                                  const Plating &plating) {
  std::size_t edges = 0;
  for (const Loop &loop : face.loops) {
    edges += loop.coedges.size();
  }
  const int points = std::clamp(plating.points / static_cast<int>(edges), plating.few, plating.many);
  GeomPlate_BuildPlateSurface builder(kPlateDegree, points, plating.iterations);
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
  const GeomPlate_MakeApprox approximation(builder.Surface(), plating.tolerance, plating.pieces,
                                           kApproximationDegree, plating.tolerance, 0);
  return approximation.Surface();
}

// Largest distance of a face's edges from a surface.
double deviation(const Face &face, const Topology &topology,
                 const Handle(Geom_BSplineSurface) & surface) {
  Projector projector(surface);
  double largest = 0.0;
  for (const Loop &loop : face.loops) {
    for (const std::int32_t coedge : loop.coedges) {
      const Segment segment = segment_of(topology.edges[edge_index(coedge)]);
      gp_Pnt2d place;
      for (int i = 0; i <= kProbes; ++i) {
        const double share = static_cast<double>(i) / kProbes;
        const gp_Pnt point =
            segment.curve->Value(segment.first + (segment.last - segment.first) * share);
        // Only the first place of an edge is searched for on all of the surface.
        place = i == 0 ? projector.place(point) : projector.place(point, place);
        largest = std::max(largest, projector.gap());
      }
    }
  }
  return largest;
}

} // namespace

Handle(Geom_BSplineSurface) fill(const Face &face, const Topology &topology) {
  using Attempt = std::function<Handle(Geom_BSplineSurface)()>;
  std::vector<Attempt> attempts;
  const Loop &loop = face.loops.front();
  const std::size_t sides = face.loops.size() == 1 ? loop.coedges.size() : 0;
  const Attempt by_sides = [&] { return coons(loop, topology); };
  if (sides == 4) {
    attempts.push_back(by_sides);
  }
  attempts.emplace_back([&] { return plate(face, topology, kCoarse); });
  attempts.emplace_back([&] { return plate(face, topology, kFine); });
  if (sides > 1 && sides <= kMostSides && sides != 4) {
    attempts.push_back(by_sides);
  }
  Handle(Geom_BSplineSurface) best;
  double least = 0.0;
  for (const Attempt &attempt : attempts) {
    try {
      const Handle(Geom_BSplineSurface) surface = attempt();
      if (surface.IsNull()) {
        continue;
      }
      const double off = deviation(face, topology, surface);
      if (best.IsNull() || off < least) {
        best = surface;
        least = off;
      }
      if (off <= kClose) {
        break;
      }
    } catch (const Standard_Failure &) {
      // Sides that meet in a wide tolerance only, for one; another attempt may not mind.
    } catch (const std::domain_error &) {
    }
  }
  if (best.IsNull()) {
    throw std::domain_error("no surface can be laid through its edges");
  }
  return best;
}

} // namespace faceformer::occt
