//! The curve that a point of a swept section runs along.
//!
//! The spine is a helix of radius R and rise c a radian around the axis a. The section stays in the
//! spine's normal plane and turns there evenly, by k radians a radian; the frame of least rotation,
//! which CAD kernels sweep with (Bishop 1975; "corrected Frenet"), has k = c / (R^2 + c^2)^(1/2),
//! a true helix k = 0. A point (x, y) of the section, x away from the axis, is at
//!
//! `o + h a + c t a + (R + X) e(t) + Y b(t)`, `(X, Y) = (x, y) turned by k t`,
//!
//! with e(t) the unit vector away from the axis and b = (R a - c e') / (R^2 + c^2)^(1/2).

use glam::{DVec2, DVec3};

use crate::lift::Camera;

/// Unknowns of the spine, which all tracks share: two turns of the axis, its shift across the lines
/// of sight, R, c, k, h.
pub(super) const SHARED: usize = 7;

/// Unknowns of one track: x and y.
pub(super) const OWN: usize = 2;

/// Step of differences.
const STEP: f64 = 1e-5;

/// Rounds of finding the parameter of a drawn point, and its largest step, radians.
const ROUNDS: usize = 6;
const STRIDE: f64 = 0.3;

/// What the unknowns are counted from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Base {
    pub(super) camera: Camera,
    pub(super) axis: DVec3,
    pub(super) origin: DVec3,
}

/// A spine in space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spine {
    camera: Camera,
    pub(super) axis: DVec3,
    pub(super) origin: DVec3,
    u: DVec3,
    v: DVec3,
    pub(super) radius: f64,
    pub(super) rise: f64,
    pub(super) turn: f64,
    height: f64,
}

impl Base {
    /// Directions at right angles to the axis, t counts from the first one.
    pub(super) fn sides(&self) -> (DVec3, DVec3) {
        let u = self.axis.any_orthonormal_vector();
        (u, self.axis.cross(u))
    }

    pub(super) fn spine(&self, x: &[f64]) -> Spine {
        let (u, v) = self.sides();
        let axis = (self.axis + u * x[0] + v * x[1]).normalize();
        let toward = match self.camera {
            Camera::Parallel => DVec3::Z,
            Camera::Central { .. } => self.origin,
        };
        let across = self.axis.cross(toward).normalize_or_zero();
        let u = u.reject_from_normalized(axis).normalize();
        Spine {
            camera: self.camera,
            axis,
            origin: self.origin + across * x[2],
            u,
            v: axis.cross(u),
            radius: x[3],
            rise: x[4],
            turn: x[5],
            height: x[6],
        }
    }
}

impl Spine {
    /// The point at t of the track of a point of the section.
    pub(super) fn point(&self, own: DVec2, t: f64) -> DVec3 {
        let (sin, cos) = t.sin_cos();
        let out = self.u * cos + self.v * sin;
        let on = self.v * cos - self.u * sin;
        let turned = DVec2::from_angle(self.turn * t).rotate(own);
        let length = self.radius.hypot(self.rise);
        let up = (self.axis * self.radius - on * self.rise) / length;
        self.origin
            + self.axis * (self.height + self.rise * t)
            + out * (self.radius + turned.x)
            + up * turned.y
    }

    /// Unit tangent of a track.
    pub(super) fn tangent(&self, own: DVec2, t: f64) -> DVec3 {
        (self.point(own, t + STEP) - self.point(own, t - STEP)).normalize_or_zero()
    }

    pub(super) fn drawn(&self, own: DVec2, t: f64) -> DVec2 {
        self.camera.project(self.point(own, t))
    }

    fn slope(&self, own: DVec2, t: f64) -> DVec2 {
        (self.drawn(own, t + STEP) - self.drawn(own, t - STEP)) / (2.0 * STEP)
    }

    /// The parameter, from `t` on, of the point of a track that is drawn nearest to `p`.
    pub(super) fn nearest(&self, own: DVec2, p: DVec2, mut t: f64) -> f64 {
        for _ in 0..ROUNDS {
            let slope = self.slope(own, t);
            let step = (p - self.drawn(own, t)).dot(slope) / slope.length_squared();
            if !step.is_finite() {
                break;
            }
            t += step.clamp(-STRIDE, STRIDE);
            if step.abs() < 1e-10 {
                break;
            }
        }
        t
    }

    /// Unit normal of the drawn track.
    pub(super) fn normal(&self, own: DVec2, t: f64) -> DVec2 {
        self.slope(own, t).perp().normalize_or_zero()
    }
}
