//! Frames that an axis and further lines would fix.

use std::f64::consts::FRAC_PI_2;

use glam::{DMat3, DVec3};

use super::lines::Lines;
use crate::lift::Camera;
use crate::lift::directions::AGREE;

/// Lines that vote, the longest ones.
const VOTING: usize = 100;

/// Frames for each axis.
const FRAMES: usize = 3;

/// Error of an angle, radians, beyond which it says nothing.
const VAGUE: f64 = 0.05;

/// Turn of a frame about its axis, by a line.
struct Turn {
    angle: f64,
    error: f64,
    weight: f64,
    second: DVec3,
}

/// The frames around an axis that most lines speak for, with their errors. A line that is at right
/// angles to the axis follows one of the two other axes, so angles count modulo 90 degrees.
pub(super) fn around(lines: &Lines, camera: &Camera, axis: DVec3, error: f64) -> Vec<(DMat3, f64)> {
    let x = axis.any_orthonormal_vector();
    let y = axis.cross(x);
    let turns: Vec<Turn> = lines
        .all
        .iter()
        .take(VOTING)
        .filter(|line| !lines.follows(camera, line, axis, error))
        .filter_map(|line| {
            let (n, n_error) = lines.plane(camera, line);
            let cross = axis.cross(n);
            let error = (error + n_error) / cross.length();
            let second = cross.try_normalize()?;
            (error < VAGUE).then(|| Turn {
                angle: second.dot(y).atan2(second.dot(x)).rem_euclid(FRAC_PI_2),
                error,
                weight: lines.salience(line),
                second,
            })
        })
        .collect();
    let near = |a: &Turn, b: &Turn| {
        let d = (a.angle - b.angle).abs();
        d.min(FRAC_PI_2 - d) < AGREE * (a.error + b.error)
    };
    let mut ranked: Vec<(f64, &Turn)> = turns
        .iter()
        .map(|t| {
            let agreeing = turns.iter().filter(|s| near(t, s));
            (agreeing.map(|s| s.weight).sum(), t)
        })
        .collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut chosen: Vec<&Turn> = Vec::new();
    for (_, turn) in ranked {
        if chosen.len() == FRAMES {
            break;
        }
        if !chosen.iter().any(|t| near(t, turn)) {
            chosen.push(turn);
        }
    }
    let frame = |t: &&Turn| {
        let second = t.second.reject_from_normalized(axis).normalize();
        let frame = DMat3::from_cols(axis, second, axis.cross(second));
        (frame, t.error + error)
    };
    chosen
        .iter()
        .map(frame)
        .filter(|f| f.0.is_finite())
        .collect()
}
