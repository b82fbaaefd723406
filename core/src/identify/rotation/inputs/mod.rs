//! What the trained model sees of a drawing: numbers for edges, corners and triples, and which
//! edges stand in which relation.
//!
//! Training and inference both read these tables (`faceformer features` writes them for training),
//! so they cannot differ. Lengths are in units of the drawing's half diagonal and positions are
//! taken from the middle of its bounding box. Walking an edge the other way changes nothing;
//! mirroring the drawing changes positions and directions only. Numbers are rounded to half
//! precision, in which files keep them.

mod corners;
mod edges;
mod nearby;
mod relations;
mod triples;

pub use corners::CORNER;
pub use edges::EDGE;
pub use relations::{RELATIONS, Relation};
pub use triples::TRIPLE;

use half::f16;

use super::Triples;
use super::cycles::shortest_cycles;
use super::features::Context;
use super::hand::HandScorer;
use crate::drawing::{CoEdge, Drawing, Graph};
use crate::lift::directions::Directions;

/// The tables of one drawing with E edges, C corners and T triples.
///
/// A corner is an ordered pair of co-edges that leave one vertex: the *middle* one, which a triple
/// is about, and the *outer* one, its neighbour there. Corners are listed by vertex, then by middle
/// co-edge, then by outer one, in the order of [`Graph::leaving`]. Triples are in the order of
/// [`Triples`].
#[derive(Debug, Clone, PartialEq)]
pub struct Inputs {
    /// One row of [`EDGE`] numbers an edge, `[E, EDGE]`.
    pub edges: Vec<f32>,
    /// One row of [`CORNER`] numbers a corner, `[C, CORNER]`.
    pub corners: Vec<f32>,
    /// Outer and middle edge of each corner, `[C, 2]`.
    pub corner_edges: Vec<[u32; 2]>,
    /// One row of [`TRIPLE`] numbers a triple, `[T, TRIPLE]`.
    pub triples: Vec<f32>,
    /// Corners at the first and at the second vertex of each triple's edge, `[T, 2]`.
    pub triple_corners: Vec<[u32; 2]>,
    /// Hand-made log-odds of each triple, `[T]`.
    pub hand: Vec<f32>,
    /// Bit `k` of entry `(i, j)` is set if edges `i` and `j` stand in relation `k` of
    /// [`Relation::ALL`], `[E, E]`; symmetric.
    pub relations: Vec<u16>,
}

impl Inputs {
    /// Computes the tables in time `O(E^2 + C)` for bounded degrees.
    pub fn new(drawing: &Drawing, graph: &Graph, triples: &Triples) -> Self {
        let directions = Directions::estimate(drawing).ok();
        Self::with_directions(drawing, graph, triples, directions.as_ref())
    }

    /// The same for a drawing whose dominant directions are known, if it has any.
    pub(super) fn with_directions(
        drawing: &Drawing,
        graph: &Graph,
        triples: &Triples,
        directions: Option<&Directions>,
    ) -> Self {
        let context = Context::new(drawing, graph, directions);
        let cycles = shortest_cycles(graph, triples);
        let rows = context.rows(triples, &cycles);
        let hand: Vec<f64> = HandScorer::default().sums(&rows);
        let corners = Corners::new(graph);
        let nearby = nearby::Nearby::new(graph, &corners);
        Self {
            edges: edges::rows(&context, triples, &cycles),
            corners: corners::rows(&context, &corners, &nearby),
            corner_edges: corners.edges(graph),
            triples: triples::rows(&context, triples, &cycles, &rows, &hand),
            triple_corners: corners.of_triples(graph, triples),
            hand: hand.iter().map(|&x| x as f32).collect(),
            relations: relations::table(&context, &corners, &nearby),
        }
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.edges.len() / EDGE
    }
}

/// Numbering of corners.
pub(super) struct Corners {
    first: Vec<usize>,
}

impl Corners {
    fn new(graph: &Graph) -> Self {
        let mut first = vec![0];
        for v in 0..graph.vertex_count() {
            let d = graph.degree(v);
            first.push(first[v] + d * d.saturating_sub(1));
        }
        Self { first }
    }

    /// Number of corners.
    fn len(&self) -> usize {
        self.first[self.first.len() - 1]
    }

    /// Corner of two co-edges that leave one vertex.
    fn index(&self, graph: &Graph, outer: CoEdge, middle: CoEdge) -> usize {
        let v = graph.origin(middle);
        let (i, j) = (graph.position(middle), graph.position(outer));
        self.first[v] + i * (graph.degree(v) - 1) + j - usize::from(j > i)
    }

    /// All corners as (vertex, outer, middle), in order.
    fn iter<'a>(
        &self,
        graph: &'a Graph,
    ) -> impl Iterator<Item = (usize, CoEdge, CoEdge)> + use<'a> {
        (0..graph.vertex_count()).flat_map(move |v| {
            let leaving = graph.leaving(v);
            leaving.iter().flat_map(move |&middle| {
                let others = leaving.iter().filter(move |&&outer| outer != middle);
                others.map(move |&outer| (v, outer, middle))
            })
        })
    }

    fn edges(&self, graph: &Graph) -> Vec<[u32; 2]> {
        let pair = |(_, outer, middle): (usize, CoEdge, CoEdge)| {
            [outer.edge() as u32, middle.edge() as u32]
        };
        self.iter(graph).map(pair).collect()
    }

    fn of_triples(&self, graph: &Graph, triples: &Triples) -> Vec<[u32; 2]> {
        let pair = |t: usize| {
            let out = CoEdge::new(triples.edge(t), false);
            [(triples.before(t), out), (triples.after(t), out.mate())]
                .map(|(outer, middle)| self.index(graph, outer, middle) as u32)
        };
        (0..triples.len()).map(pair).collect()
    }
}

/// Rows of numbers under construction.
struct Table {
    values: Vec<f32>,
    rows: usize,
    width: usize,
}

impl Table {
    fn new(rows: usize, width: usize) -> Self {
        Self {
            values: Vec::with_capacity(rows * width),
            rows,
            width,
        }
    }

    /// Adds a number. Nothing that a drawing may hold can blow it up: it is bounded by 10, and 0
    /// if it is no number.
    fn push(&mut self, x: f64) {
        let x = if x.is_nan() {
            0.0
        } else {
            x.clamp(-10.0, 10.0)
        };
        self.values.push(f16::from_f64(x).to_f32());
    }

    fn flag(&mut self, x: bool) {
        self.values.push(if x { 1.0 } else { 0.0 });
    }

    fn point(&mut self, p: glam::DVec2) {
        self.push(p.x);
        self.push(p.y);
    }

    /// One number for each class from `first` to `last`, 1 for that of `x`; what lies beyond counts
    /// as the nearest.
    fn one_hot(&mut self, x: usize, first: usize, last: usize) {
        let x = x.clamp(first, last);
        for k in first..=last {
            self.flag(k == x);
        }
    }

    /// The numbers, row by row.
    fn finish(self) -> Vec<f32> {
        assert_eq!(
            self.values.len(),
            self.rows * self.width,
            "rows are of one width"
        );
        self.values
    }
}

#[cfg(test)]
mod tests;
