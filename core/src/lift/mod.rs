//! Lifting: from a drawing with faces to depth.

mod error;
mod model;
pub mod system;

pub use error::LiftError;
pub use model::{Conflict, Lift, LiftMethod, LiftOptions, Surface};
