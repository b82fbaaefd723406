// The nearest places of points on a B-spline surface.
#pragma once

#include <utility>
#include <vector>

#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <gp_Pnt.hxx>
#include <gp_Pnt2d.hxx>

namespace faceformer::occt {

// Projects points that lie near a surface. OCCT's own search (ShapeAnalysis_Surface) compares every point
// with a net over all the poles, which takes seconds for the edges of one face; from a place nearby a few
// steps do.
class Projector {
public:
  explicit Projector(const Handle(Geom_BSplineSurface) & surface);

  gp_Pnt2d place(const gp_Pnt &point);

  // The place of a point next to one whose place is known.
  gp_Pnt2d place(const gp_Pnt &point, const gp_Pnt2d &before);

  // Distance of the last point from its place.
  double gap() const { return gap_; }

private:
  using Net = std::vector<std::pair<gp_Pnt2d, gp_Pnt>>;

  gp_Pnt2d from(const gp_Pnt &point, gp_Pnt2d place) const;
  double distance(const gp_Pnt &point, const gp_Pnt2d &place) const;

  GeomAdaptor_Surface surface_;
  // Points of the surface, and those on its border, from which the search starts.
  Net net_;
  Net border_;
  double gap_ = 0.0;
};

} // namespace faceformer::occt
