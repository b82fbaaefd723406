//! The crate's error: one variant a stage, and cancellation.

use crate::drawing::DrawingError;
use crate::identify::IdentifyError;
use crate::lift::LiftError;
use crate::plan::PlanError;

/// Why a stage could not finish. The stage's own error names the edges, vertices or faces.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The drawing cannot be read or used.
    #[error(transparent)]
    Drawing(#[from] DrawingError),
    /// No faces could be identified.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    /// Depth could not be recovered.
    #[error(transparent)]
    Lift(#[from] LiftError),
    /// No consistent B-rep follows from the faces and depths.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The caller's [`Progress`](crate::Progress) asked to stop.
    #[error("cancelled")]
    Cancelled,
}
