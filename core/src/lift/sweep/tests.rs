use glam::{DMat3, DVec2, DVec3};

use super::*;
use crate::drawing::{CoEdge, Curve2, Edge, Projection, SurfaceKind};
use crate::identify::Face;
use crate::lift::model::LiftOptions;
use crate::lift::{LiftMethod, lift};
use crate::progress::Progress;

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
        edges.push(([corner, corner + 4], (0..=POINTS).map(|i| image(at(i))).collect()));
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
        Face::new(kind, vec![walk.collect()])
    });
    let edge = |(v, points): ([usize; 2], Vec<DVec2>)| Edge {
        v,
        curve: Curve2::recognise(&points),
        points,
    };
    let drawing = Drawing {
        projection: match camera {
            Camera::Parallel => Projection::Orthographic,
            Camera::Central { focal, .. } => Projection::Perspective { focal: Some(focal) },
        },
        vertices: ends.iter().map(|p| image(*p)).collect(),
        edges: edges.into_iter().map(edge).collect(),
        ..Drawing::default()
    };
    let depths = ends.iter().map(|p| place(*p).z).collect();
    (drawing, depths, faces.to_vec())
}
