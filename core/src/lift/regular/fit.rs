//! The point of a problem that fits what is drawn best while its conditions hold exactly.
//!
//! Gauss-Newton with an augmented Lagrangian (Hestenes 1969, Powell 1969): conditions are rows of
//! large weight, and what they miss after a step is asked for in the next one, so that they hold to
//! rounding in the end although the weights are finite.

use glam::DVec3;

use super::problem::{Condition, Problem, triple};
use crate::lift::LiftError;
use crate::lift::system::{Pattern, System};

/// Weight of conditions beside drawn points.
const STRONG: f64 = 300.0;

/// Weight of staying where it is beside drawn points: for what nothing else tells.
const WEAK: f64 = 3e-3;

/// Steps.
const STEPS: usize = 30;

/// Conditions hold if they miss by less than this.
const EXACT: f64 = 1e-12;

/// How well a problem is solved.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    /// Largest miss of a condition, a length.
    pub(super) violation: f64,
    /// Distance in the drawing of every point from where it is drawn.
    pub(super) misses: Vec<f64>,
}

/// Solves a problem from where it is; the drawing's size is about 1.
pub(super) fn fit(problem: &mut Problem) -> Result<Fitted, LiftError> {
    let mut owed = vec![0.0; problem.conditions.len()];
    let parameters: Vec<Vec<usize>> = problem
        .conditions
        .iter()
        .map(|c| problem.parameters(c))
        .collect();
    let mut pattern: Option<(Pattern, Vec<bool>)> = None;
    let mut last = f64::INFINITY;
    for step in 0..STEPS {
        let system = linear(problem, &parameters, &owed);
        if pattern.is_none() {
            let all = vec![true; system.rows().len()];
            pattern = Some((system.pattern(&all)?, all));
        }
        let Some((known, all)) = &pattern else {
            break;
        };
        let delta = system.minimise_as(all, known)?;
        let longest = delta.iter().fold(0.0, |m: f64, d| m.max(d.abs()));
        // Nothing moves farther than the drawing is wide in one step.
        let share = (0.5 / longest).min(1.0);
        for (x, d) in problem.x.iter_mut().zip(&delta) {
            *x += share * d;
        }
        problem.rebase();
        let mut violation: f64 = 0.0;
        for (c, owed) in problem.conditions.iter().zip(&mut owed) {
            let value = problem.value(c, &problem.x);
            violation = violation.max(value.abs());
            if share == 1.0 {
                *owed += value;
            }
        }
        if violation.is_nan() {
            return Err(LiftError::Solver(
                "the regular drawing is not finite".into(),
            ));
        }
        let settled = longest < 1e-9;
        if step > 2 && violation < EXACT && (settled || longest < 1e-4) {
            break;
        }
        // Conditions that contradict each other would gather debts for ever.
        if step > 12 && violation > 0.9 * last && violation > 1e-6 {
            break;
        }
        last = violation;
    }
    Ok(judged(problem))
}

/// How well a problem is solved as it is.
pub(super) fn judged(problem: &Problem) -> Fitted {
    let conditions = problem.conditions.iter();
    Fitted {
        violation: conditions
            .map(|c| problem.value(c, &problem.x).abs())
            .fold(0.0, f64::max),
        misses: (0..problem.points.len())
            .map(|p| problem.miss(p, &problem.x).length())
            .collect(),
    }
}

/// The problem as linear rows about where it is, just after [`Problem::rebase`].
fn linear(problem: &Problem, parameters: &[Vec<usize>], owed: &[f64]) -> System<()> {
    let mut system = System::new(problem.x.len());
    let mut x = problem.x.clone();
    // Central differences are exact to rounding for what is quadratic.
    let h = 1e-5;
    for point in &problem.points {
        let place = problem.rotation * triple(&x, point.at);
        let miss = problem.camera.project(place) - point.drawn;
        let slope = |step: DVec3| {
            let [up, down] = [h, -h].map(|h| problem.camera.project(place + step * h));
            (up - down) / (2.0 * h)
        };
        // Turning the camera moves the point around the origin.
        let turns = DVec3::AXES.map(|axis| slope(axis.cross(place)));
        let moves = DVec3::AXES.map(|axis| slope(problem.rotation * axis));
        let slopes = || {
            let at = (0..3).chain(point.at..point.at + 3);
            at.zip(turns.into_iter().chain(moves))
        };
        system.push(slopes().map(|(i, s)| (i, s.x)), -miss.x, point.weight, ());
        system.push(slopes().map(|(i, s)| (i, s.y)), -miss.y, point.weight, ());
    }
    for ((condition, parameters), owed) in problem.conditions.iter().zip(parameters).zip(owed) {
        let value = problem.value(condition, &x);
        let mut terms = Vec::with_capacity(parameters.len());
        for &i in parameters {
            terms.push((i, slope(problem, condition, &mut x, i, h)));
        }
        system.push(terms, -value - owed, STRONG, ());
    }
    for i in 0..problem.x.len() {
        system.push([(i, 1.0)], 0.0, WEAK, ());
    }
    system
}

fn slope(problem: &Problem, condition: &Condition, x: &mut [f64], i: usize, h: f64) -> f64 {
    let was = x[i];
    x[i] = was + h;
    let up = problem.value(condition, x);
    x[i] = was - h;
    let down = problem.value(condition, x);
    x[i] = was;
    (up - down) / (2.0 * h)
}
