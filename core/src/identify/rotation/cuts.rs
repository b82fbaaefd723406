//! Parts of a component that could be turned over as a whole, and what that costs.

use super::RotationSystem;
use super::decode::Field;
use crate::drawing::{CoEdge, Graph};
use crate::sets::Sets;

/// The parts that a maximum spanning forest falls into when one of its edges is cut.
///
/// Reversing the orders at all vertices of a part changes the score of the edges that leave the
/// part and of no others. Edges that hold their ends together stiffly are in the forest, so the
/// cheap parts to reverse are among these.
#[derive(Debug)]
pub(super) struct Cuts {
    /// Vertices so that each part is a contiguous piece.
    order: Vec<usize>,
    /// Piece of `order` below each vertex, the vertex itself first.
    piece: Vec<(usize, usize)>,
    parent: Vec<Option<usize>>,
    depth: Vec<usize>,
    cost: Vec<f64>,
}

impl Cuts {
    /// Finds the parts and prices them. Time `O(E (log E + depth of the forest))`.
    pub(super) fn new(field: &Field<'_>, system: &RotationSystem) -> Self {
        let graph = field.graph();
        let stiffness: Vec<f64> = (0..graph.edge_count())
            .map(|e| field.stiffness(system, e))
            .collect();
        let mut cuts = Self::forest(graph, &stiffness);
        cuts.price(graph, &stiffness);
        cuts
    }

    /// The vertex whose part is cheapest to reverse, and the cost in log-odds; `None` if no
    /// component has two vertices.
    pub(super) fn cheapest(&self) -> Option<(usize, f64)> {
        self.all().min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Every part by its first vertex, with its cost in log-odds.
    pub(super) fn all(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        (0..self.parent.len())
            .filter(|&v| self.parent[v].is_some())
            .map(|v| (v, self.cost[v]))
    }

    /// Vertices of the part below a vertex.
    pub(super) fn part(&self, vertex: usize) -> &[usize] {
        let (begin, end) = self.piece[vertex];
        &self.order[begin..end]
    }

    /// Cost of the cheapest part that separates the two ends of an edge, in log-odds; infinite if
    /// none does.
    pub(super) fn between(&self, u: usize, v: usize) -> f64 {
        let mut cheapest = f64::INFINITY;
        self.climb(u, v, |x| cheapest = cheapest.min(self.cost[x]));
        cheapest
    }

    fn forest(graph: &Graph, stiffness: &[f64]) -> Self {
        let n = graph.vertex_count();
        let mut edges: Vec<usize> = (0..stiffness.len()).collect();
        edges.sort_by(|&a, &b| stiffness[b].total_cmp(&stiffness[a]).then(a.cmp(&b)));
        let mut sets = Sets::new(n);
        let mut links: Vec<Vec<usize>> = vec![Vec::new(); n];
        for e in edges {
            let c = CoEdge::new(e, false);
            let (u, v) = (graph.origin(c), graph.head(c));
            if sets.join(u, v) {
                links[u].push(v);
                links[v].push(u);
            }
        }
        let mut cuts = Self {
            order: Vec::with_capacity(n),
            piece: vec![(0, 0); n],
            parent: vec![None; n],
            depth: vec![0; n],
            cost: vec![0.0; n],
        };
        let mut seen = vec![false; n];
        for root in 0..n {
            if seen[root] {
                continue;
            }
            seen[root] = true;
            let mut stack = vec![root];
            while let Some(v) = stack.pop() {
                cuts.piece[v] = (cuts.order.len(), cuts.order.len() + 1);
                cuts.order.push(v);
                for &w in &links[v] {
                    if !seen[w] {
                        seen[w] = true;
                        cuts.parent[w] = Some(v);
                        cuts.depth[w] = cuts.depth[v] + 1;
                        stack.push(w);
                    }
                }
            }
        }
        for &v in cuts.order.iter().rev() {
            if let Some(p) = cuts.parent[v] {
                cuts.piece[p].1 = cuts.piece[p].1.max(cuts.piece[v].1);
            }
        }
        cuts
    }

    /// An edge counts for every part that holds one of its ends: those on the way between them.
    fn price(&mut self, graph: &Graph, stiffness: &[f64]) {
        let mut cost = vec![0.0; self.cost.len()];
        for (e, s) in stiffness.iter().enumerate() {
            let c = CoEdge::new(e, false);
            self.climb(graph.origin(c), graph.head(c), |x| cost[x] += s);
        }
        self.cost = cost;
    }

    /// Visits the vertices whose part holds just one of `u` and `v`.
    fn climb(&self, mut u: usize, mut v: usize, mut visit: impl FnMut(usize)) {
        while u != v {
            if self.depth[u] < self.depth[v] {
                std::mem::swap(&mut u, &mut v);
            }
            let Some(up) = self.parent[u] else {
                return;
            };
            visit(u);
            u = up;
        }
    }
}
