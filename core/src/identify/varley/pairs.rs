//! What two straight edges say about lying in one face: parallelism, triangles, quadrilaterals.

use glam::DVec2;

use crate::drawing::{CoEdge, Drawing, Graph};

/// From this value of [`Pairs::parallelism`] two edges count as parallel.
const PARALLEL: f64 = 0.9;

/// Directions and starting priorities of a drawing's edges.
pub(super) struct Pairs {
    directions: Vec<DVec2>,
    priorities: Vec<f64>,
}

impl Pairs {
    pub(super) fn new(drawing: &Drawing, graph: &Graph) -> Self {
        let directions = drawing
            .edges
            .iter()
            .map(|e| (drawing.vertices[e.v[1]] - drawing.vertices[e.v[0]]).normalize_or_zero())
            .collect();
        let mut pairs = Self {
            directions,
            priorities: Vec::new(),
        };
        pairs.priorities = (0..graph.edge_count())
            .map(|e| pairs.first_priority(graph, e))
            .collect();
        pairs
    }

    /// |cos angle|^10 of two edges as drawn, 0 to 1.
    pub(super) fn parallelism(&self, e: usize, f: usize) -> f64 {
        self.directions[e].dot(self.directions[f]).abs().powi(10)
    }

    /// Priority of an edge's two co-edges at the start.
    pub(super) fn priority(&self, edge: usize) -> f64 {
        self.priorities[edge]
    }

    fn is_parallel(&self, c: CoEdge, d: CoEdge) -> bool {
        self.parallelism(c.edge(), d.edge()) >= PARALLEL
    }

    /// 100, and more for an edge of a small cycle that is likely to be a face: 50 on a triangle
    /// with a trihedral vertex, else 20 or 10 on a quadrilateral with a parallel pair of opposite
    /// edges, for the pair and for the others.
    fn first_priority(&self, graph: &Graph, edge: usize) -> f64 {
        let c = CoEdge::new(edge, false);
        let (u, v) = (graph.origin(c), graph.head(c));
        let mut bonus: f64 = 0.0;
        for &next in graph.leaving(v).iter().filter(|n| n.edge() != edge) {
            let w = graph.head(next);
            for &last in graph.leaving(u).iter().filter(|l| l.edge() != edge) {
                let x = graph.head(last);
                if w == x && [u, v, w].iter().any(|&t| graph.degree(t) == 3) {
                    return 150.0;
                }
                if w == x || w == u || x == v {
                    continue;
                }
                let closing = graph.leaving(w).iter().find(|&&d| graph.head(d) == x);
                if closing.is_some_and(|&d| self.is_parallel(c, d)) {
                    bonus = bonus.max(20.0);
                } else if closing.is_some() && self.is_parallel(next, last) {
                    bonus = bonus.max(10.0);
                }
            }
        }
        100.0 + bonus
    }
}
