//! The cheapest ways to match the loops of a chain.

use std::rc::Rc;

use super::super::body::Place;
use super::super::joins::{Role, State};
use super::super::links::{Link, LinkKind};
use super::super::shapes::Shapes;
use super::{Chain, Pair};

/// Partial matchings that are followed.
const BEAM: usize = 64;

/// Matchings that are given.
const GIVEN: usize = 6;

/// Cost of a circle or a silhouette of which neither side has a second loop.
const FLAT_BODY: f64 = 8.0;

/// Cost of two discs in one plane, one inside the other: the solid would touch itself.
const OVERLAP: f64 = 8.0;

/// Cost of a pair that is no pair of the chain's, where it is found.
const STRANGE: f64 = 4.0;

/// Pairs up to which partial matchings are compared by what they lead to.
const LOOK_AHEAD: usize = 400;

/// How a ring is used by faces of loops outside of the chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Use {
    /// Not at all.
    Free,
    /// Loops are inside it in its plane; others of the chain may be, too.
    Plane,
    /// It can be in no other face.
    Taken,
}

/// A matching under construction.
#[derive(Debug, Clone)]
pub(super) struct Partial {
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

/// What a chain may be matched to.
pub(in super::super) struct Matchings {
    /// Cost of what is there, log-odds.
    pub(in super::super) now: f64,
    /// States with the chain matched anew and their costs, the cheapest first.
    pub(in super::super) ranked: Vec<(State, f64)>,
}

impl Chain {
    /// The matchings of this chain in a state.
    pub(in super::super) fn matchings(
        &self,
        shapes: &Shapes,
        links: &[Link],
        state: &State,
    ) -> Matchings {
        let own = |i: usize| self.rings.iter().position(|r| r.outline == i);
        let mut used = vec![Use::Free; self.rings.len()];
        let mut now = 0.0;
        let mut together = vec![false; self.rings.len()];
        let beside = self.beside(shapes, state);
        for (outer, inner) in state.inner.iter().enumerate() {
            for &i in inner {
                match (own(outer), own(i)) {
                    (Some(a), Some(b)) if beside.contains(&[a, b]) => {
                        used[a] = used[a].max(Use::Plane);
                        used[b] = Use::Taken;
                    }
                    (Some(a), Some(b)) => {
                        let pair = |p: &&Pair| (p.outer, p.inner) == (a, b);
                        now += self.pairs.iter().find(pair).map_or(STRANGE, |p| p.cost);
                        (together[a], together[b]) = (true, true);
                    }
                    (Some(r), None) if state.roles[outer] == Role::Flat && !state.hung[outer] => {
                        used[r] = used[r].max(Use::Plane);
                    }
                    (Some(r), None) | (None, Some(r)) => used[r] = Use::Taken,
                    (None, None) => {}
                }
            }
        }
        let single = |r: usize| !together[r] && used[r] == Use::Free;
        for r in (0..self.rings.len()).filter(|&r| single(r)) {
            now += self.alone[r];
            if self.mate[r].is_some_and(|m| m < r && single(m)) {
                now += FLAT_BODY;
            }
            now += OVERLAP * self.around[r].iter().filter(|&&s| single(s)).count() as f64;
        }
        let known = self.found.borrow().get(&used).cloned();
        let found = known.unwrap_or_else(|| {
            let found: Rc<[Partial]> = self.search(shapes, links, &used).into();
            self.found.borrow_mut().insert(used.clone(), found.clone());
            found
        });
        let ranked = found
            .iter()
            .map(|m| (self.applied(shapes, links, state, &used, m), m.cost))
            .collect();
        Matchings { now, ranked }
    }

    /// The cheapest matchings with what rings are used for outside.
    fn search(&self, shapes: &Shapes, links: &[Link], used: &[Use]) -> Vec<Partial> {
        let count = self.rings.len();
        let mut of: Vec<Vec<usize>> = vec![Vec::new(); count];
        let free = |p: &Pair| {
            used[p.inner] == Use::Free
                && match used[p.outer] {
                    Use::Free => true,
                    Use::Plane => p.kind == LinkKind::Coplanar,
                    Use::Taken => false,
                }
        };
        for (k, pair) in self.pairs.iter().enumerate().filter(|(_, p)| free(p)) {
            // The larger one comes first.
            of[pair.outer.min(pair.inner)].push(k);
        }
        let open: Vec<Pair> = of.iter().flatten().map(|&k| self.pairs[k]).collect();
        let mut beam = vec![Partial {
            cost: 0.0,
            taken: used.iter().map(|u| *u == Use::Taken).collect(),
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
                    let Pair {
                        outer, inner, link, ..
                    } = self.pairs[k];
                    if partial.taken[outer] || partial.taken[inner] {
                        continue;
                    }
                    let link = &links[link];
                    let parts = [link.outer, link.inner].map(|i| shapes.loops[i].part);
                    let Some(turned) = partial.turns(shapes, parts, link.same_sense) else {
                        continue;
                    };
                    let mut other = partial.clone();
                    other.turned = turned;
                    other.cost += self.pairs[k].cost;
                    (other.taken[outer], other.taken[inner]) = (true, true);
                    other.pairs = Some(Rc::new(Chosen {
                        pair: k,
                        before: other.pairs.take(),
                    }));
                    next.push(other);
                }
                let mut lonely = partial;
                lonely.taken[r] = true;
                if used[r] == Use::Free {
                    lonely.cost += self.alone[r];
                    lonely.alone[r] = true;
                    if self.mate[r].is_some_and(|m| lonely.alone[m]) {
                        lonely.cost += FLAT_BODY;
                    }
                    let around = self.around[r].iter().filter(|&&s| lonely.alone[s]);
                    lonely.cost += OVERLAP * around.count() as f64;
                }
                next.push(lonely);
            }
            if next.len() > BEAM && open.len() <= LOOK_AHEAD {
                let mut ranked: Vec<(f64, Partial)> = next
                    .into_iter()
                    .map(|p| (p.cost + self.rest(&open, used, &p), p))
                    .collect();
                ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
                next = ranked.into_iter().map(|(_, p)| p).collect();
            } else {
                next.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            }
            next.truncate(BEAM);
            beam = next;
        }
        beam.sort_by(|a, b| a.cost.total_cmp(&b.cost));
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
                .map(|k| [part(self.pairs[k].outer), part(self.pairs[k].inner)])
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

    /// What the rings that are open will cost at least: each alone, or half of its cheapest pair.
    fn rest(&self, open: &[Pair], used: &[Use], partial: &Partial) -> f64 {
        let least = |r: usize| match (partial.taken[r], used[r]) {
            (false, Use::Free) => self.alone[r],
            _ => 0.0,
        };
        let mut least: Vec<f64> = (0..self.rings.len()).map(least).collect();
        for p in open {
            if !partial.taken[p.outer] && !partial.taken[p.inner] {
                least[p.outer] = least[p.outer].min(p.cost / 2.0);
                least[p.inner] = least[p.inner].min(p.cost / 2.0);
            }
        }
        least.into_iter().sum()
    }

    fn applied(
        &self,
        shapes: &Shapes,
        links: &[Link],
        state: &State,
        used: &[Use],
        matching: &Partial,
    ) -> State {
        let mut state = state.clone();
        let own = |i: usize| self.rings.iter().position(|r| r.outline == i);
        for ring in &self.rings {
            let outer = ring.outline;
            let list = std::mem::take(&mut state.inner[outer]);
            // But not what is beside the axis.
            let (inside, kept): (Vec<usize>, Vec<usize>) = list
                .into_iter()
                .partition(|&i| own(i).is_some_and(|r| used[r] != Use::Taken));
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
            let free = used[r] == Use::Free;
            if free && !state.hung[ring.outline] && state.inner[ring.outline].is_empty() {
                state.roles[ring.outline] = Role::Free;
            }
        }
        for k in matching.chosen() {
            state.apply(&links[self.pairs[k].link]);
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
