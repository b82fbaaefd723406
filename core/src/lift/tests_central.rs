//! Lifting perspective drawings.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::testing::{Scene, drilled, polygon, turned};
use super::*;
use crate::drawing::{Curve2, SurfaceKind};

fn lifted(drawing: &Drawing, faces: &[Face]) -> Lift {
    lift(drawing, faces, &LiftOptions::default(), Progress::none()).unwrap()
}

fn error(drawing: &Drawing, found: &Lift) -> f64 {
    depth_error(found, drawing.truth.as_ref().unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Any generic view of a block with a hole is lifted to within the rounding of its coordinates.
    #[test]
    fn any_view_of_a_block_with_a_hole_is_lifted(
        x in 0.3..1.1f64, y in 0.3..1.2f64, z in -0.5..0.5f64, focal in 2.0..4.0f64,
        width in 1.0..2.0f64, depth in 1.0..2.0f64, height in 0.3..1.5f64, radius in 0.15..0.4f64,
        known: bool,
    ) {
        let shift = DVec3::new(-0.5, -0.3, -5.0);
        let scene = Scene::central(turned(x, y, z), shift, DVec2::ZERO, focal);
        let size = DVec3::new(width, depth, height);
        let (mut drawing, faces) = drilled(scene, size, DVec2::new(0.5, 0.5), radius);
        if !known {
            drawing.projection = Projection::Perspective { focal: None };
        }
        let rounded = |p: &mut DVec2| *p = (*p * 1e6).round() / 1e6;
        drawing.vertices.iter_mut().for_each(rounded);
        for e in &mut drawing.edges {
            e.points.iter_mut().for_each(rounded);
            e.curve = Curve2::recognise(&e.points);
        }
        let found = lifted(&drawing, &faces);
        prop_assert!(error(&drawing, &found) < 2e-3, "{}", error(&drawing, &found));
        prop_assert!(found.conflicts.is_empty());
        let scale = found.depths[0] / drawing.truth.as_ref().unwrap().vertices3d[0].z;
        for (face, surface) in faces.iter().zip(&found.surfaces) {
            match *surface {
                Surface::Cylinder { radius: r, .. } => {
                    prop_assert!((r / scale - radius).abs() < 2e-3);
                }
                Surface::Plane { .. } => prop_assert_eq!(face.kind, SurfaceKind::Plane),
                _ => prop_assert!(false, "{surface:?}"),
            }
        }
    }
}

#[test]
fn the_scale_is_such_that_lengths_are_drawn_as_they_are() {
    let scene = Scene::central(turned(0.6, 0.7, 0.1), DVec3::Z * -9.0, DVec2::ZERO, 3.0);
    let (drawing, faces) = drilled(scene, DVec3::ONE, DVec2::splat(0.5), 0.2);
    let found = lifted(&drawing, &faces);
    let mean = found.depths.iter().map(|z| 3.0 / -z).sum::<f64>() / found.depths.len() as f64;
    assert!((mean - 1.0).abs() < 1e-9);
    assert_eq!(found.method, LiftMethod::Exact);
}

#[test]
fn faces_that_are_wrong_are_named() {
    let scene = Scene::central(turned(0.6, 0.7, 0.1), DVec3::Z * -5.0, DVec2::ZERO, 3.0);
    let (drawing, mut faces) = drilled(scene, DVec3::new(2.0, 1.5, 0.8), DVec2::splat(0.7), 0.3);
    let wall = faces.remove(0);
    let top = faces.len() - 1;
    faces[top].loops[0].extend(wall.loops[0].iter().copied());
    let found = lifted(&drawing, &faces);
    assert!(
        error(&drawing, &found) < 1e-6,
        "{}",
        error(&drawing, &found)
    );
    assert!(found.conflicts.iter().any(|c| c.face == top));
}

#[test]
fn the_end_of_a_frustum_is_centred() {
    let mut scene = Scene::central(turned(0.6, 0.7, 0.1), DVec3::Z * -6.0, DVec2::ZERO, 3.0);
    let base = polygon(&[[-1.0, -0.8], [1.0, -0.8], [1.0, 0.8], [-1.0, 0.8]]);
    let top: Vec<DVec3> = base.iter().map(|p| *p * 0.5 + DVec3::Z * 1.2).collect();
    let ring = |scene: &mut Scene, corners: &[DVec3]| -> Vec<usize> {
        (0..4)
            .map(|i| scene.line(corners[i], corners[(i + 1) % 4]))
            .collect()
    };
    let (low, high) = (ring(&mut scene, &base), ring(&mut scene, &top));
    for i in 0..4 {
        let sides = [i, (i + 1) % 4].map(|k| scene.line(base[k], top[k]));
        scene.face(
            SurfaceKind::Plane,
            &[vec![low[i], sides[1], high[i], sides[0]]],
        );
    }
    scene.face(SurfaceKind::Plane, &[low]);
    scene.face(SurfaceKind::Plane, &[high]);
    let (drawing, faces) = scene.finish();
    let found = lifted(&drawing, &faces);
    assert!(
        error(&drawing, &found) < 1e-6,
        "{}",
        error(&drawing, &found)
    );
}

/// The outlines of a cone meet in a point that is no vanishing point.
#[test]
fn the_outlines_of_a_cone_follow_no_axis() {
    let scene = Scene::central(turned(0.6, 0.7, 0.1), DVec3::Z * -9.0, DVec2::ZERO, 3.0);
    let (drawing, mut faces) = drilled(scene, DVec3::ONE, DVec2::splat(0.5), 0.2);
    let readings = Directions::estimate(&drawing).unwrap();
    let lines = |faces: &[Face]| {
        let sheet = Sheet::new(&drawing, faces, &readings);
        let along = |&&e: &&usize| sheet.is_straight(e) && sheet.edge_axis[e].is_some();
        faces
            .iter()
            .enumerate()
            .filter(|(_, f)| f.kind != SurfaceKind::Plane)
            .map(|(f, _)| sheet.edges_of(f).iter().filter(along).count())
            .sum::<usize>()
    };
    assert!(lines(&faces) > 0);
    for face in &mut faces {
        if face.kind == SurfaceKind::Cylinder {
            face.kind = SurfaceKind::Cone;
        }
    }
    assert_eq!(lines(&faces), 0);
}

/// Two blocks that nothing ties to each other have a scale each: the vertices of one are open, not all.
#[test]
fn only_the_vertices_of_the_loose_part_are_named() {
    let mut scene = Scene::central(turned(0.6, 0.7, 0.1), DVec3::Z * -7.0, DVec2::ZERO, 3.0);
    let base = polygon(&[[-1.0, -0.8], [1.0, -0.8], [1.0, 0.8], [-1.0, 0.8]]);
    let far: Vec<DVec3> = [[1.3, 0.3], [1.7, 0.35], [1.6, 0.7]]
        .map(|[x, y]| DVec3::new(x, y, 0.3))
        .to_vec();
    for (profile, along) in [(&base, DVec3::Z), (&far, DVec3::Z * 0.4)] {
        let [low, high] = scene.prism(profile, along);
        scene.face(SurfaceKind::Plane, &[low]);
        scene.face(SurfaceKind::Plane, &[high]);
    }
    let (mut drawing, faces) = scene.finish();
    // Coordinates of a file: the rows of the small part disagree a little.
    let rounded = |p: &mut DVec2| *p = (*p * 1e6).round() / 1e6;
    drawing.vertices.iter_mut().for_each(rounded);
    for e in &mut drawing.edges {
        e.points.iter_mut().for_each(rounded);
    }
    let refusal = lift(&drawing, &faces, &LiftOptions::default(), Progress::none());
    let Err(crate::Error::Lift(LiftError::UnderConstrained { vertices })) = refusal else {
        panic!("{refusal:?}");
    };
    assert_eq!(vertices, [8, 9, 10, 11, 12, 13]);
}

/// Holes across a block's axes show a normal of their own. It is assumed, so that grouping, which
/// knows the axes only, sees no circles around it.
#[test]
fn circles_beside_the_axes_stay_out_of_grouping() {
    let mut scene = Scene::central(turned(0.6, 0.7, 0.1), DVec3::Z * -7.0, DVec2::ZERO, 3.0);
    let base = polygon(&[[-1.0, -0.8], [1.0, -0.8], [1.0, 0.8], [-1.0, 0.8]]);
    let [low, high] = scene.prism(&base, DVec3::Z);
    scene.face(SurfaceKind::Plane, &[low]);
    scene.face(SurfaceKind::Plane, &[high]);
    let across = DVec3::new(0.5, 0.3, 0.8).normalize() * 0.4;
    for center in [[-0.6, -0.4], [0.0, 0.3], [0.6, -0.3], [-0.5, 0.4]] {
        let center = DVec3::new(center[0], center[1], 0.3);
        for circle in scene.wall(center, across, 0.12) {
            scene.face(SurfaceKind::Plane, &[circle]);
        }
    }
    let (drawing, faces) = scene.finish();
    let further = |d: &Directions| d.normals().count() > d.axes.len();
    let candidates = Directions::candidates(&drawing).unwrap();
    assert!(candidates.iter().any(further));
    let readings = Readings::new(&drawing);
    let (_, pieces) = Pieces::new(&readings, &faces).unwrap();
    for e in 0..drawing.edges.len() {
        assert!(pieces.circle(e).is_none_or(|(k, _)| k < pieces.axes.len()));
    }
}
