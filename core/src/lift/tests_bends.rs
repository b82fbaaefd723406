//! Lifting bent pipes, which have no straight edges along three axes.

use glam::{DQuat, DVec2, DVec3};
use proptest::prelude::*;

use super::testing::{Scene, turned};
use super::*;
use crate::drawing::{Curve2, SurfaceKind};

/// Outer radius of the pipes, and that of their bends.
const RADIUS: f64 = 0.3;
const MAJOR: f64 = 1.0;

fn scene(turn: DQuat, parallel: bool) -> Scene {
    if parallel {
        Scene::new(turn)
    } else {
        Scene::central(turn, DVec3::Z * -5.0, DVec2::ZERO, 3.0)
    }
}

/// A bend by an angle, closed by two planes; with `straight`, a straight piece before it and after it.
fn pipe(mut scene: Scene, angle: f64, straight: Option<f64>) -> (Drawing, Vec<Face>) {
    let [mut start, mut end] = scene.bend(DVec3::ZERO, DVec3::Z, DVec3::X * MAJOR, RADIUS, angle);
    if let Some(length) = straight {
        let back = scene.wall(DVec3::X * MAJOR, DVec3::NEG_Y * length, RADIUS);
        let (sin, cos) = angle.sin_cos();
        let last = DVec3::new(cos, sin, 0.0) * MAJOR;
        let on = scene.wall(last, DVec3::new(-sin, cos, 0.0) * length, RADIUS);
        [[_, start], [_, end]] = [back, on];
    }
    scene.face(SurfaceKind::Plane, &[start]);
    scene.face(SurfaceKind::Plane, &[end]);
    let (mut drawing, faces) = scene.finish();
    let rounded = |p: &mut DVec2| *p = (*p * 1e7).round() / 1e7;
    drawing.vertices.iter_mut().for_each(rounded);
    for e in &mut drawing.edges {
        e.points.iter_mut().for_each(rounded);
        e.curve = Curve2::recognise(&e.points);
    }
    (drawing, faces)
}

fn check(drawing: &Drawing, faces: &[Face]) -> std::result::Result<(), TestCaseError> {
    let found = lift(drawing, faces, &LiftOptions::default(), Progress::none());
    let found = found.map_err(|e| TestCaseError::fail(e.to_string()))?;
    let truth = drawing.truth.as_ref().unwrap();
    let error = depth_error(&found, truth);
    prop_assert!(error < 2e-3, "{error}");
    let scale = match found.camera {
        Camera::Parallel => 1.0,
        Camera::Central { .. } => found.depths[0] / truth.vertices3d[0].z,
    };
    for (face, surface) in faces.iter().zip(&found.surfaces) {
        match *surface {
            Surface::Torus { major, minor, .. } => {
                prop_assert!((major / scale - MAJOR).abs() < 2e-3);
                prop_assert!((minor / scale - RADIUS).abs() < 2e-3);
            }
            Surface::Cylinder { radius, .. } => {
                prop_assert!((radius / scale - RADIUS).abs() < 2e-3);
            }
            Surface::Plane { .. } => prop_assert_eq!(face.kind, SurfaceKind::Plane),
            // Of two halves of a bend one may be left to the other.
            _ => prop_assert_eq!(*surface, Surface::Unknown),
        }
    }
    let is_torus = |s: &Surface| matches!(s, Surface::Torus { .. });
    prop_assert!(found.surfaces.iter().any(is_torus));
    Ok(())
}

/// How many bends are lifted, of all in views in which both ends are seen well.
fn lifted_of_all(straight: Option<f64>) -> (usize, usize) {
    let (mut lifted, mut all) = (0, 0);
    for step in 0..120 {
        // Spread evenly over their ranges (Weyl 1916).
        let [x, y, z, angle] =
            [0.618, 0.414, 0.732, 0.236].map(|r: f64| (r * f64::from(step)).fract());
        let (x, y, z, angle) = (0.5 + 0.5 * x, 0.3 + 0.9 * y, z - 0.5, 0.6 + 0.8 * angle);
        let turn = turned(x, y, z);
        let seen = |t: f64| (turn * DVec3::new(-t.sin(), t.cos(), 0.0)).z.abs();
        let well = seen(0.0) > 0.2 && seen(angle) > 0.2;
        if !well || (seen(0.0) - seen(angle)).abs() < 0.05 {
            continue;
        }
        let (drawing, faces) = pipe(scene(turn, step % 2 == 0), angle, straight);
        all += 1;
        lifted += usize::from(check(&drawing, &faces).is_ok());
    }
    (lifted, all)
}

/// Two circles and two outlines.
#[test]
fn a_bend_alone_is_lifted() {
    let (lifted, all) = lifted_of_all(None);
    println!("{lifted} of {all}");
    assert!(all > 40 && 100 * lifted >= 85 * all, "{lifted} of {all}");
}

/// The straight pieces beside it show no axes at right angles.
#[test]
fn a_pipe_is_lifted_through_its_bend() {
    let (lifted, all) = lifted_of_all(Some(0.7));
    println!("{lifted} of {all}");
    assert!(all > 40 && 100 * lifted >= 85 * all, "{lifted} of {all}");
}
