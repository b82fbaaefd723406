//! Triples of edges that may follow each other around a face.

use crate::drawing::{CoEdge, Graph};

/// Every triple (edge before, edge, edge after) of a drawing, as flat arrays.
///
/// A triple of edge `e` from vertex `u` to vertex `v` is `(before, after)`: a face's loop comes to
/// `u` along the mate of `before`, walks `e` and leaves `v` along `after`. Both co-edges leave the
/// edge's ends, so the same walk in the other direction is the same pair with its ends swapped:
/// one entry stands for both, and scores cannot depend on orientation or on the depth reversal
/// that every parallel projection has.
///
/// The triples of an edge form a block of `degree(u) - 1` rows and `degree(v) - 1` columns, row by
/// row, in the order of [`Graph::leaving`] without the edge itself.
#[derive(Debug, Clone)]
pub struct Triples {
    first: Vec<usize>,
    columns: Vec<usize>,
    before: Vec<CoEdge>,
    after: Vec<CoEdge>,
    edge: Vec<u32>,
}

impl Triples {
    /// Lists the triples of a graph; edges by number, each block row by row.
    pub fn new(graph: &Graph) -> Self {
        let edges = graph.edge_count();
        let mut list = Self {
            first: Vec::with_capacity(edges + 1),
            columns: Vec::with_capacity(edges),
            before: Vec::new(),
            after: Vec::new(),
            edge: Vec::new(),
        };
        list.first.push(0);
        for e in 0..edges {
            let (out, back) = (CoEdge::new(e, false), CoEdge::new(e, true));
            let others = |c: CoEdge| {
                let leaving = graph.leaving(graph.origin(c)).iter().copied();
                leaving.filter(move |&x| x != c)
            };
            for before in others(out) {
                for after in others(back) {
                    list.before.push(before);
                    list.after.push(after);
                    list.edge.push(e as u32);
                }
            }
            list.columns.push(graph.degree(graph.origin(back)) - 1);
            list.first.push(list.before.len());
        }
        list
    }

    /// Number of triples.
    pub fn len(&self) -> usize {
        self.edge.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.edge.is_empty()
    }

    /// Indices of the triples of edge `edge` (from 0).
    pub fn of_edge(&self, edge: usize) -> std::ops::Range<usize> {
        self.first[edge]..self.first[edge + 1]
    }

    /// Co-edge that leaves the edge's first vertex: the edge before, walked backwards.
    pub fn before(&self, triple: usize) -> CoEdge {
        self.before[triple]
    }

    /// Edge in the middle, index from 0.
    pub fn edge(&self, triple: usize) -> usize {
        self.edge[triple] as usize
    }

    /// Co-edge that leaves the edge's second vertex: the edge after.
    pub fn after(&self, triple: usize) -> CoEdge {
        self.after[triple]
    }

    /// Index of the triple in which a walk leaves `through` towards `after`, having come along the
    /// mate of `before`. All three co-edges may be walked either way round; positions are those
    /// of [`Graph::position`].
    ///
    /// `before` is the position at the origin of `through`, `after` that at its head.
    pub fn index(&self, graph: &Graph, through: CoEdge, before: usize, after: usize) -> usize {
        let (own, other) = (graph.position(through), graph.position(through.mate()));
        let row = before - usize::from(before > own);
        let column = after - usize::from(after > other);
        let (row, column) = if through.is_reversed() {
            (column, row)
        } else {
            (row, column)
        };
        let edge = through.edge();
        self.first[edge] + row * self.columns[edge] + column
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::rotation::samples;

    #[test]
    fn a_cube_has_four_triples_an_edge() {
        let drawing = samples::cube();
        let graph = Graph::new(&drawing);
        let triples = Triples::new(&graph);
        assert_eq!(triples.len(), 48);
        for e in 0..12 {
            assert_eq!(triples.of_edge(e).len(), 4);
        }
    }

    #[test]
    fn index_finds_the_triple_walked_either_way() {
        let drawing = samples::pyramid();
        let graph = Graph::new(&drawing);
        let triples = Triples::new(&graph);
        for t in 0..triples.len() {
            let through = CoEdge::new(triples.edge(t), false);
            let before = graph.position(triples.before(t));
            let after = graph.position(triples.after(t));
            assert_eq!(triples.index(&graph, through, before, after), t);
            assert_eq!(triples.index(&graph, through.mate(), after, before), t);
        }
    }

    #[test]
    fn a_circle_alone_has_one_triple() {
        let drawing = samples::circle();
        let graph = Graph::new(&drawing);
        let triples = Triples::new(&graph);
        assert_eq!(triples.len(), 1);
        assert_eq!(triples.before(0), CoEdge::new(0, true));
        assert_eq!(triples.after(0), CoEdge::new(0, false));
    }
}
