#include "chart.h"

#include <cmath>

#include <ElSLib.hxx>
#include <Geom2dAPI_Interpolate.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Line.hxx>
#include <Precision.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_HArray1OfPnt2d.hxx>

#include "topology.h"

namespace faceformer::occt {
namespace {

constexpr double kTurn = 2.0 * M_PI;

// Steps of the coarsest and of the finest B-spline in the parameter plane.
constexpr int kFewSteps = 32;
constexpr int kManySteps = 1024;

double wrapped(double angle) { return std::remainder(angle, kTurn); }

} // namespace

gp_Pnt2d Chart::place(const gp_Pnt &point) const {
  double u = 0.0;
  double v = 0.0;
  ElSLib::CylinderParameters(frame_, radius_, point, u, v);
  return gp_Pnt2d(u, v);
}

std::vector<gp_Pnt2d> Chart::trace(const Segment &segment, int steps) const {
  std::vector<gp_Pnt2d> places;
  places.reserve(steps + 1);
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const double t = segment.first + (segment.last - segment.first) * share;
    gp_Pnt2d next = place(segment.curve->Value(t));
    const double before = places.empty() ? 0.0 : places.back().X();
    next.SetX(before + wrapped(next.X() - before));
    places.push_back(next);
  }
  return places;
}

Chart Chart::turned(double angle) const {
  return Chart(frame_.Rotated(frame_.Axis(), angle), radius_);
}

Handle(Geom2d_Curve) Chart::exact(const Segment &segment, double u_start) const {
  const double v_start = place(segment.curve->Value(segment.first)).Y();
  double du = 0.0;
  double dv = 0.0;
  if (const auto line = Handle(Geom_Line)::DownCast(segment.curve)) {
    const double along = line->Position().Direction().Dot(frame_.Direction());
    if (1.0 - std::abs(along) > Precision::Angular()) {
      return {};
    }
    dv = std::copysign(1.0, along);
  } else if (const auto circle = Handle(Geom_Circle)::DownCast(segment.curve)) {
    const gp_Ax1 axis = circle->Axis();
    const gp_Lin middle(frame_.Axis());
    const bool coaxial = axis.IsParallel(frame_.Axis(), Precision::Angular()) &&
                         middle.Distance(axis.Location()) <= Precision::Confusion() &&
                         std::abs(circle->Radius() - radius_) <= Precision::Confusion();
    if (!coaxial) {
      return {};
    }
    du = std::copysign(1.0, axis.Direction().Dot(frame_.Direction()));
  } else {
    return {};
  }
  const gp_Pnt2d origin(u_start - du * segment.first, v_start - dv * segment.first);
  return new Geom2d_Line(origin, gp_Dir2d(du, dv));
}

Handle(Geom2d_Curve) Chart::curve(const Segment &segment, double u_start, double precision) const {
  if (Handle(Geom2d_Curve) line = exact(segment, u_start)) {
    return line;
  }
  for (int steps = kFewSteps;; steps *= 2) {
    const std::vector<gp_Pnt2d> places = trace(segment, 2 * steps);
    const double shift = u_start - places.front().X();
    Handle(TColgp_HArray1OfPnt2d) points = new TColgp_HArray1OfPnt2d(1, steps + 1);
    Handle(TColStd_HArray1OfReal) parameters = new TColStd_HArray1OfReal(1, steps + 1);
    const auto parameter = [&](double step) {
      return segment.first + (segment.last - segment.first) * step / steps;
    };
    for (int i = 0; i <= steps; ++i) {
      points->SetValue(i + 1, places[2 * i].Translated(gp_Vec2d(shift, 0.0)));
      parameters->SetValue(i + 1, parameter(i));
    }
    Geom2dAPI_Interpolate interpolate(points, parameters, Standard_False, 1e-12);
    interpolate.Perform();
    if (!interpolate.IsDone()) {
      throw std::domain_error("an edge has no image on its cylinder");
    }
    const Handle(Geom2d_BSplineCurve) spline = interpolate.Curve();
    // The places left out in between tell how good the curve is.
    double error = 0.0;
    for (int i = 0; i < steps; ++i) {
      const gp_Pnt2d between = spline->Value(parameter(i + 0.5));
      const gp_Pnt2d wanted = places[2 * i + 1];
      error = std::max(error, std::hypot((between.X() - shift - wanted.X()) * radius_,
                                         between.Y() - wanted.Y()));
    }
    if (error <= precision || steps >= kManySteps) {
      return Handle(Geom2d_Curve)(spline);
    }
  }
}

} // namespace faceformer::occt
