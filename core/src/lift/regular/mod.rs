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
mod concede;
mod draft;
mod faults;
mod fit;
mod order;
mod prisms;
mod problem;
mod redraw;
mod report;
mod rounds;
mod snaps;
#[cfg(test)]
mod tests;
mod touches;

pub use report::{Regular, Snap};

use super::directions::{Directions, is_exact, is_rounded, recognised};
use super::sheet::Sheet;
use super::{Lift, LiftError, LiftMethod, LiftOptions, solve};
use crate::drawing::{Drawing, Projection};
use crate::identify::Face;
use draft::Draft;
use faults::Faults;

/// A miss of this many errors counts no more than one of so many.
const WILD: f64 = 5.0;

/// What a number that a reading leaves to the fit costs, in squared errors: between Akaike's 2 and
/// the logarithm of the number of coordinates (Schwarz 1978).
const FREEDOM: f64 = 3.0;

/// What a surface costs that is not along an axis of the frame, in squared errors: parts have about
/// ten times as many that are. A frame that is not the part's can fit as well, but makes more surfaces
/// oblique, and usual angles are met by chance.
const OBLIQUE: f64 = 5.0;

/// What a condition that is missed by one error costs, and the most that it may.
const OPEN: f64 = 100.0;
const MOST_OPEN: f64 = 1000.0;

/// What two neighbouring faces in one plane cost: the flat drawing fits itself. An edge that vanishes
/// and a face that crosses itself cost as much, as no solid has them.
const FLAT: f64 = 30.0;

/// What a drawing costs that is flat as a whole.
const SHEET: f64 = 3000.0;

/// Sine of the angle below which neighbouring planes are one.
const BENT: f64 = 0.02;

/// Sine of the angle within which the axes of two readings are the same.
const TWIN: f64 = 0.02;

/// A reading is not doubted if its fit is no more than so many times as inexact as its directions,
/// conditions miss by less than this, and that share of the planes and cylinders is square.
const LOUD: f64 = 1.5;
const CLOSED: f64 = 1e-7;
const SQUARE: f64 = 0.9;

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
    let exact = || LiftError::NoDirections("the drawing is exact".into());
    let readings = match drawing.projection {
        Projection::Orthographic if is_exact(drawing) => return Err(exact()),
        Projection::Orthographic => Directions::coarse(drawing),
        Projection::Perspective { .. } => {
            let mut readings = Directions::candidates(drawing)?;
            readings.retain(|r| r.precision >= EXACT * drawing.size());
            readings
        }
    };
    let mut tried: Vec<Attempt> = Vec::new();
    let mut seen: Vec<Directions> = Vec::new();
    let mut refusal = exact();
    for reading in readings {
        let reading = if options.flip {
            reading.reversed()
        } else {
            reading
        };
        let drawn = recognised(drawing, reading.precision);
        let reading = prisms::completed(&drawn, faces, reading);
        if seen.iter().any(|other| is_same(other, &reading)) {
            continue;
        }
        match attempt(&drawn, faces, &reading) {
            Ok(found) => {
                let sure = found.is_sure();
                tried.push(found);
                if sure {
                    break;
                }
            }
            Err(error) => refusal = error,
        }
        seen.push(reading);
    }
    // All are compared at one level of noise, which what is flat does not tell.
    let told = tried
        .iter()
        .filter(|a| a.flat == 0 && !a.faults.flat)
        .map(|a| a.noise);
    let noise = told
        .chain(tried.iter().map(|a| 10.0 * a.noise))
        .fold(f64::INFINITY, f64::min);
    let best = tried
        .into_iter()
        .min_by(|a, b| a.cost(noise).total_cmp(&b.cost(noise)));
    best.map(|found| found.lift).ok_or(refusal)
}

/// Whether two readings place the same edges and circles along nearly the same axes.
fn is_same(a: &Directions, b: &Directions) -> bool {
    a.precision == b.precision
        && a.axes.len() == b.axes.len()
        && a.axes.iter().zip(&b.axes).all(|(p, q)| {
            p.edges == q.edges
                && p.circles == q.circles
                && p.direction.cross(q.direction).length() < TWIN
        })
}

/// Whether a drawing may be inexact, from its lift as it is drawn.
pub(super) fn is_wanted(drawing: &Drawing, lift: Option<&Lift>) -> bool {
    let rounded = || drawing.projection == Projection::Orthographic && is_rounded(drawing);
    let exact = |l: &Lift| {
        let explained =
            Directions::estimate(drawing).is_ok_and(|d| d.precision < SHARP * drawing.size());
        l.method == LiftMethod::Exact && l.conflicts.is_empty() && explained && !rounded()
    };
    !lift.is_some_and(exact)
}

/// One reading made regular. Lengths are in sizes of the drawing.
struct Attempt {
    lift: Lift,
    /// The level of noise that the fit shows.
    noise: f64,
    /// Whether that is about what the directions showed.
    fits: bool,
    /// Distances of vertices from where they are drawn.
    misses: Vec<f64>,
    /// Largest miss of a condition.
    violation: f64,
    /// Numbers left to the fit.
    freedom: usize,
    /// Surfaces along no axis of the model.
    oblique: usize,
    /// Edges between planes that are one.
    flat: usize,
    /// What no solid has.
    faults: Faults,
    /// Share of the surfaces that are along known directions of a whole frame.
    square: f64,
}

impl Attempt {
    /// How badly it fits, in squared errors, if the drawing is that inexact.
    fn cost(&self, noise: f64) -> f64 {
        let misses = self.misses.iter().map(|m| (m / noise).min(WILD).powi(2));
        misses.sum::<f64>()
            + (OPEN * self.violation / noise).min(MOST_OPEN)
            + FLAT * (self.flat + self.faults.vanished.len() + self.faults.tangled.len()) as f64
            + if self.faults.flat { SHEET } else { 0.0 }
            + FREEDOM * self.freedom as f64
            + OBLIQUE * self.oblique as f64
    }

    /// Whether no other reading need be tried.
    fn is_sure(&self) -> bool {
        let sound = self.flat == 0 && self.faults.count() == 0 && !self.faults.flat;
        self.fits && sound && self.violation < CLOSED && self.square > SQUARE
    }
}

/// Makes one reading regular.
fn attempt(drawing: &Drawing, faces: &[Face], reading: &Directions) -> Result<Attempt, LiftError> {
    let sheet = Sheet::new(drawing, faces, reading);
    let solved = solve::solve_open(&sheet)?;
    let mut draft = Draft::new(&sheet, &solved.heights(&sheet))?;
    let fitted = snaps::settle(&mut draft)?;
    let fitted = order::untangle(&mut draft, fitted);
    let mut misses = fitted.misses;
    misses.truncate(drawing.vertices.len());
    Ok(Attempt {
        noise: draft.noise,
        fits: draft.noise < LOUD * reading.precision / drawing.size(),
        violation: fitted.violation,
        freedom: draft.freedom(),
        oblique: draft.oblique(),
        flat: flat(&draft),
        faults: Faults::of(&draft),
        square: if reading.is_frame() {
            draft.square_share()
        } else {
            0.0
        },
        lift: redraw::lift(&draft, fitted.violation, common::snapped(&draft)),
        misses,
    })
}

/// Number of edges between planes that are one.
fn flat(draft: &Draft<'_, '_>) -> usize {
    let edges = 0..draft.sheet.drawing.edges.len();
    let is_flat = |e: &usize| {
        draft.beside(*e).is_some_and(|[a, b]| {
            let normals = [a, b].map(|s| {
                let dir = draft.problem.bodies[s].dir;
                draft.problem.direction(dir, &draft.problem.x)
            });
            draft.is_plane(a) && draft.is_plane(b) && normals[0].cross(normals[1]).length() < BENT
        })
    };
    edges.filter(is_flat).count()
}
