//! The drawing as a constrained problem: points that are drawn somewhere, surfaces that they lie
//! on, and what surfaces have in common, all over one list of parameters.
//!
//! Space has the axes of the model here: the frame is exact and the camera turns. So planes along
//! the frame are exact, whatever the noise.

use glam::{DMat3, DQuat, DVec2, DVec3};

use crate::lift::{Camera, Surface};

/// A direction of a surface, which surfaces may share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Dir {
    /// Along an axis of the model, or otherwise known.
    Fixed(DVec3),
    /// At right angles to a model axis, turned from the next axis by the parameter `angle` and
    /// `offset`, radians.
    Turn {
        axis: usize,
        angle: usize,
        offset: f64,
    },
    /// Near `base`, moved across it by two parameters.
    Free { base: DVec3, at: usize },
}

/// A surface; numbers are indices of parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    /// Points with `dir . p = offset`.
    Plane { offset: usize },
    /// Around the axis through a point, whose three coordinates start at `place`.
    Cylinder { place: usize, radius: usize },
    /// A surface that says nothing.
    Open,
}

/// A surface that faces lie on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Body {
    pub(super) shape: Shape,
    /// Index of its direction.
    pub(super) dir: usize,
}

/// Something drawn: a vertex, or a point of a curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    /// First of its three coordinates.
    pub(super) at: usize,
    pub(super) drawn: DVec2,
    /// How much it counts, beside a vertex.
    pub(super) weight: f64,
}

/// What has to hold exactly. `point` and `body` are indices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Condition {
    /// A point lies on a surface.
    On { point: usize, body: usize },
    /// A plane touches a cylinder on the side of its normal, or the other.
    Touch {
        plane: usize,
        round: usize,
        side: f64,
    },
    /// A point lies where a plane touches a cylinder.
    Beside {
        point: usize,
        plane: usize,
        round: usize,
    },
    /// Two cylinders of one direction touch: from outside, or one in the other.
    Nestle { a: usize, b: usize, outside: bool },
    /// A point lies where two such cylinders touch.
    Between { point: usize, a: usize, b: usize },
    /// A straight edge between two points of a cylinder follows its axis, across one of two
    /// directions.
    Along {
        from: usize,
        to: usize,
        round: usize,
        second: bool,
    },
    /// A cylinder is seen edge-on at a point.
    Outline { point: usize, round: usize },
    /// A plane is so far above another one of its direction.
    Step { upper: usize, lower: usize, by: f64 },
}

/// Parameters and what they mean. The first three turn the camera.
#[derive(Debug, Clone)]
pub(super) struct Problem {
    pub(super) camera: Camera,
    /// From the model's axes to the camera's, before the turn of the parameters.
    pub(super) rotation: DMat3,
    pub(super) x: Vec<f64>,
    pub(super) points: Vec<Point>,
    pub(super) dirs: Vec<Dir>,
    pub(super) bodies: Vec<Body>,
    pub(super) conditions: Vec<Condition>,
}

impl Problem {
    pub(super) fn new(camera: Camera, rotation: DMat3) -> Self {
        Self {
            camera,
            rotation,
            x: vec![0.0; 3],
            points: Vec::new(),
            dirs: Vec::new(),
            bodies: Vec::new(),
            conditions: Vec::new(),
        }
    }

    /// Adds parameters; returns the first one's index.
    pub(super) fn add(&mut self, values: &[f64]) -> usize {
        self.x.extend(values);
        self.x.len() - values.len()
    }

    /// From the model's axes to the camera's.
    pub(super) fn turned(&self, x: &[f64]) -> DMat3 {
        let turn = DVec3::new(x[0], x[1], x[2]);
        DMat3::from_quat(DQuat::from_scaled_axis(turn)) * self.rotation
    }

    pub(super) fn direction(&self, dir: usize, x: &[f64]) -> DVec3 {
        match self.dirs[dir] {
            Dir::Fixed(d) => d,
            Dir::Turn {
                axis,
                angle,
                offset,
            } => turn(axis, x[angle] + offset),
            Dir::Free { base, at } => {
                let (u, v) = base.any_orthonormal_pair();
                (base + u * x[at] + v * x[at + 1]).normalize_or(base)
            }
        }
    }

    pub(super) fn place(&self, point: usize, x: &[f64]) -> DVec3 {
        triple(x, self.points[point].at)
    }

    /// The surface in the model's axes.
    pub(super) fn surface(&self, body: usize, x: &[f64]) -> Surface {
        let Body { shape, dir } = self.bodies[body];
        match shape {
            Shape::Plane { offset } => {
                let normal = self.direction(dir, x);
                Surface::Plane {
                    origin: normal * x[offset],
                    normal,
                }
            }
            Shape::Cylinder { place, radius } => Surface::Cylinder {
                origin: triple(x, place),
                axis: self.direction(dir, x),
                radius: x[radius].abs(),
            },
            Shape::Open => Surface::Unknown,
        }
    }

    /// How far a point is drawn from where it is.
    pub(super) fn miss(&self, point: usize, x: &[f64]) -> DVec2 {
        self.camera.project(self.turned(x) * self.place(point, x)) - self.points[point].drawn
    }

    /// What is wrong with a condition, a length.
    pub(super) fn value(&self, condition: &Condition, x: &[f64]) -> f64 {
        let round = |body: usize| match self.bodies[body].shape {
            Shape::Cylinder { place, radius } => (
                triple(x, place),
                self.direction(self.bodies[body].dir, x),
                x[radius],
            ),
            _ => (DVec3::ZERO, DVec3::Z, 0.0),
        };
        match *condition {
            Condition::On { point, body } => self.surface(body, x).distance(self.place(point, x)),
            Condition::Touch {
                plane,
                round: r,
                side,
            } => {
                let (center, _, radius) = round(r);
                self.surface(plane, x).distance(center) - side * radius
            }
            Condition::Beside {
                point,
                plane,
                round: r,
            } => {
                let (center, axis, _) = round(r);
                let normal = self.direction(self.bodies[plane].dir, x);
                (self.place(point, x) - center).dot(axis.cross(normal))
            }
            Condition::Nestle { a, b, outside } => {
                let ((p, axis, r), (q, _, s)) = (round(a), round(b));
                let apart = (q - p).reject_from_normalized(axis).length();
                apart - if outside { r + s } else { (r - s).abs() }
            }
            Condition::Between { point, a, b } => {
                let ((p, axis, _), (q, _, _)) = (round(a), round(b));
                let across = axis.cross(q - p).normalize_or_zero();
                (self.place(point, x) - p).dot(across)
            }
            Condition::Along {
                from,
                to,
                round: r,
                second,
            } => {
                let (u, w) = round(r).1.any_orthonormal_pair();
                let d = self.place(to, x) - self.place(from, x);
                d.dot(if second { w } else { u })
            }
            Condition::Step { upper, lower, by } => {
                let height = |body: usize| match self.bodies[body].shape {
                    Shape::Plane { offset } => x[offset],
                    _ => 0.0,
                };
                height(upper) - height(lower) - by
            }
            Condition::Outline { point, round: r } => {
                let (center, axis, _) = round(r);
                let place = self.place(point, x);
                let sight = match self.camera {
                    Camera::Parallel => self.turned(x).transpose() * DVec3::Z,
                    Camera::Central { .. } => -place,
                };
                let across = sight.reject_from_normalized(axis).normalize_or_zero();
                (place - center).dot(across)
            }
        }
    }

    /// Parameters that a condition depends on.
    pub(super) fn parameters(&self, condition: &Condition) -> Vec<usize> {
        let mut all = Vec::with_capacity(10);
        let mut point = |p: usize| all.extend(self.points[p].at..self.points[p].at + 3);
        let bodies = match *condition {
            Condition::On { point: p, body } => {
                point(p);
                [Some(body), None]
            }
            Condition::Touch { plane, round, .. } => [Some(plane), Some(round)],
            Condition::Beside {
                point: p,
                plane,
                round,
            } => {
                point(p);
                [Some(plane), Some(round)]
            }
            Condition::Nestle { a, b, .. } => [Some(a), Some(b)],
            Condition::Step { upper, lower, .. } => [Some(upper), Some(lower)],
            Condition::Between { point: p, a, b } => {
                point(p);
                [Some(a), Some(b)]
            }
            Condition::Along {
                from, to, round, ..
            } => {
                point(from);
                point(to);
                [Some(round), None]
            }
            Condition::Outline { point: p, round } => {
                point(p);
                if self.camera.is_parallel() {
                    all.extend(0..3);
                }
                [Some(round), None]
            }
        };
        for body in bodies.into_iter().flatten() {
            let Body { shape, dir } = self.bodies[body];
            match shape {
                Shape::Plane { offset } => all.push(offset),
                Shape::Cylinder { place, radius } => {
                    all.extend([place, place + 1, place + 2, radius])
                }
                Shape::Open => {}
            }
            match self.dirs[dir] {
                Dir::Fixed(_) => {}
                Dir::Turn { angle, .. } => all.push(angle),
                Dir::Free { at, .. } => all.extend([at, at + 1]),
            }
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Moves turns of the camera and of free directions into what they turn.
    pub(super) fn rebase(&mut self) {
        self.rotation = self.turned(&self.x);
        self.x[..3].fill(0.0);
        for i in 0..self.dirs.len() {
            if let Dir::Free { at, .. } = self.dirs[i] {
                let base = self.direction(i, &self.x);
                self.dirs[i] = Dir::Free { base, at };
                self.x[at..at + 2].fill(0.0);
            }
        }
    }
}

/// The direction at right angles to a model axis, turned by an angle from the next axis.
pub(super) fn turn(axis: usize, angle: f64) -> DVec3 {
    let (sin, cos) = angle.sin_cos();
    DVec3::AXES[(axis + 1) % 3] * cos + DVec3::AXES[(axis + 2) % 3] * sin
}

/// The angle of a direction around a model axis, from the next axis.
pub(super) fn angle_of(axis: usize, d: DVec3) -> f64 {
    d.dot(DVec3::AXES[(axis + 2) % 3])
        .atan2(d.dot(DVec3::AXES[(axis + 1) % 3]))
}

pub(super) fn triple(x: &[f64], at: usize) -> DVec3 {
    DVec3::new(x[at], x[at + 1], x[at + 2])
}
