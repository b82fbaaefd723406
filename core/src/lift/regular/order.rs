//! Steps that are smaller than the noise: a slot whose walls were drawn the wrong way round would
//! cross itself, and no solid has such a face.
//!
//! Which of two parallel planes is the upper one is told by the drawing only as far as it is exact.
//! Where edges of a face cross, the planes beside it that are nearly at one height change places,
//! one pair after the other, as long as fewer edges cross then.

use glam::{DVec2, DVec3};

use super::draft::Draft;
use super::fit::Fitted;
use super::problem::{Condition, Shape};
use super::snaps::BROKEN;

/// Planes closer than this many errors may change places.
const NEAR: f64 = 4.0;

/// A step is at least this many errors high.
const LEAST: f64 = 0.5;

/// Changes that are tried.
const TRIES: usize = 16;

/// Edges closer than this touch, in sizes of the drawing.
const TOUCH: f64 = 1e-7;

/// Changes the places of planes until no edges of a face cross, if it can.
pub(super) fn untangle(draft: &mut Draft<'_, '_>, mut fitted: Fitted) -> Fitted {
    let mut tangled = tangled(draft);
    let mut tries = 0;
    let mut done: Vec<[usize; 2]> = Vec::new();
    while let Some(pair) = candidates(draft, &tangled)
        .into_iter()
        .find(|p| !done.contains(p))
        .filter(|_| tries < TRIES)
    {
        tries += 1;
        done.push(pair);
        let before = (draft.problem.clone(), draft.start.clone());
        exchange(draft, pair);
        let refit = draft.fit();
        let now = self::tangled(draft);
        match refit {
            Ok(new)
                if new.violation < BROKEN.max(fitted.violation)
                    && count(&now) < count(&tangled) =>
            {
                (fitted, tangled) = (new, now);
            }
            _ => (draft.problem, draft.start) = before,
        }
    }
    fitted
}

fn count(tangled: &[(usize, usize)]) -> usize {
    tangled.iter().map(|t| t.1).sum()
}

/// Planar faces of which edges cross, with the number of crossings.
fn tangled(draft: &Draft<'_, '_>) -> Vec<(usize, usize)> {
    let faces = 0..draft.sheet.faces.len();
    faces
        .filter(|&f| draft.is_plane(draft.body_of[f]))
        .map(|f| (f, crossings(draft, f)))
        .filter(|c| c.1 > 0)
        .collect()
}

/// Pairs of straight edges of a planar face that cross, touch or lie on each other.
fn crossings(draft: &Draft<'_, '_>, face: usize) -> usize {
    let dir = draft.problem.bodies[draft.body_of[face]].dir;
    let normal = draft.problem.direction(dir, &draft.problem.x);
    let (u, w) = normal.any_orthonormal_pair();
    let flat = |p: DVec3| DVec2::new(p.dot(u), p.dot(w));
    let edges = draft.sheet.edges_of(face).iter();
    let straight: Vec<([usize; 2], [DVec2; 2])> = edges
        .filter(|&&e| draft.sheet.is_straight(e))
        .map(|&e| {
            let v = draft.sheet.drawing.edges[e].v;
            (v, v.map(|v| flat(draft.place(v))))
        })
        .collect();
    let mut count = 0;
    for (i, (v, [a, b])) in straight.iter().enumerate() {
        for (w, [c, d]) in &straight[i + 1..] {
            let shared = v.iter().find(|x| w.contains(x));
            count += usize::from(match shared {
                Some(s) => {
                    // Neighbours may lie on each other.
                    let p = if v[0] == *s { *b - *a } else { *a - *b };
                    let q = if w[0] == *s { *d - *c } else { *c - *d };
                    let sine = p.perp_dot(q) / (p.length() * q.length());
                    sine.abs() < 1e-6 && p.dot(q) > 0.0
                }
                None => meet([*a, *b], [*c, *d]),
            });
        }
    }
    count
}

/// Whether two segments cross or touch.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).normalize_or_zero().perp_dot(r - p);
    let across = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
    let on = |p: DVec2, q: DVec2, r: DVec2| {
        let length = p.distance(q);
        let along = (q - p).normalize_or_zero().dot(r - p);
        side(p, q, r).abs() < TOUCH && along > -TOUCH && along < length + TOUCH
    };
    across || on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b)
}

/// Pairs of parallel planes beside tangled faces that are nearly at one height, the closest first.
fn candidates(draft: &Draft<'_, '_>, tangled: &[(usize, usize)]) -> Vec<[usize; 2]> {
    let mut all: Vec<(f64, [usize; 2])> = Vec::new();
    for &(face, _) in tangled {
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
