//! Regularisation: what was meant by a drawing that is drawn inexactly.
//!
//! A drawing by hand is off by a half percent of its size, so that no planes close and no angles are
//! right. Its frame is found by likelihood (`directions::coarse`), its depth roughly as for any
//! drawing. Then discrete questions are decided: which normals and axes are those of the frame, at
//! right angles to one, parallel or at usual angles, which cylindrical faces are one, touch, share
//! an axis or a radius. What is decided holds exactly in a least-squares problem over vertices,
//! planes, cylinders and the camera's turn ([`problem`], [`fit`]), which moves the drawing as
//! little as it can. The result is a drawing that is exact ([`Regular`]) and its lift.

mod common;
mod draft;
mod fit;
mod problem;
mod redraw;
mod report;
mod rounds;
mod snaps;
#[cfg(test)]
mod tests;

pub use report::{Regular, Snap};

use super::directions::Directions;
use super::sheet::Sheet;
use super::{Lift, LiftError, LiftMethod, LiftOptions, solve};
use crate::drawing::{Curve2, Drawing, Projection};
use crate::identify::Face;
use draft::Draft;

/// Errors within which a curve may be an ellipse.
const CURVE_ERRORS: f64 = 3.0;

/// A miss of this many errors counts no more than one of so many.
const WILD: f64 = 5.0;

/// A reading fits badly if vertices miss by more than this, squared errors in the mean.
const BAD: f64 = 6.0;

/// A drawing whose coordinates are off by less than this share of its size is exact enough.
const EXACT: f64 = 3e-4;

/// A drawing that is explained to this share of its size is exact.
const SHARP: f64 = 2e-5;

/// What a drawing that no exact reading explains was meant to be.
///
/// # Errors
/// [`LiftError`] if no frame is found or nothing can be solved.
pub(super) fn lift(
    drawing: &Drawing,
    faces: &[Face],
    options: &LiftOptions,
) -> Result<Lift, LiftError> {
    let readings = match drawing.projection {
        Projection::Orthographic => Directions::coarse(drawing),
        Projection::Perspective { .. } => Directions::candidates(drawing)?,
    };
    let mut best: Option<(f64, Lift)> = None;
    let mut refusal = LiftError::NoDirections("no reading".into());
    for reading in readings {
        if reading.precision < EXACT * drawing.size() {
            break;
        }
        let reading = if options.flip {
            reading.reversed()
        } else {
            reading
        };
        let drawn = recognised(drawing, CURVE_ERRORS * reading.precision);
        match attempt(&drawn, faces, &reading) {
            Ok((cost, lift)) => {
                // Readings come by likelihood, and one that says less always fits.
                let bad = cost > BAD * drawing.vertices.len() as f64;
                if best.as_ref().is_none_or(|(least, _)| cost < 0.5 * least) {
                    best = Some((cost, lift));
                }
                if !bad {
                    break;
                }
            }
            Err(error) => refusal = error,
        }
    }
    best.map(|(_, lift)| lift).ok_or(refusal)
}

/// Whether a drawing may be inexact, from its lift as it is drawn.
pub(super) fn is_wanted(drawing: &Drawing, lift: Option<&Lift>) -> bool {
    let exact = |l: &Lift| {
        let explained =
            Directions::estimate(drawing).is_ok_and(|d| d.precision < SHARP * drawing.size());
        l.method == LiftMethod::Exact && l.conflicts.is_empty() && explained
    };
    !lift.is_some_and(exact)
}

/// The drawing with curves recognised that are ellipses within its noise.
fn recognised(drawing: &Drawing, noise: f64) -> Drawing {
    let mut drawing = drawing.clone();
    for edge in &mut drawing.edges {
        if matches!(edge.curve, Curve2::Polyline)
            && let curve @ Curve2::Ellipse(_) = Curve2::recognise_within(&edge.points, noise)
        {
            edge.curve = curve;
        }
    }
    drawing
}

/// One reading made regular, and how badly it fits.
fn attempt(
    drawing: &Drawing,
    faces: &[Face],
    reading: &Directions,
) -> Result<(f64, Lift), LiftError> {
    let sheet = Sheet::new(drawing, faces, reading);
    let solved = solve::solve_open(&sheet)?;
    let mut draft = Draft::new(&sheet, &solved.heights(&sheet))?;
    let (fitted, snapped) = snaps::settle(&mut draft)?;
    let noise = draft.noise;
    let misses = fitted.misses.iter().take(drawing.vertices.len());
    let cost: f64 = misses.map(|m| (m / noise).min(WILD).powi(2)).sum();
    let open = fitted.violation / noise;
    let lift = redraw::lift(&draft, fitted.violation, snapped);
    Ok((cost + 100.0 * open.min(10.0), lift))
}
