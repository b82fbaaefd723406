//! What the truth says of triples, orders at vertices and loops.

use super::super::Triples;
use super::super::orders::cyclic_orders;
use crate::drawing::{CoEdge, Graph, Truth};

/// Degrees whose orders are listed. At lower ones given neighbours leave little to choose.
const ORDERS: std::ops::RangeInclusive<usize> = 4..=5;

/// Truth of one drawing in the terms of the model.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Labels {
    /// Whether the three edges of each triple follow each other in a face, `[T]`.
    pub(super) follows: Vec<u8>,
    /// Triples along each loop.
    pub(super) loops: Vec<Vec<u32>>,
    /// Surface kind of each loop's face, place in [`SurfaceKind::ALL`].
    pub(super) kinds: Vec<u8>,
    /// For the vertices of degree 4 and 5 with true neighbours: for each of the `(d - 1)!`
    /// cyclic orders, the true one first, the `2 d` triples that it chooses.
    pub(super) orders: [Vec<u32>; 2],
}

impl Labels {
    /// Labels from a truth; `None` if it leaves a co-edge without a successor.
    pub(super) fn new(graph: &Graph, triples: &Triples, truth: &Truth) -> Option<Self> {
        let mut labels = Self {
            follows: vec![0; triples.len()],
            ..Self::default()
        };
        let mut around = Around {
            next: vec![None; 2 * graph.edge_count()],
            previous: vec![None; 2 * graph.edge_count()],
        };
        for face in &truth.faces {
            for walk in &face.loops {
                let n = walk.len();
                let mut steps = Vec::with_capacity(n);
                for (k, &c) in walk.iter().enumerate() {
                    let (last, next) = (walk[(k + n - 1) % n], walk[(k + 1) % n]);
                    let (before, after) = (graph.position(last.mate()), graph.position(next));
                    let t = triples.index(graph, c, before, after);
                    *labels.follows.get_mut(t)? = 1;
                    steps.push(t as u32);
                    around.next[c.mate().index()] = Some(next);
                    around.previous[next.index()] = Some(c.mate());
                }
                labels.loops.push(steps);
                labels.kinds.push(face.kind as u8);
            }
        }
        if around.next.iter().any(Option::is_none) {
            return None;
        }
        for v in 0..graph.vertex_count() {
            let degree = graph.degree(v);
            if ORDERS.contains(&degree)
                && let Some(rows) = around.orders(graph, triples, v)
            {
                labels.orders[degree - ORDERS.start()].extend(rows);
            }
        }
        Some(labels)
    }
}

/// The true rotation system: what follows a co-edge around its origin, and what it follows.
struct Around {
    next: Vec<Option<CoEdge>>,
    previous: Vec<Option<CoEdge>>,
}

impl Around {
    /// The triples of every order at a vertex, the true order first; `None` if a closed edge is
    /// there, or if the solid touches itself there and the truth is no single cycle.
    fn orders(&self, graph: &Graph, triples: &Triples, v: usize) -> Option<Vec<u32>> {
        let leaving = graph.leaving(v);
        if leaving.iter().any(|&c| graph.head(c) == v) {
            return None;
        }
        let mut truth = vec![0];
        let mut c = self.next[leaving[0].index()]?;
        while c != leaving[0] {
            if graph.origin(c) != v || truth.len() == leaving.len() {
                return None;
            }
            truth.push(graph.position(c));
            c = self.next[c.index()]?;
        }
        if truth.len() != leaving.len() {
            return None;
        }
        let mut rows = self.chosen(graph, triples, v, &truth)?;
        for order in cyclic_orders(leaving.len()) {
            if *order != truth {
                rows.extend(self.chosen(graph, triples, v, order)?);
            }
        }
        Some(rows)
    }

    /// The two triples that an order chooses at each edge of a vertex.
    fn chosen(
        &self,
        graph: &Graph,
        triples: &Triples,
        v: usize,
        order: &[usize],
    ) -> Option<Vec<u32>> {
        let n = order.len();
        let mut chosen = Vec::with_capacity(2 * n);
        for (k, &i) in order.iter().enumerate() {
            let c = graph.leaving(v)[i];
            let far = c.mate().index();
            let next = graph.position(self.next[far]?);
            let previous = graph.position(self.previous[far]?);
            for (before, after) in [
                (order[(k + n - 1) % n], next),
                (order[(k + 1) % n], previous),
            ] {
                chosen.push(triples.index(graph, c, before, after) as u32);
            }
        }
        Some(chosen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{SurfaceKind, TruthFace};
    use crate::identify::rotation::{Field, samples};

    #[test]
    fn labels_follow_the_loops() {
        for drawing in [samples::cube(), samples::pyramid()] {
            let graph = Graph::new(&drawing);
            let triples = Triples::new(&graph);
            // Any rotation system's loops are a truth of some surface.
            let scores: Vec<f64> = (0..triples.len()).map(|t| (t as f64).sin()).collect();
            let system = Field::new(&graph, &triples, &scores).decode();
            let truth = Truth {
                faces: system
                    .loops()
                    .into_iter()
                    .map(|walk| TruthFace {
                        kind: SurfaceKind::Cone,
                        loops: vec![walk],
                    })
                    .collect(),
                ..Truth::default()
            };
            let labels = Labels::new(&graph, &triples, &truth).unwrap();
            let steps: usize = labels.loops.iter().map(Vec::len).sum();
            assert_eq!(steps, 2 * graph.edge_count());
            assert!(labels.kinds.iter().all(|&k| k == 2));
            for (k, rows) in labels.orders.iter().enumerate() {
                let degree = k + ORDERS.start();
                let count: usize = (1..degree).product();
                let width = 2 * degree;
                let vertices = (0..graph.vertex_count()).filter(|&v| graph.degree(v) == degree);
                assert_eq!(rows.len(), vertices.count() * count * width);
                for vertex in rows.chunks(count * width) {
                    for (i, order) in vertex.chunks(width).enumerate() {
                        let right = order.iter().filter(|&&t| labels.follows[t as usize] == 1);
                        assert_eq!(right.count() == width, i == 0);
                    }
                }
            }
        }
    }
}
