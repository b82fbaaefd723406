//! The sweep whose tracks are drawn nearest to points: Levenberg-Marquardt over the distances of
//! points from their tracks.

use glam::DVec2;

use super::model::{Base, OWN, SHARED, Spine};
use crate::lift::dense::solve;

/// Most steps, and trials of one step.
const STEPS: usize = 50;
const TRIALS: usize = 8;

/// Step of differences.
const STEP: f64 = 1e-6;

/// A step that gains less than this share ends the search; far from the drawing, in sizes, so many steps
/// that gain less than a larger one.
const GAIN: f64 = 1e-5;
const FAR: f64 = 1e-3;
const FAR_GAIN: f64 = 0.1;
const PATIENCE: usize = 4;

/// An edge on a track.
#[derive(Debug, Clone)]
pub(super) struct Member {
    pub(super) edge: usize,
    pub(super) track: usize,
    /// Its points as drawn, in sizes of the drawing.
    pub(super) points: Vec<DVec2>,
    /// Their parameters.
    pub(super) at: Vec<f64>,
}

/// A sweep and the edges on it, in sizes of the drawing.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pub(super) base: Base,
    pub(super) x: Vec<f64>,
    pub(super) members: Vec<Member>,
}

impl Fitted {
    pub(super) fn spine(&self) -> Spine {
        self.base.spine(&self.x)
    }

    pub(super) fn own(&self, track: usize) -> DVec2 {
        own(&self.x, track)
    }

    /// Largest distance of the points of a member from its track.
    pub(super) fn miss(&self, member: &Member) -> f64 {
        let (spine, own) = (self.spine(), self.own(member.track));
        let points = member.points.iter().zip(&member.at);
        points
            .map(|(p, t)| p.distance(spine.drawn(own, *t)))
            .fold(0.0, f64::max)
    }

    /// Moves all parameters to the points nearest to what is drawn; the sum of squared distances.
    fn settle(&mut self) -> f64 {
        let spine = self.spine();
        let mut sum = 0.0;
        for member in &mut self.members {
            let own = own(&self.x, member.track);
            for (p, t) in member.points.iter().zip(&mut member.at) {
                *t = spine.nearest(own, *p, *t);
                sum += p.distance_squared(spine.drawn(own, *t));
            }
        }
        sum
    }

    /// Fits the sweep to its members, from where it is; the sum of squared distances.
    pub(super) fn fit(&mut self) -> f64 {
        let mut cost = self.settle();
        let mut damping: f64 = 1e-3;
        let count: usize = self.members.iter().map(|m| m.points.len()).sum();
        let far = FAR * FAR * count as f64;
        let mut slow = 0;
        for _ in 0..STEPS {
            let normal = self.linear();
            let mut better = None;
            for _ in 0..TRIALS {
                let mut trial = self.clone();
                if let Some(delta) = normal.damped(damping) {
                    trial.x.iter_mut().zip(&delta).for_each(|(x, d)| *x += d);
                    let next = trial.settle();
                    if next < cost {
                        better = Some((trial, next));
                        break;
                    }
                }
                damping *= 8.0;
            }
            let Some((trial, next)) = better else {
                break;
            };
            *self = trial;
            let gained = cost - next;
            damping = (damping / 8.0).max(1e-12);
            cost = next;
            slow = if cost > far && gained <= FAR_GAIN * cost {
                slow + 1
            } else {
                0
            };
            if gained <= GAIN * cost || slow >= PATIENCE {
                break;
            }
        }
        cost
    }

    /// Distances of points from their tracks as linear rows about where the unknowns are.
    fn linear(&self) -> Normal {
        let mut normal = Normal::new(self.x.len());
        let spine = self.spine();
        let moved = |i: usize, h: f64| {
            let mut x = self.x.clone();
            x[i] += h;
            self.base.spine(&x)
        };
        let spines: Vec<[Spine; 2]> = (0..SHARED)
            .map(|i| [moved(i, STEP), moved(i, -STEP)])
            .collect();
        for member in &self.members {
            let own = self.own(member.track);
            let first = SHARED + OWN * member.track;
            let mut terms = [(0, 0.0); SHARED + OWN];
            for (p, &t) in member.points.iter().zip(&member.at) {
                let across = spine.normal(own, t);
                let miss = (*p - spine.drawn(own, t)).dot(across);
                let slope = |up: DVec2, down: DVec2| (up - down).dot(across) / (2.0 * STEP);
                for (i, [up, down]) in spines.iter().enumerate() {
                    terms[i] = (i, slope(up.drawn(own, t), down.drawn(own, t)));
                }
                for (i, d) in DVec2::AXES.into_iter().enumerate() {
                    let ends = [own + d * STEP, own - d * STEP].map(|o| spine.drawn(o, t));
                    terms[SHARED + i] = (first + i, slope(ends[0], ends[1]));
                }
                normal.push(&terms, miss);
            }
        }
        normal
    }
}

/// Normal equations of least squares, row by row.
struct Normal {
    matrix: Vec<Vec<f64>>,
    right: Vec<f64>,
}

impl Normal {
    fn new(unknowns: usize) -> Self {
        Self {
            matrix: vec![vec![0.0; unknowns]; unknowns],
            right: vec![0.0; unknowns],
        }
    }

    fn push(&mut self, terms: &[(usize, f64)], right: f64) {
        for &(i, a) in terms {
            self.right[i] += a * right;
            for &(j, b) in terms {
                self.matrix[i][j] += a * b;
            }
        }
    }

    /// The solution with each unknown held by a share of its own row (Marquardt 1963); `None` if it is
    /// not known to any precision.
    fn damped(&self, share: f64) -> Option<Vec<f64>> {
        let count = self.right.len();
        // Unknowns of unit columns.
        let scale: Vec<f64> = (0..count)
            .map(|i| self.matrix[i][i].sqrt().max(1e-12).recip())
            .collect();
        let entry = |i: usize, j: usize| {
            let held = if i == j { share } else { 0.0 };
            self.matrix[i][j] * scale[i] * scale[j] + held
        };
        let matrix = (0..count).map(|i| (0..count).map(|j| entry(i, j)).collect());
        let right = self.right.iter().zip(&scale).map(|(r, s)| r * s);
        let mut x = solve(matrix.collect(), right.collect())?;
        x.iter_mut().zip(&scale).for_each(|(x, s)| *x *= s);
        x.iter().all(|x| x.is_finite()).then_some(x)
    }
}

fn own(x: &[f64], track: usize) -> DVec2 {
    let first = SHARED + OWN * track;
    DVec2::new(x[first], x[first + 1])
}
