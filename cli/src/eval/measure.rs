//! One drawing through the stages, timed and compared with its truth.

use std::time::Instant;

use faceformer::drawing::{Drawing, Truth};
use faceformer::identify::metrics::DrawingScore;
use serde::Serialize;

use crate::stages::FacesFrom;

/// A stage that refused a drawing, or whose result is wrong.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Failed {
    /// The drawing.
    pub(crate) id: String,
    /// `identify`, `lift`, `depth` (lifted, but not as in the truth), `plan` or `build`.
    pub(crate) stage: &'static str,
    /// Why.
    pub(crate) message: String,
}

/// Figures of one drawing.
#[derive(Debug, Clone)]
pub(crate) struct Measured {
    /// Faces and loops against the truth.
    pub(crate) score: DrawingScore,
    /// What went wrong, in the order of the stages.
    pub(crate) failed: Vec<Failed>,
}

/// Takes a drawing through identification and, with `solids`, to its solid.
pub(crate) fn measure(drawing: &Drawing, truth: &Truth, faces: &FacesFrom) -> Measured {
    let mut failed = Vec::new();
    let mut fail = |stage, message| {
        failed.push(Failed {
            id: drawing.id.clone(),
            stage,
            message,
        });
    };
    let start = Instant::now();
    let found = faces.faces(drawing);
    let ms = milliseconds(start);
    let score = match &found {
        Ok(found) => DrawingScore::of(truth, found, ms),
        Err(failure) => {
            fail("identify", failure.to_string());
            DrawingScore::refused(truth)
        }
    };
    Measured { score, failed }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
