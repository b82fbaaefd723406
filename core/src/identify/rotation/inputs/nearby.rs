//! Shortest cycles through corners.

use std::collections::VecDeque;

use super::Corners;
use crate::drawing::{CoEdge, Graph};

/// Length that stands for "none, or longer than is looked for".
pub(super) const FAR: u8 = 9;

/// For each corner the shortest cycles that turn there.
pub(super) struct Nearby {
    /// Edges of the cycle, counted; [`FAR`] if it has that many or more.
    pub(super) length: Vec<u8>,
    /// The other edges on such cycles, without the corner's own two.
    pub(super) members: Vec<Vec<u32>>,
}

impl Nearby {
    /// One breadth-first search for each pair of co-edges at a vertex.
    pub(super) fn new(graph: &Graph, corners: &Corners) -> Self {
        let mut found = Self {
            length: vec![FAR; corners.len()],
            members: vec![Vec::new(); corners.len()],
        };
        let mut search = Search::new(graph);
        for (v, outer, middle) in corners.iter(graph) {
            if outer > middle {
                continue;
            }
            let (length, members) = search.cycle(v, outer, middle);
            for corner in [
                corners.index(graph, outer, middle),
                corners.index(graph, middle, outer),
            ] {
                found.length[corner] = length;
                found.members[corner].clone_from(&members);
            }
        }
        found
    }
}

struct Search<'a> {
    graph: &'a Graph,
    distance: Vec<u8>,
    seen: Vec<u32>,
    round: u32,
    queue: VecDeque<usize>,
}

impl<'a> Search<'a> {
    fn new(graph: &'a Graph) -> Self {
        Self {
            graph,
            distance: vec![0; graph.vertex_count()],
            seen: vec![0; graph.vertex_count()],
            round: 0,
            queue: VecDeque::new(),
        }
    }

    /// Length of the shortest cycles through two co-edges that leave `v`, and the other edges on
    /// all of them.
    fn cycle(&mut self, v: usize, a: CoEdge, b: CoEdge) -> (u8, Vec<u32>) {
        if a.edge() == b.edge() {
            return (1, Vec::new());
        }
        let (from, to) = (self.graph.head(a), self.graph.head(b));
        if from == v || to == v {
            return (FAR, Vec::new());
        }
        if from == to {
            return (2, Vec::new());
        }
        if !self.run(from, to, v) {
            return (FAR, Vec::new());
        }
        let length = self.distance[to] + 2;
        // Back along every shortest path.
        let mut members = Vec::new();
        self.queue.clear();
        self.queue.push_back(to);
        let mut open = vec![to];
        while let Some(x) = self.queue.pop_front() {
            for c in self.graph.leaving(x) {
                let y = self.graph.head(*c);
                if y != v && self.seen[y] == self.round && self.distance[y] + 1 == self.distance[x]
                {
                    members.push(c.edge() as u32);
                    if !open.contains(&y) {
                        open.push(y);
                        self.queue.push_back(y);
                    }
                }
            }
        }
        members.sort_unstable();
        members.dedup();
        (length, members)
    }

    /// Distances from a vertex without passing `without`; whether `to` is near enough.
    fn run(&mut self, from: usize, to: usize, without: usize) -> bool {
        self.round += 1;
        self.queue.clear();
        self.visit(from, 0);
        while let Some(x) = self.queue.pop_front() {
            if x == to {
                return true;
            }
            let next = self.distance[x] + 1;
            if next + 2 >= FAR {
                continue;
            }
            for c in self.graph.leaving(x) {
                let y = self.graph.head(*c);
                if y != without && self.seen[y] != self.round {
                    self.visit(y, next);
                }
            }
        }
        false
    }

    fn visit(&mut self, v: usize, distance: u8) {
        self.seen[v] = self.round;
        self.distance[v] = distance;
        self.queue.push_back(v);
    }
}
