//! Circles and silhouettes around one axis, matched all at once.
//!
//! What is turned on a lathe is a chain of faces from circle to circle: annuli, and surfaces of
//! revolution that need no silhouette in this view. Each loop of the chain bounds one face, which
//! has one or two of them, and placing parts one by one does not see that a circle whose two
//! sides are both left alone would be a disc without thickness. So the loops around an axis are
//! matched in pairs, or left alone, at the least total cost.

mod beside;
mod matching;
#[cfg(test)]
mod tests;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use glam::DVec2;

use super::links::{Link, LinkKind};
use super::shapes::{Outline, Shapes};
use crate::drawing::SurfaceKind;
use matching::{Partial, Use};

/// Cost of a curved face between two circles that are not in one plane.
const ROUND: f64 = 0.6;

/// Cost of each loop around the axis that a face would pass by.
const SKIPPED: f64 = 1.5;

/// Cost of a face over the whole length of the chain.
const LONG: f64 = 1.0;

/// Cost of taking a whole circle for the end of a curved face although it looks like a plane's.
const UNLIKE: f64 = 1.5;

/// A loop of a chain.
#[derive(Debug, Clone, Copy)]
struct Ring {
    outline: usize,
    /// Place along the drawn axis; unknown for silhouettes.
    along: Option<f64>,
    /// Depth that puts its part on the axis.
    shift: f64,
}

/// Two rings that may be one face.
#[derive(Debug, Clone, Copy)]
struct Pair {
    outer: usize,
    inner: usize,
    link: usize,
    kind: LinkKind,
    cost: f64,
}

/// The loops around one axis.
pub(super) struct Chain {
    rings: Vec<Ring>,
    pairs: Vec<Pair>,
    /// Costs of leaving rings alone.
    alone: Vec<f64>,
    /// The other loop of a part that is one closed edge.
    mate: Vec<Option<usize>>,
    /// Larger flat rings in whose plane and inside of which each flat one is.
    around: Vec<Vec<usize>>,
    /// Matchings found, by how rings are used outside of the chain.
    found: RefCell<BTreeMap<Vec<Use>, Rc<[Partial]>>>,
}

/// The chains of at least two loops of different parts.
pub(super) fn chains(shapes: &Shapes, links: &[Link]) -> Vec<Chain> {
    let mut groups: Vec<(usize, DVec2, Vec<usize>)> = Vec::new();
    for (i, outline) in shapes.loops.iter().enumerate() {
        let Some(line) = outline.line else { continue };
        let along = shapes.camera.drawn(shapes.axes[line.axis], line.at);
        if along.length() < 1e-3 {
            continue;
        }
        let off = |at: DVec2| (at - line.at).perp_dot(along.normalize()).abs();
        let near =
            |g: &&mut (usize, DVec2, Vec<usize>)| g.0 == line.axis && off(g.1) < shapes.on_axis();
        match groups.iter_mut().find(near) {
            Some(group) => group.2.push(i),
            None => groups.push((line.axis, line.at, vec![i])),
        }
    }
    let several = |list: &[usize]| {
        let first = shapes.loops[list[0]].part;
        list.iter().any(|&i| shapes.loops[i].part != first)
    };
    groups
        .into_iter()
        .filter(|(_, _, list)| several(list) && list.len() <= 120)
        .map(|(axis, at, list)| Chain::new(shapes, links, (axis, at), list))
        .filter(|chain| !chain.pairs.is_empty())
        .collect()
}

impl Chain {
    /// The loops of a list, around an axis through the place that is drawn there.
    fn new(
        shapes: &Shapes,
        links: &[Link],
        (axis, start): (usize, DVec2),
        mut list: Vec<usize>,
    ) -> Self {
        // From the outside to the inside, so that what is drawn near is decided together.
        list.sort_by(|&a, &b| {
            let area = |i: usize| shapes.loops[i].area.abs();
            area(b).total_cmp(&area(a)).then(a.cmp(&b))
        });
        let direction = shapes.axes[axis];
        let unit = shapes.camera.drawn(direction, start).normalize_or(DVec2::X);
        let rings: Vec<Ring> = list
            .iter()
            .filter_map(|&outline| {
                let line = shapes.loops[outline].line?;
                let along = (line.at - start).dot(unit);
                Some(Ring {
                    outline,
                    along: (!shapes.loops[outline].fold).then_some(along),
                    shift: shapes.camera.climb(direction, start, line.at) - line.depth,
                })
            })
            .collect();
        let known = || rings.iter().filter_map(|r| r.along);
        let length =
            known().fold(f64::NEG_INFINITY, f64::max) - known().fold(f64::INFINITY, f64::min);
        let place = |i: usize| rings.iter().position(|r| r.outline == i);
        let mut pairs = Vec::new();
        for (l, link) in links.iter().enumerate() {
            let (Some(a), Some(b)) = (place(link.outer), place(link.inner)) else {
                continue;
            };
            if link.kind == LinkKind::Pierced {
                continue;
            }
            let off = rings[b].shift - rings[a].shift - link.offset;
            let (p, q) = (&shapes.loops[link.outer], &shapes.loops[link.inner]);
            let circles = shapes.parts[p.part].is_circle && shapes.parts[q.part].is_circle;
            // A loop of a sphere that is no circle has some of its outline, of which a sphere's face
            // has one.
            let outlined = |o: &Outline| o.kind == SurfaceKind::Sphere && o.curved && !o.ring;
            if outlined(p) && outlined(q) {
                continue;
            }
            // Either loop of a circle stands for the other.
            if p.part == q.part
                || off.abs() > 2.0 * shapes.slack(link.error)
                || circles && link.same_sense
            {
                continue;
            }
            let (Some(first), Some(second)) =
                (unlike(shapes, p, link.kind), unlike(shapes, q, link.kind))
            else {
                continue;
            };
            let mut cost = first + second;
            if link.kind == LinkKind::Coaxial {
                cost += ROUND;
            }
            cost += SKIPPED * skipped(shapes, &rings, a, b) as f64;
            if let (Some(s), Some(t)) = (rings[a].along, rings[b].along) {
                cost += LONG * (s - t).abs() / length.max(f64::MIN_POSITIVE);
            }
            if p.curved && q.curved && p.kind != q.kind && !p.fold && !q.fold {
                cost += 1.0;
            }
            pairs.push(Pair {
                outer: a,
                inner: b,
                link: l,
                kind: link.kind,
                cost,
            });
        }
        let alone = rings
            .iter()
            .map(|ring| {
                let outline = &shapes.loops[ring.outline];
                let circle = shapes.parts[outline.part].is_circle;
                match outline.kind {
                    _ if outline.fold => 4.0,
                    _ if circle => 1.2,
                    SurfaceKind::Plane | SurfaceKind::Sphere => 0.6,
                    SurfaceKind::Cone => 2.0,
                    _ => 3.0,
                }
            })
            .collect();
        let mate = (0..rings.len())
            .map(|i| {
                let part = shapes.loops[rings[i].outline].part;
                let same = |j: &usize| *j != i && shapes.loops[rings[*j].outline].part == part;
                let other = (0..rings.len()).find(same);
                other.filter(|_| shapes.parts[part].is_circle)
            })
            .collect();
        let around = (0..rings.len())
            .map(|i| {
                (0..i)
                    .filter(|&j| over(shapes, &rings[j], &rings[i]))
                    .collect()
            })
            .collect();
        Self {
            rings,
            pairs,
            alone,
            mate,
            around,
            found: RefCell::default(),
        }
    }
}

/// Whether two rings are flat and in one plane, the second one inside the first.
fn over(shapes: &Shapes, outer: &Ring, inner: &Ring) -> bool {
    let [a, b] = [outer, inner].map(|r| &shapes.loops[r.outline]);
    let flat = |o: &Outline| o.kind == SurfaceKind::Plane && !o.curved && !o.fold;
    let one_place = match (outer.along, inner.along) {
        (Some(s), Some(t)) => (s - t).abs() < shapes.slack(shapes.error),
        _ => false,
    };
    one_place
        && a.part != b.part
        && flat(a)
        && flat(b)
        && shapes.nested(outer.outline, inner.outline)
}

/// What it costs that a loop is one of a face of that kind; `None` if it cannot be.
fn unlike(shapes: &Shapes, outline: &Outline, kind: LinkKind) -> Option<f64> {
    let circle = shapes.parts[outline.part].is_circle && !outline.fold;
    if circle || outline.curved == (kind == LinkKind::Coaxial) {
        return Some(0.0);
    }
    outline.ring.then_some(UNLIKE)
}

/// Other parts around the axis that are drawn between two rings and lie between them.
fn skipped(shapes: &Shapes, rings: &[Ring], a: usize, b: usize) -> usize {
    let (outer, inner) = (rings[a], rings[b]);
    let ends = [outer, inner].map(|r| shapes.loops[r.outline].part);
    let area = |r: &Ring| shapes.loops[r.outline].area.abs();
    let mut parts: Vec<usize> = rings
        .iter()
        .filter(|r| {
            let part = shapes.loops[r.outline].part;
            let between = match (outer.along, inner.along, r.along) {
                (Some(s), Some(t), Some(x)) => {
                    let slack = shapes.slack(shapes.error);
                    x > s.min(t) - slack && x < s.max(t) + slack
                }
                _ => true,
            };
            between
                && !ends.contains(&part)
                && area(r) < area(&outer)
                && area(r) > area(&inner)
                && shapes.nested(outer.outline, r.outline)
                && shapes.nested(r.outline, inner.outline)
        })
        .map(|r| shapes.loops[r.outline].part)
        .collect();
    parts.sort_unstable();
    parts.dedup();
    parts.len()
}
