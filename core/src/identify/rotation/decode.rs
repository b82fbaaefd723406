//! From scores of triples to the rotation system of greatest total score.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::cuts::Cuts;
use super::orders::{Best, Gains, cyclic_orders, is_exact};
use super::{RotationSystem, Triples};
use crate::drawing::{CoEdge, Graph};

/// Sweeps of conditional modes; each strictly gains, a few are enough in practice.
const SWEEPS: usize = 50;

/// Smallest gain that counts, in log-odds: less is rounding.
const GAIN: f64 = 1e-9;

/// A drawing's triples with their scores: the field that decoding maximises.
///
/// The total score of a rotation system is the sum of the log-odds of the two triples that it
/// chooses at every edge.
#[derive(Debug, Clone, Copy)]
pub struct Field<'a> {
    graph: &'a Graph,
    triples: &'a Triples,
    scores: &'a [f64],
}

impl<'a> Field<'a> {
    /// Joins triples and their scores; scores that are no number count as 0.
    pub fn new(graph: &'a Graph, triples: &'a Triples, scores: &'a [f64]) -> Self {
        Self {
            graph,
            triples,
            scores,
        }
    }

    /// The graph.
    pub fn graph(&self) -> &'a Graph {
        self.graph
    }

    /// The triples.
    pub fn triples(&self) -> &'a Triples {
        self.triples
    }

    /// Score of the triple at `through` with the positions before and after.
    fn score(&self, through: CoEdge, before: usize, after: usize) -> f64 {
        let t = self.triples.index(self.graph, through, before, after);
        let s = self.scores.get(t).copied().unwrap_or(0.0);
        if s.is_nan() { 0.0 } else { s }
    }

    /// Score that a system gives an edge: its two triples.
    pub fn edge_score(&self, system: &RotationSystem, edge: usize) -> f64 {
        let (out, back) = (CoEdge::new(edge, false), CoEdge::new(edge, true));
        let at = |c| self.graph.position(c);
        self.score(out, at(system.previous(out)), at(system.next(back)))
            + self.score(out, at(system.next(out)), at(system.previous(back)))
    }

    /// What the edge would score if the order at one of its ends were reversed.
    fn reversed_score(&self, system: &RotationSystem, edge: usize) -> f64 {
        let (out, back) = (CoEdge::new(edge, false), CoEdge::new(edge, true));
        let at = |c| self.graph.position(c);
        self.score(out, at(system.previous(out)), at(system.previous(back)))
            + self.score(out, at(system.next(out)), at(system.next(back)))
    }

    /// Total score of a system.
    pub fn total(&self, system: &RotationSystem) -> f64 {
        (0..self.graph.edge_count())
            .map(|e| self.edge_score(system, e))
            .sum()
    }

    /// Gains of the orders at a vertex, the orders at the vertices that `fixed` accepts being
    /// those of `system`, and edges to other vertices left out.
    fn gains(&self, system: &RotationSystem, vertex: usize, fixed: &[bool]) -> Gains {
        let graph = self.graph;
        let leaving = graph.leaving(vertex);
        let degree = leaving.len();
        let mut gains = Gains::new(degree);
        for (i, &c) in leaving.iter().enumerate() {
            let mate = c.mate();
            let head = graph.head(c);
            if head == vertex {
                let k = graph.position(mate);
                if i < k {
                    gains.add_closed(i, k, self.closed_table(c, degree));
                }
            } else if fixed[head] {
                let next = graph.position(system.next(mate));
                let previous = graph.position(system.previous(mate));
                for j in (0..degree).filter(|&j| j != i) {
                    gains.add(j, i, self.score(c, j, next));
                    gains.add(i, j, self.score(c, j, previous));
                }
            }
        }
        gains
    }

    fn closed_table(&self, c: CoEdge, degree: usize) -> Vec<f64> {
        let own = (self.graph.position(c), self.graph.position(c.mate()));
        let mut table = vec![0.0; degree * degree];
        for before in (0..degree).filter(|&k| k != own.0) {
            for after in (0..degree).filter(|&k| k != own.1) {
                table[before * degree + after] = self.score(c, before, after);
            }
        }
        table
    }

    /// The best order at a vertex given all others.
    pub(super) fn best_order(
        &self,
        system: &RotationSystem,
        vertex: usize,
        fixed: &[bool],
    ) -> Best {
        let current = system.order(self.graph, vertex);
        self.gains(system, vertex, fixed).best(Some(&current))
    }

    /// Lead of the order at a vertex over the best other one, all other vertices as they are,
    /// log-odds; negative if another one is better.
    pub(super) fn margin(&self, system: &RotationSystem, vertex: usize, fixed: &[bool]) -> f64 {
        let current = system.order(self.graph, vertex);
        let gains = self.gains(system, vertex, fixed);
        let best = gains.best(Some(&current));
        let behind = best.gain - gains.of(&current);
        if behind > GAIN { -behind } else { best.margin }
    }

    /// The rotation system: grown vertex by vertex, the surest next, then improved by conditional
    /// modes and by reversing parts of a component.
    ///
    /// Components do not influence each other. Reversing all orders of a component changes no
    /// score; which of the two comes out is left open.
    pub fn decode(&self) -> RotationSystem {
        let mut system = self.grow();
        self.improve(&mut system);
        system
    }

    fn grow(&self) -> RotationSystem {
        let graph = self.graph;
        let n = graph.vertex_count();
        let mut system = RotationSystem::new(graph);
        let mut fixed = vec![false; n];
        let mut starts: Vec<(f64, usize, Vec<usize>)> = (0..n)
            .filter(|&v| graph.degree(v) > 0)
            .map(|v| {
                let (sureness, order) = self.start(v);
                (sureness, v, order)
            })
            .collect();
        starts.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut heap = BinaryHeap::new();
        for (_, start, order) in starts {
            if fixed[start] {
                continue;
            }
            system.set(graph, start, &order);
            fixed[start] = true;
            self.push_neighbours(&system, start, &fixed, &mut heap);
            // Entries are stale if the vertex is fixed or was pushed again with more neighbours
            // known; the order is then computed anew anyway.
            while let Some(Next { vertex, .. }) = heap.pop() {
                if fixed[vertex] {
                    continue;
                }
                let best = self.best_order(&system, vertex, &fixed);
                system.set(graph, vertex, &best.order);
                fixed[vertex] = true;
                self.push_neighbours(&system, vertex, &fixed, &mut heap);
            }
        }
        system
    }

    fn push_neighbours(
        &self,
        system: &RotationSystem,
        vertex: usize,
        fixed: &[bool],
        heap: &mut BinaryHeap<Next>,
    ) {
        for c in self.graph.leaving(vertex) {
            let head = self.graph.head(*c);
            if !fixed[head] {
                let margin = self.best_order(system, head, fixed).margin;
                heap.push(Next {
                    margin,
                    vertex: head,
                });
            }
        }
    }

    /// How sure a vertex is as the first of its component, and its best order if every
    /// neighbour agrees.
    ///
    /// At degree 3 the first order is as good as its reverse; what counts is how clear the
    /// surest edge is. At higher degrees the order itself must be clear too.
    fn start(&self, vertex: usize) -> (f64, Vec<usize>) {
        let degree = self.graph.degree(vertex);
        if !is_exact(degree) {
            return (f64::NEG_INFINITY, (0..degree).collect());
        }
        let mut best: Option<(f64, f64, &Vec<usize>)> = None;
        let mut second = f64::NEG_INFINITY;
        for order in cyclic_orders(degree) {
            // An order and its reverse score the same: one of them is enough.
            if degree > 2 && order[1] > order[degree - 1] {
                continue;
            }
            let (total, clear) = self.optimistic(vertex, order);
            match best {
                Some((b, ..)) if total <= b => second = second.max(total),
                _ => {
                    second = best.map_or(second, |b| b.0);
                    best = Some((total, clear, order));
                }
            }
        }
        match best {
            Some((total, clear, order)) => (clear.min(total - second), order.clone()),
            None => (f64::NEG_INFINITY, (0..degree).collect()),
        }
    }

    /// Sum over a vertex's edges of the best score that any order at the other end allows, and
    /// the largest lead of such a best over its second.
    fn optimistic(&self, vertex: usize, order: &[usize]) -> (f64, f64) {
        let graph = self.graph;
        let degree = order.len();
        let (mut total, mut clear) = (0.0, 0.0f64);
        for (k, &i) in order.iter().enumerate() {
            let c = graph.leaving(vertex)[i];
            let head = graph.head(c);
            if head == vertex {
                continue;
            }
            let (before, after) = (order[(k + degree - 1) % degree], order[(k + 1) % degree]);
            let own = graph.position(c.mate());
            let far = graph.degree(head);
            let (mut best, mut second) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
            for next in (0..far).filter(|&x| x != own) {
                for previous in (0..far).filter(|&x| x != own && (x != next || far == 2)) {
                    let s = self.score(c, before, next) + self.score(c, after, previous);
                    if s > best {
                        (second, best) = (best, s);
                    } else {
                        second = second.max(s);
                    }
                }
            }
            if best.is_finite() {
                total += best;
            }
            if second.is_finite() {
                clear = clear.max(best - second);
            }
        }
        (total, clear)
    }

    /// Improves a system until neither a new order at a vertex nor the reversal of a part gains.
    pub fn improve(&self, system: &mut RotationSystem) {
        for _ in 0..SWEEPS {
            self.conditional_modes(system);
            if !self.reverse_parts(system) {
                break;
            }
        }
    }

    /// Iterated conditional modes (Besag 1986): the best order at each vertex given the others.
    fn conditional_modes(&self, system: &mut RotationSystem) {
        let fixed = vec![true; self.graph.vertex_count()];
        for _ in 0..SWEEPS {
            let mut changed = false;
            for v in (0..fixed.len()).filter(|&v| self.graph.degree(v) > 2) {
                let current = system.order(self.graph, v);
                let gains = self.gains(system, v, &fixed);
                let best = gains.best(Some(&current));
                if best.gain > gains.of(&current) + GAIN {
                    system.set(self.graph, v, &best.order);
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
    }

    /// Reverses the part of a component on one side of a cut if that gains; says whether any did.
    fn reverse_parts(&self, system: &mut RotationSystem) -> bool {
        let cuts = Cuts::new(self, system);
        let Some((vertex, cost)) = cuts.cheapest() else {
            return false;
        };
        if cost < -GAIN {
            for &v in cuts.part(vertex) {
                system.reverse(self.graph, v);
            }
            return true;
        }
        false
    }

    /// What the total score would lose if the order at one end of an edge were reversed: how
    /// stiffly the edge holds its two ends together.
    pub fn stiffness(&self, system: &RotationSystem, edge: usize) -> f64 {
        self.edge_score(system, edge) - self.reversed_score(system, edge)
    }
}

struct Next {
    margin: f64,
    vertex: usize,
}

impl PartialEq for Next {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Next {}

impl PartialOrd for Next {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Next {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_margin = self.margin.total_cmp(&other.margin);
        by_margin.then(other.vertex.cmp(&self.vertex))
    }
}
