//! Shortest cycles through triples.

use std::collections::VecDeque;

use super::Triples;
use crate::drawing::{CoEdge, Graph};

/// Length that stands for "none, or longer than is told apart".
pub(super) const LONG: u8 = 15;

/// Number of edges of the shortest cycle through each triple that passes the ends of the middle
/// edge once; [`LONG`] where there is none that short.
///
/// One breadth-first search for each co-edge after an edge: time `O(E (V + E))` for bounded
/// degrees.
pub(super) fn shortest_cycles(graph: &Graph, triples: &Triples) -> Vec<u8> {
    let mut search = Search::new(graph);
    let mut lengths = vec![LONG; triples.len()];
    for edge in 0..graph.edge_count() {
        let through = CoEdge::new(edge, false);
        let (u, v) = (graph.origin(through), graph.head(through));
        for after in graph.leaving(v) {
            let mut searched = false;
            for t in triples
                .of_edge(edge)
                .filter(|&t| triples.after(t) == *after)
            {
                let before = triples.before(t);
                lengths[t] = if before.edge() == edge || after.edge() == edge {
                    // A closed edge: alone it is a cycle, with others its vertex comes twice.
                    if before.mate() == *after { 1 } else { LONG }
                } else {
                    let (a, b) = (graph.head(before), graph.head(*after));
                    if before.mate() == *after {
                        2
                    } else if u == v || a == v || b == u {
                        LONG
                    } else {
                        if !searched {
                            search.run(b, [u, v]);
                            searched = true;
                        }
                        search.distance(a).map_or(LONG, |d| (d + 3).min(LONG))
                    }
                };
            }
        }
    }
    lengths
}

struct Search<'a> {
    graph: &'a Graph,
    distance: Vec<u8>,
    round: Vec<u32>,
    current: u32,
    queue: VecDeque<usize>,
}

impl<'a> Search<'a> {
    fn new(graph: &'a Graph) -> Self {
        let n = graph.vertex_count();
        Self {
            graph,
            distance: vec![0; n],
            round: vec![0; n],
            current: 0,
            queue: VecDeque::new(),
        }
    }

    fn run(&mut self, from: usize, without: [usize; 2]) {
        self.current += 1;
        self.visit(from, 0);
        while let Some(v) = self.queue.pop_front() {
            let next = self.distance[v] + 1;
            if next + 3 >= LONG {
                continue;
            }
            for c in self.graph.leaving(v) {
                let w = self.graph.head(*c);
                if self.round[w] != self.current && !without.contains(&w) {
                    self.visit(w, next);
                }
            }
        }
    }

    fn visit(&mut self, v: usize, distance: u8) {
        self.round[v] = self.current;
        self.distance[v] = distance;
        self.queue.push_back(v);
    }

    fn distance(&self, v: usize) -> Option<u8> {
        (self.round[v] == self.current).then(|| self.distance[v])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::rotation::samples;

    #[test]
    fn corners_of_a_cube_close_in_four_or_six() {
        let drawing = samples::cube();
        let graph = Graph::new(&drawing);
        let triples = Triples::new(&graph);
        let mut lengths = shortest_cycles(&graph, &triples);
        lengths.sort_unstable();
        assert_eq!(lengths[..24], [4; 24]);
        assert_eq!(lengths[24..], [6; 24]);
    }

    #[test]
    fn closed_edges_and_pairs_of_arcs_are_short() {
        for (drawing, length) in [(samples::circle(), 1), (samples::two_arcs(), 2)] {
            let graph = Graph::new(&drawing);
            let triples = Triples::new(&graph);
            let lengths = shortest_cycles(&graph, &triples);
            assert!(lengths.iter().all(|&l| l == length), "{lengths:?}");
        }
    }
}
