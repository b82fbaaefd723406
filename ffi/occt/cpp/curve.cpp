#include "curve.h"

#include <cmath>

#include <ElCLib.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Precision.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <gp_Ax2.hxx>
#include <gp_Lin.hxx>

#include "topology.h"

namespace faceformer::occt {
namespace {

constexpr double kTurn = 2.0 * M_PI;

// A circle and an ellipse of nearly equal axes are not told apart by OCCT either.
constexpr double kRound = 1e-12;

Segment line_through(const gp_Pnt &start, const gp_Pnt &end) {
  const double length = start.Distance(end);
  if (length <= Precision::Confusion()) {
    throw std::domain_error("its ends are the same point");
  }
  return {new Geom_Line(start, gp_Dir(gp_Vec(start, end))), 0.0, length};
}

// Sets the range of a closed conic from the parameters of the ends, walked counter-clockwise.
void set_range(Segment &segment, bool whole, double first, double last) {
  segment.first = first;
  segment.last = whole ? first + kTurn : last;
  while (segment.last <= segment.first + Precision::PConfusion()) {
    segment.last += kTurn;
  }
}

Segment ellipse_through(const Edge &edge, const gp_Pnt &start, const gp_Pnt &end) {
  const gp_Vec major(edge.major.x, edge.major.y, edge.major.z);
  const double radius = major.Magnitude();
  gp_Ax2 axes(to_point(edge.center), to_dir(edge.normal), gp_Dir(major));
  const bool whole = edge.first == edge.last;
  Segment segment;
  if (edge.ratio >= 1.0 - kRound) {
    // Parameter 0 at the first vertex: exact ends, and a closed circle starts at its vertex.
    const gp_Vec arm(axes.Location(), start);
    if (arm.Crossed(gp_Vec(axes.Direction())).Magnitude() > Precision::Confusion()) {
      axes = gp_Ax2(axes.Location(), axes.Direction(), gp_Dir(arm));
    }
    const gp_Circ circle(axes, radius);
    segment.curve = new Geom_Circle(circle);
    set_range(segment, whole, 0.0, ElCLib::Parameter(circle, end));
  } else {
    const gp_Elips ellipse(axes, radius, radius * edge.ratio);
    segment.curve = new Geom_Ellipse(ellipse);
    set_range(segment, whole, ElCLib::Parameter(ellipse, start), ElCLib::Parameter(ellipse, end));
  }
  return segment;
}

// Derivative at an end of a curve whose parameters are lengths along chords: the unit tangent, longer by
// as much as an arc with this tangent is longer than its chord.
gp_Vec slope(const Point &tangent, const gp_Vec &chord) {
  const gp_Vec unit(tangent.x, tangent.y, tangent.z);
  const double angle = unit.Angle(chord);
  return angle > 1e-6 && angle < 1.0 ? unit * (angle / std::sin(angle)) : unit;
}

Segment spline_through(const Edge &edge, const gp_Pnt &start, const gp_Pnt &end) {
  const std::size_t count = edge.points.size();
  const bool closed = edge.first == edge.last;
  if (count == 2 && !closed) {
    return line_through(start, end);
  }
  if (count < 4 && closed) {
    throw std::domain_error("a closed curve needs four points or more");
  }
  // A periodic curve closes by itself: its last point is its first and is left out.
  const int used = static_cast<int>(count) - (closed ? 1 : 0);
  Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, used);
  for (int i = 1; i <= used; ++i) {
    points->SetValue(i, to_point(edge.points[i - 1]));
  }
  points->SetValue(1, start);
  if (!closed) {
    points->SetValue(used, end);
  }
  GeomAPI_Interpolate interpolate(points, closed, Precision::Confusion());
  if (!closed && edge.tangents.size() == 2) {
    interpolate.Load(slope(edge.tangents[0], gp_Vec(points->Value(1), points->Value(2))),
                     slope(edge.tangents[1], gp_Vec(points->Value(used - 1), points->Value(used))),
                     Standard_False);
  }
  interpolate.Perform();
  if (!interpolate.IsDone()) {
    throw std::domain_error("no curve can be laid through its points");
  }
  const Handle(Geom_BSplineCurve) curve = interpolate.Curve();
  return {Handle(Geom_Curve)(curve), curve->FirstParameter(), curve->LastParameter()};
}

} // namespace

Segment make_curve(const Edge &edge, const gp_Pnt &start, const gp_Pnt &end) {
  switch (edge.kind) {
  case CurveKind::Line:
    return line_through(start, end);
  case CurveKind::Ellipse:
    return ellipse_through(edge, start, end);
  default:
    return spline_through(edge, start, end);
  }
}

} // namespace faceformer::occt
