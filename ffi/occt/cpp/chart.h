// The parameter plane of a cylinder, and curves of edges in it.
#pragma once

#include <vector>

#include <Geom2d_Curve.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <gp_Ax3.hxx>
#include <gp_Pnt2d.hxx>

#include "curve.h"

namespace faceformer::occt {

// A cylinder unrolled: u is the angle around the axis in radians, v the height along it.
class Chart {
public:
  Chart(const gp_Ax3 &frame, double radius) : frame_(frame), radius_(radius) {}

  // Places of a segment's points at equal steps of its parameter, `steps` + 1 of them; u is
  // continuous along the segment and in (-pi, pi] at its first point.
  std::vector<gp_Pnt2d> trace(const Segment &segment, int steps) const;

  // The same chart turned by an angle: a point's u becomes u - angle.
  Chart turned(double angle) const;

  // The segment's curve in the parameter plane, with the segment's own parameter. `u_start` is u
  // at the segment's first point, which picks the turn. Lines and coaxial circles become straight
  // lines, others cubic B-splines within `precision` of the segment.
  Handle(Geom2d_Curve) curve(const Segment &segment, double u_start, double precision) const;

  Handle(Geom_CylindricalSurface) surface() const {
    return new Geom_CylindricalSurface(frame_, radius_);
  }

private:
  gp_Pnt2d place(const gp_Pnt &point) const;
  Handle(Geom2d_Curve) exact(const Segment &segment, double u_start) const;

  gp_Ax3 frame_;
  double radius_;
};

} // namespace faceformer::occt
