//! The camera of a drawing that does not tell its focal length.

use glam::{DVec2, DVec3};

use super::Open;
use super::lines::Lines;
use super::pencils::{Pencil, pencils};
use super::reading::{Reading, readings};
use crate::drawing::Drawing;
use crate::lift::Camera;

/// Pencils that cameras are made from, and cameras that are tried.
const PENCILS: usize = 7;
const CAMERAS: usize = 10;

/// Focal lengths beyond these, in units of the drawing's size, are none: drawings are neither that
/// wide nor that flat.
const SHORTEST: f64 = 0.2;
const LONGEST: f64 = 60.0;

/// Cameras whose focal lengths differ by less than this share are tried once.
const ALIKE: f64 = 0.005;

/// Focal length, in units of the drawing's size, under which vanishing points are first sought.
/// Which lines meet in a point does not depend on it, only how errors are weighed.
const PROVISIONAL: f64 = 2.5;

/// Readings of a drawing, with the camera among what is fitted; the most likely first.
///
/// # Errors
/// The number of vanishing points found, if they do not tell a focal length.
pub(super) fn readings_of(lines: &Lines, drawing: &Drawing) -> Result<Vec<Reading>, usize> {
    let principal = center(lines);
    let focal = PROVISIONAL * lines.size;
    let found = pencils(lines, &Camera::Central { principal, focal }, &[]);
    // In homogeneous coordinates: principal - f l_xy / l_z.
    let point = |p: &Pencil| {
        let l = p.direction;
        (principal * l.z - l.truncate() * focal).extend(l.z)
    };
    let points: Vec<(DVec3, f64)> = found
        .iter()
        .take(PENCILS)
        .map(|p| (point(p), p.salience))
        .collect();
    let mut best: Vec<Reading> = Vec::new();
    let mut any = false;
    for (cameras, open) in [
        (of_pairs(&points, lines.size), Open::Focal),
        (of_triples(&points, lines.size), Open::FocalAndPrincipal),
    ] {
        for camera in cameras {
            any = true;
            let found = readings(lines, drawing, camera, open);
            let votes = |r: &[Reading]| r.first().map_or(0.0, |r| r.votes);
            if votes(&found) > votes(&best) {
                best = found;
            }
        }
    }
    if any && !best.is_empty() {
        Ok(best)
    } else {
        Err(points.len().min(2))
    }
}

/// Middle of the drawn lines.
fn center(lines: &Lines) -> DVec2 {
    let sum: DVec2 = lines.all.iter().map(|l| l.middle).sum();
    sum / lines.all.len().max(1) as f64
}

/// Cameras with the principal point at the origin: two vanishing points at right angles have
/// `f^2 = -v1.v2`.
fn of_pairs(points: &[(DVec3, f64)], size: f64) -> Vec<Camera> {
    let mut all = Vec::new();
    for (i, (a, weight)) in points.iter().enumerate() {
        for (b, other) in &points[i + 1..] {
            let square = -a.truncate().dot(b.truncate()) / (a.z * b.z);
            all.push((weight + other, DVec2::ZERO, square.sqrt()));
        }
    }
    chosen(all, size)
}

/// Cameras in general: the principal point is the orthocentre of three vanishing points at right
/// angles.
fn of_triples(points: &[(DVec3, f64)], size: f64) -> Vec<Camera> {
    let finite: Vec<(DVec2, f64)> = points
        .iter()
        .map(|(v, weight)| (v.truncate() / v.z, *weight))
        .filter(|(v, _)| v.length() < LONGEST * LONGEST * size)
        .collect();
    let mut all = Vec::new();
    for (i, (a, first)) in finite.iter().enumerate() {
        for (j, (b, second)) in finite.iter().enumerate().skip(i + 1) {
            for (c, third) in &finite[j + 1..] {
                // (p - a).(b - c) = 0 and (p - b).(c - a) = 0.
                let (u, v) = (*b - *c, *c - *a);
                let (r, s) = (u.dot(*a), v.dot(*b));
                let p = DVec2::new(r * v.y - s * u.y, s * u.x - r * v.x) / u.perp_dot(v);
                let square = -(*a - p).dot(*b - p);
                all.push((first + second + third, p, square.sqrt()));
            }
        }
    }
    chosen(all, size)
}

fn chosen(mut all: Vec<(f64, DVec2, f64)>, size: f64) -> Vec<Camera> {
    all.retain(|(_, p, f)| p.is_finite() && (SHORTEST * size..LONGEST * size).contains(f));
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut cameras: Vec<(DVec2, f64)> = Vec::new();
    for (_, principal, focal) in all {
        let same = |(p, f): &(DVec2, f64)| {
            (f - focal).abs() < ALIKE * focal && p.distance(principal) < ALIKE * focal
        };
        if cameras.len() < CAMERAS && !cameras.iter().any(same) {
            cameras.push((principal, focal));
        }
    }
    let camera = |(principal, focal)| Camera::Central { principal, focal };
    cameras.into_iter().map(camera).collect()
}
