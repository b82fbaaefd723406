//! What a draft gives up: conditions that contradict each other, and directions that the drawing
//! does not bear.

use glam::DVec3;

use super::draft::Draft;
use super::fit::Fitted;
use super::problem::{Condition, Dir, Problem};
use super::snaps::BROKEN;
use crate::lift::LiftError;

/// Rounds of giving up.
pub(super) const ROUNDS: usize = 8;

/// No drawing is more inexact than this share of its size.
const LOUDEST: f64 = 0.02;

/// A vertex that misses by so many errors is torn away by a wrong direction, if giving that up
/// takes so many squared errors away.
const TORN: f64 = 4.5;
const GAIN: f64 = 12.0;

/// Root of the mean squared miss of a coordinate; a vertex that misses wildly tells nothing.
pub(super) fn rms(draft: &Draft<'_, '_>, fitted: &Fitted) -> f64 {
    let count = draft.sheet.drawing.vertices.len();
    let mut misses: Vec<f64> = fitted.misses[..count].to_vec();
    misses.sort_by(f64::total_cmp);
    let kept = &misses[..count - count / 10];
    let squares: f64 = kept.iter().map(|m| m * m).sum();
    (squares / (2 * kept.len().max(1)) as f64)
        .sqrt()
        .min(LOUDEST)
}

/// Gives up directions that tear vertices away: a short edge that seems to follow an axis puts its
/// planes along it.
pub(super) fn relaxed(draft: &mut Draft<'_, '_>, mut fitted: Fitted) -> Result<Fitted, LiftError> {
    for _ in 0..ROUNDS {
        let count = draft.sheet.drawing.vertices.len();
        let worst = (0..count).max_by(|&a, &b| fitted.misses[a].total_cmp(&fitted.misses[b]));
        let Some(v) = worst.filter(|&v| fitted.misses[v] > TORN * draft.noise) else {
            break;
        };
        let mut bodies: Vec<usize> = draft.body_of.clone();
        bodies.sort_unstable();
        bodies.dedup();
        bodies.retain(|&b| {
            let dir = draft.problem.dirs[draft.problem.bodies[b].dir];
            let held = !matches!(dir, Dir::Free { .. });
            held && draft.is_plane(b) && draft.corners(b).contains(&v)
        });
        let before = (draft.problem.clone(), draft.start.clone());
        let mut best: Option<(f64, Problem, Problem, Fitted)> = None;
        for b in bodies {
            let dir = draft.problem.bodies[b].dir;
            let base = draft.problem.direction(dir, &draft.problem.x);
            free(draft, b, base);
            if let Ok(new) = draft.fit()
                && new.violation < BROKEN.max(fitted.violation)
            {
                let cost = cost(draft, &new);
                if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                    best = Some((cost, draft.problem.clone(), draft.start.clone(), new));
                }
            }
            (draft.problem, draft.start) = before.clone();
        }
        match best {
            Some((least, problem, start, new)) if least < cost(draft, &fitted) - GAIN => {
                (draft.problem, draft.start, fitted) = (problem, start, new);
            }
            _ => break,
        }
    }
    Ok(fitted)
}

/// Sum of squared misses of vertices, in errors.
pub(super) fn cost(draft: &Draft<'_, '_>, fitted: &Fitted) -> f64 {
    let misses = fitted
        .misses
        .iter()
        .take(draft.sheet.drawing.vertices.len());
    misses.map(|m| (m / draft.noise).powi(2)).sum()
}

/// Gives up what stands against the conditions that miss most: a touch, an outline, or else the
/// direction of a plane; false if there is nothing left to give up. The draft starts again then.
pub(super) fn give_up(draft: &mut Draft<'_, '_>) -> bool {
    let value = |c: &Condition| draft.problem.value(c, &draft.problem.x).abs();
    let worst = draft
        .problem
        .conditions
        .iter()
        .map(value)
        .fold(0.0, f64::max);
    let is_bad = |c: &Condition| value(c) > 0.3 * worst;
    let bad: Vec<Condition> = draft
        .problem
        .conditions
        .iter()
        .copied()
        .filter(is_bad)
        .collect();
    let mut bodies: Vec<usize> = bad.iter().flat_map(bodies_of).collect();
    bodies.sort_unstable();
    bodies.dedup();
    // No solid has a straight edge across a cylinder.
    let soft = |c: &Condition| !matches!(c, Condition::On { .. } | Condition::Along { .. });
    let mut given: Vec<Condition> = bad.iter().copied().filter(soft).collect();
    if given.is_empty() {
        let beside = |c: &Condition| bodies_of(c).iter().any(|b| bodies.contains(b));
        let all = draft.problem.conditions.iter().copied();
        given = all.filter(|c| soft(c) && beside(c)).collect();
    }
    draft.problem = draft.start.clone();
    if !given.is_empty() {
        draft.problem.conditions.retain(|c| !given.contains(c));
        return true;
    }
    let mut changed = false;
    for b in bodies {
        let dir = draft.problem.bodies[b].dir;
        if !matches!(draft.problem.dirs[dir], Dir::Free { .. }) {
            let base = draft.problem.direction(dir, &draft.problem.x);
            free(draft, b, base);
            changed = true;
        }
    }
    changed
}

fn bodies_of(condition: &Condition) -> Vec<usize> {
    match *condition {
        Condition::On { body, .. } => vec![body],
        Condition::Touch { plane, round, .. } | Condition::Beside { plane, round, .. } => {
            vec![plane, round]
        }
        Condition::Nestle { a, b, .. } | Condition::Between { a, b, .. } => vec![a, b],
        Condition::Step { upper, lower, .. } => vec![upper, lower],
        Condition::Outline { round, .. } | Condition::Along { round, .. } => vec![round],
    }
}

fn free(draft: &mut Draft<'_, '_>, body: usize, base: DVec3) {
    let at = draft.problem.add(&[0.0, 0.0]);
    draft.problem.dirs.push(Dir::Free { base, at });
    draft.problem.bodies[body].dir = draft.problem.dirs.len() - 1;
}
