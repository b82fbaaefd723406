//! Fit of a frame, and of the camera where it is not given, to all that agrees with it.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use glam::{DMat3, DQuat, DVec2, DVec3};

use super::Open;
use super::circles::Circle;
use super::followers::Followers;
use super::lines::Lines;
use crate::lift::Camera;
use crate::lift::directions::model_frame::USUAL;

/// Steps of Gauss-Newton; each one also chooses the followers anew.
const STEPS: usize = 8;

/// Standard error, radians, of a frame that is no use.
const LOST: f64 = 0.2;

/// Step of numeric derivatives, radians or shares of the focal length.
const SMALL: f64 = 1e-6;

/// A frame under a camera.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pub(super) frame: DMat3,
    pub(super) camera: Camera,
    /// Standard error of the axes, radians.
    pub(super) error: f64,
    pub(super) followers: Followers,
}

/// Unknowns: a small rotation, log f, the principal point in units of f.
type Step = [f64; 6];

fn moved(frame: &DMat3, camera: &Camera, step: &Step) -> (DMat3, Camera) {
    let turn = DQuat::from_scaled_axis(DVec3::new(step[0], step[1], step[2]));
    let camera = match *camera {
        Camera::Parallel => Camera::Parallel,
        Camera::Central { principal, focal } => Camera::Central {
            principal: principal + DVec2::new(step[4], step[5]) * focal,
            focal: focal * step[3].exp(),
        },
    };
    (DMat3::from_quat(turn) * *frame, camera)
}

/// Weighted residuals of what follows.
fn residuals(
    lines: &Lines,
    circles: &[Circle],
    followers: &Followers,
    frame: &DMat3,
    camera: &Camera,
) -> Vec<f64> {
    let straight = lines.all.iter().zip(&followers.lines).filter_map(|(l, i)| {
        let axis = *frame * USUAL[(*i)?].direction;
        let drawn = camera.drawn(axis, l.middle).normalize();
        let slant = l.direction.perp_dot(drawn) * l.direction.dot(drawn).signum();
        Some([slant / lines.slant_error(l), 0.0, 0.0])
    });
    let round = circles.iter().zip(&followers.circles).filter_map(|(c, k)| {
        let n = frame.col((*k)?);
        let own = c.agreeing(n, 1.0)?;
        Some(((n - own) / c.error).to_array())
    });
    straight.chain(round).flatten().collect()
}

/// The frame that its followers agree with best (Gauss-Newton). Slanted directions take part only
/// if the axes do not fix the frame without them. `None` if nothing does.
pub(super) fn fit(
    lines: &Lines,
    circles: &[Circle],
    (frame, error): (DMat3, f64),
    camera: Camera,
    open: Open,
) -> Option<Fitted> {
    let mut now = Fitted {
        followers: Followers::of_axes(lines, circles, &camera, &frame, error),
        frame,
        camera,
        error,
    };
    for _ in 0..STEPS {
        let (step, error) = improve(lines, circles, &now.followers, &now, open).or_else(|| {
            let (camera, frame) = (&now.camera, &now.frame);
            let all = Followers::with_slanted(lines, circles, camera, frame, now.error);
            improve(lines, circles, &all, &now, open)
        })?;
        let (frame, camera) = moved(&now.frame, &now.camera, &step);
        if !frame.is_finite() || error.is_nan() || error > LOST {
            return None;
        }
        let largest = step.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
        let followers = Followers::of_axes(lines, circles, &camera, &frame, error);
        let settled = largest < 1e-3 * error && followers == now.followers;
        now = Fitted {
            frame,
            camera,
            error,
            followers,
        };
        if settled {
            break;
        }
    }
    now.followers = Followers::with_slanted(lines, circles, &now.camera, &now.frame, now.error);
    Some(now)
}

/// A step, and the standard error of the axes; `None` if the followers leave something open.
fn improve(
    lines: &Lines,
    circles: &[Circle],
    followers: &Followers,
    now: &Fitted,
    open: Open,
) -> Option<(Step, f64)> {
    let count = 3 + open.count();
    let at = |step: &Step| {
        let (frame, camera) = moved(&now.frame, &now.camera, step);
        residuals(lines, circles, followers, &frame, &camera)
    };
    let here = at(&[0.0; 6]);
    let slopes: Vec<Vec<f64>> = (0..count)
        .map(|k| {
            let mut step = [0.0; 6];
            step[k] = SMALL;
            let ahead = at(&step);
            step[k] = -SMALL;
            let behind = at(&step);
            let pairs = ahead.iter().zip(&behind);
            pairs.map(|(a, b)| (a - b) / (2.0 * SMALL)).collect()
        })
        .collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let information = Mat::from_fn(count, count, |i, j| dot(&slopes[i], &slopes[j]));
    let scale: Vec<f64> = (0..count).map(|i| information[(i, i)].sqrt()).collect();
    if scale.iter().any(|s| s.is_nan() || *s <= 0.0) {
        return None;
    }
    let scaled = Mat::from_fn(count, count, |i, j| {
        information[(i, j)] / (scale[i] * scale[j])
    });
    let factor = scaled.llt(Side::Lower).ok()?;
    let gradient = Mat::from_fn(count, 1, |i, _| -dot(&slopes[i], &here) / scale[i]);
    let solution = factor.solve(&gradient);
    let inverse = factor.solve(Mat::<f64>::identity(count, count));
    let mut step = [0.0; 6];
    for k in 0..count {
        step[k] = solution[(k, 0)] / scale[k];
    }
    // The trace bounds the largest eigenvalue of the rotation's covariance.
    let variance: f64 = (0..3)
        .map(|k| inverse[(k, k)] / (scale[k] * scale[k]))
        .sum();
    let sound = (0..count).all(|k| inverse[(k, k)] < 1e12);
    sound.then(|| (step, variance.sqrt()))
}
