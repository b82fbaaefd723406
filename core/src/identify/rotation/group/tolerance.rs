//! How near is one: in an exact drawing a share of its size, in one by hand some of its errors.

use glam::{DVec2, DVec3};

use super::shapes::{Outline, Shapes};
use crate::lift::{Pieces, Tilt};

/// Error of depth that is allowed in an exact drawing, relative to its size.
const SAME: f64 = 2e-3;

/// Error of a place in an exact drawing that is allowed, relative to its size.
const NEAR: f64 = 1e-3;

/// Error of a place in an exact drawing that is usual, relative to its size.
const EXACT: f64 = 5e-5;

/// Standard errors that are allowed in a drawing by hand.
const ERRORS: f64 = 3.0;

/// Places that have nothing to do with each other are about so far apart, relative to the size.
const CHANCE: f64 = 0.25;

/// Sine of the angle between normals up to which planes are parallel, in an exact drawing and at
/// most.
const PARALLEL: f64 = 5e-3;
const MOST: f64 = 0.15;

/// Share of a normal towards the viewer, and across, that counts at least.
const STEEPEST: f64 = 0.05;

/// Share of a normal towards the viewer below which a plane is seen from its edge.
const FLAT: f64 = 0.01;

impl Shapes {
    /// Distance in the drawing up to which two places are one.
    pub(super) fn near(&self) -> f64 {
        (NEAR * self.size).max(ERRORS * self.error)
    }

    /// Difference of depth up to which two are one, of which one is known to a standard error.
    pub(super) fn slack(&self, error: f64) -> f64 {
        (SAME * self.size).max(ERRORS * error)
    }

    /// How much two places that are one tell, beside an exact drawing: the larger the distance up to
    /// which they are, the more are by chance.
    pub(super) fn telling(&self) -> f64 {
        (CHANCE * self.size / self.near()).max(1.0).ln() / (CHANCE / NEAR).ln()
    }

    /// Distance up to which two places are one that are told exactly.
    pub(super) fn exactly(&self) -> f64 {
        (EXACT * self.size).max(ERRORS * self.error)
    }

    /// Distance from a drawn axis up to which a centre is on it.
    pub(super) fn on_axis(&self) -> f64 {
        2.0 * self.near()
    }

    /// The planes of two loops, if they are parallel as far as the drawing tells.
    pub(super) fn parallel(&self, a: &Outline, b: &Outline) -> Option<(Tilt, Tilt)> {
        let (p, q) = (a.plane?, b.plane?);
        let limit = (ERRORS * a.turn.hypot(b.turn)).clamp(PARALLEL, MOST);
        (p.normal().cross(q.normal()).length() < limit).then_some((p, q))
    }
}

impl Outline {
    /// Standard error of its depth in its part if that of drawn coordinates is `error`.
    ///
    /// How far a plane is from others that are parallel is told by edges across it, which are drawn
    /// the shorter the more it faces the viewer, and its depth at a place is that times its slope.
    /// There is an edge across at each of its corners.
    pub(super) fn depth_error(&self, error: f64) -> f64 {
        let corners = (self.corners.len().max(1) as f64).sqrt();
        let told = self.plane.map_or(1.0, |p| {
            let normal = p.normal();
            let [steep, across] = [normal.z.abs(), normal.truncate().length()];
            steep.max(STEEPEST) * across.max(STEEPEST)
        });
        error / (told * corners)
    }
}

/// A plane with the normal of the axis that its own is one with as far as the drawing tells, the
/// same at a point.
pub(super) fn squared(plane: Tilt, pieces: &Pieces, turn: f64, at: DVec2) -> Tilt {
    let limit = (ERRORS * turn).min(MOST);
    let normal = plane.normal();
    let off = |n: &DVec3| normal.cross(*n).length();
    let nearest = pieces.axes.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    match nearest {
        Some(n) if pieces.camera.is_parallel() && off(n) < limit && n.z.abs() > FLAT => {
            let (a, b) = (n.x / n.z, n.y / n.z);
            let c = -(plane.level(at) + a * at.x + b * at.y);
            Tilt { a, b, c, ..plane }
        }
        _ => plane,
    }
}
