//! Planes that are one, and what the surfaces of a draft have in common, for the report.

use glam::DVec3;

use super::draft::Draft;
use super::problem::{Condition, Dir, Shape, angle_of};
use super::report::Snap;
use super::snaps::{STEP, by_extent, cylinder};

/// Planes of one direction at one height become one, unless an edge leads from one to the other:
/// then the step between them is meant.
pub(super) fn coplanar(draft: &mut Draft<'_, '_>) -> bool {
    let mut changed = false;
    let order: Vec<usize> = by_extent(draft)
        .into_iter()
        .map(|o| o.0)
        .filter(|&b| draft.is_plane(b))
        .collect();
    let corners: Vec<Vec<usize>> = order.iter().map(|&b| draft.corners(b)).collect();
    let steps = |i: usize, j: usize| {
        draft.sheet.drawing.edges.iter().any(|e| {
            let [v, w] = e.v;
            let from = |c: &[usize], v: usize| c.binary_search(&v).is_ok();
            (from(&corners[i], v) && from(&corners[j], w) && !from(&corners[i], w))
                || (from(&corners[i], w) && from(&corners[j], v) && !from(&corners[i], v))
        })
    };
    let mut merged = Vec::new();
    for i in 1..order.len() {
        for j in 0..i {
            let (b, other) = (
                draft.problem.bodies[order[i]],
                draft.problem.bodies[order[j]],
            );
            let (Shape::Plane { offset }, Shape::Plane { offset: twin }) = (b.shape, other.shape)
            else {
                continue;
            };
            let apart = (draft.problem.x[offset] - draft.problem.x[twin]).abs();
            if b.dir == other.dir && offset != twin && apart < draft.noise && !steps(i, j) {
                merged.push((order[i], twin));
                break;
            }
        }
    }
    for (b, twin) in merged {
        draft.problem.bodies[b].shape = Shape::Plane { offset: twin };
        changed = true;
    }
    changed
}

/// What the draft has in common now.
pub(super) fn snapped(draft: &Draft<'_, '_>) -> Vec<Snap> {
    let problem = &draft.problem;
    let mut all = Vec::new();
    let faces_of = |bodies: &[usize]| {
        let mut faces: Vec<usize> = bodies.iter().flat_map(|&b| draft.faces(b)).collect();
        faces.sort_unstable();
        faces
    };
    let used: Vec<usize> = (0..problem.bodies.len())
        .filter(|&b| problem.bodies[b].shape != Shape::Open && draft.faces(b).next().is_some())
        .collect();
    let with = |test: &dyn Fn(usize) -> bool| -> Vec<usize> {
        used.iter().copied().filter(|&b| test(b)).collect()
    };
    let square = with(
        &|b| matches!(problem.dirs[problem.bodies[b].dir], Dir::Fixed(d) if DVec3::AXES.contains(&d.abs())),
    );
    if !square.is_empty() {
        all.push(Snap::Square {
            faces: faces_of(&square),
        });
    }
    for (i, dir) in problem.dirs.iter().enumerate() {
        let same = with(&|b| problem.bodies[b].dir == i);
        match dir {
            Dir::Fixed(d) if !same.is_empty() && !DVec3::AXES.contains(&d.abs()) => {
                let axis = (0..3)
                    .min_by(|&j, &k| d[j].abs().total_cmp(&d[k].abs()))
                    .unwrap_or(0);
                let degrees =
                    (angle_of(axis, *d).to_degrees().rem_euclid(180.0) / STEP).round() * STEP;
                all.push(Snap::Angle {
                    degrees,
                    faces: faces_of(&same),
                });
            }
            Dir::Turn { .. } | Dir::Free { .. } if same.len() > 1 => {
                all.push(Snap::Parallel {
                    faces: faces_of(&same),
                });
            }
            _ => {}
        }
    }
    let mut groups = |key: &dyn Fn(usize) -> Option<usize>, snap: fn(Vec<usize>) -> Snap| {
        let mut keys: Vec<usize> = used.iter().filter_map(|&b| key(b)).collect();
        keys.sort_unstable();
        keys.dedup();
        for k in keys {
            let same = with(&|b| key(b) == Some(k));
            if same.len() > 1 {
                all.push(snap(faces_of(&same)));
            }
        }
    };
    let offset = |b: usize| match problem.bodies[b].shape {
        Shape::Plane { offset } => Some(offset),
        _ => None,
    };
    groups(&offset, |faces| Snap::Coplanar { faces });
    groups(&|b| Some(cylinder(problem, b)?.1), |faces| Snap::Coaxial {
        faces,
    });
    groups(&|b| Some(cylinder(problem, b)?.2), |faces| {
        Snap::EqualRadius { faces }
    });
    let touching = problem.conditions.iter().flat_map(|c| match *c {
        Condition::Touch { round, .. } => vec![round],
        Condition::Nestle { a, b, .. } => vec![a, b],
        _ => Vec::new(),
    });
    let mut touching: Vec<usize> = touching.collect();
    touching.sort_unstable();
    touching.dedup();
    if !touching.is_empty() {
        all.push(Snap::Tangent {
            faces: faces_of(&touching),
        });
    }
    all
}
