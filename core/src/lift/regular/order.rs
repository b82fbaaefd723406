//! Steps that are smaller than the noise: a slot whose walls were drawn the wrong way round would
//! cross itself, and no solid has such a face.
//!
//! Which of two parallel planes is the upper one is told by the drawing only as far as it is exact.
//! Where edges of a face cross, the planes beside it that are nearly at one height change places,
//! one pair after the other, as long as fewer edges cross then.

use super::draft::Draft;
use super::faults::Faults;
use super::fit::Fitted;
use super::problem::{Condition, Shape};
use super::snaps::BROKEN;

/// Planes closer than this many errors may change places.
const NEAR: f64 = 4.0;

/// A step is at least this many errors high.
const LEAST: f64 = 0.5;

/// Changes that are tried.
const TRIES: usize = 16;

/// Changes the places of planes until no edges of a face cross, if it can.
pub(super) fn untangle(draft: &mut Draft<'_, '_>, mut fitted: Fitted) -> Fitted {
    let mut faults = Faults::of(draft);
    let mut tries = 0;
    let mut done: Vec<[usize; 2]> = Vec::new();
    while let Some(pair) = candidates(draft, &faults)
        .into_iter()
        .find(|p| !done.contains(p))
        .filter(|_| tries < TRIES)
    {
        tries += 1;
        done.push(pair);
        let before = (draft.problem.clone(), draft.start.clone());
        exchange(draft, pair);
        let refit = draft.fit();
        let now = Faults::of(draft);
        match refit {
            Ok(new)
                if new.violation < BROKEN.max(fitted.violation) && now.count() < faults.count() =>
            {
                (fitted, faults) = (new, now);
            }
            _ => (draft.problem, draft.start) = before,
        }
    }
    fitted
}

/// Pairs of parallel planes beside tangled faces that are nearly at one height, the closest first.
fn candidates(draft: &Draft<'_, '_>, faults: &Faults) -> Vec<[usize; 2]> {
    let mut all: Vec<(f64, [usize; 2])> = Vec::new();
    for &(face, _) in &faults.tangled {
        let mut beside: Vec<usize> = draft
            .sheet
            .edges_of(face)
            .iter()
            .filter_map(|&e| draft.beside(e))
            .flatten()
            .filter(|&b| draft.is_plane(b))
            .collect();
        beside.sort_unstable();
        beside.dedup();
        for (i, &a) in beside.iter().enumerate() {
            for &b in &beside[i + 1..] {
                if let Some(step) = step(draft, [a, b])
                    && step.abs() < NEAR * draft.noise
                {
                    all.push((step.abs(), [a, b]));
                }
            }
        }
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    all.dedup();
    all.into_iter().map(|c| c.1).collect()
}

/// How far a plane is above another one of its direction.
fn step(draft: &Draft<'_, '_>, pair: [usize; 2]) -> Option<f64> {
    let [a, b] = pair.map(|b| draft.problem.bodies[b]);
    match (a.shape, b.shape) {
        (Shape::Plane { offset }, Shape::Plane { offset: other })
            if a.dir == b.dir && offset != other =>
        {
            Some(draft.problem.x[offset] - draft.problem.x[other])
        }
        _ => None,
    }
}

/// Puts the upper one of two planes below the other.
fn exchange(draft: &mut Draft<'_, '_>, pair: [usize; 2]) {
    let Some(now) = step(draft, pair) else {
        return;
    };
    let by = -now.signum() * now.abs().max(LEAST * draft.noise);
    let [upper, lower] = pair;
    draft
        .problem
        .conditions
        .retain(|c| !matches!(c, Condition::Step { upper: u, lower: l, .. } if [*u, *l] == pair));
    draft
        .problem
        .conditions
        .push(Condition::Step { upper, lower, by });
}
