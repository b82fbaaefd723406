//! Surfaces that no solid can be built with are given up.

use std::path::Path;

use faceformer::drawing::{Drawing, dataset};
use faceformer::identify::{Face, from_truth};
use faceformer::lift::{Lift, LiftOptions, Surface, lift};
use faceformer::plan::{PlanOptions, Surface3};
use faceformer::{Error, Progress};
use faceformer_occt::{Reconstruction, reconstruct};
use glam::DVec3;

/// A machined block of the corpus, all planes.
fn block() -> (Drawing, Vec<Face>, Lift) {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/corpus/sample.jsonl.zst");
    let drawing = dataset::find(sample, "mfcad/00841#o0").unwrap();
    let faces = from_truth(&drawing).unwrap().faces;
    let lifted = lift(&drawing, &faces, &LiftOptions::default(), Progress::none()).unwrap();
    (drawing, faces, lifted)
}

/// Through none of the block's edges.
const TUBE: Surface = Surface::Cylinder {
    origin: DVec3::ZERO,
    axis: DVec3::Z,
    radius: 0.01,
};

/// A face with one loop of four edges.
fn simple(faces: &[Face]) -> usize {
    let four = |f: &Face| f.loops.len() == 1 && f.loops[0].len() == 4;
    faces.iter().position(four).unwrap()
}

#[test]
fn surfaces_that_fit_stay() {
    let (drawing, faces, mut lifted) = block();
    let before = lifted.clone();
    let options = PlanOptions::default();
    let made = reconstruct(&drawing, &faces, &mut lifted, &options, Progress::none()).unwrap();
    assert!(made.solid.is_ok());
    assert!(made.given_up.is_empty());
    assert_eq!(lifted, before);
}

#[test]
fn a_face_whose_surface_misses_its_edges_is_filled_and_told() {
    let (drawing, faces, mut lifted) = block();
    let options = PlanOptions::default();
    let right = reconstruct(&drawing, &faces, &mut lifted, &options, Progress::none()).unwrap();
    let wrong = simple(&faces);
    lifted.surfaces[wrong] = TUBE;
    let made = reconstruct(&drawing, &faces, &mut lifted, &options, Progress::none()).unwrap();
    assert_eq!(made.given_up, [wrong]);
    assert_eq!(lifted.surfaces[wrong], Surface::Unknown);
    assert_eq!(made.plan.faces[wrong].surface, Surface3::Filled);
    let told = format!("the cylinder of face {};", wrong + 1);
    assert!(made.plan.notices.iter().any(|n| n.contains(&told)));
    let volume = |made: &Reconstruction| made.solid.as_ref().unwrap().report().volume;
    assert!((volume(&made) / volume(&right) - 1.0).abs() < 1e-4);
}

#[test]
fn what_cannot_be_helped_is_left_as_it_is() {
    let (drawing, faces, mut lifted) = block();
    let wrong = simple(&faces);
    lifted.surfaces[wrong] = TUBE;
    // Two neighbours in parallel planes.
    let meet = |f: usize, g: usize| {
        let edges = faces[g].edge_set();
        f != g && faces[f].edge_set().iter().any(|e| edges.contains(e))
    };
    let beside = |f: usize, other: usize| {
        (0..faces.len())
            .find(|&g| ![wrong, other].contains(&g) && meet(f, g))
            .unwrap()
    };
    let first = beside(wrong, wrong);
    let second = beside(first, first);
    let Surface::Plane { origin, normal } = lifted.surfaces[first] else {
        panic!("{:?}", lifted.surfaces[first]);
    };
    lifted.surfaces[second] = Surface::Plane {
        origin: origin + normal * 0.3,
        normal,
    };
    let before = lifted.clone();
    let options = PlanOptions::default();
    let made = reconstruct(&drawing, &faces, &mut lifted, &options, Progress::none());
    assert!(matches!(made, Err(Error::Plan(_))));
    assert_eq!(lifted, before);
}
