#include "check.h"

#include <algorithm>
#include <sstream>

#include <BRepCheck.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepCheck_ListIteratorOfListOfStatus.hxx>
#include <BRepCheck_Result.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>

namespace faceformer::occt {
namespace {

// OCCT's name of a status without its prefix and line end: "SelfIntersectingWire".
std::string name_of(BRepCheck_Status status) {
  std::ostringstream stream;
  BRepCheck::Print(status, stream);
  std::string text = stream.str();
  const std::string prefix = "BRepCheck_";
  const std::size_t start = text.find(prefix);
  if (start != std::string::npos) {
    text.erase(0, start + prefix.size());
  }
  text.erase(text.find_last_not_of(" \r\n") + 1);
  return text;
}

// First bad status of a list; empty if all is well.
std::string bad_status(const BRepCheck_ListOfStatus &statuses) {
  for (BRepCheck_ListIteratorOfListOfStatus it(statuses); it.More(); it.Next()) {
    if (it.Value() != BRepCheck_NoError) {
      return name_of(it.Value());
    }
  }
  return {};
}

// First bad status of a shape, by itself and within each shape around it.
std::string bad_status(const BRepCheck_Analyzer &analyzer, const TopoDS_Shape &shape) {
  const Handle(BRepCheck_Result) &result = analyzer.Result(shape);
  if (result.IsNull()) {
    return {};
  }
  std::string text = bad_status(result->Status());
  for (result->InitContextIterator(); text.empty() && result->MoreShapeInContext();
       result->NextShapeInContext()) {
    text = bad_status(result->StatusOnShape());
  }
  return text;
}

double volume_of(const TopoDS_Shape &shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

// What is wrong with the shells as wholes; empty if nothing.
std::string shell_fault(const TopoDS_Shape &solid) {
  int bodies = 0;
  for (TopExp_Explorer it(solid, TopAbs_SHELL); it.More(); it.Next()) {
    if (!BRep_Tool::IsClosed(it.Current())) {
      return "there is a gap between them";
    }
    bodies += volume_of(it.Current()) > 0.0 ? 1 : 0;
  }
  if (bodies > 1) {
    return "they make " + std::to_string(bodies) + " separate bodies";
  }
  if (bodies == 0 || volume_of(solid) <= 0.0) {
    return "they enclose no positive volume";
  }
  return {};
}

// Number of a shape in the model, from 1; 0 if it is not there.
template <typename Shapes> std::size_t number_of(const TopoDS_Shape &shape, const Shapes &shapes) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].IsSame(shape)) {
      return i + 1;
    }
  }
  return 0;
}

// Throws for the edge or face that the analyzer objects to. The analyzer knows shapes with their
// orientation in the solid, so they are looked up from there.
void name_fault(const BRepCheck_Analyzer &analyzer, const Topology &topology,
                const TopoDS_Shape &solid) {
  for (TopExp_Explorer it(solid, TopAbs_EDGE); it.More(); it.Next()) {
    const std::string text = bad_status(analyzer, it.Current());
    if (!text.empty()) {
      throw BuildFault(Fault::Edge, number_of(it.Current(), topology.edges),
                       "it is not valid: " + text);
    }
  }
  for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
    // What is wrong with a wire says more than that its face has no sides then.
    std::string text;
    for (TopExp_Explorer wire(it.Current(), TopAbs_WIRE); text.empty() && wire.More();
         wire.Next()) {
      text = bad_status(analyzer, wire.Current());
    }
    text = text.empty() ? bad_status(analyzer, it.Current()) : text;
    if (!text.empty()) {
      throw BuildFault(Fault::Face, number_of(it.Current(), topology.faces),
                       "it is not valid: " + text);
    }
  }
  for (const TopAbs_ShapeEnum kind : {TopAbs_SHELL, TopAbs_SOLID, TopAbs_VERTEX}) {
    for (TopExp_Explorer it(solid, kind); it.More(); it.Next()) {
      const std::string text = bad_status(analyzer, it.Current());
      if (!text.empty()) {
        throw BuildFault(Fault::Shell, 0, text);
      }
    }
  }
  throw BuildFault(Fault::Shell, 0, "BRepCheck objects, but names no place");
}

} // namespace

double largest_tolerance(const TopoDS_Shape &shape) {
  double largest = 0.0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    largest = std::max(largest, BRep_Tool::Tolerance(TopoDS::Face(it.Current())));
  }
  for (TopExp_Explorer it(shape, TopAbs_EDGE); it.More(); it.Next()) {
    largest = std::max(largest, BRep_Tool::Tolerance(TopoDS::Edge(it.Current())));
  }
  for (TopExp_Explorer it(shape, TopAbs_VERTEX); it.More(); it.Next()) {
    largest = std::max(largest, BRep_Tool::Tolerance(TopoDS::Vertex(it.Current())));
  }
  return largest;
}

void check_model(const Model &model, const Topology &topology, const TopoDS_Shape &solid) {
  // Gaps and separate bodies first: they say more than what BRepCheck makes of them.
  const std::string text = shell_fault(solid);
  if (!text.empty()) {
    throw BuildFault(Fault::Shell, 0, text);
  }
  const BRepCheck_Analyzer analyzer(solid);
  if (!analyzer.IsValid()) {
    name_fault(analyzer, topology, solid);
  }
  const double tolerance = largest_tolerance(solid);
  if (tolerance > limit(model, has_filled(model))) {
    throw BuildFault(Fault::Tolerance, 0,
                     "its parts meet only within " + length_text(tolerance, model));
  }
}

} // namespace faceformer::occt
