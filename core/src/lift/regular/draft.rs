//! From a sheet with rough heights to a problem: which directions and surfaces the faces have.

use glam::{DMat3, DVec2, DVec3};

use super::fit::{Fitted, fit};
use super::problem::{Body, Condition, Dir, Point, Problem, Shape, angle_of};
use super::rounds;
use crate::drawing::SurfaceKind;
use crate::lift::heights::Heights;
use crate::lift::sheet::Sheet;
use crate::lift::surfaces::best_plane;
use crate::lift::{Camera, LiftError};

/// Points of a curve count this much beside a vertex: their errors are not independent.
const CURVE_POINT: f64 = 0.5;

/// Points taken of an open and of a closed curve.
const OPEN: usize = 5;
const CLOSED: usize = 9;

/// A drawing as a problem.
pub(super) struct Draft<'a, 'b> {
    pub(super) sheet: &'a Sheet<'b>,
    pub(super) problem: Problem,
    /// The problem as it was before the last fit, to start from again.
    pub(super) start: Problem,
    /// Body of every face.
    pub(super) body_of: Vec<usize>,
    /// Points of the problem along every edge, without its ends; none if nothing tells them.
    pub(super) curve_points: Vec<Vec<usize>>,
    /// Drawing units per unit of the problem.
    pub(super) size: f64,
    /// The level of noise, in units of the problem.
    pub(super) noise: f64,
}

impl<'a, 'b> Draft<'a, 'b> {
    /// A draft with all surfaces, fitted.
    ///
    /// # Errors
    /// [`LiftError::Solver`] if it cannot be solved.
    pub(super) fn new(sheet: &'a Sheet<'b>, heights: &Heights) -> Result<Self, LiftError> {
        let size = sheet.size;
        let axes: Vec<DVec3> = sheet.directions.axes.iter().map(|a| a.direction).collect();
        let first = axes.first().copied().unwrap_or(DVec3::Z);
        let second = axes
            .get(1)
            .copied()
            .unwrap_or(first.any_orthonormal_vector());
        let second = second.reject_from_normalized(first).normalize();
        let rotation = DMat3::from_cols(first, second, first.cross(second));
        let camera = match *sheet.camera() {
            Camera::Parallel => Camera::Parallel,
            Camera::Central { principal, focal } => Camera::Central {
                principal: principal / size,
                focal: focal / size,
            },
        };
        let mut problem = Problem::new(camera, rotation);
        for (v, p) in sheet.drawing.vertices.iter().enumerate() {
            let place = rotation.transpose() * sheet.place(*p, heights.of(v)) / size;
            let at = problem.add(&place.to_array());
            problem.points.push(Point {
                at,
                drawn: *p / size,
                weight: 1.0,
            });
        }
        problem.dirs.push(Dir::Fixed(DVec3::Z));
        problem.bodies.push(Body {
            shape: Shape::Open,
            dir: 0,
        });
        let mut draft = Self {
            sheet,
            start: problem.clone(),
            problem,
            body_of: vec![0; sheet.faces.len()],
            curve_points: vec![Vec::new(); sheet.drawing.edges.len()],
            size,
            noise: sheet.directions.precision / size,
        };
        draft.add_planes();
        draft.fit()?;
        rounds::add_cylinders(&mut draft);
        draft.add_curves();
        draft.fit()?;
        Ok(draft)
    }

    pub(super) fn fit(&mut self) -> Result<Fitted, LiftError> {
        self.start = self.problem.clone();
        fit(&mut self.problem)
    }

    /// A vertex or other point in the model's axes.
    pub(super) fn place(&self, point: usize) -> DVec3 {
        self.problem.place(point, &self.problem.x)
    }

    fn add_planes(&mut self) {
        for face in 0..self.sheet.faces.len() {
            if !self.sheet.is_planar(face) {
                continue;
            }
            let corners = &self.sheet.corners[face];
            let points: Vec<DVec3> = corners.iter().map(|&v| self.place(v)).collect();
            let dir = self.plane_direction(face, &points);
            let dir = self.add_dir(dir);
            let normal = self.problem.direction(dir, &self.problem.x);
            let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
            let offset = self.problem.add(&[normal.dot(middle)]);
            let body = self.add_body(Shape::Plane { offset }, dir);
            self.body_of[face] = body;
            for &v in &self.sheet.corners[face] {
                self.problem
                    .conditions
                    .push(Condition::On { point: v, body });
            }
        }
    }

    /// The direction of a plane: an axis if two others run in it or a circle lies in it, at right
    /// angles to an axis that runs in it, or what its corners say.
    fn plane_direction(&mut self, face: usize, points: &[DVec3]) -> Dir {
        let mut along = [0.0f64; 3];
        let mut around = None;
        for &e in self.sheet.edges_of(face) {
            if let Some(k) = self.sheet.edge_axis[e] {
                along[k] += self.sheet.drawing.edges[e].length() / self.size;
            }
            if let Some((k, _)) = self.sheet.circles[e] {
                around = Some(k);
            }
        }
        let held: Vec<usize> = (0..3).filter(|&k| along[k] > 0.0).collect();
        if let [i, j] = held[..] {
            return Dir::Fixed(DVec3::AXES[3 - i - j]);
        }
        if let Some(k) = around {
            return Dir::Fixed(DVec3::AXES[k]);
        }
        let rough = best_plane(points).map(|p| p.1);
        if let [axis] = held[..] {
            let rough = rough.unwrap_or(DVec3::AXES[(axis + 1) % 3]);
            let angle = self.problem.add(&[angle_of(axis, rough)]);
            return Dir::Turn {
                axis,
                angle,
                offset: 0.0,
            };
        }
        let toward = self.problem.rotation.transpose() * DVec3::Z;
        let at = self.problem.add(&[0.0, 0.0]);
        Dir::Free {
            base: rough.unwrap_or(toward),
            at,
        }
    }

    pub(super) fn add_dir(&mut self, dir: Dir) -> usize {
        let known = self.problem.dirs.iter().position(|d| *d == dir);
        known.unwrap_or_else(|| {
            self.problem.dirs.push(dir);
            self.problem.dirs.len() - 1
        })
    }

    pub(super) fn add_body(&mut self, shape: Shape, dir: usize) -> usize {
        self.problem.bodies.push(Body { shape, dir });
        self.problem.bodies.len() - 1
    }

    /// Bodies beside an edge, if there are two faces.
    pub(super) fn beside(&self, edge: usize) -> Option<[usize; 2]> {
        match *self.sheet.neighbours(edge) {
            [f, g] => Some([self.body_of[f], self.body_of[g]]),
            _ => None,
        }
    }

    pub(super) fn is_round(&self, body: usize) -> bool {
        matches!(self.problem.bodies[body].shape, Shape::Cylinder { .. })
    }

    pub(super) fn is_plane(&self, body: usize) -> bool {
        matches!(self.problem.bodies[body].shape, Shape::Plane { .. })
    }

    /// Points of curves in which two known surfaces meet.
    fn add_curves(&mut self) {
        for e in 0..self.sheet.drawing.edges.len() {
            let Some([a, b]) = self.beside(e) else {
                continue;
            };
            let both = [a, b].map(|s| self.is_round(s) || self.is_plane(s));
            let round = self.is_round(a) || self.is_round(b);
            if self.sheet.is_straight(e) || a == b || both != [true; 2] || !round {
                continue;
            }
            let edge = &self.sheet.drawing.edges[e];
            let closed = edge.v[0] == edge.v[1];
            let steps = if closed { CLOSED } else { OPEN };
            let last = edge.points.len() - 1;
            let [start, end] = edge.v.map(|v| self.place(v));
            let first = if self.is_plane(a) { a } else { b };
            let mut taken = 0;
            for i in 1..=steps {
                let at = i * last / (steps + 1);
                if at <= taken || at >= last {
                    continue;
                }
                taken = at;
                let drawn = edge.points[at] / self.size;
                let near = start.lerp(end, at as f64 / last as f64);
                let place = self.onto(first, drawn, near);
                let at = self.problem.add(&place.to_array());
                self.problem.points.push(Point {
                    at,
                    drawn,
                    weight: CURVE_POINT,
                });
                let point = self.problem.points.len() - 1;
                self.curve_points[e].push(point);
                for body in [a, b] {
                    self.problem.conditions.push(Condition::On { point, body });
                }
            }
        }
    }

    /// The point of a surface that is drawn at `p`, the one next to `near`.
    pub(super) fn onto(&self, body: usize, p: DVec2, near: DVec3) -> DVec3 {
        let (from, ray) = self.problem.camera.ray(p);
        let back = self.problem.rotation.transpose();
        let (from, ray) = (back * from, back * ray);
        let surface = self.problem.surface(body, &self.problem.x);
        let crossings = surface.crossings(from, ray).into_iter();
        crossings
            .map(|t| from + ray * t)
            .filter(|q| q.is_finite() && q.distance(near) < 3.0)
            .min_by(|a, b| a.distance(near).total_cmp(&b.distance(near)))
            .unwrap_or(near)
    }

    /// Corners of the faces of a body.
    pub(super) fn corners(&self, body: usize) -> Vec<usize> {
        let faces = self.faces(body);
        let mut all: Vec<usize> = faces.flat_map(|f| self.sheet.corners[f].clone()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Faces of a body.
    pub(super) fn faces(&self, body: usize) -> impl Iterator<Item = usize> + '_ {
        let faces = self.body_of.iter().enumerate();
        faces.filter(move |(_, b)| **b == body).map(|(f, _)| f)
    }

    /// Bodies that faces lie on and that say something.
    fn used(&self) -> Vec<Body> {
        let bodies = self.problem.bodies.iter().enumerate();
        bodies
            .filter(|(b, body)| body.shape != Shape::Open && self.faces(*b).next().is_some())
            .map(|(_, body)| *body)
            .collect()
    }

    /// Numbers that the fit is free to choose: of surfaces, and of the camera's turn.
    pub(super) fn freedom(&self) -> usize {
        let mut numbers = Vec::new();
        for body in self.used() {
            match body.shape {
                Shape::Plane { offset } => numbers.push(offset),
                // The place along the axis is none.
                Shape::Cylinder { place, radius } => numbers.extend([place, place + 1, radius]),
                Shape::Open => {}
            }
            match self.problem.dirs[body.dir] {
                Dir::Fixed(_) => {}
                Dir::Turn { angle, .. } => numbers.push(angle),
                Dir::Free { at, .. } => numbers.extend([at, at + 1]),
            }
        }
        numbers.sort_unstable();
        numbers.dedup();
        numbers.len() + 3
    }

    /// Number of surfaces that are along no axis of the model.
    pub(super) fn oblique(&self) -> usize {
        let along = |b: &Body| matches!(self.problem.dirs[b.dir], Dir::Fixed(d) if DVec3::AXES.contains(&d.abs()));
        self.used().iter().filter(|b| !along(b)).count()
    }

    /// Share of the surfaces that are along a known direction.
    pub(super) fn square_share(&self) -> f64 {
        let used = self.used();
        let square = used
            .iter()
            .filter(|b| matches!(self.problem.dirs[b.dir], Dir::Fixed(_)));
        square.count() as f64 / used.len().max(1) as f64
    }

    /// Axes of the model that the drawing tells; others are arbitrary.
    pub(super) fn axes(&self) -> usize {
        self.sheet.directions.axes.len()
    }

    /// Kind of a face.
    pub(super) fn kind(&self, face: usize) -> SurfaceKind {
        self.sheet.faces[face].kind
    }
}
