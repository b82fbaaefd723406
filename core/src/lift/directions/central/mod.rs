//! Directions in a perspective drawing, from vanishing points.
//!
//! Lines that are parallel in space are drawn through one vanishing point v, and with the principal
//! point p and the focal length f their direction is `l ~ (v - p, -f)` (design, section 4). Three
//! lines and more through one point make a [`Pencil`](pencils::Pencil); circles show their normals,
//! two each (`circles`); an axis and one further line make a hypothesis of a frame (`frames`), and
//! the frame that explains most is fitted to all that agree with it (`fit`).
//!
//! A focal length that is not given follows from vanishing points at right angles (`focal`): from
//! two if the principal point is the drawing's origin, as the format has it, from three if not.

mod circles;
mod eigen;
mod fit;
mod focal;
mod followers;
mod frames;
mod lines;
mod pencils;
mod reading;
#[cfg(test)]
mod tests;

use glam::DVec2;

use super::Directions;
use crate::drawing::Drawing;
use crate::lift::{Camera, LiftError};

pub(super) use circles::circles as drawn_normals;
use lines::Lines;
use reading::Reading;

/// Standard errors of coordinates that are tried, in units of the drawing's size.
const PRECISIONS: [f64; 5] = [6e-7, 1e-5, 1e-4, 1e-3, 4e-3];

/// Chance agreement is told from a match by how much smaller than this share of the size the error
/// is.
const CHANCE: f64 = 0.1;

/// Standard error of the axes, radians, beyond which depth cannot be told.
const MAX_ERROR: f64 = 0.03;

/// A reading with a smaller share of the best one's votes has few conflicts because it says little.
const RIVAL: f64 = 0.6;

/// Readings that are worth a second look when the first one leads to conflicts.
const READINGS: usize = 4;

/// Which numbers of the camera are to be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Open {
    Nothing,
    Focal,
    FocalAndPrincipal,
}

impl Open {
    const fn count(self) -> usize {
        match self {
            Self::Nothing => 0,
            Self::Focal => 1,
            Self::FocalAndPrincipal => 3,
        }
    }
}

/// Readings of a perspective drawing, most likely first; never empty.
///
/// # Errors
/// [`LiftError::NoDirections`] or [`LiftError::Focal`].
pub(super) fn candidates(
    drawing: &Drawing,
    focal: Option<f64>,
) -> Result<Vec<Directions>, LiftError> {
    let size = drawing.size();
    let mut best: Option<(f64, Vec<Reading>)> = None;
    let mut right_angles = None;
    for relative in PRECISIONS {
        let worth = (CHANCE / relative).ln();
        let lines = Lines::new(drawing, relative * size);
        // Coarser precision is worth less a vote and can win by explaining more only.
        if best
            .as_ref()
            .is_some_and(|(bits, _)| *bits >= lines.votes() * worth)
        {
            break;
        }
        let readings = match focal {
            Some(focal) => {
                let camera = Camera::Central {
                    principal: DVec2::ZERO,
                    focal,
                };
                reading::readings(&lines, drawing, camera, Open::Nothing)
            }
            None => focal::readings_of(&lines, drawing).unwrap_or_else(|directions| {
                right_angles = Some(directions);
                Vec::new()
            }),
        };
        let bits = readings.first().map_or(0.0, |r| r.votes * worth);
        // Fitting fewer numbers is no gain where a finer reading explains as much.
        let constraints = |r: &[Reading]| r.first().map_or(0, |r| r.constraints);
        let more =
            |b: &(f64, Vec<Reading>)| bits > b.0 && constraints(&readings) > constraints(&b.1);
        if bits > 0.0 && best.as_ref().is_none_or(more) {
            best = Some((bits, readings));
        }
    }
    let most = best
        .as_ref()
        .map_or(0.0, |(_, r)| r.first().map_or(0.0, |r| r.votes));
    let good: Vec<Directions> = best
        .into_iter()
        .flat_map(|(_, readings)| readings)
        .filter(|r| r.directions.error < MAX_ERROR && r.votes >= RIVAL * most)
        .take(READINGS)
        .map(|mut r| {
            let lines = Lines::new(drawing, r.directions.precision);
            reading::add_pencils(&lines, &mut r.directions);
            reading::add_normals(&lines, drawing, &mut r.directions);
            r.directions
        })
        .collect();
    match (good.is_empty(), right_angles) {
        (false, _) => Ok(good),
        (true, Some(directions)) => Err(LiftError::Focal { directions }),
        (true, None) => Err(LiftError::NoDirections(
            "too few edges lead to common vanishing points, and no circles help".into(),
        )),
    }
}
