//! What is decided after a first fit: conditions that contradict each other are given up
//! ([`concede`]), then directions, offsets, axes and radii that are nearly one become one.
//!
//! Each decision has to leave the drawing within its noise: a plane that turns may not take its
//! corners farther than [`ERRORS`] errors away, and if the fit becomes much worse the decisions of
//! that kind are taken back.

use std::f64::consts::PI;

use glam::DVec3;

use super::common::coplanar;
use super::concede;
use super::draft::Draft;
use super::fit::{Fitted, judged};
use super::problem::{Dir, Problem, Shape, angle_of, turn};
use crate::lift::LiftError;

/// Errors of the drawing within which things are one.
const ERRORS: f64 = 2.5;

/// No direction turns by more than this, radians.
const LARGEST_TURN: f64 = 0.2;

/// A direction that turns by less was along the other already.
const SAME: f64 = 1e-9;

/// Conditions that miss by more are not met.
pub(super) const BROKEN: f64 = 1e-7;

/// The squared misses may become this many times as large, beside one squared error a vertex.
const WORSE: f64 = 1.5;

/// Usual angles are multiples of this, degrees.
pub(super) const STEP: f64 = 15.0;

/// Decides and fits again.
pub(super) fn settle(draft: &mut Draft<'_, '_>) -> Result<Fitted, LiftError> {
    let mut fitted = judged(&draft.problem);
    for _ in 0..concede::ROUNDS {
        if fitted.violation < BROKEN || !concede::give_up(draft) {
            break;
        }
        fitted = draft.fit()?;
    }
    draft.noise = draft.noise.max(concede::rms(draft, &fitted));
    fitted = concede::relaxed(draft, fitted)?;
    for decide in [aligned, parallel, round, coplanar] {
        let before = (draft.problem.clone(), draft.start.clone());
        if !decide(draft) {
            continue;
        }
        let refit = draft.fit();
        let good = |new: &Fitted| {
            let limit =
                WORSE * concede::cost(draft, &fitted) + draft.sheet.drawing.vertices.len() as f64;
            new.violation < BROKEN.max(fitted.violation) && concede::cost(draft, new) < limit
        };
        match refit {
            Ok(new) if good(&new) => fitted = new,
            _ => (draft.problem, draft.start) = before,
        }
    }
    Ok(fitted)
}

/// Bodies with a direction, the largest first, with the distance of their corners from the middle.
pub(super) fn by_extent(draft: &Draft<'_, '_>) -> Vec<(usize, f64)> {
    let bodies = 0..draft.problem.bodies.len();
    let mut all: Vec<(usize, f64)> = bodies
        .filter(|&b| {
            draft.problem.bodies[b].shape != Shape::Open && draft.faces(b).next().is_some()
        })
        .map(|b| {
            let points: Vec<DVec3> = draft.corners(b).iter().map(|&v| draft.place(v)).collect();
            let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
            let reach = points
                .iter()
                .map(|p| p.distance(middle))
                .fold(0.0, f64::max);
            (b, reach)
        })
        .collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all
}

/// Whether a body may take another direction.
fn may_turn(draft: &Draft<'_, '_>, reach: f64, old: DVec3, new: DVec3) -> bool {
    let off = old.distance(new).min(old.distance(-new));
    off < LARGEST_TURN && off * reach < ERRORS * draft.noise
}

/// Directions go to the model's axes, to right angles with one, or to usual angles.
fn aligned(draft: &mut Draft<'_, '_>) -> bool {
    let mut changed = false;
    for (b, reach) in by_extent(draft) {
        let dir = draft.problem.bodies[b].dir;
        let old = draft.problem.direction(dir, &draft.problem.x);
        let found = match draft.problem.dirs[dir] {
            Dir::Fixed(_) => None,
            Dir::Turn { axis, .. } => usual(draft, axis, reach, old),
            Dir::Free { .. } => {
                let axes = draft.axes();
                let mut known = DVec3::AXES.into_iter().take(axes);
                let axis = known.find(|&a| may_turn(draft, reach, old, a));
                axis.map(Dir::Fixed).or_else(|| {
                    let across = (0..axes).find(|&k| {
                        let flat = old
                            .reject_from_normalized(DVec3::AXES[k])
                            .normalize_or_zero();
                        may_turn(draft, reach, old, flat)
                    })?;
                    let flat = old.reject_from_normalized(DVec3::AXES[across]).normalize();
                    usual(draft, across, reach, flat).or_else(|| {
                        let angle = draft.problem.add(&[angle_of(across, flat)]);
                        Some(Dir::Turn {
                            axis: across,
                            angle,
                            offset: 0.0,
                        })
                    })
                })
            }
        };
        if let Some(new) = found {
            let new = draft.add_dir(new);
            turn_body(draft, b, new);
            changed = true;
        }
    }
    changed
}

/// The direction around an axis at a usual angle.
fn usual(draft: &Draft<'_, '_>, axis: usize, reach: f64, old: DVec3) -> Option<Dir> {
    if draft.axes() < 3 {
        return None;
    }
    let degrees = angle_of(axis, old).to_degrees();
    let nearest = (degrees / STEP).round() * STEP;
    let quarter = (nearest / 90.0).round() * 90.0 == nearest;
    let new = if quarter {
        // Exactly the axis.
        turn(axis, nearest.to_radians()).round()
    } else {
        turn(axis, nearest / 180.0 * PI)
    };
    may_turn(draft, reach, old, new).then_some(Dir::Fixed(new))
}

/// Gives a body another direction, with its plane through the same middle.
fn turn_body(draft: &mut Draft<'_, '_>, body: usize, dir: usize) {
    draft.problem.bodies[body].dir = dir;
    if let Shape::Plane { offset } = draft.problem.bodies[body].shape {
        let points: Vec<DVec3> = draft
            .corners(body)
            .iter()
            .map(|&v| draft.place(v))
            .collect();
        let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
        draft.problem.x[offset] = draft.problem.direction(dir, &draft.problem.x).dot(middle);
    }
}

/// Directions that no axis fixes become that of a larger body, or, around one axis, at right
/// angles to it.
fn parallel(draft: &mut Draft<'_, '_>) -> bool {
    let mut changed = false;
    let order = by_extent(draft);
    for i in 1..order.len() {
        let (b, reach) = order[i];
        let dir = draft.problem.bodies[b].dir;
        if matches!(draft.problem.dirs[dir], Dir::Fixed(_)) {
            continue;
        }
        let old = draft.problem.direction(dir, &draft.problem.x);
        let mut found = None;
        for &(other, _) in &order[..i] {
            let twin = draft.problem.bodies[other].dir;
            let new = draft.problem.direction(twin, &draft.problem.x);
            if twin == dir {
                break;
            }
            if may_turn(draft, reach, old, new) {
                found = Some(draft.problem.dirs[twin]);
                break;
            }
            if let Dir::Turn {
                axis,
                angle,
                offset,
            } = draft.problem.dirs[twin]
            {
                let square = turn(axis, draft.problem.x[angle] + offset + PI / 2.0);
                if may_turn(draft, reach, old, square) {
                    let offset = offset + PI / 2.0;
                    found = Some(Dir::Turn {
                        axis,
                        angle,
                        offset,
                    });
                    break;
                }
            }
        }
        if let Some(new) = found {
            let new = draft.add_dir(new);
            turn_body(draft, b, new);
            changed = true;
        }
    }
    changed
}

/// Cylinders of one direction get one axis, and one radius. The inside and the outside of a tube do not
/// get both: a plane that cuts them has them as two.
fn round(draft: &mut Draft<'_, '_>) -> bool {
    let limit = ERRORS * draft.noise;
    let mut changed = false;
    let order: Vec<usize> = by_extent(draft)
        .into_iter()
        .map(|o| o.0)
        .filter(|&b| draft.is_round(b))
        .collect();
    for i in 1..order.len() {
        let (Some((dir, place, radius)), b) = (cylinder(&draft.problem, order[i]), order[i]) else {
            continue;
        };
        let x = &draft.problem.x;
        let axis = draft.problem.direction(dir, x);
        let center = |at: usize| DVec3::new(x[at], x[at + 1], x[at + 2]);
        let others = order[..i].iter();
        let others: Vec<(usize, usize, usize, usize)> = others
            .filter_map(|&o| cylinder(&draft.problem, o).map(|(d, p, r)| (d, p, r, o)))
            .collect();
        let coaxial = others.iter().find(|o| {
            let along = draft.problem.direction(o.0, x).cross(axis).length() < SAME;
            let apart = (center(o.1) - center(place))
                .reject_from_normalized(axis)
                .length();
            along && o.1 != place && apart < limit.min(0.3 * x[radius].max(x[o.2]))
        });
        let shared = coaxial.map_or(place, |o| o.1);
        let equal = others.iter().find(|o| {
            let (r, s) = (x[radius].abs(), x[o.2].abs());
            let are_one = others
                .iter()
                .any(|twin| twin.1 == shared && twin.2 == o.2 && meet_one(draft, b, twin.3));
            o.2 != radius && (r - s).abs() < limit.min(0.15 * r.min(s)) && !are_one
        });
        let (coaxial, equal) = (coaxial.map(|o| o.1), equal.map(|o| o.2));
        if coaxial.is_some() || equal.is_some() {
            draft.problem.bodies[b].shape = Shape::Cylinder {
                place: coaxial.unwrap_or(place),
                radius: equal.unwrap_or(radius),
            };
            changed = true;
        }
    }
    changed
}

/// Whether a third body is beside both.
fn meet_one(draft: &Draft<'_, '_>, a: usize, b: usize) -> bool {
    let beside = |own: usize| -> Vec<usize> {
        let edges = 0..draft.sheet.drawing.edges.len();
        let pairs = edges.filter_map(|e| draft.beside(e));
        let other = |[p, q]: [usize; 2]| match (p == own, q == own) {
            (true, false) => Some(q),
            (false, true) => Some(p),
            _ => None,
        };
        pairs.filter_map(other).collect()
    };
    let of_a = beside(a);
    beside(b).iter().any(|c| of_a.contains(c))
}

/// Direction, place and radius of a cylinder.
pub(super) fn cylinder(problem: &Problem, body: usize) -> Option<(usize, usize, usize)> {
    match problem.bodies[body].shape {
        Shape::Cylinder { place, radius } => Some((problem.bodies[body].dir, place, radius)),
        _ => None,
    }
}
