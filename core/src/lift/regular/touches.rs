//! Surfaces of a draft that touch.

use super::draft::Draft;
use super::problem::Condition;
use super::rounds::is_smooth;

/// Planes and cylinders that touch along a straight edge: at an end the curve of the cylinder goes
/// on smoothly into an edge of its neighbour.
pub(super) fn touches(draft: &mut Draft<'_, '_>) {
    for e in 0..draft.sheet.drawing.edges.len() {
        let (Some([a, b]), true) = (draft.beside(e), draft.sheet.is_straight(e)) else {
            continue;
        };
        let [f, g] = *draft.sheet.neighbours(e) else {
            continue;
        };
        if a == b || !(draft.is_round(a) || draft.is_round(b)) || !is_smooth(draft, e, f, g) {
            continue;
        }
        let (first, round) = if draft.is_round(b) { (a, b) } else { (b, a) };
        let ends = draft.sheet.drawing.edges[e].v;
        let conditions = if draft.is_plane(first) {
            touch(draft, first, round, ends)
        } else if draft.is_round(first) {
            nestle(draft, first, round, ends)
        } else {
            continue;
        };
        for condition in conditions.into_iter().flatten() {
            if !draft.problem.conditions.contains(&condition) {
                draft.problem.conditions.push(condition);
            }
        }
    }
}

fn touch(
    draft: &Draft<'_, '_>,
    plane: usize,
    round: usize,
    ends: [usize; 2],
) -> Option<[Condition; 3]> {
    let (p, r) = (draft.problem.bodies[plane], draft.problem.bodies[round]);
    let x = &draft.problem.x;
    let across = draft
        .problem
        .direction(p.dir, x)
        .dot(draft.problem.direction(r.dir, x));
    if across.abs() > 0.1 {
        return None;
    }
    let side = draft
        .problem
        .surface(plane, x)
        .distance(draft.problem.surface(round, x).origin());
    let side = side.signum();
    let beside = |point| Condition::Beside {
        point,
        plane,
        round,
    };
    Some([
        Condition::Touch { plane, round, side },
        beside(ends[0]),
        beside(ends[1]),
    ])
}

fn nestle(draft: &Draft<'_, '_>, a: usize, b: usize, ends: [usize; 2]) -> Option<[Condition; 3]> {
    let x = &draft.problem.x;
    let (one, two) = (draft.problem.surface(a, x), draft.problem.surface(b, x));
    if one.direction().cross(two.direction()).length() > 1e-9 {
        return None;
    }
    let middle = draft.place(ends[0]).midpoint(draft.place(ends[1]));
    let outside = one.gradient(middle).dot(two.gradient(middle)) < 0.0;
    let between = |point| Condition::Between { point, a, b };
    Some([
        Condition::Nestle { a, b, outside },
        between(ends[0]),
        between(ends[1]),
    ])
}
