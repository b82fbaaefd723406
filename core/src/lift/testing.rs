//! Solids drawn for tests: known depths, exact curves.

use std::f64::consts::PI;

use glam::{DQuat, DVec2, DVec3, EulerRot};

use crate::drawing::{CoEdge, Curve2, Drawing, Edge, EllipseArc, Projection, SurfaceKind, Truth};
use crate::identify::{Evidence, Face};

/// A view from above and from the side.
pub(super) fn turned(x: f64, y: f64, z: f64) -> DQuat {
    DQuat::from_euler(EulerRot::ZXY, z, x, y)
}

/// A solid in its own coordinates, drawn after a turn.
pub(super) struct Scene {
    turn: DQuat,
    vertices: Vec<DVec3>,
    edges: Vec<Edge>,
    faces: Vec<Face>,
}

impl Scene {
    pub(super) fn new(turn: DQuat) -> Self {
        Self {
            turn,
            vertices: Vec::new(),
            edges: Vec::new(),
            faces: Vec::new(),
        }
    }

    fn vertex(&mut self, p: DVec3) -> usize {
        let known = self.vertices.iter().position(|q| q.distance(p) < 1e-9);
        known.unwrap_or_else(|| {
            self.vertices.push(p);
            self.vertices.len() - 1
        })
    }

    fn drawn(&self, p: DVec3) -> DVec2 {
        (self.turn * p).truncate()
    }

    /// A straight edge; one that is there already is found again.
    pub(super) fn line(&mut self, a: DVec3, b: DVec3) -> usize {
        let v = [self.vertex(a), self.vertex(b)];
        let same = |e: &Edge| matches!(e.curve, Curve2::Line) && (e.v == v || e.v == [v[1], v[0]]);
        if let Some(known) = self.edges.iter().position(same) {
            return known;
        }
        let points = vec![self.drawn(a), self.drawn(b)];
        self.edges.push(Edge {
            v,
            points,
            curve: Curve2::Line,
        });
        self.edges.len() - 1
    }

    /// Half a circle around `axis` from `center + across` to `center - across`.
    fn half_circle(&mut self, center: DVec3, axis: DVec3, across: DVec3) -> usize {
        let v = [self.vertex(center + across), self.vertex(center - across)];
        let at = |t: f64| center + across * t.cos() + axis.cross(across) * t.sin();
        let points: Vec<DVec2> = (0..=16)
            .map(|i| self.drawn(at(PI * f64::from(i) / 16.0)))
            .collect();
        let n = self.turn * axis;
        let ratio = n.z.abs();
        let mut arc = EllipseArc {
            center: self.drawn(center),
            major: n.truncate().normalize().perp() * across.length(),
            ratio,
            start: 0.0,
            sweep: PI * n.z.signum(),
            residual: 0.0,
            uncertainty: 0.0,
        };
        arc.start = arc.parameter(points[0]);
        self.edges.push(Edge {
            v,
            points,
            curve: Curve2::Ellipse(arc),
        });
        self.edges.len() - 1
    }

    /// A face from loops of edges, each loop in walking order.
    pub(super) fn face(&mut self, kind: SurfaceKind, loops: &[Vec<usize>]) {
        let walk = |edges: &Vec<usize>| {
            let ends = |e: usize| self.edges[e].v;
            let first = ends(edges[0]);
            let second = ends(edges[1]);
            let mut at = first[0];
            if second.contains(&first[0]) && !second.contains(&first[1]) {
                at = first[1];
            }
            let mut coedges = Vec::new();
            for &e in edges {
                let reversed = ends(e)[0] != at;
                coedges.push(CoEdge::new(e, reversed));
                at = ends(e)[usize::from(!reversed)];
            }
            coedges
        };
        self.faces.push(Face {
            kind,
            loops: loops.iter().map(walk).collect(),
            confidence: 1.0,
            evidence: Evidence::default(),
        });
    }

    /// A round wall from `center` along `axis` (its length is the wall's): two outlines, four half
    /// circles, two faces. Gives the loops at the start and at the end.
    pub(super) fn wall(&mut self, center: DVec3, axis: DVec3, radius: f64) -> [Vec<usize>; 2] {
        let view = self.turn.inverse() * DVec3::Z;
        let along = axis.normalize();
        let across = along.cross(view).normalize() * radius;
        let loops = [center, center + axis].map(|c| {
            vec![
                self.half_circle(c, along, across),
                self.half_circle(c, along, -across),
            ]
        });
        let outlines = [across, -across].map(|a| self.line(center + a, center + axis + a));
        for (start, end) in loops[0].iter().zip(&loops[1]) {
            let boundary = vec![*start, outlines[1], *end, outlines[0]];
            self.face(SurfaceKind::Cylinder, &[boundary]);
        }
        loops
    }

    /// Side walls of a prism over a closed polygon; gives the loops at the bottom and at the top.
    pub(super) fn prism(&mut self, profile: &[DVec3], along: DVec3) -> [Vec<usize>; 2] {
        let n = profile.len();
        let mut loops = [Vec::new(), Vec::new()];
        for i in 0..n {
            let (a, b) = (profile[i], profile[(i + 1) % n]);
            let bottom = self.line(a, b);
            let top = self.line(a + along, b + along);
            let sides = [self.line(a, a + along), self.line(b, b + along)];
            self.face(SurfaceKind::Plane, &[vec![bottom, sides[1], top, sides[0]]]);
            loops[0].push(bottom);
            loops[1].push(top);
        }
        loops
    }

    /// The drawing with its truth, and the faces.
    pub(super) fn finish(self) -> (Drawing, Vec<Face>) {
        let vertices3d: Vec<DVec3> = self.vertices.iter().map(|&p| self.turn * p).collect();
        let drawing = Drawing {
            id: String::new(),
            source: String::new(),
            projection: Projection::Orthographic,
            vertices: vertices3d.iter().map(|p| p.truncate()).collect(),
            edges: self.edges,
            truth: Some(Truth {
                vertices3d,
                ..Truth::default()
            }),
        };
        (drawing, self.faces)
    }
}

/// Corners of a polygon in the plane z = 0.
pub(super) fn polygon(corners: &[[f64; 2]]) -> Vec<DVec3> {
    corners
        .iter()
        .map(|c| DVec3::new(c[0], c[1], 0.0))
        .collect()
}

/// A prism with plane ends.
pub(super) fn extrusion(turn: DQuat, corners: &[[f64; 2]], height: f64) -> (Drawing, Vec<Face>) {
    let mut scene = Scene::new(turn);
    let [bottom, top] = scene.prism(&polygon(corners), DVec3::Z * height);
    scene.face(SurfaceKind::Plane, &[bottom]);
    scene.face(SurfaceKind::Plane, &[top]);
    scene.finish()
}

/// A block with a round hole through it along z.
pub(super) fn block_with_hole(
    turn: DQuat,
    size: DVec3,
    at: DVec2,
    radius: f64,
) -> (Drawing, Vec<Face>) {
    let mut scene = Scene::new(turn);
    let corners = polygon(&[[0.0, 0.0], [size.x, 0.0], [size.x, size.y], [0.0, size.y]]);
    let [bottom, top] = scene.prism(&corners, DVec3::Z * size.z);
    let [low, high] = scene.wall(at.extend(0.0), DVec3::Z * size.z, radius);
    scene.face(SurfaceKind::Plane, &[bottom, low]);
    scene.face(SurfaceKind::Plane, &[top, high]);
    scene.finish()
}

/// Cylinders of the given radii and lengths, one after the other along z.
pub(super) fn shaft(turn: DQuat, steps: &[(f64, f64)]) -> (Drawing, Vec<Face>) {
    let mut scene = Scene::new(turn);
    let mut z = 0.0;
    let mut before: Vec<Vec<usize>> = Vec::new();
    for &(radius, length) in steps {
        let [start, end] = scene.wall(DVec3::Z * z, DVec3::Z * length, radius);
        before.push(start);
        scene.face(SurfaceKind::Plane, &before);
        before = vec![end];
        z += length;
    }
    scene.face(SurfaceKind::Plane, &before);
    scene.finish()
}
