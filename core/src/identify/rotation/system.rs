//! Rotation systems and their orbits.

use crate::drawing::{CoEdge, Graph};

/// A cyclic order of the co-edges that leave each vertex: how the edges follow each other around
/// it on the solid's surface.
///
/// A walk that comes to a vertex along a co-edge leaves along the one that follows its mate. That
/// makes every rotation system a set of closed loops that use each co-edge exactly once, whatever
/// the orders are (Heffter 1891, Edmonds 1960).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RotationSystem {
    next: Vec<CoEdge>,
    previous: Vec<CoEdge>,
}

impl RotationSystem {
    /// The system in which co-edges follow each other as in [`Graph::leaving`].
    pub fn new(graph: &Graph) -> Self {
        let empty = vec![CoEdge::from_index(0); 2 * graph.edge_count()];
        let mut system = Self {
            next: empty.clone(),
            previous: empty,
        };
        for v in 0..graph.vertex_count() {
            let order: Vec<usize> = (0..graph.degree(v)).collect();
            system.set(graph, v, &order);
        }
        system
    }

    /// Sets the cyclic order at a vertex: a permutation of the positions in [`Graph::leaving`].
    pub fn set(&mut self, graph: &Graph, vertex: usize, order: &[usize]) {
        let leaving = graph.leaving(vertex);
        for (k, &here) in order.iter().enumerate() {
            let there = order[(k + 1) % order.len()];
            self.next[leaving[here].index()] = leaving[there];
            self.previous[leaving[there].index()] = leaving[here];
        }
    }

    /// The cyclic order at a vertex, as positions in [`Graph::leaving`], the first one first.
    pub fn order(&self, graph: &Graph, vertex: usize) -> Vec<usize> {
        let Some(&first) = graph.leaving(vertex).first() else {
            return Vec::new();
        };
        let mut order = vec![0];
        let mut c = self.next(first);
        while c != first {
            order.push(graph.position(c));
            c = self.next(c);
        }
        order
    }

    /// Reverses the order at a vertex.
    pub fn reverse(&mut self, graph: &Graph, vertex: usize) {
        for c in graph.leaving(vertex) {
            std::mem::swap(&mut self.next[c.index()], &mut self.previous[c.index()]);
        }
    }

    /// Co-edge that follows `c` around its origin.
    pub fn next(&self, c: CoEdge) -> CoEdge {
        self.next[c.index()]
    }

    /// Co-edge that `c` follows around its origin.
    pub fn previous(&self, c: CoEdge) -> CoEdge {
        self.previous[c.index()]
    }

    /// Co-edge that a loop walks after `c`.
    pub fn successor(&self, c: CoEdge) -> CoEdge {
        self.next(c.mate())
    }

    /// Co-edge that a loop walks before `c`.
    pub fn predecessor(&self, c: CoEdge) -> CoEdge {
        self.previous(c).mate()
    }

    /// The loop through a co-edge, starting with it.
    pub fn orbit(&self, start: CoEdge) -> impl Iterator<Item = CoEdge> + '_ {
        let mut following = Some(start);
        std::iter::from_fn(move || {
            let here = following?;
            let next = self.successor(here);
            following = (next != start).then_some(next);
            Some(here)
        })
    }

    /// All loops. Each co-edge is in exactly one; loops start at their smallest co-edge and come
    /// in the order of these.
    pub fn loops(&self) -> Vec<Vec<CoEdge>> {
        let mut seen = vec![false; self.next.len()];
        let mut loops = Vec::new();
        for i in 0..self.next.len() {
            if seen[i] {
                continue;
            }
            let walk: Vec<CoEdge> = self.orbit(CoEdge::from_index(i)).collect();
            for c in &walk {
                seen[c.index()] = true;
            }
            loops.push(walk);
        }
        loops
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::rotation::samples;

    #[test]
    fn a_cube_in_listed_order_still_gives_closed_loops() {
        let drawing = samples::cube();
        let graph = Graph::new(&drawing);
        let system = RotationSystem::new(&graph);
        let loops = system.loops();
        assert_eq!(loops.iter().map(Vec::len).sum::<usize>(), 24);
        for walk in &loops {
            for (k, c) in walk.iter().enumerate() {
                assert_eq!(graph.head(*c), graph.origin(walk[(k + 1) % walk.len()]));
                assert_eq!(system.predecessor(system.successor(*c)), *c);
            }
        }
    }

    #[test]
    fn reversing_every_vertex_reverses_the_loops() {
        let drawing = samples::pyramid();
        let graph = Graph::new(&drawing);
        let mut system = RotationSystem::new(&graph);
        let sets = |s: &RotationSystem| {
            let mut sets: Vec<Vec<usize>> = s
                .loops()
                .iter()
                .map(|l| {
                    let mut edges: Vec<usize> = l.iter().map(|c| c.edge()).collect();
                    edges.sort_unstable();
                    edges
                })
                .collect();
            sets.sort();
            sets
        };
        let before = sets(&system);
        for v in 0..graph.vertex_count() {
            system.reverse(&graph, v);
        }
        assert_eq!(sets(&system), before);
    }
}
