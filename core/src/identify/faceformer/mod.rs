//! The paper's engines: faces as sequences of pointers at the drawing's co-edges (paper, sections
//! 4.1 to 4.3).
//!
//! Three variants share one network, an encoder over the tokens of a drawing and a decoder whose
//! output points at them:
//!
//! | engine | tokens | sequence |
//! |---|---|---|
//! | `faceformer` | co-edges | one face from every co-edge as a start, ended by its type |
//! | `seq2seq-coedge` | co-edges | all faces one after the other |
//! | `seq2seq` | edges | all faces one after the other, each a sorted set of edges |
//!
//! [`inputs`] is what the network sees, [`shards`] the same with the truth for training,
//! [`Network`] the network, [`search`] the decoding and [`FaceformerEngine`] the engine. There is no
//! mode without a trained model.

mod config;
mod decoding;
mod engine;
pub mod inputs;
mod layers;
mod network;
mod search;
pub mod shards;
#[cfg(test)]
mod tests;
mod walk;

pub use config::{Config, FORMAT, Frame, FurtherLoops, LIMIT, TOKENS, Variant};
pub use decoding::{Decoding, Hypothesis};
pub use engine::{DecodeOptions, FaceformerEngine};
pub use network::{Memory, Network};
pub use search::{Found, search};
