//! Solids drawn for tests: known depths, exact curves.

use std::f64::consts::PI;

use glam::{DQuat, DVec2, DVec3, EulerRot};

use super::Camera;
use crate::drawing::{CoEdge, Curve2, Drawing, Edge, EllipseArc, Projection, SurfaceKind, Truth};
use crate::identify::{Evidence, Face};

/// A view from above and from the side.
pub(super) fn turned(x: f64, y: f64, z: f64) -> DQuat {
    DQuat::from_euler(EulerRot::ZXY, z, x, y)
}

/// A solid in its own coordinates, drawn after a turn.
pub(super) struct Scene {
    turn: DQuat,
    /// Moves the turned solid in front of the camera.
    shift: DVec3,
    camera: Camera,
    vertices: Vec<DVec3>,
    edges: Vec<Edge>,
    faces: Vec<Face>,
}

impl Scene {
    pub(super) fn new(turn: DQuat) -> Self {
        Self {
            turn,
            shift: DVec3::ZERO,
            camera: Camera::Parallel,
            vertices: Vec::new(),
            edges: Vec::new(),
            faces: Vec::new(),
        }
    }

    /// Draws in perspective, the solid's origin at `shift` from the camera.
    pub(super) fn central(turn: DQuat, shift: DVec3, principal: DVec2, focal: f64) -> Self {
        Self {
            shift,
            camera: Camera::Central { principal, focal },
            ..Self::new(turn)
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
        self.camera.project(self.turn * p + self.shift)
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

    /// Where a cylinder's outlines are, from a point of its axis: where the ray touches it.
    fn outline(&self, center: DVec3, along: DVec3, radius: f64) -> [DVec3; 2] {
        if self.camera.is_parallel() {
            let view = self.turn.inverse() * DVec3::Z;
            let across = along.cross(view).normalize() * radius;
            return [across, -across];
        }
        // Seen along the axis, the tangents from the camera to the circle.
        let eye = self.turn.inverse() * -self.shift;
        let away = (eye - center).reject_from_normalized(along);
        let (toward, side) = (away.normalize(), along.cross(away.normalize()));
        let cos = radius / away.length();
        let sin = (1.0 - cos * cos).sqrt();
        [1.0, -1.0].map(|s| (toward * cos + side * (s * sin)) * radius)
    }

    /// An arc around `axis` from `center + from`, counter-clockwise, to `center + to`; one that is there
    /// already is found again.
    pub(super) fn arc(&mut self, center: DVec3, axis: DVec3, from: DVec3, to: DVec3) -> usize {
        let v = [self.vertex(center + from), self.vertex(center + to)];
        let side = axis.cross(from);
        let sweep = to.dot(side).atan2(to.dot(from)).rem_euclid(2.0 * PI);
        let at = |t: f64| center + from * t.cos() + side * t.sin();
        let points: Vec<DVec2> = (0..=16)
            .map(|i| self.drawn(at(sweep * f64::from(i) / 16.0)))
            .collect();
        let same = |e: &Edge| {
            let ends = e.v == v || e.v == [v[1], v[0]];
            ends && e.points.len() == 17 && e.points[8].distance(points[8]) < 1e-9
        };
        if let Some(known) = self.edges.iter().position(same) {
            return known;
        }
        let curve = if self.camera.is_parallel() {
            let n = self.turn * axis;
            let mut arc = EllipseArc {
                center: self.drawn(center),
                major: n.truncate().normalize().perp() * from.length(),
                ratio: n.z.abs(),
                start: 0.0,
                sweep: sweep * n.z.signum(),
                residual: 0.0,
                uncertainty: 0.0,
            };
            arc.start = arc.parameter(points[0]);
            Curve2::Ellipse(arc)
        } else {
            Curve2::recognise(&points)
        };
        self.edges.push(Edge { v, points, curve });
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
        let along = axis.normalize();
        let [one, other] = self.outline(center, along, radius);
        let loops = [center, center + axis].map(|c| {
            vec![
                self.arc(c, along, one, other),
                self.arc(c, along, other, one),
            ]
        });
        let outlines = [one, other].map(|a| self.line(center + a, center + axis + a));
        for (start, end) in loops[0].iter().zip(&loops[1]) {
            let boundary = vec![*start, outlines[1], *end, outlines[0]];
            self.face(SurfaceKind::Cylinder, &[boundary]);
        }
        loops
    }

    /// A pipe's bend around `center` by `angle`, radians, from the spine's point `center + from` about the
    /// unit `axis`: two outlines, four half circles, two faces. Gives the loops at the start and at the end.
    pub(super) fn bend(
        &mut self,
        center: DVec3,
        axis: DVec3,
        from: DVec3,
        radius: f64,
        angle: f64,
    ) -> [Vec<usize>; 2] {
        const STEPS: i32 = 64;
        let side = axis.cross(from);
        let parallel = self.camera.is_parallel();
        let back = self.turn.inverse();
        let eye = back * -self.shift;
        // Where the tube's normal is at right angles to the line of sight, on one side or the other.
        let normal = |t: f64, sign: f64| {
            let spine = center + from * t.cos() + side * t.sin();
            let out = (spine - center).normalize();
            let (sight, near) = if parallel {
                (back * DVec3::NEG_Z, 0.0)
            } else {
                (spine - eye, radius)
            };
            let (a, b) = (sight.dot(out), sight.dot(axis));
            let v = b.atan2(a) + sign * (-near / a.hypot(b)).acos();
            (spine, out * v.cos() + axis * v.sin())
        };
        let mut outlines = Vec::new();
        for sign in [1.0, -1.0] {
            let at = |i: i32| {
                let (spine, normal) = normal(angle * f64::from(i) / f64::from(STEPS), sign);
                spine + normal * radius
            };
            let points: Vec<DVec2> = (0..=STEPS).map(|i| self.drawn(at(i))).collect();
            let v = [self.vertex(at(0)), self.vertex(at(STEPS))];
            self.edges.push(Edge::drawn(v, points));
            outlines.push(self.edges.len() - 1);
        }
        let loops = [0.0, angle].map(|t| {
            let [(spine, one), (_, other)] = [normal(t, 1.0), normal(t, -1.0)];
            let along = axis.cross(spine - center).normalize();
            let (one, other) = (one * radius, other * radius);
            vec![
                self.arc(spine, along, one, other),
                self.arc(spine, along, other, one),
            ]
        });
        for (start, end) in loops[0].iter().zip(&loops[1]) {
            let boundary = vec![*start, outlines[1], *end, outlines[0]];
            self.face(SurfaceKind::Torus, &[boundary]);
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
        let place = |p: &DVec3| self.turn * *p + self.shift;
        let vertices3d: Vec<DVec3> = self.vertices.iter().map(place).collect();
        let drawing = Drawing {
            id: String::new(),
            source: String::new(),
            projection: match self.camera {
                Camera::Parallel => Projection::Orthographic,
                Camera::Central { focal, .. } => Projection::Perspective { focal: Some(focal) },
            },
            vertices: vertices3d.iter().map(|p| self.camera.project(*p)).collect(),
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
    drilled(Scene::new(turn), size, at, radius)
}

/// The same drawn in a scene that is empty so far.
pub(super) fn drilled(
    mut scene: Scene,
    size: DVec3,
    at: DVec2,
    radius: f64,
) -> (Drawing, Vec<Face>) {
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
