use glam::{DMat3, DVec2, DVec3};

use super::{OBLIQUE, attempt};
use crate::Progress;
use crate::drawing::{Curve2, Drawing, SurfaceKind};
use crate::identify::Face;
use crate::lift::directions::{Axis, Directions};
use crate::lift::testing::{Scene, extrusion, turned};
use crate::lift::{Camera, Lift, LiftMethod, LiftOptions, Surface, lift};

/// A bracket: all its angles are right.
pub(super) const BRACKET: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [1.4, 0.0],
    [1.4, 0.5],
    [0.6, 0.5],
    [0.6, 1.1],
    [0.0, 1.1],
];

/// Moves the vertices of a drawing by about a share of its size, and curves with their ends.
fn shaken(drawing: &Drawing, share: f64, seed: u64) -> Drawing {
    let mut state = seed;
    let mut unit = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut drawing = drawing.clone();
    let size = drawing.size();
    let mut steps = Vec::new();
    for p in &mut drawing.vertices {
        // A sum of even numbers is nearly normal.
        let mut normal = || (0..12).map(|_| unit()).sum::<f64>() - 6.0;
        let step = DVec2::new(normal(), normal()) * share * size;
        steps.push(step);
        *p += step;
    }
    for edge in &mut drawing.edges {
        let last = edge.points.len() - 1;
        let [from, to] = edge.v.map(|v| steps[v]);
        for (i, p) in edge.points.iter_mut().enumerate() {
            *p += from.lerp(to, i as f64 / last as f64);
        }
        if last > 1 {
            edge.curve = Curve2::recognise(&edge.points);
        }
    }
    drawing
}

fn lifted(drawing: &Drawing, faces: &[Face]) -> Lift {
    lift(drawing, faces, &LiftOptions::default(), Progress::none()).unwrap()
}

fn normals(found: &Lift) -> Vec<DVec3> {
    let normal = |s: &Surface| match *s {
        Surface::Plane { normal, .. } => Some(normal),
        _ => None,
    };
    found.surfaces.iter().filter_map(normal).collect()
}

#[test]
fn an_exact_drawing_is_left_alone() {
    let (drawing, faces) = extrusion(turned(0.6, 0.7, 0.05), &BRACKET, 0.8);
    let found = lifted(&drawing, &faces);
    assert_eq!(found.method, LiftMethod::Exact);
    assert_eq!(found.regular, None);
}

/// A bracket with that much noise: whether all its angles are right. Its vertices are on its planes
/// and near to where they were drawn in any case.
fn made_exact(seed: u64, share: f64) -> bool {
    let (drawing, faces) = extrusion(turned(0.6, 0.7, 0.05), &BRACKET, 0.8);
    let drawn = shaken(&drawing, share, seed);
    let found = lifted(&drawn, &faces);
    assert_eq!(found.method, LiftMethod::Regular);
    let regular = found.regular.as_ref().unwrap();
    assert!(regular.moved < 6.0 * share * drawing.size());
    assert!(!regular.snapped.is_empty() && !regular.notices().is_empty());
    let meant = regular.applied(&drawn);
    for (face, surface) in faces.iter().zip(&found.surfaces) {
        for v in face
            .loops
            .iter()
            .flatten()
            .flat_map(|c| meant.edges[c.edge()].v)
        {
            let p = meant.vertices[v].extend(found.depths[v]);
            assert!(surface.distance(p).abs() < 1e-9);
        }
    }
    let normals = normals(&found);
    assert_eq!(normals.len(), faces.len());
    let right = |a: &DVec3, b: &DVec3| {
        let dot = a.dot(*b).abs();
        dot < 1e-9 || (dot - 1.0).abs() < 1e-9
    };
    normals.iter().all(|a| normals.iter().all(|b| right(a, b)))
}

/// Noise that happens to look like a slope is not told from one: a few brackets keep it.
#[test]
fn brackets_by_hand_are_made_exact() {
    const DRAWN: usize = 200;
    let exact = (0..DRAWN as u64).filter(|&seed| made_exact(seed, 0.002 + 2e-5 * seed as f64));
    let exact = exact.count();
    println!("{exact} of {DRAWN}");
    assert!(exact * 100 >= 95 * DRAWN, "{exact}");
}

/// A plate whose thickness is a few errors keeps it: no reading that lays all in one plane is taken.
#[test]
fn thin_plates_by_hand_do_not_become_flat() {
    const DRAWN: u64 = 60;
    let (drawing, faces) = extrusion(turned(0.6, 0.7, 0.05), &BRACKET, 0.06);
    let thick = |&seed: &u64| {
        let found = lifted(&shaken(&drawing, 0.005, seed), &faces);
        let [bottom, top] = [faces.len() - 2, faces.len() - 1].map(|f| found.surfaces[f]);
        let v = faces[faces.len() - 2].loops[0][0].edge();
        let regular = found.regular.as_ref().unwrap();
        let v = drawing.edges[v].v[0];
        let p = regular.vertices[v].extend(found.depths[v]);
        bottom.distance(p).abs() < 1e-9 && (0.01..0.2).contains(&top.distance(p).abs())
    };
    let thick = (0..DRAWN).filter(thick).count();
    println!("{thick} of {DRAWN}");
    assert!(thick as u64 * 100 >= 90 * DRAWN, "{thick}");
}

/// The inside and the outside of a tube with a thin wall stay two cylinders around one axis.
#[test]
fn thin_tubes_by_hand_keep_their_walls() {
    const DRAWN: u64 = 20;
    let mut scene = Scene::new(turned(0.6, 0.7, 0.05));
    let [low, high] = scene.wall(DVec3::ZERO, DVec3::Z, 0.6);
    let [low_inside, high_inside] = scene.wall(DVec3::ZERO, DVec3::Z, 0.58);
    scene.face(SurfaceKind::Plane, &[low, low_inside]);
    scene.face(SurfaceKind::Plane, &[high, high_inside]);
    let (drawing, faces) = scene.finish();
    let has_wall = |&seed: &u64| {
        let found = lifted(&shaken(&drawing, 0.003, seed), &faces);
        let radius = |s: &Surface| match *s {
            Surface::Cylinder { radius, .. } => Some(radius),
            _ => None,
        };
        let radii: Vec<f64> = found.surfaces.iter().filter_map(radius).collect();
        radii.len() == 4 && (radii[0] - radii[2]).abs() > 1e-3
    };
    let with_wall = (0..DRAWN).filter(has_wall).count();
    println!("{with_wall} of {DRAWN}");
    assert!(with_wall as u64 * 100 >= 80 * DRAWN, "{with_wall}");
}

/// The reading of a drawing in which what follows the axes of a frame does so.
fn along(drawing: &Drawing, frame: DMat3) -> Directions {
    let places = &drawing.truth.as_ref().unwrap().vertices3d;
    let axes = [frame.x_axis, frame.y_axis, frame.z_axis].map(|direction| {
        let follows = |e: &usize| {
            let [a, b] = drawing.edges[*e].v.map(|v| places[v]);
            (b - a).normalize().cross(direction).length() < 1e-6
        };
        Axis {
            direction,
            edges: (0..drawing.edges.len()).filter(follows).collect(),
            circles: Vec::new(),
        }
    });
    Directions {
        axes: axes.into(),
        slanted: Vec::new(),
        swept: Vec::new(),
        camera: Camera::Parallel,
        error: 0.01,
        precision: 0.005,
    }
}

/// Along its roof a house fits its drawing as well as along its walls, which are more.
#[test]
fn the_frame_of_most_surfaces_is_taken_of_those_that_fit() {
    const NOISE: f64 = 0.005;
    let house = [[0.0, 0.0], [1.6, 0.0], [1.6, 0.6], [0.8, 1.4], [0.0, 0.6]];
    let turn = turned(0.6, 0.7, 0.05);
    let (drawing, faces) = extrusion(turn, &house, 1.1);
    let [walls, roof] = [0.0, 45.0f64].map(|degrees| {
        let frame = DMat3::from_quat(turn) * DMat3::from_rotation_z(degrees.to_radians());
        attempt(&drawing, &faces, &along(&drawing, frame)).unwrap()
    });
    assert_eq!([walls.oblique, roof.oblique], [2, 3]);
    assert_eq!(walls.freedom, roof.freedom);
    let apart = roof.cost(NOISE) - walls.cost(NOISE);
    assert!((apart - OBLIQUE).abs() < 1e-3, "{apart}");
}
