//! Face identification: from a drawing to faces as loops of co-edges.

mod error;
mod model;

pub use error::IdentifyError;
pub use model::{Candidate, Engine, EngineKind, Evidence, Face, Identification};
