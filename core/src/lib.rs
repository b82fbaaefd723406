//! From a 2D wireframe drawing of a solid to its faces, its depth and a plan of its B-rep.
//!
//! The stages are modules, and data goes one way through them:
//!
//! 1. [`drawing`]: reading, clean-up and diagnosis of a wireframe drawing,
//! 2. [`identify`]: faces as loops of co-edges, by one of several engines,
//! 3. [`lift`]: depth of every vertex and the surface of every face,
//! 4. [`plan`]: a neutral B-rep that a CAD kernel can build.
//!
//! Each stage takes the results of the stages before it and returns one serialisable value.
//! Nothing here knows a CAD kernel; the crate `faceformer-occt` builds a [`plan::Plan`] with
//! OpenCASCADE.

pub mod drawing;
mod error;
pub mod identify;
pub mod lift;
pub mod plan;
pub mod polygon;
mod progress;
pub mod readings;
mod scatter;
mod sets;

pub use error::Error;
pub use progress::{Progress, Stage};

/// Result of every fallible function of this crate's stages.
pub type Result<T, E = Error> = std::result::Result<T, E>;
