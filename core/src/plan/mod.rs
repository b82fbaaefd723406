//! The plan: a neutral B-rep, ready for a CAD kernel.
//!
//! [`plan`] takes a drawing, its faces and their lift, and
//! 1. checks that every edge borders two faces,
//! 2. turns the model upright ([`Orientation`]),
//! 3. snaps surfaces: what was measured becomes what was meant, within the lift's own tolerance,
//! 4. recomputes vertices from the surfaces that meet there,
//! 5. gives every edge its curve: line, circle, ellipse, or a curve through points,
//! 6. orients all loops outwards.
//!
//! It never repairs faces: what does not close is refused by name.

mod chart;
mod conic;
mod curves;
mod error;
mod finish;
mod graze;
mod lengths;
mod measure;
mod model;
mod options;
mod orient;
mod sample;
mod side;
mod silhouette;
mod snap;
mod stage;
mod support;
mod touch;
mod touch_round;
mod upright;
mod uses;
mod vertices;
mod view;

pub use error::PlanError;
pub use model::{Curve3, Plan, PlanEdge, PlanFace, Surface3};
pub use options::{Orientation, PlanOptions};
pub use sample::polyline;
pub use stage::plan;
