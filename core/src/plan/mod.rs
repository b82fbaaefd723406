//! The plan: a neutral B-rep, ready for a CAD kernel.

mod error;
mod model;

pub use error::PlanError;
pub use model::{Curve3, Plan, PlanEdge, PlanFace, Surface3};
