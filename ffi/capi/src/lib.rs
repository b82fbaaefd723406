//! The C ABI of faceformer: what FreeCAD, C and C++ programs load.
//!
//! The header `include/faceformer.h` is generated from the comments of this crate, and
//! `include/faceformer.hpp` wraps it for C++. Structured data crosses as UTF-8 JSON, in the forms
//! that the types of the crate [`faceformer`] serialise to; a B-rep crosses as OpenCASCADE's BREP
//! text, never as a pointer to a shape.
//!
//! All `unsafe` of the way up is here, in three modules: [`guard`] initialises outputs and keeps
//! panics inside, [`input`] checks what comes in, [`memory`] hands out what the caller frees. The
//! other modules are one a handle type.

mod drawing;
mod error;
mod faces;
mod guard;
mod info;
mod input;
mod lift;
mod memory;
mod progress;
mod solid;
mod status;
mod version;

#[cfg(test)]
mod testing;

pub use drawing::{
    FaceformerDrawing, faceformer_drawing_free, faceformer_drawing_read, faceformer_drawing_report,
};
pub use faces::{
    FaceformerFaces, faceformer_faces_free, faceformer_faces_json, faceformer_faces_read,
    faceformer_identify,
};
pub use info::{faceformer_abi_version, faceformer_info};
pub use lift::faceformer_lift;
pub use memory::{faceformer_bytes_free, faceformer_string_free};
pub use progress::FaceformerProgress;
pub use solid::{
    FaceformerSolid, faceformer_solid, faceformer_solid_brep, faceformer_solid_free,
    faceformer_solid_report, faceformer_solid_write,
};
pub use status::FaceformerStatus;
pub use version::FACEFORMER_ABI_VERSION;

/// The header promises that several threads may use a handle at once.
const _: () = {
    const fn shared_between_threads<T: Send + Sync>() {}
    shared_between_threads::<FaceformerDrawing>();
    shared_between_threads::<FaceformerFaces>();
    shared_between_threads::<FaceformerSolid>();
};
