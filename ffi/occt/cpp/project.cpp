#include "project.h"

#include <algorithm>

#include <Precision.hxx>
#include <gp_Vec.hxx>

namespace faceformer::occt {
namespace {

// Lines of the net either way.
constexpr int kLines = 24;

// So many of the net's points, the nearest ones, and of those on the border are tried.
constexpr std::size_t kStarts = 4;

// Steps from one place; most points need three.
constexpr int kSteps = 30;

// A step that leads away is halved so often at the most.
constexpr int kHalvings = 8;

// A step this short, in inner units, is the last.
constexpr double kLast = 1e-10;

// A place this far from its point, in inner units, is looked for anew.
constexpr double kNear = 1e-4;

} // namespace

Projector::Projector(const Handle(Geom_BSplineSurface) & surface) : surface_(surface) {
  const double u = surface_.FirstUParameter();
  const double v = surface_.FirstVParameter();
  const double du = (surface_.LastUParameter() - u) / kLines;
  const double dv = (surface_.LastVParameter() - v) / kLines;
  for (int i = 0; i <= kLines; ++i) {
    for (int j = 0; j <= kLines; ++j) {
      const gp_Pnt2d place(u + du * i, v + dv * j);
      const gp_Pnt point = surface_.Value(place.X(), place.Y());
      net_.emplace_back(place, point);
      if (i % kLines == 0 || j % kLines == 0) {
        border_.emplace_back(place, point);
      }
    }
  }
}

double Projector::distance(const gp_Pnt &point, const gp_Pnt2d &place) const {
  return surface_.Value(place.X(), place.Y()).Distance(point);
}

// Steps of Gauss and Newton, which need no curvature for points near the surface; a step that leaves the
// surface goes along its border.
gp_Pnt2d Projector::from(const gp_Pnt &point, gp_Pnt2d place) const {
  const auto in_u = [&](double u) {
    return std::clamp(u, surface_.FirstUParameter(), surface_.LastUParameter());
  };
  const auto in_v = [&](double v) {
    return std::clamp(v, surface_.FirstVParameter(), surface_.LastVParameter());
  };
  for (int i = 0; i < kSteps; ++i) {
    gp_Pnt at;
    gp_Vec by_u;
    gp_Vec by_v;
    surface_.D1(place.X(), place.Y(), at, by_u, by_v);
    const gp_Vec off(at, point);
    const double uu = by_u.SquareMagnitude();
    const double vv = by_v.SquareMagnitude();
    const double uv = by_u.Dot(by_v);
    const double determinant = uu * vv - uv * uv;
    if (determinant <= 0.0) {
      break;
    }
    const double u = by_u.Dot(off);
    const double v = by_v.Dot(off);
    double to_u = place.X() + (u * vv - v * uv) / determinant;
    double to_v = place.Y() + (v * uu - u * uv) / determinant;
    if (in_u(to_u) != to_u) {
      to_u = in_u(to_u);
      to_v = place.Y() + (v - uv * (to_u - place.X())) / vv;
    } else if (in_v(to_v) != to_v) {
      to_v = in_v(to_v);
      to_u = place.X() + (u - uv * (to_v - place.Y())) / uu;
    }
    gp_Pnt2d next(in_u(to_u), in_v(to_v));
    for (int j = 0; j < kHalvings && distance(point, next) > off.Magnitude() + kLast; ++j) {
      next.SetXY((next.XY() + place.XY()) / 2.0);
    }
    const gp_Vec step = by_u * (next.X() - place.X()) + by_v * (next.Y() - place.Y());
    place = next;
    if (step.Magnitude() < kLast) {
      break;
    }
  }
  return place;
}

gp_Pnt2d Projector::place(const gp_Pnt &point) {
  const auto nearer = [&](const auto &a, const auto &b) {
    return a.second.SquareDistance(point) < b.second.SquareDistance(point);
  };
  gp_Pnt2d best;
  gap_ = Precision::Infinite();
  // What is sought lies on the border, mostly, and a surface that folds may come near it elsewhere.
  for (Net *net : {&net_, &border_}) {
    std::partial_sort(net->begin(), net->begin() + kStarts, net->end(), nearer);
    for (std::size_t i = 0; i < kStarts && gap_ > kNear; ++i) {
      const gp_Pnt2d found = from(point, (*net)[i].first);
      const double gap = distance(point, found);
      if (gap < gap_) {
        best = found;
        gap_ = gap;
      }
    }
  }
  return best;
}

gp_Pnt2d Projector::place(const gp_Pnt &point, const gp_Pnt2d &before) {
  const gp_Pnt2d found = from(point, before);
  gap_ = distance(point, found);
  if (gap_ <= kNear) {
    return found;
  }
  const double gap = gap_;
  const gp_Pnt2d anew = place(point);
  if (gap_ <= gap) {
    return anew;
  }
  gap_ = gap;
  return found;
}

} // namespace faceformer::occt
