#include "properties.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>

#include "check.h"

namespace faceformer::occt {
namespace {

std::uint32_t count(const TopoDS_Shape &shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return static_cast<std::uint32_t>(map.Extent());
}

std::size_t kind_index(const TopoDS_Face &face) {
  switch (BRepAdaptor_Surface(face, Standard_False).GetType()) {
  case GeomAbs_Plane:
    return 0;
  case GeomAbs_Cylinder:
    return 1;
  case GeomAbs_Cone:
    return 2;
  case GeomAbs_Sphere:
    return 3;
  case GeomAbs_Torus:
    return 4;
  default:
    return 5;
  }
}

} // namespace

void measure(const TopoDS_Shape &solid, Outcome &outcome) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(solid, properties);
  outcome.volume = properties.Mass();
  BRepGProp::SurfaceProperties(solid, properties);
  outcome.area = properties.Mass();

  Bnd_Box box;
  BRepBndLib::AddOptimal(solid, box, Standard_False, Standard_False);
  box.Get(outcome.lower.x, outcome.lower.y, outcome.lower.z, outcome.upper.x, outcome.upper.y,
          outcome.upper.z);

  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(solid, TopAbs_FACE, faces);
  for (int i = 1; i <= faces.Extent(); ++i) {
    ++outcome.kinds[kind_index(TopoDS::Face(faces(i)))];
  }
  outcome.edges = count(solid, TopAbs_EDGE);
  outcome.vertices = count(solid, TopAbs_VERTEX);
  outcome.shells = count(solid, TopAbs_SHELL);
  outcome.largest_tolerance = largest_tolerance(solid);
}

} // namespace faceformer::occt
