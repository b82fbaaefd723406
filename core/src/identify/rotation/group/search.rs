//! The likeliest joins of all parts, and ranked alternatives.
//!
//! Parts are placed one after the other, the surest first. Each step is a choice among the joins of
//! one part; alternatives change one choice or several, the likeliest combinations first, and place
//! the parts after it anew.

use std::cmp::Ordering;
use std::collections::{BTreeSet, BinaryHeap};

use super::Grouping;
use super::body::Place;
use super::chains::{Chain, chains};
use super::joins::{Join, Joiner, Role, State};
use super::links::{Link, LinkKind};
use super::score::JoinScorer;
use super::shapes::Shapes;

/// Joins of a part that are kept.
const JOINS: usize = 6;

/// Groupings that are given at most.
const GROUPINGS: usize = 5;

/// Score of a join that is not there yet, but may be when more is placed.
const UNSEEN: f64 = -3.0;

/// Log-odds by which a part waits whose links lead to larger parts that are not placed yet.
const WAIT: f64 = 2.0;

pub(super) struct Search<'a> {
    joiner: Joiner<'a>,
    chains: Vec<Chain>,
    /// Links to other parts, of each part.
    own: Vec<Vec<usize>>,
}

/// A choice among the joins of a part.
#[derive(Debug, Clone)]
struct Step {
    part: usize,
    joins: Vec<Join>,
    chosen: usize,
}

/// All choices, and the state before each and at the end.
struct Run {
    steps: Vec<Step>,
    states: Vec<State>,
    log_likelihood: f64,
    /// First step that is not its parent's.
    from: usize,
}

/// A run to be tried.
struct Trial {
    estimate: f64,
    run: usize,
    step: usize,
    choice: usize,
}

impl PartialEq for Trial {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Trial {}

impl PartialOrd for Trial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Trial {
    fn cmp(&self, other: &Self) -> Ordering {
        let by = |t: &Self| (t.run, t.step, t.choice);
        self.estimate
            .total_cmp(&other.estimate)
            .then_with(|| by(other).cmp(&by(self)))
    }
}

impl Step {
    /// Probability of each join.
    fn shares(&self) -> Vec<f64> {
        let top = self.joins.first().map_or(0.0, |j| j.score);
        let all: Vec<f64> = self.joins.iter().map(|j| (j.score - top).exp()).collect();
        let sum: f64 = all.iter().sum();
        all.into_iter().map(|x| x / sum).collect()
    }

    fn log_share(&self, choice: usize) -> f64 {
        self.shares()[choice].ln()
    }
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
            joiner: Joiner {
                shapes,
                links,
                scorer,
                main: shapes.main_part().unwrap_or(0),
            },
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
        self.keep(&runs[0], &mut seen, &mut found);
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
    /// chains, and for each chain the next ones.
    fn keep(&self, run: &Run, seen: &mut BTreeSet<Vec<Vec<usize>>>, found: &mut Vec<Grouping>) {
        let mut best = run.states[run.states.len() - 1].clone();
        let mut others: Vec<(State, f64)> = Vec::new();
        for chain in &self.chains {
            let mut ranked = chain.matchings(self.joiner.shapes, self.joiner.links, &best);
            if ranked.is_empty() {
                continue;
            }
            let first = ranked.remove(0);
            // What differs in an earlier chain keeps the likeliest matching of this one.
            for (state, _) in &mut others {
                let own = chain.matchings(self.joiner.shapes, self.joiner.links, state);
                if let Some((matched, _)) = own.into_iter().next() {
                    *state = matched;
                }
            }
            let behind = |(state, cost): (State, f64)| (state, cost - first.1);
            others.extend(ranked.into_iter().map(behind));
            best = first.0;
        }
        self.keep_one(run, &best, 0.0, seen, found);
        for (state, behind) in &others {
            self.keep_one(run, state, *behind, seen, found);
        }
    }

    fn keep_one(
        &self,
        run: &Run,
        state: &State,
        behind: f64,
        seen: &mut BTreeSet<Vec<Vec<usize>>>,
        found: &mut Vec<Grouping>,
    ) {
        let mut grouping = self.grouping(run, state);
        grouping.score -= behind;
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
                && link.offset.abs() < 2.0 * shapes.tolerance
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
        let mut cache: Vec<Option<Vec<Join>>> = vec![None; self.own.len()];
        loop {
            let mut best: Option<(f64, usize)> = None;
            for (part, cached) in cache.iter_mut().enumerate() {
                if state.placed[part].is_some() {
                    continue;
                }
                let joins =
                    cached.get_or_insert_with(|| self.joiner.joins(part, &self.own[part], &state));
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
            let mut joins = self.joiner.joins(part, &self.own[part], &state);
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

    fn grouping(&self, run: &Run, state: &State) -> Grouping {
        let shapes = self.joiner.shapes;
        let count = shapes.loops.len();
        let mut owner: Vec<usize> = (0..count).collect();
        for (outer, inner) in state.inner.iter().enumerate() {
            for &i in inner {
                let (from, to) = (owner[i], owner[outer]);
                owner
                    .iter_mut()
                    .filter(|o| **o == from)
                    .for_each(|o| *o = to);
            }
        }
        let mut sure = vec![1.0; count];
        for step in &run.steps {
            let shares = step.shares();
            let at = |j: &Join, i: usize| -> Vec<usize> {
                let touches = |l: &&usize| {
                    let link = &self.joiner.links[**l];
                    link.outer == i || link.inner == i
                };
                j.links.iter().filter(touches).copied().collect()
            };
            let ends = step.joins.iter().flat_map(|j| &j.links).flat_map(|&l| {
                let link = &self.joiner.links[l];
                [link.outer, link.inner]
            });
            let ends: BTreeSet<usize> = ends.collect();
            for i in ends {
                let own = at(&step.joins[step.chosen], i);
                let same = step.joins.iter().zip(&shares);
                let share: f64 = same.filter(|(j, _)| at(j, i) == own).map(|(_, s)| s).sum();
                sure[i] *= share;
            }
        }
        let mut faces: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (i, &o) in owner.iter().enumerate() {
            faces[o].push(i);
        }
        faces.retain(|f| !f.is_empty());
        for face in &mut faces {
            let size = |i: &usize| shapes.loops[*i].area.abs();
            face.sort_by(|a, b| size(b).total_cmp(&size(a)).then(a.cmp(b)));
        }
        let turned: Vec<bool> = (0..shapes.parts.len())
            .map(|p| state.placed[p].map_or_else(|| shapes.volume(p) < 0.0, |place| place.turned))
            .collect();
        Grouping {
            sureness: faces
                .iter()
                .map(|f| f.iter().map(|&i| sure[i]).fold(1.0, f64::min))
                .collect(),
            round: faces
                .iter()
                .map(|f| f.len() > 1 && state.roles[f[0]] == Role::Round)
                .collect(),
            faces,
            reversed: shapes.loops.iter().map(|l| turned[l.part]).collect(),
            score: run.log_likelihood,
        }
    }
}

/// Every other choice of a run's own steps.
fn push_trials(heap: &mut BinaryHeap<Trial>, runs: &[Run], run: usize) {
    let whole = &runs[run];
    for (k, step) in whole.steps.iter().enumerate().skip(whole.from) {
        for choice in 1..step.joins.len() {
            heap.push(Trial {
                estimate: whole.log_likelihood - step.log_share(step.chosen)
                    + step.log_share(choice),
                run,
                step: k,
                choice,
            });
        }
    }
}
