//! The rotation engine: scores for triples of edges, a rotation system decoded from them, loops
//! as its orbits, and faces as groups of loops that lie on one surface.

mod calibration;
mod canonical;
mod crossing;
mod cuts;
mod cycles;
mod decode;
mod ends;
mod engine;
pub mod features;
mod frame;
mod group;
mod hand;
pub mod inputs;
mod looks;
pub mod model;
mod orders;
mod reading;
mod rings;
#[cfg(test)]
mod samples;
mod scorer;
pub mod shards;
mod system;
mod triples;
mod variants;

pub use decode::Field;
pub use engine::{MAX_DEGREE, RotationEngine};
pub use hand::HandScorer;
pub use model::{ModelError, ModelScorer};
pub use scorer::{LoopKinds, Scores, TripleScorer};
pub use system::RotationSystem;
pub use triples::Triples;
