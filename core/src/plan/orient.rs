//! Orientation of all loops: seen from outside, every face is on the left of its edges.

use glam::DVec3;

use crate::drawing::CoEdge;

use super::PlanError;
use super::chart::{Measure, measure};
use super::support::Support;
use super::uses::Use;

/// A face with its loops in the order and direction of the plan.
#[derive(Debug, Clone)]
pub(super) struct Oriented {
    /// Loops, outer first.
    pub(super) loops: Vec<Vec<CoEdge>>,
    /// Whether the outward normal is against the gradient of the surface.
    pub(super) reversed: bool,
}

/// A face while it is worked on.
struct Draft {
    /// Outer first.
    loops: Vec<Vec<CoEdge>>,
    /// For each of the face's loops as given: whether it was turned around.
    turned: Vec<bool>,
    volume: f64,
    low: DVec3,
    high: DVec3,
}

/// Orients the loops of all faces.
///
/// Loops of one face are tied by geometry: with the gradient towards the viewer the outer one runs
/// counter-clockwise and the others clockwise. Faces are tied by their common edges, which they
/// walk in opposite directions. What is left is one choice for each shell: its volume is positive,
/// or negative if it is a void inside another shell.
///
/// `points` gives the points along a co-edge without the last one.
pub(super) fn orient(
    loops: &[Vec<Vec<CoEdge>>],
    supports: &[Support],
    uses: &[[Use; 2]],
    points: impl Fn(CoEdge) -> Vec<DVec3>,
) -> Result<Vec<Oriented>, PlanError> {
    let drafts: Vec<Draft> = loops
        .iter()
        .zip(supports)
        .map(|(loops, support)| draft(loops, support, &points))
        .collect();
    let shells = propagate(&drafts, uses)?;
    let mut flips: Vec<bool> = vec![false; drafts.len()];
    let volumes: Vec<f64> = shells.iter().map(|s| shell_volume(s, &drafts)).collect();
    for (i, shell) in shells.iter().enumerate() {
        let inside =
            (0..shells.len()).any(|j| j != i && is_inside(&shells[i], &shells[j], &drafts));
        let turn = (volumes[i] < 0.0) != inside;
        for &(face, flip) in shell {
            flips[face] = flip != turn;
        }
    }
    let turn = |walk: Vec<CoEdge>| walk.iter().rev().map(|c| c.mate()).collect();
    Ok(drafts
        .into_iter()
        .zip(flips)
        .map(|(draft, reversed)| Oriented {
            loops: if reversed {
                draft.loops.into_iter().map(turn).collect()
            } else {
                draft.loops
            },
            reversed,
        })
        .collect())
}

/// The loops of a face, each turned so that the face is on the left against the gradient.
fn draft(
    loops: &[Vec<CoEdge>],
    support: &Support,
    points: &impl Fn(CoEdge) -> Vec<DVec3>,
) -> Draft {
    let polylines: Vec<Vec<DVec3>> = loops
        .iter()
        .map(|walk| walk.iter().flat_map(|c| points(*c)).collect())
        .collect();
    let measures: Vec<Measure> = polylines.iter().map(|p| measure(support, p)).collect();
    // A loop around a cylinder has no inside; of two such loops the lower one walks forwards.
    let height = |i: usize| -measures[i].area * f64::from(measures[i].turns);
    let around: Vec<usize> = (0..loops.len())
        .filter(|&i| measures[i].turns != 0)
        .collect();
    let lowest = around
        .iter()
        .copied()
        .min_by(|&a, &b| height(a).total_cmp(&height(b)));
    let largest = (0..loops.len()).max_by(|&a, &b| {
        let size = |i: usize| measures[i].area.abs();
        size(a).total_cmp(&size(b))
    });
    let outer = lowest.or(largest).unwrap_or(0);
    let turned: Vec<bool> = (0..loops.len())
        .map(|i| match measures[i].turns {
            0 => (measures[i].area > 0.0) != (i == outer),
            turns => (turns > 0) != (i == outer),
        })
        .collect();
    let sign = |i: usize| if turned[i] { -1.0 } else { 1.0 };
    let volume = (0..loops.len()).map(|i| sign(i) * measures[i].volume).sum();
    let mut order: Vec<usize> = (0..loops.len()).collect();
    order.sort_by_key(|&i| i != outer);
    let walk = |i: usize| -> Vec<CoEdge> {
        if turned[i] {
            loops[i].iter().rev().map(|c| c.mate()).collect()
        } else {
            loops[i].clone()
        }
    };
    let all = || polylines.iter().flatten();
    Draft {
        loops: order.iter().map(|&i| walk(i)).collect(),
        turned,
        volume,
        low: all().fold(DVec3::INFINITY, |m, p| m.min(*p)),
        high: all().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p)),
    }
}

/// Faces of one shell, each with whether it is turned around to fit the first.
type Shell = Vec<(usize, bool)>;

/// Walks over common edges from face to face.
fn propagate(drafts: &[Draft], uses: &[[Use; 2]]) -> Result<Vec<Shell>, PlanError> {
    let mut neighbours: Vec<Vec<(usize, bool, usize)>> = vec![Vec::new(); drafts.len()];
    for (e, [a, b]) in uses.iter().enumerate() {
        // Both walk the edge the same way: one of them has to turn.
        let way = |u: &Use| u.reversed != drafts[u.face].turned[u.walk];
        let turn = way(a) == way(b);
        neighbours[a.face].push((b.face, turn, e));
        neighbours[b.face].push((a.face, turn, e));
    }
    let mut flip: Vec<Option<bool>> = vec![None; drafts.len()];
    let mut shells = Vec::new();
    for start in 0..drafts.len() {
        if flip[start].is_some() {
            continue;
        }
        flip[start] = Some(false);
        let mut shell = vec![(start, false)];
        let mut next = 0;
        while let Some(&(face, own)) = shell.get(next) {
            next += 1;
            for &(other, turn, edge) in &neighbours[face] {
                let wanted = own != turn;
                match flip[other] {
                    None => {
                        flip[other] = Some(wanted);
                        shell.push((other, wanted));
                    }
                    Some(found) if found != wanted => {
                        return Err(PlanError::NotOrientable {
                            edge: edge + 1,
                            faces: vec![face + 1, other + 1],
                        });
                    }
                    Some(_) => {}
                }
            }
        }
        shells.push(shell);
    }
    Ok(shells)
}

fn shell_volume(shell: &Shell, drafts: &[Draft]) -> f64 {
    let share = |&(face, flip): &(usize, bool)| {
        let volume: f64 = drafts[face].volume;
        if flip { -volume } else { volume }
    };
    shell.iter().map(share).sum()
}

/// Whether a shell's box lies inside another shell's box.
fn is_inside(inner: &Shell, outer: &Shell, drafts: &[Draft]) -> bool {
    let bounds = |shell: &Shell| {
        shell.iter().fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), (f, _)| (low.min(drafts[*f].low), high.max(drafts[*f].high)),
        )
    };
    let (low, high) = bounds(inner);
    let (outer_low, outer_high) = bounds(outer);
    low.cmpgt(outer_low).all() && high.cmplt(outer_high).all()
}
