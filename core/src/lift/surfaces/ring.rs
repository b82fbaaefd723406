//! Circles in space.

use glam::{DVec2, DVec3};

use super::flat::best_plane;
use crate::lift::circle::circle_fit;

/// A circle in space.
#[derive(Debug, Clone, Copy)]
pub(in crate::lift) struct Ring {
    pub(in crate::lift) center: DVec3,
    /// Unit normal, its sign without meaning.
    pub(in crate::lift) normal: DVec3,
    pub(in crate::lift) radius: f64,
}

impl Ring {
    /// The circle through points, in the plane of a known normal or in the one that fits best;
    /// `None` if they are off it by more than `tolerance`.
    pub(super) fn through(points: &[DVec3], normal: Option<DVec3>, tolerance: f64) -> Option<Self> {
        if points.len() < 4 {
            return None;
        }
        let (origin, normal) = match normal {
            Some(n) => (points[0], n.try_normalize()?),
            None => best_plane(points)?,
        };
        let (u, w) = normal.any_orthonormal_pair();
        let flat = |p: &DVec3| DVec2::new((*p - origin).dot(u), (*p - origin).dot(w));
        let (center, radius, gain) = circle_fit(points.iter().map(flat))?;
        let height = points
            .iter()
            .map(|p| (*p - origin).dot(normal))
            .sum::<f64>();
        let height = height / points.len() as f64;
        let off = |p: &DVec3| {
            let out = flat(p).distance(center) - radius;
            out.hypot((*p - origin).dot(normal) - height)
        };
        let worst = points.iter().map(off).fold(0.0, f64::max);
        // Of a short arc the centre is not known.
        (worst <= tolerance && gain < 2e3).then(|| Self {
            center: origin + u * center.x + w * center.y + normal * height,
            normal,
            radius,
        })
    }
}
