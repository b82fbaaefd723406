//! Further edges of a sweep: those that go on where its tracks end.

use glam::DVec2;

use super::fit::{Fitted, Member};
use super::start::{joined, points};
use crate::drawing::Drawing;

/// An edge goes on along a track if it stays this near to it, in sizes: before the sweep is fitted to
/// it.
const NEAR: f64 = 3e-3;

/// Adds all edges that go on along tracks, but for `others`; whether there are any.
pub(super) fn grow(drawing: &Drawing, fitted: &mut Fitted, others: &[usize]) -> bool {
    let before: usize = fitted.members.iter().map(|m| m.points.len()).sum();
    for i in 0..fitted.members.len() {
        complete(drawing, fitted, i);
    }
    let mut i = 0;
    while i < fitted.members.len() {
        for end in [false, true] {
            let last = fitted.members[i].points.len() - 1;
            let next = next(drawing, fitted, others, (i, if end { last } else { 0 }));
            fitted.members.extend(next);
        }
        i += 1;
    }
    before < fitted.members.iter().map(|m| m.points.len()).sum()
}

/// Follows an edge of which a track has the first turn to its end.
fn complete(drawing: &Drawing, fitted: &mut Fitted, i: usize) {
    let member = &fitted.members[i];
    let all = points(drawing, member.edge);
    let known = member.points.len();
    if known < all.len()
        && let Some(at) = follow(fitted, i, known - 1, &all[known - 1..])
    {
        let member = &mut fitted.members[i];
        member.at.extend(&at[1..]);
        member.points = all;
    }
}

/// The edge that goes on best beyond one end of a member.
fn next(
    drawing: &Drawing,
    fitted: &Fitted,
    others: &[usize],
    (i, end): (usize, usize),
) -> Option<Member> {
    let member = &fitted.members[i];
    let mut best: Option<(f64, Member)> = None;
    for (edge, e) in drawing.edges.iter().enumerate() {
        let beside = e.v.iter().any(|v| drawing.edges[member.edge].v.contains(v));
        let taken = |e: usize| others.contains(&e) || fitted.members.iter().any(|m| m.edge == e);
        if !beside || e.is_straight() || e.v[0] == e.v[1] || taken(edge) {
            continue;
        }
        let mut points = points(drawing, edge);
        let Some((from, to)) = joined(drawing, (edge, &points), (member.edge, &member.points))
        else {
            continue;
        };
        if to != end {
            continue;
        }
        if from > 0 {
            points.reverse();
        }
        let Some(mut at) = follow(fitted, i, end, &points) else {
            continue;
        };
        if from > 0 {
            points.reverse();
            at.reverse();
        }
        let found = Member {
            edge,
            track: member.track,
            points,
            at,
        };
        let miss = fitted.miss(&found);
        if best.as_ref().is_none_or(|(least, _)| miss < *least) {
            best = Some((miss, found));
        }
    }
    best.map(|(_, member)| member)
}

/// Parameters of points that go on from one end of a member; `None` if they leave its track.
fn follow(fitted: &Fitted, i: usize, end: usize, points: &[DVec2]) -> Option<Vec<f64>> {
    let member = &fitted.members[i];
    let (spine, own) = (fitted.spine(), fitted.own(member.track));
    let inner = if end == 0 { 1 } else { end - 1 };
    let step = member.at[end] - member.at[inner];
    let length = member.points[end].distance(member.points[inner]);
    let mut at = vec![member.at[end]];
    let mut speed = step / length;
    for pair in points.windows(2) {
        let (last, way) = (at[at.len() - 1], pair[0].distance(pair[1]));
        let t = spine.nearest(own, pair[1], last + speed * way);
        if spine.drawn(own, t).distance(pair[1]) > NEAR || (t - last) * step <= 0.0 {
            return None;
        }
        speed = (t - last) / way;
        at.push(t);
    }
    Some(at)
}
