//! Lifting: from a drawing with faces to depth.

pub mod directions;
mod error;
mod model;
pub mod system;

pub use error::LiftError;
pub use model::{Conflict, Lift, LiftMethod, LiftOptions, Surface};
