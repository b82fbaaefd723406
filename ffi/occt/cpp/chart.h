// The parameter plane of a curved surface, and curves of edges in it.
#pragma once

#include <memory>
#include <vector>

#include <Geom2d_Curve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Surface.hxx>
#include <gp_Ax3.hxx>
#include <gp_Pnt2d.hxx>

#include "curve.h"
#include "project.h"

namespace faceformer::occt {

// A surface unrolled: u and v as OCCT's Geom_ElementarySurface classes have them, or those of a
// B-spline surface.
class Chart {
public:
  // The chart of a round surface of the model: cylinder, cone, sphere or torus.
  explicit Chart(const Face &face);
  explicit Chart(const Handle(Geom_BSplineSurface) & surface);

  // Places of a segment's points at equal steps of its parameter, `steps` + 1 of them, continuous
  // along the segment. At an apex or a pole u is that of the point beside it.
  std::vector<gp_Pnt2d> trace(const Segment &segment, int steps) const;

  // The same chart turned by an angle: a point's u becomes u - angle.
  Chart turned(double angle) const;

  // The segment's curve in the parameter plane, with the segment's own parameter, from `start` on,
  // which picks the turn. Lines along an axis, coaxial circles and meridians become straight lines,
  // others cubic B-splines within `precision` of the segment.
  Handle(Geom2d_Curve) curve(const Segment &segment, const gp_Pnt2d &start, double precision) const;

  Handle(Geom_Surface) surface() const { return surface_; }

  bool is_periodic() const { return kind_ != SurfaceType::Filled; }
  bool is_torus() const { return kind_ == SurfaceType::Torus; }

  // Whether a point is an apex or a pole, where all u are one point; then whether the surface is
  // above it (larger v) there.
  bool is_pole(const gp_Pnt &point) const;
  bool is_low_pole(const gp_Pnt &point) const;

private:
  Chart(const Chart &other, const gp_Ax3 &frame);
  void make_surface();
  gp_Pnt2d place(const gp_Pnt &point) const;
  // The place of a point next to one whose place is known.
  gp_Pnt2d place(const gp_Pnt &point, const gp_Pnt2d &before) const;
  // How the place changes with the segment's parameter.
  gp_Vec2d slope(const Segment &segment, double t, const gp_Pnt2d &place) const;
  Handle(Geom2d_Curve) exact(const Segment &segment, const std::vector<gp_Pnt2d> &places,
                             const gp_Pnt2d &start) const;

  SurfaceType kind_;
  gp_Ax3 frame_;
  double first_ = 0.0;
  double second_ = 0.0;
  Handle(Geom_Surface) surface_;
  // Of a B-spline surface.
  std::shared_ptr<Projector> projector_;
};

} // namespace faceformer::occt
