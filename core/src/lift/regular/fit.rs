//! The point of a problem that fits what is drawn best while its conditions hold exactly.
//!
//! Gauss-Newton with an augmented Lagrangian (Hestenes 1969, Powell 1969): conditions are rows of
//! large weight, and what they miss after a step is asked for in the next one, so that they hold to
//! rounding in the end although the weights are finite.

use super::problem::{Condition, Problem};
use crate::lift::LiftError;
use crate::lift::system::System;

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
    let mut last = f64::INFINITY;
    for step in 0..STEPS {
        let system = linear(problem, &owed);
        let delta = system.minimise(&vec![true; system.rows().len()])?;
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

/// The problem as linear rows about where it is.
fn linear(problem: &Problem, owed: &[f64]) -> System<()> {
    let mut system = System::new(problem.x.len());
    let mut x = problem.x.clone();
    // Central differences are exact to rounding for what is quadratic.
    let h = 1e-5;
    for p in 0..problem.points.len() {
        let point = &problem.points[p];
        let miss = problem.miss(p, &x);
        let mut slopes = Vec::with_capacity(6);
        for i in (0..3).chain(point.at..point.at + 3) {
            let was = x[i];
            x[i] = was + h;
            let up = problem.miss(p, &x);
            x[i] = was - h;
            let down = problem.miss(p, &x);
            x[i] = was;
            slopes.push((i, (up - down) / (2.0 * h)));
        }
        let row = |c: usize| slopes.iter().map(move |(i, s)| (*i, s[c]));
        system.push(row(0), -miss.x, point.weight, ());
        system.push(row(1), -miss.y, point.weight, ());
    }
    for (condition, owed) in problem.conditions.iter().zip(owed) {
        let value = problem.value(condition, &x);
        let parameters = problem.parameters(condition);
        let mut terms = Vec::with_capacity(parameters.len());
        for i in parameters {
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
