//! Face identification: from a drawing to faces as loops of co-edges.
//!
//! [`engine`] gives a method by name; every one returns an [`Identification`]. [`from_truth`] and
//! [`read_faces`] give the same type from a drawing's truth and from a file. [`metrics`] compares
//! a result with the truth.

mod error;
pub mod faceformer;
mod faces;
mod kinds;
pub mod metrics;
mod model;
mod orient;
pub mod postprocess;
mod registry;
pub mod rotation;
mod shortest;
#[cfg(test)]
pub(crate) mod testing;
mod varley;
mod weights;

pub use error::IdentifyError;
pub use faces::{FILE, TRUTH, from_truth, read_faces};
pub use model::{Candidate, Engine, Evidence, Face, Identification};
pub use orient::orient;
pub use registry::{EngineKind, engine, engine_with, engine_with_model};
pub use shortest::ShortestEngine;
pub use varley::VarleyEngine;
pub use weights::ModelError;
