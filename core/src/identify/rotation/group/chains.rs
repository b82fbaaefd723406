//! Circles and silhouettes around one axis, matched all at once.
//!
//! What is turned on a lathe is a chain of faces from circle to circle: annuli, and surfaces of
//! revolution that need no silhouette in this view. Each loop of the chain bounds one face, which
//! has one or two of them, and placing parts one by one does not see that a circle whose two
//! sides are both left alone would be a disc without thickness. So the loops around an axis are
//! matched in pairs, or left alone, at the least total cost.

use std::rc::Rc;

use glam::DVec2;

use super::body::Place;
use super::joins::{Role, State};
use super::links::{Link, LinkKind};
use super::shapes::Shapes;
use crate::drawing::SurfaceKind;

/// Partial matchings that are followed.
const BEAM: usize = 64;

/// Matchings that are given.
const GIVEN: usize = 3;

/// Least cost by which a matching must be better than what is there, in log-odds.
const BETTER: f64 = 0.5;

/// Cost of a curved face between two circles that are not in one plane.
const ROUND: f64 = 0.6;

/// Cost of each loop around the axis that a face would pass by.
const SKIPPED: f64 = 1.5;

/// Cost of a face over the whole length of the chain.
const LONG: f64 = 1.0;

/// Cost of a circle or a silhouette of which neither side has a second loop.
const FLAT_BODY: f64 = 8.0;

/// A loop of a chain.
#[derive(Debug, Clone, Copy)]
struct Ring {
    outline: usize,
    /// Place along the drawn axis; unknown for silhouettes.
    along: Option<f64>,
    /// Depth that puts its part on the axis.
    shift: f64,
}

/// The loops around one axis.
pub(super) struct Chain {
    rings: Vec<Ring>,
    /// Pairs that may be one face: outer and inner ring, link, and cost.
    pairs: Vec<(usize, usize, usize, f64)>,
    /// Costs of leaving rings alone.
    alone: Vec<f64>,
    /// The other loop of a part that is one closed edge.
    mate: Vec<Option<usize>>,
}

/// A matching under construction.
#[derive(Debug, Clone)]
struct Partial {
    cost: f64,
    taken: Vec<bool>,
    alone: Vec<bool>,
    /// Parts whose sense is known.
    turned: Vec<(usize, bool)>,
    pairs: Option<Rc<Chosen>>,
}

/// A pair chosen, and those before.
#[derive(Debug)]
struct Chosen {
    pair: usize,
    before: Option<Rc<Chosen>>,
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
            |g: &&mut (usize, DVec2, Vec<usize>)| g.0 == line.axis && off(g.1) < 2e-3 * shapes.size;
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
            let off = rings[b].shift - rings[a].shift - link.offset;
            let (p, q) = (&shapes.loops[link.outer], &shapes.loops[link.inner]);
            let circles = shapes.parts[p.part].is_circle && shapes.parts[q.part].is_circle;
            // Either loop of a circle stands for the other.
            if p.part == q.part || off.abs() > 2.0 * shapes.tolerance || circles && link.same_sense
            {
                continue;
            }
            let bare = |o: &super::shapes::Outline| {
                shapes.parts[o.part].is_circle && !o.fold
                    || o.curved == (link.kind == LinkKind::Coaxial)
            };
            if !bare(p) || !bare(q) {
                continue;
            }
            let mut cost = match link.kind {
                LinkKind::Coplanar => 0.0,
                LinkKind::Coaxial => ROUND,
            };
            cost += SKIPPED * skipped(shapes, &rings, a, b) as f64;
            if let (Some(s), Some(t)) = (rings[a].along, rings[b].along) {
                cost += LONG * (s - t).abs() / length.max(f64::MIN_POSITIVE);
            }
            if p.curved && q.curved && p.kind != q.kind && !p.fold && !q.fold {
                cost += 1.0;
            }
            pairs.push((a, b, l, cost));
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
        Self {
            rings,
            pairs,
            alone,
            mate,
        }
    }

    /// States with this chain matched anew, the likeliest first, with their costs; none if what is
    /// there is as good.
    pub(super) fn matchings(
        &self,
        shapes: &Shapes,
        links: &[Link],
        state: &State,
    ) -> Vec<(State, f64)> {
        let own = |i: usize| self.rings.iter().position(|r| r.outline == i);
        // Loops that share a face with a loop elsewhere stay there.
        let mut fixed = vec![false; self.rings.len()];
        let mut now = 0.0;
        let mut together = vec![false; self.rings.len()];
        for (outer, inner) in state.inner.iter().enumerate() {
            for &i in inner {
                match (own(outer), own(i)) {
                    (Some(a), Some(b)) => {
                        let pair = |p: &&(usize, usize, usize, f64)| (p.0, p.1) == (a, b);
                        now += self.pairs.iter().find(pair).map_or(4.0, |p| p.3);
                        (together[a], together[b]) = (true, true);
                    }
                    (Some(r), None) | (None, Some(r)) => fixed[r] = true,
                    (None, None) => {}
                }
            }
        }
        for (r, fixed) in fixed.iter_mut().enumerate() {
            *fixed &= !together[r];
        }
        let single = |r: usize| !together[r] && !fixed[r];
        for r in (0..self.rings.len()).filter(|&r| single(r)) {
            now += self.alone[r];
            if self.mate[r].is_some_and(|m| m < r && single(m)) {
                now += FLAT_BODY;
            }
        }
        let found = self.search(shapes, links, &fixed);
        match found.first() {
            Some(best) if best.cost < now - BETTER => found
                .iter()
                .map(|m| (self.applied(shapes, links, state, &fixed, m), m.cost))
                .collect(),
            _ => Vec::new(),
        }
    }

    fn search(&self, shapes: &Shapes, links: &[Link], fixed: &[bool]) -> Vec<Partial> {
        let count = self.rings.len();
        let mut of: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (k, pair) in self.pairs.iter().enumerate() {
            // The larger one comes first.
            of[pair.0.min(pair.1)].push(k);
        }
        let mut beam = vec![Partial {
            cost: 0.0,
            taken: fixed.to_vec(),
            alone: vec![false; count],
            turned: Vec::new(),
            pairs: None,
        }];
        for (r, own) in of.iter().enumerate() {
            let mut next = Vec::with_capacity(beam.len() * 2);
            for partial in beam {
                if partial.taken[r] {
                    next.push(partial);
                    continue;
                }
                for &k in own {
                    let (a, b, l, cost) = self.pairs[k];
                    if partial.taken[a] || partial.taken[b] {
                        continue;
                    }
                    let link = &links[l];
                    let parts = [link.outer, link.inner].map(|i| shapes.loops[i].part);
                    let Some(turned) = partial.turns(shapes, parts, link.same_sense) else {
                        continue;
                    };
                    let mut other = partial.clone();
                    other.turned = turned;
                    other.cost += cost;
                    (other.taken[a], other.taken[b]) = (true, true);
                    other.pairs = Some(Rc::new(Chosen {
                        pair: k,
                        before: other.pairs.take(),
                    }));
                    next.push(other);
                }
                let mut lonely = partial;
                lonely.cost += self.alone[r];
                lonely.taken[r] = true;
                lonely.alone[r] = true;
                if self.mate[r].is_some_and(|m| lonely.alone[m]) {
                    lonely.cost += FLAT_BODY;
                }
                next.push(lonely);
            }
            next.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            next.truncate(BEAM);
            beam = next;
        }
        // The two loops of a circle are alike: matchings that differ in them only are one.
        let mut seen: Vec<Vec<[usize; 2]>> = Vec::new();
        beam.retain(|m| {
            let part = |r: usize| {
                let i = self.rings[r].outline;
                let p = shapes.loops[i].part;
                if shapes.parts[p].is_circle {
                    shapes.parts[p].loops[0]
                } else {
                    i
                }
            };
            let mut key: Vec<[usize; 2]> = m
                .chosen()
                .map(|k| [part(self.pairs[k].0), part(self.pairs[k].1)])
                .collect();
            key.sort_unstable();
            let new = seen.len() < GIVEN && !seen.contains(&key);
            if new {
                seen.push(key);
            }
            new
        });
        beam
    }

    fn applied(
        &self,
        shapes: &Shapes,
        links: &[Link],
        state: &State,
        fixed: &[bool],
        matching: &Partial,
    ) -> State {
        let mut state = state.clone();
        let own = |i: usize| self.rings.iter().position(|r| r.outline == i);
        for ring in &self.rings {
            let outer = ring.outline;
            let list = std::mem::take(&mut state.inner[outer]);
            let (inside, kept): (Vec<usize>, Vec<usize>) =
                list.into_iter().partition(|&i| own(i).is_some());
            for i in inside {
                state.hung[i] = false;
                if state.inner[i].is_empty() {
                    state.roles[i] = Role::Free;
                }
            }
            if kept.is_empty() && !state.hung[outer] {
                state.roles[outer] = Role::Free;
            }
            state.inner[outer] = kept;
        }
        for (r, ring) in self.rings.iter().enumerate() {
            // Unhung above in whatever order.
            if !fixed[r] && !state.hung[ring.outline] && state.inner[ring.outline].is_empty() {
                state.roles[ring.outline] = Role::Free;
            }
        }
        for k in matching.chosen() {
            state.apply(&links[self.pairs[k].2]);
        }
        // Whatever is placed says how the axis lies.
        let base = self.rings.iter().find_map(|r| {
            let part = shapes.loops[r.outline].part;
            state.placed[part].map(|place| (part, place.shift - r.shift, place.turned))
        });
        let flip = base.is_some_and(|(part, _, turned)| {
            let known = matching.turned.iter().find(|t| t.0 == part);
            known.is_some_and(|t| t.1 != turned)
        });
        for ring in &self.rings {
            let part = shapes.loops[ring.outline].part;
            let turned = matching.turned.iter().find(|t| t.0 == part).map(|t| t.1);
            match (&mut state.placed[part], turned) {
                (Some(place), Some(turned)) => place.turned = turned ^ flip,
                (slot @ None, Some(turned)) => {
                    *slot = Some(Place {
                        shift: ring.shift + base.map_or(0.0, |b| b.1),
                        turned: turned ^ flip,
                    });
                }
                _ => {}
            }
        }
        state
    }
}

impl Partial {
    /// The senses of parts when two have the same or not; `None` if that contradicts.
    fn turns(&self, shapes: &Shapes, parts: [usize; 2], same: bool) -> Option<Vec<(usize, bool)>> {
        let known = |p: usize| {
            let told = self.turned.iter().find(|t| t.0 == p).map(|t| t.1);
            told.or(shapes.parts[p].is_circle.then_some(false))
        };
        let (first, second) = match parts.map(known) {
            [Some(a), Some(b)] => (a ^ b == same).then_some((a, b))?,
            [Some(a), None] => (a, a ^ same),
            [None, Some(b)] => (b ^ same, b),
            [None, None] => (false, same),
        };
        let mut turned = self.turned.clone();
        for (part, sense) in parts.into_iter().zip([first, second]) {
            if !turned.iter().any(|t| t.0 == part) {
                turned.push((part, sense));
            }
        }
        Some(turned)
    }

    fn chosen(&self) -> impl Iterator<Item = usize> + '_ {
        let mut next = self.pairs.as_ref();
        std::iter::from_fn(move || {
            let here = next?;
            next = here.before.as_ref();
            Some(here.pair)
        })
    }
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
                    x > s.min(t) - shapes.tolerance && x < s.max(t) + shapes.tolerance
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
