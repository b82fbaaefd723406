use glam::{DQuat, DVec2, DVec3};
use proptest::prelude::*;

use super::testing::{Scene, block_with_hole, extrusion, polygon, shaft, turned};
use super::*;
use crate::Error;
use crate::drawing::{Projection, SurfaceKind, Truth};

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

fn view() -> DQuat {
    turned(0.6, 0.7, 0.05)
}

fn lifted(drawing: &Drawing, faces: &[Face]) -> Lift {
    lift(drawing, faces, &LiftOptions::default(), Progress::none()).unwrap()
}

fn error(drawing: &Drawing, found: &Lift) -> f64 {
    depth_error(found, drawing.truth.as_ref().unwrap())
}

fn planes_and_cylinders(found: &Lift) -> (usize, usize) {
    let count = |f: fn(&Surface) -> bool| found.surfaces.iter().filter(|s| f(s)).count();
    (
        count(|s| matches!(s, Surface::Plane { .. })),
        count(|s| matches!(s, Surface::Cylinder { .. })),
    )
}

#[test]
fn a_cube_is_lifted_from_above() {
    let (drawing, faces) = extrusion(view(), &SQUARE, 1.0);
    let found = lifted(&drawing, &faces);
    assert!(error(&drawing, &found) < 1e-9);
    assert_eq!(found.method, LiftMethod::Exact);
    assert_eq!(planes_and_cylinders(&found), (6, 0));
    assert!(found.conflicts.is_empty() && found.residual < 1e-9);
    assert!(found.depths.iter().sum::<f64>().abs() < 1e-9);
    // The view is from above: of the steepest edges the upper end is nearer.
    let steep = found
        .directions
        .iter()
        .max_by(|a, b| a.y.abs().total_cmp(&b.y.abs()));
    assert!(steep.is_some_and(|d| d.y * d.z > 0.0));
}

#[test]
fn a_wedge_is_drawn_upright_and_stands_on_a_face() {
    // A right-angled triangle whose upright leg is drawn vertically, from several sides. Its
    // drawing fits the solids with the right angle at another corner as well.
    let triangle = [[0.0, 0.0], [1.6, 0.0], [0.0, 1.0]];
    for (tilt, yaw) in [(0.45, 0.65), (0.6, -0.5), (0.3, 0.9), (0.7, 2.5)] {
        let turn = DQuat::from_rotation_x(tilt) * DQuat::from_rotation_y(yaw);
        let (drawing, faces) = extrusion(turn, &triangle, 0.8);
        for flip in [false, true] {
            let options = LiftOptions { flip };
            let found = lift(&drawing, &faces, &options, Progress::none()).unwrap();
            assert!(error(&drawing, &found) < 1e-9, "tilt {tilt}, yaw {yaw}");
        }
    }
}

#[test]
fn flip_is_the_mirror_image() {
    let (drawing, faces) = extrusion(view(), &SQUARE, 0.7);
    let straight = lifted(&drawing, &faces);
    let flipped = lift(
        &drawing,
        &faces,
        &LiftOptions { flip: true },
        Progress::none(),
    )
    .unwrap();
    for (a, b) in straight.depths.iter().zip(&flipped.depths) {
        assert!((a + b).abs() < 1e-9);
    }
    let Surface::Plane { normal: a, .. } = straight.surfaces[0] else {
        panic!()
    };
    let Surface::Plane { normal: b, .. } = flipped.surfaces[0] else {
        panic!()
    };
    assert!(a.cross(b * DVec3::new(1.0, 1.0, -1.0)).length() < 1e-9);
}

#[test]
fn a_wedge_and_a_bracket_are_lifted() {
    let bracket = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 0.3],
        [0.4, 0.3],
        [0.4, 1.5],
        [0.0, 1.5],
    ];
    let house = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.8], [0.5, 1.3], [0.0, 0.8]];
    for (corners, faces_count) in [(&bracket[..], 8), (&house[..], 7)] {
        let (drawing, faces) = extrusion(view(), corners, 0.9);
        let found = lifted(&drawing, &faces);
        assert!(error(&drawing, &found) < 1e-8);
        assert_eq!(planes_and_cylinders(&found), (faces_count, 0));
    }
}

#[test]
fn a_hole_becomes_a_cylinder() {
    let (drawing, faces) =
        block_with_hole(view(), DVec3::new(2.0, 1.5, 0.8), DVec2::new(0.9, 0.7), 0.4);
    let found = lifted(&drawing, &faces);
    assert!(error(&drawing, &found) < 1e-8);
    assert_eq!(planes_and_cylinders(&found), (6, 2));
    let center = view() * DVec3::new(0.9, 0.7, 0.0);
    let direction = view() * DVec3::Z;
    let shift = found.depths[0] - drawing.truth.as_ref().unwrap().vertices3d[0].z;
    for surface in &found.surfaces {
        if let Surface::Cylinder {
            origin,
            axis,
            radius,
        } = surface
        {
            assert!((radius - 0.4).abs() < 1e-8);
            assert!(axis.cross(direction).length() < 1e-8);
            let off = *origin - center - DVec3::Z * shift;
            assert!(off.cross(direction).length() < 1e-8, "{off}");
        }
    }
}

#[test]
fn a_surface_taken_for_another_kind_is_the_one_that_fits() {
    let (drawing, mut faces) =
        block_with_hole(view(), DVec3::new(2.0, 1.5, 0.8), DVec2::new(0.8, 0.7), 0.3);
    for face in faces.iter_mut().filter(|f| f.kind == SurfaceKind::Cylinder) {
        face.kind = SurfaceKind::Torus;
    }
    let found = lifted(&drawing, &faces);
    assert!(error(&drawing, &found) < 1e-9);
    assert_eq!(planes_and_cylinders(&found), (6, 2));
}

#[test]
fn a_stepped_shaft_needs_no_frame() {
    let (drawing, faces) = shaft(view(), &[(1.0, 0.5), (0.6, 2.0), (0.8, 0.3)]);
    let found = lifted(&drawing, &faces);
    assert_eq!(found.directions.len(), 1);
    assert!(error(&drawing, &found) < 1e-8);
    assert_eq!(planes_and_cylinders(&found), (4, 6));
    let axis = view() * DVec3::Z;
    let along = |d: DVec3| {
        [axis, axis * DVec3::new(1.0, 1.0, -1.0)]
            .iter()
            .any(|a| a.cross(d).length() < 1e-8)
    };
    assert!(found.surfaces.iter().all(|s| match s {
        Surface::Cylinder { radius, axis, .. } =>
            along(*axis) && [1.0, 0.6, 0.8].iter().any(|r| (r - radius).abs() < 1e-8),
        Surface::Plane { normal, .. } => along(*normal),
        _ => false,
    }));
}

#[test]
fn faces_that_are_wrong_are_named() {
    let (drawing, mut faces) =
        block_with_hole(view(), DVec3::new(2.0, 1.5, 0.8), DVec2::new(0.9, 0.7), 0.4);
    // A side wall is taken for one face with the top, and the hole's wall for a plane.
    let wall = faces.remove(0);
    let top = faces.len() - 1;
    faces[top].loops[0] = faces[top].loops[0]
        .iter()
        .chain(&wall.loops[0])
        .copied()
        .collect();
    let hole = faces
        .iter()
        .position(|f| f.kind == SurfaceKind::Cylinder)
        .unwrap();
    faces[hole].kind = SurfaceKind::Plane;
    let found = lifted(&drawing, &faces);
    assert_eq!(found.method, LiftMethod::L1);
    assert!(error(&drawing, &found) < 1e-8);
    let conflict = found.conflicts.iter().find(|c| c.face == top).unwrap();
    assert!(conflict.vertices.len() >= 2 && !conflict.others.is_empty());
    assert!(conflict.residual > 0.1);
    assert!(
        found
            .conflicts
            .iter()
            .all(|c| c.face == top || c.face == hole)
    );
}

/// Takes the first face of a kind from those given.
fn take_face(faces: &mut Vec<Face>, kind: SurfaceKind) -> Face {
    let at = faces.iter().position(|f| f.kind == kind).unwrap();
    faces.remove(at)
}

#[test]
fn a_wall_taken_for_one_with_a_hole_is_the_only_face_blamed() {
    let size = DVec3::new(2.0, 1.5, 0.8);
    let (drawing, right) = block_with_hole(view(), size, DVec2::new(0.9, 0.7), 0.4);
    for confidence in [1.0, 0.1] {
        let mut faces = right.clone();
        let hole = take_face(&mut faces, SurfaceKind::Cylinder);
        let top = faces
            .iter()
            .position(|f| f.edge_set().iter().any(|e| hole.edge_set().contains(e)))
            .unwrap();
        faces[top].loops.extend(hole.loops);
        faces[top].confidence = confidence;
        let found = lifted(&drawing, &faces);
        assert!(error(&drawing, &found) < 1e-8);
        let named: Vec<usize> = found.conflicts.iter().map(|c| c.face).collect();
        assert_eq!(named, [top]);
    }
}

#[test]
fn a_loop_in_the_wrong_face_is_hung_where_it_belongs() {
    // A block with a blind pocket, which hangs on the block by one loop alone.
    let mut scene = Scene::new(view());
    let block = scene.prism(&polygon(&SQUARE), DVec3::Z * 0.9);
    let pocket: Vec<DVec3> = polygon(&SQUARE)
        .iter()
        .map(|p| DVec3::new(0.3 + 0.4 * p.x, 0.3 + 0.4 * p.y, 0.4))
        .collect();
    let [floor, mouth] = scene.prism(&pocket, DVec3::Z * 0.5);
    let [bottom, top] = block;
    scene.face(SurfaceKind::Plane, &[bottom]);
    scene.face(SurfaceKind::Plane, &[floor]);
    scene.face(SurfaceKind::Plane, &[top, mouth]);
    let (drawing, mut faces) = scene.finish();
    assert!(error(&drawing, &lifted(&drawing, &faces)) < 1e-8);
    let host = faces.len() - 1;
    let taken = faces[host].loops.pop().unwrap();
    faces[0].loops.push(taken);
    let found = lifted(&drawing, &faces);
    assert!(error(&drawing, &found) < 1e-8);
    let named: Vec<usize> = found.conflicts.iter().map(|c| c.face).collect();
    assert_eq!(named, [0], "{:?}", found.conflicts);
}

#[test]
fn two_solids_have_no_common_depth() {
    let mut scene = Scene::new(view());
    for x in [0.0, 3.0] {
        let corners: Vec<DVec3> = polygon(&SQUARE).iter().map(|p| p + DVec3::X * x).collect();
        let ends = scene.prism(&corners, DVec3::Z);
        for end in ends {
            scene.face(SurfaceKind::Plane, &[end]);
        }
    }
    let (drawing, faces) = scene.finish();
    let refused = lift(&drawing, &faces, &LiftOptions::default(), Progress::none());
    let Err(Error::Lift(LiftError::UnderConstrained { vertices })) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!(vertices.len(), 8);
}

#[test]
fn faces_are_not_needed_where_edges_are_enough() {
    let (drawing, _) = extrusion(view(), &SQUARE, 1.0);
    let found = lifted(&drawing, &[]);
    assert!(error(&drawing, &found) < 1e-9);
    assert!(found.surfaces.is_empty());
}

#[test]
fn flipped_perspective_and_cancelling_stop() {
    let (mut drawing, faces) = extrusion(view(), &SQUARE, 1.0);
    let stop = |_: Stage, share: f64| share < 0.1;
    let stopped = lift(
        &drawing,
        &faces,
        &LiftOptions::default(),
        Progress::new(&stop),
    );
    assert_eq!(stopped, Err(Error::Cancelled));
    drawing.projection = Projection::Perspective { focal: Some(3.0) };
    let flipped = LiftOptions { flip: true };
    let refused = lift(&drawing, &faces, &flipped, Progress::none());
    assert_eq!(refused, Err(LiftError::NoReversal.into()));
}

#[test]
fn faces_with_edges_that_are_not_there_do_no_harm() {
    let (drawing, mut faces) = extrusion(view(), &SQUARE, 1.0);
    faces[0].loops[0].push(crate::drawing::CoEdge::new(99, false));
    faces[1].loops.clear();
    let found = lifted(&drawing, &faces);
    assert!(error(&drawing, &found) < 1e-9);
    assert_eq!(found.surfaces.len(), faces.len());
}

#[test]
fn depth_error_knows_offset_and_reversal() {
    let (drawing, faces) = extrusion(view(), &SQUARE, 1.0);
    let mut found = lifted(&drawing, &faces);
    for z in &mut found.depths {
        *z = 5.0 - *z;
    }
    assert!(error(&drawing, &found) < 1e-9);
    found.depths[3] += 0.02;
    assert!((error(&drawing, &found) - 0.01).abs() < 1e-9);
    assert_eq!(depth_error(&found, &Truth::default()), f64::INFINITY);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any generic view of a block with a hole is lifted to within the rounding of its
    /// coordinates, wherever it lies in depth and on the page.
    #[test]
    fn any_view_of_a_block_with_a_hole_is_lifted(
        x in 0.2..1.3f64, y in 0.2..1.3f64, z in -3.0..3.0f64,
        width in 1.0..3.0f64, depth in 1.0..2.0f64, height in 0.3..2.0f64,
        radius in 0.1..0.4f64, rounded: bool, move_x in -5.0..5.0f64,
    ) {
        let size = DVec3::new(width, depth, height);
        let (mut drawing, faces) =
            block_with_hole(turned(x, y, z), size, DVec2::new(0.5, 0.5), radius);
        let shift = DVec2::new(move_x, 0.3);
        let moved = |p: DVec2| {
            let p = p + shift;
            if rounded { (p * 1e6).round() / 1e6 } else { p }
        };
        drawing.vertices.iter_mut().for_each(|p| *p = moved(*p));
        for e in &mut drawing.edges {
            e.points.iter_mut().for_each(|p| *p = moved(*p));
            e.curve = crate::drawing::Curve2::recognise(&e.points);
        }
        let found = lifted(&drawing, &faces);
        let limit = if rounded { 5e-4 } else { 1e-6 };
        prop_assert!(error(&drawing, &found) < limit, "{}", error(&drawing, &found));
        prop_assert_eq!(planes_and_cylinders(&found), (6, 2));
        prop_assert!(found.conflicts.is_empty());
    }
}
