//! Tori from circles of their tube: bends of pipes, and fillets that run around a corner.

use glam::{DMat3, DVec3};

use super::evidence::Evidence;
use super::ring::Ring;
use crate::lift::Surface;

/// Rings of one tube have radii within this share.
const SAME: f64 = 0.02;

/// Tori whose tube has the circles on the boundary as sections.
pub(super) fn tori(evidence: &Evidence) -> Vec<Surface> {
    let rings: Vec<Ring> = evidence.rings().map(|(ring, _)| ring).collect();
    let mut found = Vec::new();
    for (i, a) in rings.iter().enumerate() {
        for b in &rings[i + 1..] {
            if (a.radius - b.radius).abs() < SAME * a.radius {
                found.extend(between(a, b));
            }
        }
        found.extend(from_one(evidence, a));
    }
    found
}

/// The torus with two sections.
pub(in crate::lift) fn between(a: &Ring, b: &Ring) -> Option<Surface> {
    let apart = b.center - a.center;
    let cross = a.normal.cross(b.normal);
    let (axis, center) = if cross.length() > 1e-3 {
        let axis = cross.normalize();
        let planes = DMat3::from_cols(a.normal, b.normal, axis).transpose();
        let middle = axis.dot(a.center.midpoint(b.center));
        let right = DVec3::new(a.normal.dot(a.center), b.normal.dot(b.center), middle);
        (axis, planes.inverse() * right)
    } else {
        // Half a turn: both sections in one plane.
        let axis = a.normal.cross(apart).try_normalize()?;
        (axis, a.center.midpoint(b.center))
    };
    let major = (center.distance(a.center) + center.distance(b.center)) / 2.0;
    Some(Surface::Torus {
        center,
        axis,
        major,
        minor: (a.radius + b.radius) / 2.0,
    })
}

/// Tori with one section, around an axis of the drawing, through another point.
fn from_one(evidence: &Evidence, ring: &Ring) -> Vec<Surface> {
    let far = evidence.points().max_by(|p, q| {
        let away = |p: &DVec3| ring.normal.dot(*p - ring.center).abs();
        away(p).total_cmp(&away(q))
    });
    let Some(far) = far else {
        return Vec::new();
    };
    let axes = evidence.directions.iter().copied();
    let axes = axes.filter(|a| a.dot(ring.normal).abs() < 1e-3);
    let mut found = Vec::new();
    for axis in axes {
        let toward = axis.cross(ring.normal);
        let d = far - ring.center;
        let height = axis.dot(d);
        let flat = d - axis * height;
        let reach = (ring.radius * ring.radius - height * height)
            .max(0.0)
            .sqrt();
        for q in [reach, -reach] {
            for side in [toward, -toward] {
                // |flat - s side| = s + q
                let s = (flat.length_squared() - q * q) / (2.0 * (flat.dot(side) + q));
                if s.is_finite() && s > ring.radius * 0.01 && s < 1e3 * evidence.size {
                    found.push(Surface::Torus {
                        center: ring.center + side * s,
                        axis,
                        major: s,
                        minor: ring.radius,
                    });
                }
            }
        }
    }
    found
}
