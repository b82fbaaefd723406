//! Cones and tori around a known axis, from the profile: distance from the axis over height.

use std::f64::consts::PI;

use glam::DVec2;

use super::axes::Axis;
use super::evidence::Evidence;
use crate::lift::Surface;
use crate::lift::circle::circle_fit;

/// Profiles narrower than this, relative to the drawing's size, are one circle drawn with errors.
const ONE_CIRCLE: f64 = 3e-5;

/// Tubes of more than this many times the drawing's size are none.
const WIDEST: f64 = 100.0;

/// The cylinder around an axis: the mean distance.
pub(super) fn cylinder(evidence: &Evidence, axis: &Axis) -> Option<Surface> {
    let count = evidence.points().count();
    let sum: f64 = evidence.points().map(|p| axis.profile(p).0).sum();
    (count > 0).then(|| Surface::Cylinder {
        origin: axis.origin,
        axis: axis.direction,
        radius: sum / count as f64,
    })
}

/// The cone around an axis: the best line through the profile.
pub(super) fn cone(evidence: &Evidence, axis: &Axis) -> Option<Surface> {
    let points: Vec<DVec2> = evidence.points().map(|p| axis.profile(p).into()).collect();
    if points.len() < 2 {
        return None;
    }
    let middle = points.iter().sum::<DVec2>() / points.len() as f64;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for p in &points {
        let d = *p - middle;
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
    }
    // One circle alone is the boundary of any cone.
    let spread = f64::sqrt((xx + yy) / points.len() as f64);
    if spread < ONE_CIRCLE * evidence.size {
        return None;
    }
    // Direction of the largest spread, towards growing radius.
    let along = DVec2::from_angle(0.5 * (2.0 * xy).atan2(xx - yy));
    let along = if along.x < 0.0 { -along } else { along };
    if along.x < 1e-4 || along.y.abs() < 1e-4 {
        return None;
    }
    let apex = middle.y - middle.x * along.y / along.x;
    let up = along.y.signum();
    Some(Surface::Cone {
        apex: axis.origin + axis.direction * apex,
        axis: axis.direction * up,
        angle: along.x.atan2(along.y.abs()),
    })
}

/// Tori around an axis: the circle through the profile's points if they fix it; else through two of
/// them with the normal at one, which an outline or a neighbour that is touched there gives.
pub(super) fn tori(evidence: &Evidence, axis: &Axis) -> Vec<Surface> {
    let points: Vec<DVec2> = evidence.points().map(|p| axis.profile(p).into()).collect();
    let mut circles: Vec<(DVec2, f64)> = Vec::new();
    if let Some((center, radius, gain)) = circle_fit(points.iter().copied())
        && gain < 1e3
    {
        circles.push((center, radius));
    }
    for (at, normal) in normals(evidence, axis) {
        let far = points
            .iter()
            .max_by(|a, b| a.distance(at).total_cmp(&b.distance(at)));
        if let Some(far) = far {
            // |at + t n - far| = |t|
            let d = *far - at;
            let t = d.length_squared() / (2.0 * normal.dot(d));
            circles.push((at + normal * t, t.abs()));
        }
    }
    circles
        .into_iter()
        .filter(|(center, minor)| {
            let possible = 1e-5 * evidence.size..WIDEST * evidence.size;
            possible.contains(minor) && possible.contains(&center.x)
        })
        .map(|(center, minor)| Surface::Torus {
            center: axis.origin + axis.direction * center.y,
            axis: axis.direction,
            major: center.x,
            minor,
        })
        .collect()
}

/// Tori around an axis through two of its circles alone, from flat to nearly whole tubes; none without
/// outlines, which tell the one from the other.
pub(super) fn bulges(evidence: &Evidence, axis: &Axis) -> Vec<Surface> {
    /// Number of tubes on either side of the upright one.
    const EACH: i32 = 5;
    let points: Vec<DVec2> = evidence.points().map(|p| axis.profile(p).into()).collect();
    let Some((&first, rest)) = points
        .split_first()
        .filter(|_| !evidence.outlines.is_empty())
    else {
        return Vec::new();
    };
    let far = rest.iter().copied().fold(first, |best, p| {
        if p.distance(first) > best.distance(first) {
            p
        } else {
            best
        }
    });
    let (chord, middle) = (far - first, first.midpoint(far));
    let near = |p: &DVec2| p.distance(first).min(p.distance(far)) < 1e-3 * chord.length();
    if !points.iter().all(near) {
        return Vec::new();
    }
    let step = PI / f64::from(2 * (EACH + 1));
    let tube = |i: i32| {
        let bulge = f64::from(i) * step;
        let center = middle + chord.perp() * (0.5 * bulge.tan());
        (center.x > 0.0).then(|| Surface::Torus {
            center: axis.origin + axis.direction * center.y,
            axis: axis.direction,
            major: center.x,
            minor: 0.5 * chord.length() / bulge.cos(),
        })
    };
    (-EACH..=EACH).filter_map(tube).collect()
}

/// Points of the profile with the surface's unit normal there, up to its sign.
fn normals(evidence: &Evidence, axis: &Axis) -> Vec<(DVec2, DVec2)> {
    let mut found = Vec::new();
    for (p, sight) in &evidence.outline_ends {
        if let Some(out) = axis.outwards(*p) {
            // In the plane of out and axis, and at right angles to the view.
            let view = sight.direction;
            let normal = DVec2::new(axis.direction.dot(view), -out.dot(view)).normalize_or_zero();
            found.push((DVec2::from(axis.profile(*p)), normal));
        }
    }
    for bound in &evidence.bounds {
        for p in [
            bound.points.first(),
            bound.points.get(bound.points.len() / 2),
        ]
        .into_iter()
        .flatten()
        {
            let gradient = bound.beside.gradient(*p);
            if let Some(out) = axis.outwards(*p) {
                let normal = DVec2::new(gradient.dot(out), gradient.dot(axis.direction));
                // A neighbour across the profile is not touched.
                if normal.length() > 0.99 {
                    found.push((DVec2::from(axis.profile(*p)), normal.normalize()));
                }
            }
        }
    }
    found
}
