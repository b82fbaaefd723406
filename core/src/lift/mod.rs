//! Lifting: from a drawing with faces to depth.
//!
//! 1. [`directions`] reads dominant directions off the drawing,
//! 2. the rows of the depth problem are linear in the depths and the planes of faces ([`system`]),
//! 3. they are solved as least squares if they agree, in the L1 norm if not,
//! 4. every plane, cylinder, cone, sphere and torus gets its surface.

mod assumed;
mod bends;
mod blame;
mod camera;
mod chance;
mod circle;
mod coaxial;
mod completion;
mod conflicts;
mod dense;
pub mod directions;
mod error;
mod evident;
mod fillets;
mod gauge;
mod heights;
mod inclined;
mod metric;
mod model;
mod pieces;
mod posture;
mod regular;
mod revolved;
mod ring_torus;
mod rows;
mod rulings;
mod shape;
mod sheet;
mod similar;
mod solve;
mod split;
mod straight;
mod surfaces;
mod sweep;
pub mod system;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_bends;
#[cfg(test)]
mod tests_central;
mod truth;

pub use camera::Camera;
pub(crate) use circle::{circle_fit, circle_through};
pub use error::LiftError;
pub use metric::depth_error;
pub use model::{Conflict, Lift, LiftMethod, LiftOptions, LiftedCurve, Surface};
pub(crate) use pieces::{Pieces, Readings, Tilt};
pub use regular::{Regular, Snap};
pub(crate) use sweep::Sweep;
pub use truth::true_lift;

use glam::DVec3;

use crate::drawing::{Drawing, Projection};
use crate::identify::Face;
use crate::{Progress, Result, Stage};
use directions::Directions;
use posture::{Posture, explained};
use sheet::Sheet;
use solve::Solved;

/// Recovers the depth of every vertex and the surface of every face whose kind is known.
///
/// An orthographic drawing has two readings that are mirror images in depth (Necker reversal). The
/// default is the model seen from above: of the dominant directions, the one that is most vertical
/// on the page has its upper end towards the viewer. [`LiftOptions::flip`] takes the other.
///
/// A perspective drawing has one reading, and no scale: [`Lift::camera`] holds its focal length and
/// principal point, given or estimated from vanishing points.
///
/// Faces need not be right: rows that contradict the others are dropped, and
/// [`Lift::conflicts`] names the faces.
///
/// # Errors
/// [`LiftError`]: no directions, a degenerate view, a focal length that nothing tells, or vertices
/// whose depth nothing fixes. [`Error::Cancelled`](crate::Error::Cancelled) if `progress` asked to stop.
pub fn lift(
    drawing: &Drawing,
    faces: &[Face],
    options: &LiftOptions,
    progress: Progress<'_>,
) -> Result<Lift> {
    progress.report(Stage::Lift, 0.0)?;
    let exact = lift_exact(drawing, faces, options, progress);
    if matches!(&exact, Err(crate::Error::Cancelled)) {
        return exact;
    }
    // Sweeps are exact, or there are none.
    let swept = exact
        .as_ref()
        .is_ok_and(|l| !l.curves.is_empty() && l.conflicts.is_empty());
    if !swept
        && regular::is_wanted(drawing, exact.as_ref().ok())
        && let Ok(lift) = regular::lift(drawing, faces, options)
    {
        return Ok(lift);
    }
    exact
}

/// Lifts a drawing as it is drawn.
fn lift_exact(
    drawing: &Drawing,
    faces: &[Face],
    options: &LiftOptions,
    progress: Progress<'_>,
) -> Result<Lift> {
    if options.flip && matches!(drawing.projection, Projection::Perspective { .. }) {
        return Err(LiftError::NoReversal.into());
    }
    let sweeps = sweep::sweeps(drawing);
    let readings = match Directions::candidates(drawing) {
        Ok(readings) => sweep::readings(drawing, &sweeps, readings),
        Err(_) if !sweeps.is_empty() => sweep::readings(drawing, &sweeps, Vec::new()),
        Err(error) => return Err(error.into()),
    };
    let mut readings: Vec<(usize, Directions)> = readings
        .into_iter()
        .map(|reading| {
            let reading = if options.flip {
                reading.reversed()
            } else {
                reading
            };
            let shown = explained(&reading);
            let (reading, told) = bends::extended(drawing, faces, reading);
            (shown + told, inclined::extended(drawing, reading))
        })
        .collect();
    // A normal that bends go on from is the true one of its circle. A frame has no such doubt.
    if readings.first().is_some_and(|(_, r)| r.is_frame()) {
        readings.iter_mut().for_each(|(all, r)| *all = explained(r));
    } else if readings.iter().any(|(all, r)| *all > explained(r)) {
        readings.sort_by_key(|(all, _)| std::cmp::Reverse(*all));
    }
    let most = readings.iter().map(|r| r.0).max().unwrap_or(0);
    let mut best: Option<Choice> = None;
    let mut refusal: Option<LiftError> = None;
    let count = readings.len();
    for (i, (all, reading)) in readings.into_iter().enumerate() {
        progress.report(Stage::Lift, 0.2 + 0.8 * i as f64 / count as f64)?;
        let rival = all == most;
        let settled = best.as_ref().is_some_and(|b| b.contradictions == 0);
        // What explains little contradicts little.
        let shows_little = 2 * all < most && reading.swept.is_empty();
        if (settled && !rival) || shows_little {
            continue;
        }
        match choice(drawing, faces, reading, rival) {
            Ok(choice) => {
                if best.as_ref().is_none_or(|b| choice.is_better_than(b)) {
                    best = Some(choice);
                }
            }
            Err(error) => {
                if refusal.as_ref().is_none_or(|r| error.open() < r.open()) {
                    refusal = Some(error);
                }
            }
        }
    }
    let lift = match (best, refusal) {
        (Some(choice), _) => choice.finish(drawing, faces),
        (None, Some(error)) => return Err(error.into()),
        (None, None) => return Err(LiftError::NoDirections("no reading".into()).into()),
    };
    progress.report(Stage::Lift, 1.0)?;
    Ok(lift)
}

/// A solved reading. Its surfaces, which cost most, are fitted once it is chosen.
struct Choice {
    reading: Directions,
    solved: Solved,
    /// The faces that `solved` is of, if they are not the given ones.
    mended: Option<Mended>,
    /// Number of rows that contradict it, and of faces left as they are though no depth makes them
    /// right.
    contradictions: usize,
    /// Whether no other reading explains more edges.
    rival: bool,
    posture: Posture,
}

/// Faces in the place of the given ones, so that they agree.
struct Mended {
    /// The faces taken apart.
    split: split::Split,
    /// Which of the given faces were taken for something else.
    blamed: Vec<usize>,
}

impl Choice {
    /// Whether this reading is to be believed rather than one before it, which is likelier by
    /// itself: if it has far fewer contradictions, or explains as much and stands more naturally.
    fn is_better_than(&self, other: &Self) -> bool {
        2 * self.contradictions < other.contradictions
            || (self.rival
                && other.rival
                && self.contradictions <= other.contradictions
                && self.posture > other.posture)
    }

    fn finish(&self, drawing: &Drawing, faces: &[Face]) -> Lift {
        let sheet = Sheet::new(drawing, faces, &self.reading);
        let Some(Mended { split, blamed }) = &self.mended else {
            return finish(&sheet, &self.solved);
        };
        let parts = Sheet::new(drawing, &split.faces, &self.reading);
        let mut lift = finish(&parts, &self.solved);
        lift.surfaces = gathered(&parts, split, &lift.surfaces, faces.len());
        lift.conflicts = conflicts::conflicts(&sheet, &lift.depths, &lift.surfaces, blamed);
        lift.method = LiftMethod::L1;
        lift
    }
}

/// Solves one reading: as it is if its faces agree, else with the faces that do not taken apart, and
/// the fewest of them taken for something else.
fn choice(
    drawing: &Drawing,
    faces: &[Face],
    reading: Directions,
    rival: bool,
) -> std::result::Result<Choice, LiftError> {
    let sheet = Sheet::new(drawing, faces, &reading);
    let whole = solve::solve(&sheet);
    let posture = |sheet: &Sheet<'_>, solved: &Solved| Posture::of(sheet, |v| solved.height(v));
    let evident: Vec<usize> = (0..faces.len())
        .filter(|&f| !evident::evident(&sheet, f).is_empty())
        .collect();
    let contradictions = whole
        .as_ref()
        .map_or(usize::MAX, |w| w.dropped() + evident.len());
    if contradictions > 0
        && let Some(split) = split::split(drawing, faces, &evident, &reading)
        && let broken = split.parts_of(&evident)
        && let Ok(blame) = blame::blame(drawing, split.faces, &broken, &reading)
        && blame.contradictions() < contradictions
    {
        let parts = Sheet::new(drawing, &blame.faces, &reading);
        let mut blamed: Vec<usize> = blame.wrong.iter().map(|&p| split.owners[p]).collect();
        blamed.sort_unstable();
        return Ok(Choice {
            contradictions: blame.contradictions(),
            posture: posture(&parts, &blame.solved),
            reading,
            mended: Some(Mended {
                split: split::Split {
                    faces: blame.faces,
                    owners: split.owners,
                },
                blamed,
            }),
            solved: blame.solved,
            rival,
        });
    }
    let solved = whole?;
    Ok(Choice {
        contradictions,
        posture: posture(&sheet, &solved),
        reading,
        solved,
        mended: None,
        rival,
    })
}

/// Surfaces of whole faces: each one that of its part with most vertices.
fn gathered(
    parts: &Sheet<'_>,
    split: &split::Split,
    surfaces: &[Surface],
    count: usize,
) -> Vec<Surface> {
    let mut all = vec![(0, Surface::Unknown); count];
    for (part, (&owner, surface)) in split.owners.iter().zip(surfaces).enumerate() {
        let corners = parts.corners[part].len();
        if corners > all[owner].0 {
            all[owner] = (corners, *surface);
        }
    }
    all.into_iter().map(|(_, surface)| surface).collect()
}

fn finish(sheet: &Sheet<'_>, solved: &Solved) -> Lift {
    let count = sheet.drawing.vertices.len();
    let camera = *sheet.camera();
    let depth = |v: usize| camera.depth(solved.height(v));
    // In a parallel projection the place in depth is free.
    let mean = if camera.is_parallel() {
        (0..count).map(depth).sum::<f64>() / count.max(1) as f64
    } else {
        0.0
    };
    let depths: Vec<f64> = (0..count).map(|v| depth(v) - mean).collect();
    let surfaces: Vec<Surface> = surfaces::surfaces(sheet, &solved.heights(sheet))
        .into_iter()
        .map(|surface| surface.lowered(mean))
        .collect();
    Lift {
        conflicts: conflicts::conflicts(sheet, &depths, &surfaces, &[]),
        depths,
        camera,
        surfaces,
        directions: sheet.directions.axes.iter().map(|a| a.direction).collect(),
        method: solved.method,
        residual: solved.residual(),
        regular: None,
        curves: curves(sheet, solved, mean),
    }
}

/// The curves of swept edges, moved along the lines of sight to where the sweep was lifted.
fn curves(sheet: &Sheet<'_>, solved: &Solved, mean: f64) -> Vec<LiftedCurve> {
    let camera = sheet.camera();
    let mut all = Vec::new();
    for sweep in &sheet.directions.swept {
        let ends: Vec<(f64, f64)> = sweep
            .ends(sheet.drawing)
            .map(|(_, v, z)| (camera.depth(solved.height(v)), z))
            .collect();
        let count = ends.len().max(1) as f64;
        let share = |f: fn(&(f64, f64)) -> f64| ends.iter().map(f).sum::<f64>() / count;
        let shift = share(|(lifted, own)| lifted - own) - mean;
        let growth = share(|(lifted, own)| lifted / own);
        let place = |p: &DVec3| match camera {
            Camera::Parallel => *p + DVec3::Z * shift,
            Camera::Central { .. } => *p * growth,
        };
        all.extend(sweep.edges.iter().map(|swept| LiftedCurve {
            edge: swept.edge,
            points: swept.points.iter().map(place).collect(),
            tangents: swept.tangents,
        }));
    }
    all
}
