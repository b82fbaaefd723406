#include "chart.h"

#include <algorithm>
#include <cmath>

#include <ElSLib.hxx>
#include <Geom2dAPI_Interpolate.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
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
constexpr int kManyOnSpline = 256;

// Curves on a B-spline surface, which itself is no closer to its edges, are this precise, in inner
// units.
constexpr double kSplinePrecision = 1e-4;

// A point this close to the axis, relative to the radius, is an apex or a pole.
constexpr double kOnAxis = 1e-6;

// A curve in the parameter plane this close to straight is straight.
constexpr double kStraight = 1e-9;

double wrapped(double angle) { return std::remainder(angle, kTurn); }

} // namespace

Chart::Chart(const Face &face)
    : kind_(face.kind), frame_(to_point(face.origin), to_dir(face.direction)), first_(face.first),
      second_(face.second) {
  make_surface();
}

Chart::Chart(const Handle(Geom_BSplineSurface) & surface)
    : kind_(SurfaceType::Filled), surface_(surface), projector_(std::make_shared<Projector>(surface)) {}

Chart::Chart(const Chart &other, const gp_Ax3 &frame)
    : kind_(other.kind_), frame_(frame), first_(other.first_), second_(other.second_) {
  make_surface();
}

void Chart::make_surface() {
  switch (kind_) {
  case SurfaceType::Cylinder:
    surface_ = new Geom_CylindricalSurface(frame_, first_);
    break;
  case SurfaceType::Cone:
    surface_ = new Geom_ConicalSurface(frame_, second_, first_);
    break;
  case SurfaceType::Sphere:
    surface_ = new Geom_SphericalSurface(frame_, first_);
    break;
  default:
    surface_ = new Geom_ToroidalSurface(frame_, first_, second_);
  }
}

gp_Pnt2d Chart::place(const gp_Pnt &point) const {
  double u = 0.0;
  double v = 0.0;
  switch (kind_) {
  case SurfaceType::Cylinder:
    ElSLib::CylinderParameters(frame_, first_, point, u, v);
    break;
  case SurfaceType::Cone:
    ElSLib::ConeParameters(frame_, first_, second_, point, u, v);
    break;
  case SurfaceType::Sphere:
    ElSLib::SphereParameters(frame_, first_, point, u, v);
    break;
  case SurfaceType::Torus:
    ElSLib::TorusParameters(frame_, first_, second_, point, u, v);
    break;
  default:
    return projector_->place(point);
  }
  return gp_Pnt2d(u, v);
}

gp_Pnt2d Chart::place(const gp_Pnt &point, const gp_Pnt2d &before) const {
  return kind_ == SurfaceType::Filled ? projector_->place(point, before) : place(point);
}

bool Chart::is_pole(const gp_Pnt &point) const {
  const gp_Vec arm(frame_.Location(), point);
  const double off = arm.Crossed(gp_Vec(frame_.Direction())).Magnitude();
  if (kind_ == SurfaceType::Sphere) {
    return off < kOnAxis * first_;
  }
  return kind_ == SurfaceType::Cone && off < kOnAxis * std::max(first_, arm.Magnitude());
}

bool Chart::is_low_pole(const gp_Pnt &point) const {
  const gp_Vec arm(frame_.Location(), point);
  return kind_ == SurfaceType::Cone || arm.Dot(gp_Vec(frame_.Direction())) < 0.0;
}

std::vector<gp_Pnt2d> Chart::trace(const Segment &segment, int steps) const {
  std::vector<gp_Pnt2d> places;
  places.reserve(steps + 1);
  const auto point = [&](int i) {
    const double share = static_cast<double>(i) / steps;
    return segment.curve->Value(segment.first + (segment.last - segment.first) * share);
  };
  for (int i = 0; i <= steps; ++i) {
    gp_Pnt2d next = places.empty() ? place(point(i)) : place(point(i), places.back());
    if (!places.empty() && is_periodic()) {
      const gp_Pnt2d &before = places.back();
      next.SetX(before.X() + wrapped(next.X() - before.X()));
      if (is_torus()) {
        next.SetY(before.Y() + wrapped(next.Y() - before.Y()));
      }
    }
    // The first point may be a pole, whose u the second one tells.
    if (i == 1 && is_pole(point(0))) {
      next.SetX(wrapped(next.X()));
      places.front().SetX(next.X());
    }
    places.push_back(next);
  }
  if (is_pole(point(steps))) {
    places.back().SetX(places[steps - 1].X());
  }
  return places;
}

Chart Chart::turned(double angle) const {
  return Chart(*this, frame_.Rotated(frame_.Axis(), angle));
}

gp_Vec2d Chart::slope(const Segment &segment, double t, const gp_Pnt2d &place) const {
  gp_Pnt point;
  gp_Vec along;
  segment.curve->D1(t, point, along);
  gp_Vec by_u;
  gp_Vec by_v;
  surface_->D1(place.X(), place.Y(), point, by_u, by_v);
  const double uu = by_u.Dot(by_u);
  const double uv = by_u.Dot(by_v);
  const double vv = by_v.Dot(by_v);
  const double determinant = uu * vv - uv * uv;
  if (determinant <= kOnAxis * uu * vv) {
    return gp_Vec2d(0.0, 0.0);
  }
  const double u = along.Dot(by_u);
  const double v = along.Dot(by_v);
  return gp_Vec2d((u * vv - v * uv) / determinant, (v * uu - u * uv) / determinant);
}

Handle(Geom2d_Curve) Chart::exact(const Segment &segment, const std::vector<gp_Pnt2d> &places,
                                  const gp_Pnt2d &start) const {
  const double length = segment.last - segment.first;
  const double du = (places.back().X() - places.front().X()) / length;
  const double dv = (places.back().Y() - places.front().Y()) / length;
  const bool across = std::abs(std::abs(du) - 1.0) < kStraight && std::abs(dv) < kStraight;
  const bool along = std::abs(std::abs(dv) - 1.0) < kStraight && std::abs(du) < kStraight;
  if (!is_periodic() || (!across && !along)) {
    return {};
  }
  const int steps = static_cast<int>(places.size()) - 1;
  for (int i = 0; i <= steps; ++i) {
    const double t = length * i / steps;
    const double off_u = places[i].X() - places.front().X() - du * t;
    const double off_v = places[i].Y() - places.front().Y() - dv * t;
    // Heights are lengths, of which OCCT resolves 1e-7.
    if (std::abs(off_u) > kStraight || std::abs(off_v) > Precision::Confusion()) {
      return {};
    }
  }
  const gp_Vec2d way(across ? std::copysign(1.0, du) : 0.0, along ? std::copysign(1.0, dv) : 0.0);
  const gp_Pnt2d origin = start.Translated(way * -segment.first);
  return new Geom2d_Line(origin, gp_Dir2d(way));
}

Handle(Geom2d_Curve) Chart::curve(const Segment &segment, const gp_Pnt2d &start,
                                  double precision) const {
  for (int steps = kFewSteps;; steps *= 2) {
    const std::vector<gp_Pnt2d> places = trace(segment, 2 * steps);
    if (Handle(Geom2d_Curve) line = exact(segment, places, start)) {
      return line;
    }
    const gp_Vec2d shift(places.front(), start);
    Handle(TColgp_HArray1OfPnt2d) points = new TColgp_HArray1OfPnt2d(1, steps + 1);
    Handle(TColStd_HArray1OfReal) parameters = new TColStd_HArray1OfReal(1, steps + 1);
    const auto parameter = [&](double step) {
      return segment.first + (segment.last - segment.first) * step / steps;
    };
    for (int i = 0; i <= steps; ++i) {
      points->SetValue(i + 1, places[2 * i].Translated(shift));
      parameters->SetValue(i + 1, parameter(i));
    }
    Geom2dAPI_Interpolate interpolate(points, parameters, Standard_False, 1e-12);
    // With its true slopes at the ends, where it may touch another edge.
    const gp_Vec2d first = slope(segment, segment.first, places.front());
    const gp_Vec2d last = slope(segment, segment.last, places.back());
    if (first.Magnitude() > Precision::Confusion() && last.Magnitude() > Precision::Confusion()) {
      interpolate.Load(first, last, Standard_False);
    }
    interpolate.Perform();
    if (!interpolate.IsDone()) {
      throw std::domain_error("an edge has no image on its surface");
    }
    const Handle(Geom2d_BSplineCurve) spline = interpolate.Curve();
    // The places left out in between tell how good the curve is.
    double error = 0.0;
    for (int i = 0; i < steps; ++i) {
      const gp_Pnt2d wanted = places[2 * i + 1].Translated(shift);
      const gp_Vec2d off(wanted, spline->Value(parameter(i + 0.5)));
      gp_Pnt point;
      gp_Vec by_u;
      gp_Vec by_v;
      surface_->D1(wanted.X(), wanted.Y(), point, by_u, by_v);
      error = std::max(error, (by_u * off.X() + by_v * off.Y()).Magnitude());
    }
    // Places on a B-spline surface are searched for, which takes its time.
    const int most = is_periodic() ? kManySteps : kManyOnSpline;
    const double enough = is_periodic() ? precision : std::max(precision, kSplinePrecision);
    if (error <= enough || steps >= most) {
      return Handle(Geom2d_Curve)(spline);
    }
  }
}

} // namespace faceformer::occt
