//! How well identified faces agree with a drawing's truth (paper, section 4.3).
//!
//! A predicted face matches a true one if their sets of edges are equal; a loop likewise. Precision
//! and recall are computed for each drawing and averaged over drawings, so a part with many faces
//! weighs no more than one with few. The type rate is pooled over the matched faces of all
//! drawings, as the paper words it.
//!
//! Conventions where the paper is silent:
//! - Matching is one to one: two predictions of the same edge set match only one true face.
//! - An empty prediction has precision and recall 0, and so has a drawing that an engine refused.
//! - `exact` asks for the right sets of edges, no more and no fewer; types do not count in it.

mod calibration;
mod mistakes;
mod score;
mod summary;

pub use calibration::{BINS, Bin, Bins};
pub use mistakes::Mistakes;
pub use score::DrawingScore;
pub use summary::{Summary, median};

#[cfg(test)]
mod tests;
