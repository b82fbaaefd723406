//! Snapping: from what was measured to what was meant.
//!
//! Faces get supports: surfaces that several faces may share. In turn
//! 1. faces that meet along an edge, as the halves of a hole do, and whose curved surfaces differ by
//!    little, get one surface,
//! 2. normals and axes turn to a dominant direction, to its normal plane, or to a direction that a
//!    larger face has,
//! 3. coplanar faces get one plane, coaxial surfaces one axis, equal cylinders, spheres and tori one
//!    radius.
//!
//! Each step must leave the face's own points within the tolerance of its surface.

mod align;
mod merge;

use glam::DVec3;

use super::support::Support;

/// A direction turns by no more than this, radians.
const LARGEST_TURN: f64 = 0.01;

/// A face before snapping.
#[derive(Debug, Clone)]
pub(super) struct Measured {
    /// Its surface as lifted.
    pub(super) support: Support,
    /// Points that lie on the face.
    pub(super) points: Vec<DVec3>,
}

/// Two faces that meet along an edge where one surface may go on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joint {
    pub(super) faces: [usize; 2],
    /// Whether the edge is an outline of either face's surface.
    pub(super) outline: bool,
}

/// Surfaces after snapping.
#[derive(Debug, Clone)]
pub(super) struct Snapped {
    /// The support of every face, an index into `supports`.
    pub(super) of_face: Vec<usize>,
    /// Different surfaces.
    pub(super) supports: Vec<Support>,
    /// What was done, for the user.
    pub(super) notices: Vec<String>,
}

/// A surface shared by some faces, while it is worked on.
#[derive(Debug, Clone)]
struct Group {
    support: Support,
    faces: Vec<usize>,
    points: Vec<DVec3>,
    /// Half diagonal of the points' box.
    extent: f64,
}

impl Group {
    /// Largest distance of the points from a surface.
    fn gap(&self, support: &Support) -> f64 {
        let distances = self.points.iter().map(|p| support.distance(*p).abs());
        distances.fold(0.0, f64::max)
    }

    /// Whether a surface fits the points within the tolerance, or as well as the present one.
    fn fits(&self, support: &Support, tolerance: f64) -> bool {
        self.gap(support) <= tolerance.max(1.5 * self.gap(&self.support))
    }

    fn join(&mut self, other: Self) {
        self.faces.extend(other.faces);
        self.points.extend(other.points);
        self.extent = self.extent.max(other.extent);
    }
}

/// Snaps the surfaces of all faces.
///
/// `smooth` are the faces that an outline may part, `axes` the dominant directions
/// (unit, in the frame of the points), `tolerance` is a length.
pub(super) fn snap(
    faces: &[Measured],
    smooth: &[Joint],
    axes: &[DVec3],
    tolerance: f64,
) -> Snapped {
    let mut groups: Vec<Group> = faces
        .iter()
        .enumerate()
        .map(|(f, face)| {
            let low = face.points.iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
            let high = face
                .points
                .iter()
                .fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
            Group {
                support: face.support,
                faces: vec![f],
                points: face.points.clone(),
                extent: (high - low).length() / 2.0,
            }
        })
        .collect();
    let mut notices = Vec::new();
    groups = merge::halves(groups, smooth, tolerance);
    let aligned = align::directions(&mut groups, axes, tolerance);
    if aligned > 0 {
        notices.push(format!(
            "{aligned} surfaces were aligned with common directions"
        ));
    }
    let before = groups.len();
    groups = merge::planes(groups, tolerance);
    if groups.len() < before {
        notices.push(format!(
            "{} planes were merged with coplanar ones",
            before - groups.len()
        ));
    }
    let changed = merge::round(&mut groups, tolerance);
    if changed > 0 {
        notices.push(format!(
            "{changed} curved surfaces were given the axis or radius of another"
        ));
    }
    groups = merge::equal(groups);
    let mut of_face = vec![0; faces.len()];
    for (g, group) in groups.iter().enumerate() {
        for &f in &group.faces {
            of_face[f] = g;
        }
    }
    Snapped {
        of_face,
        supports: groups.into_iter().map(|g| g.support).collect(),
        notices,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(points: &[[f64; 3]], normal: [f64; 3]) -> Measured {
        let points: Vec<DVec3> = points.iter().map(|p| DVec3::from_array(*p)).collect();
        Measured {
            support: Support::Plane {
                origin: points[0],
                normal: DVec3::from_array(normal).normalize(),
            },
            points,
        }
    }

    fn square(z: f64) -> [[f64; 3]; 4] {
        [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]]
    }

    fn tube(x: f64, axis: [f64; 3], radius: f64) -> Measured {
        let axis = DVec3::from_array(axis).normalize();
        let origin = DVec3::new(x, 0.0, 0.0);
        let arm = axis.any_orthonormal_vector() * radius;
        Measured {
            support: Support::Cylinder {
                origin,
                axis,
                radius,
            },
            points: vec![
                origin + arm,
                origin - arm,
                origin + arm + axis,
                origin - arm + axis,
            ],
        }
    }

    #[test]
    fn nearly_aligned_planes_become_one_exact_plane() {
        let faces = [
            plane(&square(1.0), [1e-6, 0.0, 1.0]),
            plane(&square(1.0 + 2e-6), [0.0, -1e-6, -1.0]),
        ];
        let snapped = snap(&faces, &[], &DVec3::AXES, 1e-5);
        assert_eq!(snapped.of_face, [0, 0]);
        assert_eq!(snapped.supports[0].direction().abs(), DVec3::Z);
        assert!((snapped.supports[0].origin().z - 1.0).abs() < 3e-6);
    }

    #[test]
    fn planes_at_different_heights_stay_apart() {
        let faces = [
            plane(&square(1.0), [0.0, 0.0, 1.0]),
            plane(&square(1.01), [0.0, 0.0, 1.0]),
        ];
        let snapped = snap(&faces, &[], &DVec3::AXES, 1e-5);
        assert_eq!(snapped.of_face, [0, 1]);
    }

    #[test]
    fn a_slight_but_real_slope_stays() {
        let slope = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 1e-3],
            [1.0, 1.0, 1e-3],
            [0.0, 1.0, 0.0],
        ];
        let snapped = snap(&[plane(&slope, [-1e-3, 0.0, 1.0])], &[], &DVec3::AXES, 1e-5);
        assert!(
            snapped.supports[0]
                .distance(DVec3::new(1.0, 0.5, 1e-3))
                .abs()
                < 1e-9
        );
        assert_eq!(snapped.supports[0].direction().y, 0.0);
    }

    #[test]
    fn halves_of_a_hole_become_one_cylinder() {
        let faces = [
            tube(0.0, [0.0, 0.0, 1.0], 0.5),
            tube(1e-4, [1e-4, 0.0, 1.0], 0.5001),
        ];
        let of_face = |smooth: &[Joint]| snap(&faces, smooth, &DVec3::AXES, 1e-5).of_face;
        let joint = |outline| Joint {
            faces: [0, 1],
            outline,
        };
        assert_eq!(of_face(&[joint(true)]), [0, 0]);
        // Two cylinders that nearly are one meet where nothing is seen edge-on.
        assert_eq!(of_face(&[joint(false)]), [0, 1]);
        assert_eq!(of_face(&[]), [0, 1]);
    }

    #[test]
    fn coaxial_cylinders_share_the_axis_and_equal_ones_the_radius() {
        let faces = [
            tube(0.0, [0.0, 0.0, 1.0], 0.5),
            tube(2e-6, [0.0, 0.0, 1.0], 0.3),
            tube(2.0, [0.0, 0.0, 1.0], 0.500_003),
        ];
        let snapped = snap(&faces, &[], &DVec3::AXES, 1e-5);
        assert_eq!(snapped.of_face, [0, 1, 2]);
        let [a, b, c] = snapped.supports[..] else {
            panic!("three supports");
        };
        let place = |s: Support| s.origin().reject_from_normalized(DVec3::Z);
        assert_eq!(place(a), place(b));
        match (a, c) {
            (Support::Cylinder { radius: r, .. }, Support::Cylinder { radius: s, .. }) => {
                assert_eq!(r, s);
            }
            _ => panic!("cylinders"),
        }
    }
}
