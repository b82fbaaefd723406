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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lift::surfaces::evidence::Sight;

    #[test]
    fn outlines_that_meet_give_an_axis_through_the_apex() {
        let apex = DVec3::new(0.1, 0.2, 0.3);
        let end = |p: DVec3| {
            let sight = Sight {
                from: p,
                direction: DVec3::Z,
            };
            (p, sight)
        };
        let evidence = |ends: [DVec3; 4]| Evidence {
            vertices: Vec::new(),
            bounds: Vec::new(),
            outlines: Vec::new(),
            bent: false,
            outline_ends: ends.map(end).into(),
            discs: Vec::new(),
            directions: vec![DVec3::X, DVec3::Y],
            size: 1.0,
        };
        let found = axes(&evidence([apex, DVec3::X, DVec3::Y, apex]));
        let through: Vec<_> = found.iter().map(|a| (a.origin, a.direction)).collect();
        assert_eq!(through, [(apex, DVec3::X), (apex, DVec3::Y)]);
        assert!(axes(&evidence([apex, DVec3::X, DVec3::Y, DVec3::ZERO])).is_empty());
    }
}
