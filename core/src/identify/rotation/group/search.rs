//! The likeliest joins of all parts, and ranked alternatives.
//!
//! Parts are placed one after the other, the surest first. Each step is a choice among the joins of
//! one part; alternatives change one choice or several, the likeliest combinations first, and place
//! the parts after it anew.

use std::collections::{BTreeSet, BinaryHeap};

use super::Grouping;
use super::body::Place;
use super::chains::{Chain, chains};
use super::joins::{Join, Joiner, Role, State};
use super::links::{Link, LinkKind};
use super::score::JoinScorer;
use super::shapes::Shapes;
use super::trials::{Run, Step, push_trials};
use crate::sets::Sets;

/// Joins of a part that are kept.
const JOINS: usize = 6;

/// Groupings that are given at most.
const GROUPINGS: usize = 5;

/// Score of a join that is not there yet, but may be when more is placed.
const UNSEEN: f64 = -3.0;

/// Cost of each piece of the solid that no face joins to the rest, in log-odds.
const LOOSE: f64 = 5.0;

/// Cost by which a matching of a chain must be better than what is there, in log-odds.
const BETTER: f64 = 0.5;

/// Matchings of a chain that are given beside the cheapest one.
const OTHERS: usize = 3;

/// Log-odds by which a part waits whose links lead to larger parts that are not placed yet.
const WAIT: f64 = 2.0;

pub(super) struct Search<'a> {
    joiner: Joiner<'a>,
    chains: Vec<Chain>,
    /// Links to other parts, of each part.
    own: Vec<Vec<usize>>,
}

impl<'a> Search<'a> {
    pub(super) fn new(shapes: &'a Shapes, links: &'a [Link], scorer: &'a dyn JoinScorer) -> Self {
        let mut own = vec![Vec::new(); shapes.parts.len()];
        for (l, link) in links.iter().enumerate() {
            let (a, b) = (shapes.loops[link.outer].part, shapes.loops[link.inner].part);
            if a != b {
                own[a].push(l);
                own[b].push(l);
            }
        }
        Self {
            chains: chains(shapes, links),
            joiner: Joiner::new(shapes, links, scorer),
            own,
        }
    }

    /// The groupings, best first.
    pub(super) fn run(&self) -> Vec<Grouping> {
        let mut runs = vec![self.place(self.start(), Vec::new(), Vec::new(), None)];
        let mut heap = BinaryHeap::new();
        push_trials(&mut heap, &runs, 0);
        let mut seen = BTreeSet::new();
        let mut found = Vec::new();
        let cost = self.keep(&runs[0], &mut seen, &mut found);
        if !self.chains.is_empty() {
            // What hangs on a part that only a chain places waits for all chains.
            let none = Run {
                steps: Vec::new(),
                states: vec![self.start()],
                log_likelihood: 0.0,
                from: 0,
            };
            let known = found.len();
            let behind = self.keep(&none, &mut seen, &mut found) - cost;
            found[known..].iter_mut().for_each(|g| g.score -= behind);
        }
        let tries = (3000 / self.joiner.shapes.loops.len().max(1)).clamp(3, 12);
        for _ in 0..tries {
            let Some(trial) = heap.pop() else { break };
            let parent = &runs[trial.run];
            let steps = parent.steps[..=trial.step].to_vec();
            let states = parent.states[..trial.step].to_vec();
            let state = parent.states[trial.step].clone();
            let run = self.place(state, steps, states, Some(trial.choice));
            self.keep(&run, &mut seen, &mut found);
            runs.push(run);
            push_trials(&mut heap, &runs, runs.len() - 1);
        }
        found.sort_by(|a, b| b.score.total_cmp(&a.score));
        found.truncate(GROUPINGS);
        let top = found[0].score;
        found.iter_mut().for_each(|g| g.score -= top);
        found
    }

    /// Keeps the groupings that a run leads to and that are new: the likeliest matching of its
    /// chains, and for each chain the next ones. Returns the cost of the likeliest ones.
    fn keep(
        &self,
        run: &Run,
        seen: &mut BTreeSet<Vec<Vec<usize>>>,
        found: &mut Vec<Grouping>,
    ) -> f64 {
        let mut whole = 0.0;
        let mut best = run.states[run.states.len() - 1].clone();
        let mut others: Vec<(State, f64)> = Vec::new();
        for chain in &self.chains {
            let ranked = self.matched(chain, &best);
            // What differs in an earlier chain keeps the likeliest matching of this one.
            for (state, _) in &mut others {
                *state = self.matched(chain, state).swap_remove(0).0;
            }
            let mut ranked = ranked.into_iter();
            let Some((first, cost)) = ranked.next() else {
                continue;
            };
            others.extend(ranked.map(|(state, other)| (state, other - cost)));
            best = first;
            whole += cost;
        }
        self.keep_one(run, &best, 0.0, seen, found);
        for (state, behind) in &others {
            self.keep_one(run, state, *behind, seen, found);
        }
        whole
    }

    /// A state with a chain as it is or matched anew, the likeliest first, never none; each with its
    /// cost, but for what [`Self::loose`] says of it.
    fn matched(&self, chain: &Chain, state: &State) -> Vec<(State, f64)> {
        let all = chain.matchings(self.joiner.shapes, self.joiner.links, state);
        let loose = |state: &State| LOOSE * self.loose(state) as f64;
        // What is there stays unless there is much better.
        let mut ranked = vec![(all.now + loose(state) - BETTER, all.now, state.clone())];
        let anew = all.ranked.into_iter();
        ranked.extend(anew.map(|(state, cost)| (cost + loose(&state), cost, state)));
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        ranked.truncate(1 + OTHERS);
        let costly = |(_, cost, state)| (state, cost);
        ranked.into_iter().map(costly).collect()
    }

    /// Pieces of the solid, but one, that no face joins to another.
    fn loose(&self, state: &State) -> usize {
        let shapes = self.joiner.shapes;
        let mut pieces = Sets::new(shapes.parts.len());
        let mut joined = 0;
        for (outer, inner) in state.inner.iter().enumerate() {
            for &i in inner {
                let [a, b] = [outer, i].map(|l| shapes.loops[l].part);
                joined += usize::from(pieces.join(a, b));
            }
        }
        shapes.parts.len().saturating_sub(joined + 1)
    }

    fn keep_one(
        &self,
        run: &Run,
        state: &State,
        behind: f64,
        seen: &mut BTreeSet<Vec<Vec<usize>>>,
        found: &mut Vec<Grouping>,
    ) {
        // What joins nothing but what the chains placed.
        let rest = self.place(state.clone(), Vec::new(), Vec::new(), None);
        let state = &rest.states[rest.states.len() - 1];
        let steps = run.steps.iter().chain(&rest.steps);
        let mut grouping = self.joiner.grouping(steps, state);
        grouping.score =
            run.log_likelihood + rest.log_likelihood - behind - LOOSE * self.loose(state) as f64;
        let mut key: Vec<Vec<usize>> = grouping
            .faces
            .iter()
            .map(|f| {
                let mut f: Vec<usize> = f.iter().map(|&i| self.alias(i)).collect();
                f.sort_unstable();
                f
            })
            .collect();
        key.sort_unstable();
        if seen.insert(key) {
            found.push(grouping);
        }
    }

    /// The first of the two loops of a circle, which are alike; else the loop itself.
    fn alias(&self, i: usize) -> usize {
        let part = &self.joiner.shapes.parts[self.joiner.shapes.loops[i].part];
        if part.is_circle { part.loops[0] } else { i }
    }

    /// The main part placed, and faces of several loops within one part.
    fn start(&self) -> State {
        let shapes = self.joiner.shapes;
        let mut state = State {
            placed: vec![None; shapes.parts.len()],
            roles: vec![Role::Free; shapes.loops.len()],
            inner: vec![Vec::new(); shapes.loops.len()],
            hung: vec![false; shapes.loops.len()],
        };
        let mut around: Vec<Option<usize>> = vec![None; shapes.loops.len()];
        for (l, link) in self.joiner.links.iter().enumerate() {
            let (a, b) = (&shapes.loops[link.outer], &shapes.loops[link.inner]);
            let apart = a.vertices.iter().all(|v| !b.vertices.contains(v));
            if a.part == b.part
                && link.kind == LinkKind::Coplanar
                && !link.same_sense
                && apart
                && link.offset.abs() < 2.0 * shapes.slack(link.error)
            {
                let area = |l: usize| shapes.loops[self.joiner.links[l].outer].area.abs();
                let best = &mut around[link.inner];
                if best.is_none_or(|k| area(l) < area(k)) {
                    *best = Some(l);
                }
            }
        }
        let mut own: Vec<usize> = around.into_iter().flatten().collect();
        let size = |l: usize| shapes.loops[self.joiner.links[l].inner].area.abs();
        own.sort_by(|&a, &b| size(b).total_cmp(&size(a)));
        for link in own.into_iter().map(|l| &self.joiner.links[l]) {
            if state.allows(link, shapes) {
                state.apply(link);
            }
        }
        if !shapes.parts.is_empty() {
            let main = self.joiner.main;
            state.placed[main] = Some(Place {
                shift: 0.0,
                turned: shapes.volume(main) < 0.0,
            });
        }
        state
    }

    /// Places all parts that are not, the last of the given steps by another choice.
    fn place(
        &self,
        mut state: State,
        mut steps: Vec<Step>,
        mut states: Vec<State>,
        choice: Option<usize>,
    ) -> Run {
        let from = steps.len();
        if let (Some(choice), Some(step)) = (choice, steps.last_mut()) {
            step.chosen = choice;
            states.push(state.clone());
            self.take(&mut state, step);
        }
        let extent = |p: usize| {
            let part = &self.joiner.shapes.parts[p];
            (part.high - part.low).length()
        };
        // Joins of each part, with the number of steps before them.
        let mut cache: Vec<Option<(usize, Vec<Join>)>> = vec![None; self.own.len()];
        loop {
            let mut best: Option<(f64, usize)> = None;
            for (part, cached) in cache.iter_mut().enumerate() {
                if state.placed[part].is_some() {
                    continue;
                }
                let (_, joins) = cached.get_or_insert_with(|| {
                    let joins = self.joiner.joins(part, &self.own[part], &state);
                    (steps.len(), joins)
                });
                let Some(first) = joins.first() else { continue };
                let second = joins.get(1).map_or(f64::NEG_INFINITY, |j| j.score);
                let mut lead = first.score - second.max(UNSEEN);
                let waits = self.own[part].iter().any(|&l| {
                    let link = &self.joiner.links[l];
                    let p = self.joiner.shapes.loops[link.outer].part;
                    p != part && state.placed[p].is_none() && extent(p) > extent(part)
                });
                if waits {
                    lead -= WAIT;
                }
                if best.is_none_or(|b| lead > b.0) {
                    best = Some((lead, part));
                }
            }
            let Some((_, part)) = best else { break };
            let mut joins = match cache[part].take() {
                Some((made, joins)) if made == steps.len() => joins,
                _ => self.joiner.joins(part, &self.own[part], &state),
            };
            joins.truncate(JOINS);
            if joins.is_empty() {
                break;
            }
            let step = Step {
                part,
                joins,
                chosen: 0,
            };
            states.push(state.clone());
            self.take(&mut state, &step);
            steps.push(step);
            for &l in &self.own[part] {
                let link = &self.joiner.links[l];
                for i in [link.outer, link.inner] {
                    cache[self.joiner.shapes.loops[i].part] = None;
                }
            }
        }
        states.push(state);
        Run {
            log_likelihood: steps.iter().map(|s| s.log_share(s.chosen)).sum(),
            steps,
            states,
            from,
        }
    }

    fn take(&self, state: &mut State, step: &Step) {
        let join = &step.joins[step.chosen];
        state.placed[step.part] = Some(join.place);
        for &l in &join.links {
            state.apply(&self.joiner.links[l]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::round::{Round, drawn, lifted};
    use super::super::score::HandJoinScorer;
    use super::*;

    #[test]
    fn parts_that_a_state_leaves_open_are_placed() {
        let cylinder = |x: f64, radius: f64| Round::cylinder([x, 0.5], radius, 0.0, 0.5);
        let (drawing, loops) = drawn(&[cylinder(0.0, 2.0), cylinder(1.0, 0.3)]);
        lifted(&drawing, &loops, |shapes, links| {
            let search = Search::new(shapes, links, &HandJoinScorer);
            let none = Run {
                steps: Vec::new(),
                states: vec![search.start()],
                log_likelihood: 0.0,
                from: 0,
            };
            let mut found = Vec::new();
            search.keep_one(
                &none,
                &none.states[0],
                0.0,
                &mut BTreeSet::new(),
                &mut found,
            );
            let mut joined = found[0].faces.clone();
            joined.retain(|f| f.len() > 1);
            // Bottoms and tops.
            assert_eq!(joined, [[0, 4], [1, 5]]);
            assert!(found[0].score > -LOOSE);
        });
    }
}
