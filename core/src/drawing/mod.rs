//! The wireframe drawing: a graph of vertices and edges with curve geometry.
//!
//! A [`Drawing`] is valid by construction: every edge names existing vertices, its polyline begins
//! and ends there, all numbers are finite and the size is within [`Limits`]. Input that lists
//! curves without vertices goes through clean-up first and becomes a [`CleanDrawing`].

mod clean;
mod coedge;
mod curve;
pub mod dataset;
mod diagnose;
mod ellipse;
mod error;
mod fold;
mod format;
mod graph;
mod grid;
mod model;
mod recognise;
mod report;

pub use clean::{CleanOptions, clean};
pub use coedge::CoEdge;
pub use curve::{Curve2, EllipseArc};
pub use diagnose::diagnose;
pub use error::DrawingError;
pub(crate) use fold::leaving;
pub use format::read;
pub use graph::Graph;
pub use model::{Drawing, Edge, Limits, Projection, SurfaceKind, Truth, TruthFace};
pub use report::{CleanDrawing, Finding, FindingKind, Report, Severity};
