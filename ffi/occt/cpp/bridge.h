// The functions that Rust calls; see src/bridge.rs for the data. All of them may throw.
#pragma once

#include "guard.h"
#include "rust/cxx.h"

namespace faceformer::occt {

struct Model;
struct Outcome;
struct Watcher;

// Builds, checks and writes one solid. Faults of the model come back in the outcome, with what
// could be built; only what nobody expected is thrown.
Outcome build(const Model &model, const Watcher &watcher);

// Writes the solid in a BREP text as a STEP file (AP214, millimetres). Holds a lock: OCCT's writer
// has global parameters.
void write_step(rust::Slice<const std::uint8_t> brep, rust::Str path);

// Writes the solid in a BREP text as triangles, as a binary STL file.
void write_stl(rust::Slice<const std::uint8_t> brep, rust::Str path);

// Triangles of the solid in a BREP text, no further than `deflection` from its faces: nine numbers
// each, counter-clockwise seen from outside.
rust::Vec<double> triangles(rust::Slice<const std::uint8_t> brep, double deflection);

// Version of OCCT, as in "7.6.3".
rust::String version();

} // namespace faceformer::occt
