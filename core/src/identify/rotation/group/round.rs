//! Cylinders and patches of them for tests, seen from above.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DMat3, DVec3};

use super::links::{Link, links};
use super::shapes::Shapes;
use crate::drawing::{CoEdge, Drawing, Edge, Graph, SurfaceKind};
use crate::identify::{Evidence, Face};
use crate::lift::{Pieces, Readings};

/// A cylinder, or a patch of one that faces the viewer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Round {
    center: [f64; 2],
    radius: f64,
    ends: [f64; 2],
    /// Half the angle of a patch.
    angle: Option<f64>,
}

impl Round {
    /// A whole cylinder: its loops are the bottom, the top, the near and the far wall.
    pub(super) fn cylinder(center: [f64; 2], radius: f64, low: f64, high: f64) -> Self {
        Self {
            center,
            radius,
            ends: [low, high],
            angle: None,
        }
    }

    /// A patch: its loops are its two sides.
    pub(super) fn patch(center: [f64; 2], radius: f64, ends: [f64; 2], angle: f64) -> Self {
        Self {
            center,
            radius,
            ends,
            angle: Some(angle),
        }
    }
}

/// The drawing, and its loops.
pub(super) fn drawn(all: &[Round]) -> (Drawing, Vec<Face>) {
    let view = DMat3::from_rotation_x(-0.9);
    let to_viewer = view.transpose() * DVec3::Z;
    let front = to_viewer.y.atan2(to_viewer.x);
    let (mut vertices, mut edges, mut loops) = (Vec::new(), Vec::new(), Vec::new());
    for round in all {
        let at = |angle: f64, z: f64| {
            let (sin, cos) = angle.sin_cos();
            let [x, y] = round.center;
            view * DVec3::new(x + round.radius * cos, y + round.radius * sin, z)
        };
        let half = round.angle.unwrap_or(FRAC_PI_2);
        let (v, e) = (vertices.len(), edges.len());
        for z in round.ends {
            vertices.extend([front - half, front + half].map(|a| at(a, z).truncate()));
        }
        let mut push = |ends: [usize; 2], points: Vec<DVec3>| {
            let points: Vec<_> = points.into_iter().map(|p| p.truncate()).collect();
            edges.push(Edge::drawn(ends.map(|k| v + k), points));
        };
        let arc = |from: f64, to: f64, z: f64| -> Vec<DVec3> {
            let angles = (0..=32).map(|k| from + (to - from) * f64::from(k) / 32.0);
            angles.map(|a| at(front + a, z)).collect()
        };
        let [low, high] = round.ends;
        for (k, angle) in [(0, -half), (1, half)] {
            push(
                [k, k + 2],
                [low, high].map(|z| at(front + angle, z)).to_vec(),
            );
        }
        for (k, z) in [(0, low), (2, high)] {
            push([k, k + 1], arc(-half, half, z));
        }
        let near: &[(usize, bool)] = &[(2, false), (1, false), (3, true), (0, true)];
        let back: &[(usize, bool)] = &[(0, false), (3, false), (1, true), (2, true)];
        let mut walks = vec![(SurfaceKind::Cylinder, near)];
        if round.angle.is_some() {
            walks.push((SurfaceKind::Cylinder, back));
        } else {
            for (k, z) in [(0, low), (2, high)] {
                push([k + 1, k], arc(half, 2.0 * PI - half, z));
            }
            let far: &[(usize, bool)] = &[(4, false), (0, false), (5, true), (1, true)];
            let bottom: &[(usize, bool)] = &[(2, true), (4, true)];
            let top: &[(usize, bool)] = &[(3, false), (5, false)];
            walks.push((SurfaceKind::Cylinder, far));
            walks.splice(0..0, [bottom, top].map(|w| (SurfaceKind::Plane, w)));
        }
        loops.extend(walks.into_iter().map(|(kind, walk)| Face {
            kind,
            loops: vec![walk.iter().map(|&(k, back)| CoEdge::new(e + k, back)).collect()],
            confidence: 1.0,
            evidence: Evidence::default(),
        }));
    }
    let drawing = Drawing::orthographic(vertices, edges);
    (drawing, loops)
}

/// Calls `look` with the shapes and links of lifted loops.
pub(super) fn lifted(drawing: &Drawing, loops: &[Face], look: impl Fn(&Shapes, &[Link])) {
    let readings = Readings::new(drawing);
    let (drawing, pieces) = Pieces::new(&readings, loops).unwrap();
    let shapes = Shapes::new(&drawing, &Graph::new(&drawing), &pieces, loops);
    look(&shapes, &links(&shapes));
}
