//! What is not a solid is refused with the place of the fault, and never ends the process.

mod common;

use std::cell::Cell;

use common::{SQUARE, cylinder, drilled_block, prism};
use faceformer::plan::{Curve3, Plan, Surface3};
use faceformer::{Progress, Stage};
use faceformer_occt::{OcctError, build};
use glam::DVec3;

fn fault(plan: &Plan) -> OcctError {
    build(plan, Progress::none()).unwrap_err()
}

#[test]
fn missing_face_leaves_a_gap() {
    let mut plan = prism(&SQUARE);
    plan.faces.pop();
    let error = fault(&plan);
    assert!(error.to_string().contains("gap"), "{error}");
    let partial = String::from_utf8_lossy(error.partial().unwrap());
    assert!(partial.contains("CASCADE Topology V1"));
}

#[test]
fn faces_turned_inside_out_have_no_positive_volume() {
    let mut plan = prism(&SQUARE);
    for face in &mut plan.faces {
        for walk in &mut face.loops {
            *walk = walk.iter().rev().map(|c| c.mate()).collect();
        }
        if let Surface3::Plane { normal, .. } = &mut face.surface {
            *normal = -*normal;
        }
    }
    let error = fault(&plan);
    assert!(matches!(error, OcctError::Shell { .. }), "{error}");
}

#[test]
fn with_a_filled_face_the_whole_is_turned_right_side_out() {
    let mut plan = prism(&SQUARE);
    let volume = build(&plan, Progress::none()).unwrap().report().volume;
    for face in &mut plan.faces {
        for walk in &mut face.loops {
            *walk = walk.iter().rev().map(|c| c.mate()).collect();
        }
        if let Surface3::Plane { normal, .. } = &mut face.surface {
            *normal = -*normal;
        }
    }
    plan.faces[0].surface = Surface3::Filled;
    let turned = build(&plan, Progress::none()).unwrap().report().volume;
    assert!((turned - volume).abs() < 1e-9, "{turned} {volume}");
}

#[test]
fn one_face_turned_is_named() {
    let mut plan = prism(&SQUARE);
    let face = &mut plan.faces[2];
    face.loops[0] = face.loops[0].iter().rev().map(|c| c.mate()).collect();
    let error = fault(&plan);
    assert!(error.partial().is_some(), "{error}");
}

#[test]
fn edge_off_its_plane_is_named() {
    let mut plan = prism(&SQUARE);
    plan.vertices[0].z -= 0.1;
    match fault(&plan) {
        OcctError::Edge { edge, what, .. } => {
            assert!([1, 4, 9].contains(&edge), "edge {edge}");
            assert!(what.contains("off the surface of face"), "{what}");
        }
        error => panic!("{error}"),
    }
}

#[test]
fn face_that_an_edge_misses_has_its_number_in_the_plan() {
    let mut plan = cylinder();
    // The halves of the wall are one face in the kernel.
    if let Surface3::Plane { origin, .. } = &mut plan.faces[3].surface {
        origin.z += 0.1;
    }
    let error = fault(&plan).to_string();
    assert!(error.contains("off the surface of face 4"), "{error}");
}

#[test]
fn curve_that_misses_its_vertex_is_named() {
    let mut plan = cylinder();
    if let Curve3::Circle { radius, .. } = &mut plan.edges[1].curve {
        *radius *= 1.1;
    }
    match fault(&plan) {
        OcctError::Edge { edge, .. } => assert_eq!(edge, 2),
        error => panic!("{error}"),
    }
}

#[test]
fn face_that_runs_around_with_one_loop_only_is_refused() {
    let mut plan = cylinder();
    // The first half face alone, above the whole lower circle.
    let low = plan.faces[2].loops[0].clone();
    plan.faces[0].loops = vec![low.iter().rev().map(|c| c.mate()).collect()];
    plan.faces.remove(1);
    match fault(&plan) {
        OcctError::Face { face, what, .. } => {
            assert_eq!(face, 1);
            assert!(what.contains("no seam"), "{what}");
        }
        error => panic!("{error}"),
    }
}

#[test]
fn two_bodies_are_refused() {
    let mut plan = prism(&SQUARE);
    let mut other = common::moved(&plan, 1.0);
    let (vertices, edges) = (plan.vertices.len(), plan.edges.len());
    for edge in &mut other.edges {
        edge.v = edge.v.map(|v| v + vertices);
    }
    for co in other.faces.iter_mut().flat_map(|f| &mut f.loops).flatten() {
        *co = faceformer::drawing::CoEdge::new(co.edge() + edges, co.is_reversed());
    }
    plan.vertices.append(&mut other.vertices);
    plan.edges.append(&mut other.edges);
    plan.faces.append(&mut other.faces);
    let error = fault(&plan);
    assert!(error.to_string().contains("separate bodies"), "{error}");
}

#[test]
fn plans_that_make_no_sense_are_refused() {
    let change: [fn(&mut Plan); 10] = [
        |p| *p = common::moved(p, 1e-5),
        |p| p.faces.clear(),
        |p| p.vertices[3].x = f64::NAN,
        |p| p.vertices.fill(DVec3::ONE),
        |p| p.edges[1].v = [0, 99],
        |p| p.edges[1].v = [2, 2],
        |p| p.edges.truncate(3),
        |p| p.faces[1].loops.clear(),
        |p| {
            p.edges[0].curve = Curve3::Points {
                points: Vec::new(),
                tangents: None,
            };
        },
        |p| {
            p.faces[0].surface = Surface3::Cylinder {
                origin: DVec3::ZERO,
                axis: DVec3::ZERO,
                radius: -1.0,
                hollow: true,
            };
        },
    ];
    for (i, change) in change.iter().enumerate() {
        let mut plan = drilled_block();
        change(&mut plan);
        let error = fault(&plan);
        assert!(matches!(error, OcctError::Plan(_)), "{i}: {error}");
    }
}

#[test]
fn build_reports_progress_and_can_be_cancelled() {
    let last = Cell::new(-1.0);
    let watch = |stage: Stage, share: f64| {
        assert_eq!(stage, Stage::Build);
        assert!(share >= last.get());
        last.set(share);
        share < 0.5
    };
    let error = build(&drilled_block(), Progress::new(&watch)).unwrap_err();
    assert_eq!(error, OcctError::Cancelled);
    assert!(last.get() >= 0.5);
}

#[test]
fn panic_in_the_callback_goes_on_in_rust() {
    let watch = |_: Stage, share: f64| {
        assert!(share < 0.2, "stop here");
        true
    };
    let plan = drilled_block();
    let caught = std::panic::catch_unwind(|| build(&plan, Progress::new(&watch)));
    assert!(caught.is_err());
}
