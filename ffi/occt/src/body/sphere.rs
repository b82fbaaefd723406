//! The axis of a sphere's parameter plane, chosen so that its poles are out of the way.

use glam::DVec3;

use super::chart::{Chart, wrapped};
use super::{Body, BodyFace};

/// Steps along an edge.
const STEPS: usize = 24;

/// Poles this far from the boundary, as a sine, are far enough.
const FAR: f64 = 0.3;

/// The axis around which the loops of a face on a sphere run least, with both poles away from them.
pub(super) fn axis(body: &Body, face: &BodyFace) -> DVec3 {
    let faceformer::plan::Surface3::Sphere { center, hollow, .. } = face.surface else {
        return DVec3::Z;
    };
    let loops: Vec<Vec<DVec3>> = face
        .loops
        .iter()
        .map(|walk| {
            let points = walk.iter().flat_map(|c| {
                let mut points = body.points(*c, STEPS);
                points.pop();
                points
            });
            points.collect()
        })
        .collect();
    // Through the middle of each loop, at right angles to it, and evenly all around.
    let mut candidates: Vec<DVec3> = Vec::new();
    for points in &loops {
        let next = points.iter().cycle().skip(1);
        let area: DVec3 = points
            .iter()
            .zip(next)
            .map(|(p, q)| (*p - center).cross(*q - center))
            .sum();
        if let Some(normal) = area.try_normalize() {
            let (u, v) = normal.any_orthonormal_pair();
            candidates.extend([normal, u, v, (u + v).normalize(), (u - v).normalize()]);
        }
    }
    for x in [-1.0, 0.0, 1.0] {
        for y in [-1.0, 0.0, 1.0] {
            candidates.push(DVec3::new(x, y, 1.0).normalize());
        }
    }
    candidates.extend([DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0).normalize()]);
    candidates.push(DVec3::new(1.0, -1.0, 0.0).normalize());
    let cost = |axis: &DVec3| -> f64 {
        let Some(chart) = Chart::new(&face.surface, *axis) else {
            return f64::INFINITY;
        };
        let (mut turning, mut area, mut near) = (0, 0.0, 1.0f64);
        for points in &loops {
            let mut turned = 0.0;
            let next = points.iter().cycle().skip(1);
            for (p, q) in points.iter().zip(next) {
                let ([a, s], [b, t]) = (chart.place(*p), chart.place(*q));
                let du = wrapped(b - a);
                turned += du;
                area -= (s.sin() + t.sin()) / 2.0 * du;
                near = near.min(chart.off_axis(*p));
            }
            turning += i32::from(turned.abs() > 1.0);
        }
        // Loops that do not turn bound a part with no pole only if it is on their left.
        let inside = if hollow { -area } else { area };
        let poles = if turning == 0 && inside <= 0.0 {
            10.0
        } else {
            0.0
        };
        let close = (FAR - near).max(0.0) / FAR;
        poles + f64::from(turning.max(0)) + 4.0 * close
    };
    candidates
        .into_iter()
        .min_by(|a, b| cost(a).total_cmp(&cost(b)))
        .unwrap_or(DVec3::Z)
}
