#include "write.h"

#include <algorithm>
#include <mutex>
#include <sstream>
#include <stdexcept>

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Interface_Static.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <Standard_Version.hxx>
#include <StlAPI_Writer.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_FormatVersion.hxx>
#include <TopoDS.hxx>

#include "bridge.h"
#include "faceformer-occt/src/bridge.rs.h"
#include "quiet.h"

namespace faceformer::occt {
namespace {

// Triangles stay this close to the surface, as a share of the box's diagonal, and neighbours turn
// by no more than this angle in radians.
constexpr double kDeflection = 5e-4;
constexpr double kAngle = 0.3;

std::mutex &writer_lock() {
  static std::mutex lock;
  return lock;
}

// Sets one of the exchange library's global parameters while it lives.
class Parameter {
public:
  Parameter(const char *name, const char *value) : name_(name) {
    const char *before = Interface_Static::CVal(name);
    before_ = before == nullptr ? "" : before;
    Interface_Static::SetCVal(name, value);
  }
  ~Parameter() { Interface_Static::SetCVal(name_, before_.c_str()); }
  Parameter(const Parameter &) = delete;
  Parameter &operator=(const Parameter &) = delete;

private:
  const char *name_;
  std::string before_;
};

TopoDS_Shape read_brep(rust::Slice<const std::uint8_t> brep) {
  std::istringstream stream(std::string(brep.begin(), brep.end()));
  TopoDS_Shape shape;
  BRepTools::Read(shape, stream, BRep_Builder());
  if (shape.IsNull()) {
    throw std::runtime_error("this is no BREP text");
  }
  return shape;
}

} // namespace

std::string brep_text(const TopoDS_Shape &shape) {
  std::ostringstream stream;
  BRepTools::Write(shape, stream, Standard_False, Standard_False, TopTools_FormatVersion_VERSION_1);
  return stream.str();
}

void write_step(rust::Slice<const std::uint8_t> brep, rust::Str path) {
  const std::lock_guard<std::mutex> lock(writer_lock());
  const Quiet quiet;
  STEPControl_Controller::Init();
  const Parameter unit("write.step.unit", "MM");
  const Parameter product("write.step.product.name", "Faceformer");
  STEPControl_Writer writer;
  if (writer.Transfer(read_brep(brep), STEPControl_AsIs) != IFSelect_RetDone) {
    throw std::runtime_error("the solid cannot be expressed in STEP");
  }
  if (writer.Write(std::string(path).c_str()) != IFSelect_RetDone) {
    throw std::runtime_error("the file cannot be opened or is not complete");
  }
}

void write_stl(rust::Slice<const std::uint8_t> brep, rust::Str path) {
  const TopoDS_Shape shape = read_brep(brep);
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  const double diagonal = std::sqrt(box.SquareExtent());
  const BRepMesh_IncrementalMesh mesh(shape, kDeflection * diagonal, Standard_False, kAngle);
  if (!mesh.IsDone()) {
    throw std::runtime_error("the solid cannot be divided into triangles");
  }
  const std::lock_guard<std::mutex> lock(writer_lock());
  const Quiet quiet;
  StlAPI_Writer writer;
  writer.ASCIIMode() = Standard_False;
  if (!writer.Write(shape, std::string(path).c_str())) {
    throw std::runtime_error("the file cannot be opened or is not complete");
  }
}

rust::Vec<double> triangles(rust::Slice<const std::uint8_t> brep, double deflection) {
  const TopoDS_Shape shape = read_brep(brep);
  const BRepMesh_IncrementalMesh mesh(shape, deflection, Standard_False, kAngle);
  if (!mesh.IsDone()) {
    throw std::runtime_error("the solid cannot be divided into triangles");
  }
  rust::Vec<double> numbers;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face &face = TopoDS::Face(it.Current());
    TopLoc_Location place;
    const Handle(Poly_Triangulation) part = BRep_Tool::Triangulation(face, place);
    if (part.IsNull()) {
      throw std::runtime_error("a face cannot be divided into triangles");
    }
    const bool reversed = face.Orientation() == TopAbs_REVERSED;
    for (int i = 1; i <= part->NbTriangles(); ++i) {
      int corners[3];
      part->Triangle(i).Get(corners[0], corners[1], corners[2]);
      if (reversed) {
        std::swap(corners[1], corners[2]);
      }
      for (const int corner : corners) {
        const gp_Pnt p = part->Node(corner).Transformed(place);
        numbers.push_back(p.X());
        numbers.push_back(p.Y());
        numbers.push_back(p.Z());
      }
    }
  }
  return numbers;
}

rust::String version() { return OCC_VERSION_COMPLETE; }

} // namespace faceformer::occt
