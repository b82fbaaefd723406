//! Fit of one rotation to all evidence that agrees with it.

use glam::{DMat3, DVec3};

use super::evidence::{AGREE, Evidence, circle_shape, shape_distance};
use super::hypotheses::Hypothesis;

/// Which axis (0, 1, 2) each cluster and circle group follows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Followers {
    pub(super) clusters: Vec<Option<usize>>,
    pub(super) circles: Vec<Option<usize>>,
}

/// The evidence that agrees with a frame within its error. A cluster that two axes would explain
/// follows neither.
pub(super) fn followers(evidence: &Evidence, h: &Hypothesis) -> Followers {
    let axes = [h.frame.x_axis, h.frame.y_axis, h.frame.z_axis];
    let only = |agrees: &dyn Fn(DVec3) -> bool| {
        let mut found = (0..3).filter(|&k| agrees(axes[k]));
        let first = found.next();
        if found.next().is_some() { None } else { first }
    };
    let clusters = evidence.clusters.iter().map(|c| {
        only(&|axis| {
            let drawn = axis.truncate();
            let length = drawn.length();
            let error = c.error(evidence.precision) + h.error / length.max(1e-9);
            length > 1e-6 && (c.direction.perp_dot(drawn) / length).abs() < AGREE * error.min(0.05)
        })
    });
    let circles = evidence.circles.iter().map(|g| {
        only(&|axis| shape_distance(g.shape, axis) < AGREE * (g.error + h.error).min(0.05))
    });
    Followers {
        clusters: clusters.collect(),
        circles: circles.collect(),
    }
}

/// Gauss-Newton on SO(3): the rotation that its followers agree with best, with its standard error.
/// `None` if the followers do not fix a rotation.
pub(super) fn refine(evidence: &Evidence, start: Hypothesis) -> Option<(Hypothesis, Followers)> {
    let mut current = start;
    for _ in 0..6 {
        let following = followers(evidence, &current);
        let (information, gradient) = normal_equations(evidence, &current.frame, &following);
        let covariance = invert(information)?;
        let step = -(covariance * gradient);
        let turned = DMat3::from_quat(glam::DQuat::from_scaled_axis(step)) * current.frame;
        let error = largest_eigenvalue(covariance).sqrt();
        if !turned.is_finite() || error > 0.2 {
            return None;
        }
        let settled = step.length() < 1e-3 * error && error >= 0.999 * current.error;
        current = Hypothesis {
            frame: turned,
            error,
        };
        if settled {
            break;
        }
    }
    let following = followers(evidence, &current);
    Some((current, following))
}

/// Information matrix and gradient of half the sum of squares, by a small rotation vector.
fn normal_equations(evidence: &Evidence, frame: &DMat3, following: &Followers) -> (DMat3, DVec3) {
    let axes = [frame.x_axis, frame.y_axis, frame.z_axis];
    let (mut information, mut gradient) = (DMat3::ZERO, DVec3::ZERO);
    let mut add = |residual: f64, slope: DVec3, error: f64| {
        let s = slope / error;
        information += DMat3::from_cols(s * s.x, s * s.y, s * s.z);
        gradient += s * (residual / error);
    };
    for (c, k) in evidence.clusters.iter().zip(&following.clusters) {
        let Some(axis) = k.map(|k| axes[k]) else {
            continue;
        };
        let drawn = axis.truncate();
        let (unit, length) = (drawn.normalize(), drawn.length());
        let across = unit.perp();
        // d(axis) = w x axis; its part across the drawn direction, by w.
        let slope = DVec3::new(
            -across.y * axis.z,
            across.x * axis.z,
            across.y * axis.x - across.x * axis.y,
        );
        let residual = c.direction.perp_dot(unit);
        add(
            residual,
            slope * (c.direction.dot(unit) / length),
            c.error(evidence.precision),
        );
    }
    for (g, k) in evidence.circles.iter().zip(&following.circles) {
        let Some(n) = k.map(|k| axes[k]) else {
            continue;
        };
        let d = g.shape - circle_shape(n);
        let by_x = DVec3::new(0.0, n.z, -n.y);
        let by_y = DVec3::new(-n.z, 0.0, n.x);
        add(d.x_axis.x, 2.0 * n.x * by_x, g.error);
        add(d.y_axis.y, 2.0 * n.y * by_y, g.error);
        add(d.x_axis.y, n.x * by_y + n.y * by_x, g.error);
    }
    (information, gradient)
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
