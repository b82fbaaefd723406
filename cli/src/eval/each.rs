//! The line of one drawing in the file of `eval --each`.

use faceformer::drawing::{Drawing, SurfaceKind, Truth};
use faceformer::identify::metrics::DrawingScore;
use serde::Serialize;

use super::measure::Measured;

/// What a drawing is and how it was measured. Times are in milliseconds; without `--solids` the figures
/// of solids are left out, and with it those of a stage that failed are `null`.
#[derive(Debug, Serialize)]
pub(crate) struct Row<'a> {
    /// The drawing.
    id: &'a str,
    /// Edges of the drawing.
    edges: usize,
    /// Whether its truth has a face that is no plane.
    curved: bool,
    /// Whether its truth has a face with several loops.
    multi_loop: bool,
    /// Whether the faces are the true ones.
    exact: bool,
    /// Whether the loops are.
    loops_exact: bool,
    #[serde(flatten)]
    score: &'a DrawingScore,
    /// The further figures with `--solids`.
    #[serde(flatten)]
    solid: Option<Solid>,
}

/// Figures of a drawing's solid, as in [`Measured`].
#[derive(Debug, Serialize)]
struct Solid {
    lifted: bool,
    valid: bool,
    lift_ms: Option<f64>,
    solid_ms: Option<f64>,
    /// Distance from the true solid, in its half diagonals.
    chamfer: Option<f64>,
    /// True right angles between neighbouring planes, and those of them that are exact in the lift.
    right_angles: Option<[usize; 2]>,
}

impl<'a> Row<'a> {
    /// The line of a drawing, with the figures of its solid if `solids` is set.
    pub(crate) fn of(
        drawing: &'a Drawing,
        truth: &Truth,
        measured: &'a Measured,
        solids: bool,
    ) -> Self {
        let score = &measured.score;
        Self {
            id: &drawing.id,
            edges: drawing.edges.len(),
            curved: truth.faces.iter().any(|f| f.kind != SurfaceKind::Plane),
            multi_loop: truth.faces.iter().any(|f| f.loops.len() > 1),
            exact: score.exact(),
            loops_exact: score.loops_exact(),
            score,
            solid: solids.then(|| Solid {
                lifted: measured.lifted,
                valid: measured.valid,
                lift_ms: measured.lift_ms,
                solid_ms: measured.solid_ms,
                chamfer: measured.compared.as_ref().map(|c| c.chamfer),
                right_angles: measured.right_angles.map(|a| [a.wanted, a.exact]),
            }),
        }
    }
}
