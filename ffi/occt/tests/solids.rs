//! Solids of hand-made plans: volumes, areas and counts are exact.

mod common;

use std::f64::consts::PI;

use common::{SQUARE, block_with_pocket, cylinder, drilled_block, moved, prism};
use faceformer::Progress;
use faceformer::drawing::CoEdge;
use faceformer::plan::Plan;
use faceformer_occt::{Solid, build};

fn solid(plan: &Plan) -> Solid {
    build(plan, Progress::none()).unwrap()
}

#[track_caller]
fn assert_near(found: f64, wanted: f64) {
    assert!(
        (found - wanted).abs() <= 1e-9 * wanted.abs(),
        "{found} is not {wanted}"
    );
}

#[test]
fn box_is_exact() {
    let solid = solid(&prism(&SQUARE));
    let report = solid.report();
    assert_near(report.volume, 24.0);
    assert_near(report.area, 2.0 * (12.0 + 8.0 + 6.0));
    assert_eq!(
        (report.faces, report.edges, report.vertices, report.shells),
        (6, 12, 8, 1)
    );
    assert_eq!(report.face_counts.plane, 6);
    assert_eq!(report.bounds, [[0.0; 3], [4.0, 3.0, 2.0]]);
    assert!(report.largest_tolerance < 1e-6);
}

#[test]
fn bracket_is_exact() {
    let corners = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 1.0],
        [1.0, 1.0],
        [1.0, 3.0],
        [0.0, 3.0],
    ];
    let solid = solid(&prism(&corners));
    assert_near(solid.report().volume, 2.0 * (4.0 + 2.0));
    assert_eq!(solid.report().faces, 8);
}

#[test]
fn pocket_is_exact() {
    let solid = solid(&block_with_pocket());
    assert_near(solid.report().volume, 24.0 - 3.0);
    assert_eq!(solid.report().faces, 11);
}

#[test]
fn cylinder_is_one_face_with_a_seam() {
    let solid = solid(&cylinder());
    let report = solid.report();
    assert_near(report.volume, 2.0 * PI);
    assert_near(report.area, 2.0 * PI + 4.0 * PI);
    assert_eq!(
        (report.face_counts.plane, report.face_counts.cylinder),
        (2, 1)
    );
    // Two circles and the seam: the arcs are merged, and so are the silhouettes' ends.
    assert_eq!((report.edges, report.vertices), (3, 2));
}

#[test]
fn cylinder_drawn_without_outlines_gets_a_seam_all_the_same() {
    let mut plan = cylinder();
    // The first half face alone, between the whole lower circle and the whole upper one.
    let mates = |walk: &[CoEdge]| walk.iter().rev().map(|c| c.mate()).collect();
    plan.faces[0].loops = [2, 3].map(|f: usize| mates(&plan.faces[f].loops[0])).into();
    plan.faces.remove(1);
    let solid = solid(&plan);
    let report = solid.report();
    assert_near(report.volume, 2.0 * PI);
    assert_eq!((report.faces, report.face_counts.cylinder), (3, 1));
}

#[test]
fn through_hole_is_one_cylinder() {
    let solid = solid(&drilled_block());
    let report = solid.report();
    assert_near(report.volume, 24.0 - 2.0 * PI);
    assert_eq!(
        (report.face_counts.plane, report.face_counts.cylinder),
        (6, 1)
    );
    assert_eq!((report.edges, report.vertices), (12 + 3, 8 + 2));
}

#[test]
fn place_and_scale_change_nothing() {
    for scale in [1e-2, 1.0, 37.0, 1e6] {
        let solid = solid(&moved(&drilled_block(), scale));
        let report = solid.report();
        assert_near(report.volume, (24.0 - 2.0 * PI) * scale.powi(3));
        assert_eq!((report.faces, report.edges), (7, 15));
        assert!(report.largest_tolerance <= (1e-6 * scale).max(1.001e-7));
    }
}
