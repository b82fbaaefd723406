//! Spheres.

use glam::DVec3;

use super::evidence::Evidence;
use super::flat::best_plane;
use crate::lift::Surface;
use crate::lift::dense::solve;

/// Points this near to one plane, relative to the drawing's size, are on one circle, whatever their errors
/// say.
const FLAT: f64 = 1e-5;

/// Spheres that the boundary suggests: by an outline, through all points, or touching the
/// neighbours of a circle.
pub(super) fn spheres(evidence: &Evidence) -> Vec<Surface> {
    let mut found = Vec::new();
    // The outline is seen as a circle around the centre, at the centre's depth.
    let depths: Vec<f64> = evidence.outline_ends.iter().map(|end| end.0.z).collect();
    for &(center, radius) in evidence.discs.iter().filter(|_| !depths.is_empty()) {
        let mean = depths.iter().sum::<f64>() / depths.len() as f64;
        found.push((center.extend(mean), radius));
    }
    // Without a depth there, on the axis of a circle that is drawn through the centre.
    for &(center, radius) in &evidence.discs {
        for (ring, _) in evidence.rings() {
            let reach = (radius * radius - ring.radius * ring.radius)
                .max(0.0)
                .sqrt();
            for side in [reach, -reach] {
                let at = ring.center + ring.normal * side;
                if at.truncate().distance(center) < 1e-3 * evidence.size {
                    found.push((center.extend(at.z), radius));
                }
            }
        }
    }
    found.extend(in_cone(evidence));
    found.extend(through(evidence));
    for (ring, bound) in evidence.rings() {
        for p in bound.points.iter().take(1) {
            // The normal at the circle, if the neighbour goes on smoothly, meets the axis at the
            // centre.
            let gradient = bound.beside.gradient(*p);
            let out = (*p - ring.center).normalize_or_zero();
            let (across, along) = (gradient.dot(out), gradient.dot(ring.normal));
            if across.abs() > 1e-3 && across.hypot(along) > 0.99 {
                let center = ring.center - ring.normal * (along / across * ring.radius);
                found.push((center, center.distance(*p)));
            }
        }
    }
    let usable = |r: f64| r.is_finite() && r > 1e-5 * evidence.size && r < 1e3 * evidence.size;
    found
        .into_iter()
        .filter(|(center, radius)| center.is_finite() && usable(*radius))
        .map(|(center, radius)| Surface::Sphere { center, radius })
        .collect()
}

/// In a central projection the lines of sight that touch a sphere are a circular cone around the one
/// through its centre, which is as far along it as a known point of the sphere says.
fn in_cone(evidence: &Evidence) -> Vec<(DVec3, f64)> {
    let lines = &evidence.outlines;
    let directions: Vec<DVec3> = lines.iter().map(|line| line.direction).collect();
    if lines.len() < 4 || !evidence.discs.is_empty() {
        return Vec::new();
    }
    // Unit vectors at one angle from an axis are on a plane across it.
    let Some((middle, axis)) = best_plane(&directions) else {
        return Vec::new();
    };
    let cosine = axis.dot(middle);
    let (axis, cosine) = (axis * cosine.signum(), cosine.abs());
    let sine = (1.0 - cosine * cosine).sqrt();
    let from = lines[0].from;
    let mut found = Vec::new();
    // Where a line of sight touches, t cos^2 = axis.p; elsewhere |p - t axis| = t sin.
    for (p, _) in &evidence.outline_ends {
        found.push(axis.dot(*p - from) / (cosine * cosine));
    }
    for p in evidence.points().take(8) {
        let p = p - from;
        let (half, square) = (axis.dot(p), cosine * cosine);
        let root = (half * half - square * p.length_squared()).max(0.0).sqrt();
        found.extend([(half - root) / square, (half + root) / square]);
    }
    found
        .into_iter()
        .map(|t| (from + axis * t, (t * sine).abs()))
        .collect()
}

/// Least squares of `|p|^2 = 2 c.p + k`, which is linear; `None` if the points are on one circle.
fn through(evidence: &Evidence) -> Option<(DVec3, f64)> {
    let points: Vec<DVec3> = evidence.points().collect();
    if points.len() < 4 {
        return None;
    }
    let (origin, normal) = best_plane(&points)?;
    let flat = |p: &DVec3| (*p - origin).dot(normal).abs() < FLAT * evidence.size;
    if points.iter().all(flat) {
        return None;
    }
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let mut matrix = vec![vec![0.0; 4]; 4];
    let mut right = vec![0.0; 4];
    let scale = evidence.size;
    for p in &points {
        let d = (*p - middle) / scale;
        let row = [2.0 * d.x, 2.0 * d.y, 2.0 * d.z, 1.0];
        for i in 0..4 {
            for j in 0..4 {
                matrix[i][j] += row[i] * row[j];
            }
            right[i] += row[i] * d.length_squared();
        }
    }
    let x = solve(matrix, right)?;
    let center = DVec3::new(x[0], x[1], x[2]);
    let radius = (x[3] + center.length_squared()).sqrt();
    Some((middle + center * scale, radius * scale))
}
