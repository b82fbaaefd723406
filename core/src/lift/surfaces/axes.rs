//! Axes of revolution that the boundary of a surface suggests.

use glam::DVec3;

use super::evidence::Evidence;
use crate::lift::Surface;

/// A line in space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    pub(super) origin: DVec3,
    /// Unit.
    pub(super) direction: DVec3,
}

impl Axis {
    /// Distance from the axis, and height along it.
    pub(super) fn profile(&self, p: DVec3) -> (f64, f64) {
        let d = p - self.origin;
        let height = d.dot(self.direction);
        ((d - self.direction * height).length(), height)
    }

    /// Unit direction away from the axis.
    pub(super) fn outwards(&self, p: DVec3) -> Option<DVec3> {
        (p - self.origin)
            .reject_from_normalized(self.direction)
            .try_normalize()
    }

    fn is_same(&self, other: &Self, size: f64) -> bool {
        let aside = (other.origin - self.origin).reject_from_normalized(self.direction);
        self.direction.cross(other.direction).length() < 1e-7 && aside.length() < 1e-7 * size
    }
}

/// Axes of circles on the boundary, the largest first, of neighbours, and those of the drawing
/// through an apex; each once.
pub(super) fn axes(evidence: &Evidence) -> Vec<Axis> {
    let mut rings: Vec<_> = evidence.rings().map(|(ring, _)| ring).collect();
    rings.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    let mut all: Vec<Axis> = Vec::new();
    let mut add = |origin: DVec3, direction: DVec3| {
        let axis = Axis { origin, direction };
        if !all.iter().any(|a| a.is_same(&axis, evidence.size)) {
            all.push(axis);
        }
    };
    for ring in &rings {
        add(ring.center, ring.normal);
    }
    for bound in &evidence.bounds {
        if let Some((origin, direction)) = bound.beside.axis() {
            add(origin, direction);
        }
        // A sphere has an axis through its centre along that of any circle.
        if let Surface::Sphere { center, .. } = bound.beside {
            for ring in &rings {
                add(center, ring.normal);
            }
        }
    }
    if !evidence.bent {
        // Straight outlines of a cone meet in its apex.
        for (i, (p, _)) in evidence.outline_ends.iter().enumerate() {
            if evidence.outline_ends[..i].iter().any(|(q, _)| q == p) {
                evidence.directions.iter().for_each(|&d| add(*p, d));
            }
        }
    }
    all
}
