//! Fit of one rotation to all evidence that agrees with it.

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::evidence::{AGREE, Evidence};
use super::hypotheses::Hypothesis;
use super::model_frame::{USUAL, Usual};

/// Errors, radians, up to which slanted directions are told apart by chance seldom enough.
const SHARP: f64 = 1e-3;

/// Steps of Gauss-Newton; each one also chooses the followers anew.
const STEPS: usize = 6;

/// Standard error, radians, of a frame that is no use.
const LOST: f64 = 0.2;

/// What follows a frame: indices of usual directions for clusters, of axes for circles.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Followers {
    pub(super) clusters: Vec<Option<usize>>,
    pub(super) circles: Vec<Option<usize>>,
}

impl Followers {
    /// The evidence that agrees with a frame within its error. What two axes would explain follows
    /// neither; slanted directions are asked only where no axis explains a cluster.
    pub(super) fn new(evidence: &Evidence, h: &Hypothesis) -> Self {
        let drawn = |usual: &Usual| DrawnAxis::new(h.frame * usual.direction, h.error);
        let usual: Vec<DrawnAxis> = USUAL.iter().map(drawn).collect();
        let circles: Vec<Option<usize>> = evidence
            .circles
            .iter()
            .map(|group| only((0..3).filter(|&k| group.agrees(h.frame.col(k), h.error))).one())
            .collect();
        let clusters = evidence.clusters.iter().map(|c| {
            // The outlines of a cylinder that stands aslant.
            if c.of_circles.iter().any(|&g| circles[g].is_none()) {
                return None;
            }
            let error = c.error(evidence.precision);
            let along = |i: &usize| usual[*i].is_along(c.direction, error);
            match only((0..3).filter(along)) {
                Found::None if error + h.error < SHARP => {
                    only((3..USUAL.len()).filter(along)).one()
                }
                found => found.one(),
            }
        });
        Self {
            clusters: clusters.collect(),
            circles,
        }
    }

    fn without_slanted(mut self) -> Self {
        for c in &mut self.clusters {
            *c = c.filter(|&i| i < 3);
        }
        self
    }
}

enum Found {
    None,
    One(usize),
    Several,
}

impl Found {
    fn one(self) -> Option<usize> {
        match self {
            Self::One(i) => Some(i),
            Self::None | Self::Several => None,
        }
    }
}

fn only(mut all: impl Iterator<Item = usize>) -> Found {
    match (all.next(), all.next()) {
        (None, _) => Found::None,
        (Some(i), None) => Found::One(i),
        _ => Found::Several,
    }
}

/// An axis as it is drawn.
struct DrawnAxis {
    along: DVec2,
    length: f64,
    /// Error of its drawn direction, radians.
    error: f64,
}

impl DrawnAxis {
    fn new(axis: DVec3, error: f64) -> Self {
        let along = axis.truncate();
        let length = along.length();
        Self {
            along,
            length,
            error: error / length.max(1e-9),
        }
    }

    /// Whether `drawn` is its direction within the errors of both.
    fn is_along(&self, drawn: DVec2, error: f64) -> bool {
        let error = (error + self.error).min(0.05);
        self.length > 1e-6 && (drawn.perp_dot(self.along) / self.length).abs() < AGREE * error
    }
}

/// Gauss-Newton on SO(3): the rotation that its followers agree with best, with its standard error.
/// Slanted directions take part only if the axes do not fix the rotation without them. `None` if
/// nothing does.
pub(super) fn refine(evidence: &Evidence, start: Hypothesis) -> Option<(Hypothesis, Followers)> {
    let mut current = start;
    for _ in 0..STEPS {
        let all = Followers::new(evidence, &current);
        let axes = all.clone().without_slanted();
        let (covariance, gradient) = normal_equations(evidence, &current.frame, &axes)
            .or_else(|| normal_equations(evidence, &current.frame, &all))?;
        let step = -(covariance * gradient);
        let frame = DMat3::from_quat(DQuat::from_scaled_axis(step)) * current.frame;
        let error = largest_eigenvalue(covariance).sqrt();
        if !frame.is_finite() || error > LOST {
            return None;
        }
        let settled = step.length() < 1e-3 * error && error >= 0.999 * current.error;
        current = Hypothesis { frame, error };
        if settled {
            break;
        }
    }
    let followers = Followers::new(evidence, &current);
    Some((current, followers))
}

/// Sine of the angle from an axis, as it is drawn, to a drawn direction, and how it changes with a
/// small rotation of the axis.
pub(super) fn aside(direction: DVec2, axis: DVec3) -> (f64, DVec3) {
    let drawn = axis.truncate();
    let (unit, length) = (drawn.normalize(), drawn.length());
    let across = unit.perp();
    // d(axis) = w x axis; its part across the drawn direction, by w.
    let slope = DVec3::new(
        -across.y * axis.z,
        across.x * axis.z,
        across.y * axis.x - across.x * axis.y,
    );
    (
        direction.perp_dot(unit),
        slope * (direction.dot(unit) / length),
    )
}

/// Covariance, and gradient of half the sum of squares, by a small rotation vector; `None` if the
/// followers leave a rotation open.
fn normal_equations(
    evidence: &Evidence,
    frame: &DMat3,
    followers: &Followers,
) -> Option<(DMat3, DVec3)> {
    let (mut information, mut gradient) = (DMat3::ZERO, DVec3::ZERO);
    let mut add = |residual: f64, slope: DVec3, error: f64| {
        let s = slope / error;
        information += DMat3::from_cols(s * s.x, s * s.y, s * s.z);
        gradient += s * (residual / error);
    };
    for (c, i) in evidence.clusters.iter().zip(&followers.clusters) {
        let Some(axis) = i.map(|i| *frame * USUAL[i].direction) else {
            continue;
        };
        let (residual, slope) = aside(c.direction, axis);
        add(residual, slope, c.error(evidence.precision));
    }
    for (g, k) in evidence.circles.iter().zip(&followers.circles) {
        let Some(n) = k.map(|k| frame.col(k)) else {
            continue;
        };
        let (folded, signs) = g.fold(n);
        let off = folded - g.normal;
        add(off.x, signs.x * DVec3::new(0.0, n.z, -n.y), g.error);
        add(off.y, signs.y * DVec3::new(-n.z, 0.0, n.x), g.error);
        add(off.z, signs.z * DVec3::new(n.y, -n.x, 0.0), g.error);
    }
    Some((invert(information)?, gradient))
}

fn invert(m: DMat3) -> Option<DMat3> {
    let scale = (m.x_axis.x + m.y_axis.y + m.z_axis.z) / 3.0;
    if !(scale.is_finite() && scale > 0.0) {
        return None;
    }
    let unit = m * scale.recip();
    (unit.determinant() > 1e-13).then(|| unit.inverse() * scale.recip())
}

/// Largest eigenvalue of a symmetric positive matrix, by power iteration.
fn largest_eigenvalue(m: DMat3) -> f64 {
    let mut v = DVec3::new(0.577, 0.578, 0.576);
    for _ in 0..40 {
        v = (m * v).normalize_or(v);
    }
    v.dot(m * v)
}
