//! A spring washer of known depth, drawn for tests.

use glam::{DMat3, DVec2, DVec3};

use super::*;
use crate::Progress;
use crate::drawing::{CoEdge, Edge, SurfaceKind};
use crate::identify::{Evidence, Face};
use crate::lift::{LiftOptions, lift};

/// Turns of a spring washer, and points of a turn of its edges.
const TURNS: f64 = 0.96;
const POINTS: usize = 64;

/// A spring washer around z: a rectangular section from (0.5, 0) to (0.8, 0.15) that rises by 0.2 in a
/// turn. With `twist` it turns by as much a radian in its own plane.
struct Washer {
    twist: f64,
}

impl Washer {
    fn point(&self, corner: usize, t: f64) -> DVec3 {
        let flat = [(-0.15, 0.0), (0.15, 0.0), (0.15, 0.15), (-0.15, 0.15)][corner];
        let turned = DVec2::from_angle(self.twist * t).rotate(flat.into());
        let (radius, rise) = (0.65, 0.2 / (2.0 * PI));
        let out = DVec3::new(t.cos(), t.sin(), 0.0);
        if self.twist == 0.0 {
            // True helices.
            return out * (radius + turned.x) + DVec3::Z * (rise * t + turned.y);
        }
        let on = DVec3::new(-t.sin(), t.cos(), 0.0);
        let up = (DVec3::Z * radius - on * rise) / radius.hypot(rise);
        out * (radius + turned.x) + DVec3::Z * (rise * t) + up * turned.y
    }
}

/// The washer drawn by a camera that it is turned for and is `away` from, its depths and its faces.
fn drawn(washer: &Washer, camera: Camera, away: f64) -> (Drawing, Vec<f64>, Vec<Face>) {
    let turn = DMat3::from_rotation_x(-0.9) * DMat3::from_rotation_z(0.7);
    let place = |p: DVec3| turn * p - DVec3::Z * away;
    let rounded = |p: DVec2| DVec2::new((p.x * 1e6).round() / 1e6, (p.y * 1e6).round() / 1e6);
    let image = |p: DVec3| rounded(camera.project(place(p)));
    let last = TURNS * 2.0 * PI;
    let ends: Vec<DVec3> = (0..8)
        .map(|i| washer.point(i % 4, if i < 4 { 0.0 } else { last }))
        .collect();
    let mut edges = Vec::new();
    for corner in 0..4 {
        let at = |i: usize| washer.point(corner, last * i as f64 / POINTS as f64);
        edges.push((
            [corner, corner + 4],
            (0..=POINTS).map(|i| image(at(i))).collect(),
        ));
    }
    for first in [0, 4] {
        for i in 0..4 {
            let v = [first + i, first + (i + 1) % 4];
            edges.push((v, v.map(|v| image(ends[v])).to_vec()));
        }
    }
    let loops: [(SurfaceKind, [i64; 4]); 6] = [
        (SurfaceKind::Other, [1, 9, -2, -5]),
        (SurfaceKind::Other, [2, 10, -3, -6]),
        (SurfaceKind::Other, [3, 11, -4, -7]),
        (SurfaceKind::Other, [4, 12, -1, -8]),
        (SurfaceKind::Plane, [5, 6, 7, 8]),
        (SurfaceKind::Plane, [-12, -11, -10, -9]),
    ];
    let faces = loops.map(|(kind, walk)| {
        let walk = walk.iter().filter_map(|&k| CoEdge::from_signed(k));
        Face {
            kind,
            loops: vec![walk.collect()],
            confidence: 1.0,
            evidence: Evidence::default(),
        }
    });
    let edge = |(v, points): ([usize; 2], Vec<DVec2>)| Edge::drawn(v, points);
    let vertices = ends.iter().map(|p| image(*p)).collect();
    let mut drawing = Drawing::orthographic(vertices, edges.into_iter().map(edge).collect());
    if let Camera::Central { focal, .. } = camera {
        drawing.projection = Projection::Perspective { focal: Some(focal) };
    }
    let depths = ends.iter().map(|p| place(*p).z).collect();
    (drawing, depths, faces.to_vec())
}

const CENTRAL: Camera = Camera::Central {
    principal: DVec2::ZERO,
    focal: 3.0,
};

/// Largest error of lifted depths: up to a shift and the reversal, or a factor.
fn error(camera: Camera, lifted: &[f64], depths: &[f64]) -> f64 {
    let signs: &[f64] = if camera.is_parallel() {
        &[1.0, -1.0]
    } else {
        &[1.0]
    };
    let errors = signs.iter().map(|sign| {
        let own = depths.iter().map(|z| z * sign);
        let off: Vec<f64> = lifted
            .iter()
            .zip(own)
            .map(|(a, b)| if camera.is_parallel() { a - b } else { a / b })
            .collect();
        let low = off.iter().copied().fold(f64::INFINITY, f64::min);
        let high = off.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        high - low
    });
    errors.fold(f64::INFINITY, f64::min)
}

#[test]
fn spring_washers_are_lifted_by_their_edges() {
    // Of true helices, and of a section that turns in the frame of least rotation.
    let least = (0.2 / (2.0 * PI) / 0.65f64).atan().sin();
    for twist in [0.0, least] {
        for (camera, away) in [(Camera::Parallel, 0.0), (CENTRAL, 3.2)] {
            let (drawing, depths, faces) = drawn(&Washer { twist }, camera, away);
            let found = sweeps(&drawing);
            assert_eq!(found.len(), 1, "{twist} {camera:?}");
            assert_eq!(found[0].edges.len(), 4, "{twist} {camera:?}");
            let lifted = lift(&drawing, &faces, &LiftOptions::default(), Progress::none());
            let lifted = lifted.unwrap_or_else(|e| panic!("{twist} {camera:?}: {e}"));
            let off = error(camera, &lifted.depths, &depths);
            assert!(off < 5e-4, "{twist} {camera:?}: {off}");
            assert_eq!(lifted.curves.len(), 4);
            assert!(lifted.conflicts.is_empty(), "{:?}", lifted.conflicts);
        }
    }
}

#[test]
fn curves_of_swept_edges_are_drawn_where_the_edges_are() {
    let (drawing, _, faces) = drawn(&Washer { twist: 0.03 }, CENTRAL, 3.2);
    let lifted = lift(&drawing, &faces, &LiftOptions::default(), Progress::none());
    let lifted = lifted.unwrap_or_else(|e| panic!("{e}"));
    for curve in &lifted.curves {
        let drawn = &drawing.edges[curve.edge].points;
        for p in &curve.points {
            let p = lifted.camera.project(*p);
            let off = drawn.windows(2).map(|s| {
                let d = s[1] - s[0];
                let t = ((p - s[0]).dot(d) / d.length_squared()).clamp(0.0, 1.0);
                p.distance(s[0] + d * t)
            });
            assert!(off.fold(f64::INFINITY, f64::min) < 2e-3);
        }
    }
}

#[test]
fn circles_and_other_curves_are_no_sweeps() {
    // Curves that are nearly ellipses and belong to no helix.
    let point = |k: usize, t: f64| {
        let wave = 0.03 * (3.0 * t + k as f64).sin();
        DVec2::new((0.5 + 0.2 * k as f64) * t.cos(), 0.3 * t.sin() + wave)
    };
    let mut vertices = Vec::new();
    let mut edges = Vec::new();
    for k in 0..3 {
        let points: Vec<DVec2> = (0..=40).map(|i| point(k, 0.1 * f64::from(i))).collect();
        vertices.extend([points[0], points[40]]);
        edges.push(Edge::drawn([2 * k, 2 * k + 1], points));
    }
    assert!(sweeps(&Drawing::orthographic(vertices, edges)).is_empty());
}
