use glam::{DMat3, DQuat, DVec2, DVec3, EulerRot};
use proptest::prelude::*;

use super::*;
use crate::drawing::{Curve2, Edge, Projection};
use crate::lift::directions::columns;

/// The edges of a box of three by one by two cells, drawn in perspective.
fn boxes(turn: DQuat, principal: DVec2, focal: f64, known: bool) -> Drawing {
    let camera = Camera::Central { principal, focal };
    let at = |p: DVec3| camera.project(turn * p + DVec3::new(0.2, -0.1, -4.0));
    let size = DVec3::new(1.2, 0.8, 1.6);
    let corner = |c: u8| DVec3::new(f64::from(c & 1), f64::from(c >> 1 & 1), f64::from(c >> 2));
    let vertices: Vec<DVec2> = (0..8u8).map(|c| at((corner(c) - 0.5) * size)).collect();
    let mut edges = Vec::new();
    for c in 0..8usize {
        for bit in [1, 2, 4] {
            if c & bit == 0 {
                edges.push(Edge {
                    v: [c, c | bit],
                    points: vec![vertices[c], vertices[c | bit]],
                    curve: Curve2::Line,
                });
            }
        }
    }
    Drawing {
        id: String::new(),
        source: String::new(),
        projection: Projection::Perspective {
            focal: known.then_some(focal),
        },
        vertices,
        edges,
        truth: None,
    }
}

fn found_axes(found: &Directions, turn: DQuat) -> bool {
    let truth = columns(&DMat3::from_quat(turn));
    found.axes.len() == 3
        && found.axes.iter().all(|a| {
            let near = |t: &DVec3| t.cross(a.direction).length() < 1e-5;
            truth.iter().any(near) && a.edges.len() == 4
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// A box shows its frame, and its focal length and principal point if these are not known.
    #[test]
    fn a_box_shows_frame_and_camera(
        x in 0.3..1.1f64, y in 0.3..1.2f64, z in -0.3..0.3f64,
        px in -0.4..0.4f64, py in -0.4..0.4f64, focal in 2.0..4.0f64, mode in 0..3u8,
    ) {
        let turn = DQuat::from_euler(EulerRot::ZXY, z, x, y);
        let principal = if mode == 2 { DVec2::new(px, py) } else { DVec2::ZERO };
        let drawing = boxes(turn, principal, focal, mode == 0);
        let found = Directions::estimate(&drawing).unwrap();
        prop_assert!(found_axes(&found, turn), "{found:?}");
        let Camera::Central { principal: p, focal: f } = found.camera else {
            return Err(TestCaseError::fail("parallel"));
        };
        prop_assert!((f - focal).abs() < 1e-4 && p.distance(principal) < 1e-4, "{p} {f}");
    }
}

#[test]
fn a_principal_point_next_to_the_origin_is_told_from_it() {
    let turn = DQuat::from_euler(EulerRot::ZXY, 0.0, 0.3, 0.3);
    let principal = DVec2::new(0.0, 2.787e-4);
    let found = Directions::estimate(&boxes(turn, principal, 2.0, false)).unwrap();
    assert!(found_axes(&found, turn), "{found:?}");
}

#[test]
fn one_vanishing_point_tells_no_focal_length() {
    let turn = DQuat::from_rotation_x(0.0);
    let drawing = boxes(turn, DVec2::ZERO, 3.0, false);
    assert!(matches!(
        Directions::estimate(&drawing),
        Err(LiftError::Focal { .. })
    ));
    // With the focal length it is enough.
    let found = Directions::estimate(&boxes(turn, DVec2::ZERO, 3.0, true)).unwrap();
    assert!(found_axes(&found, turn));
}
