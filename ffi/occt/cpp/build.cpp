#include <BRepBuilderAPI_Transform.hxx>
#include <BRepLib.hxx>
#include <TopoDS.hxx>
#include <gp_Trsf.hxx>

#include "bridge.h"
#include "check.h"
#include "face.h"
#include "properties.h"
#include "topology.h"
#include "write.h"

namespace faceformer::occt {
namespace {

// Shares of the whole at which the parts of the work begin.
constexpr double kFacesShare = 0.1;
constexpr double kCheckShare = 0.4;
constexpr double kWriteShare = 0.9;

void report(const Watcher &watcher, double share) {
  if (!watcher.report(share)) {
    throw Cancelled();
  }
}

// The shape in the model's own units.
TopoDS_Shape scaled(const TopoDS_Shape &shape, double scale) {
  gp_Trsf transformation;
  transformation.SetScale(gp_Pnt(), scale);
  return BRepBuilderAPI_Transform(shape, transformation, Standard_True).Shape();
}

rust::Vec<std::uint8_t> to_bytes(const std::string &text) {
  rust::Vec<std::uint8_t> bytes;
  bytes.reserve(text.size());
  std::copy(text.begin(), text.end(), std::back_inserter(bytes));
  return bytes;
}

void run(const Model &model, const Watcher &watcher, Topology &topology, Outcome &outcome) {
  report(watcher, 0.0);
  make_edges(model, topology);
  const std::size_t count = model.faces.size();
  for (std::size_t f = 0; f < count; ++f) {
    report(watcher, kFacesShare + (kCheckShare - kFacesShare) * f / count);
    make_face(model, f, topology, outcome);
  }
  report(watcher, kCheckShare);
  TopoDS_Shape solid = make_solid(model, topology);
  if (model.shells == 1 && has_filled(model)) {
    // Which side of a filled face is out can only be guessed before it is there.
    BRepLib::OrientClosedSolid(TopoDS::Solid(solid));
  }
  check_model(model, topology, solid);

  report(watcher, kWriteShare);
  solid = scaled(solid, model.scale);
  measure(solid, outcome);
  outcome.brep = to_bytes(brep_text(solid));
  report(watcher, 1.0);
}

// What there is of the shell; nothing if even that fails, since the fault itself counts more.
rust::Vec<std::uint8_t> partial_text(const Topology &topology, double scale) noexcept {
  try {
    return to_bytes(brep_text(scaled(topology.partial(), scale)));
  } catch (...) {
    return {};
  }
}

} // namespace

Outcome build(const Model &model, const Watcher &watcher) {
  Outcome outcome{};
  Topology topology;
  try {
    run(model, watcher, topology, outcome);
  } catch (const BuildFault &fault) {
    outcome.fault = fault.fault;
    outcome.number = static_cast<std::uint32_t>(fault.number);
    outcome.message = rust::String::lossy(fault.what());
    outcome.brep = partial_text(topology, model.scale);
  } catch (const Cancelled &) {
    outcome.fault = Fault::Cancelled;
  }
  return outcome;
}

} // namespace faceformer::occt
