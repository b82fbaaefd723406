//! The engine `shortest`: the least-cost loop through each co-edge.
//!
//! This is the older baseline from which Varley and Company (2010) start: "for each co-edge, the
//! true face has the least cost among all loops enclosing that co-edge" (paper, section 4.3). The
//! loops come from Dijkstra's algorithm over co-edges. A step from one co-edge to the next costs 1
//! and a little for its turn in the drawing, so that of loops with equally many edges the
//! straighter one wins.
//!
//! An undirected cost gives an edge's two co-edges the same loop, though an edge bounds two faces.
//! So the mate gets the least-cost loop that leaves the first one at both ends of the edge; at a
//! vertex of degree 2 there is nothing to leave. Loops are not grouped into faces.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use glam::DVec2;

use super::kinds::kind_of;
use super::postprocess::{Prediction, postprocess};
use super::{Engine, EngineKind, Identification, IdentifyError, orient};
use crate::drawing::{CoEdge, Drawing, Graph};
use crate::{Progress, Result, Stage};

/// The least-cost loop through each co-edge, by Dijkstra's algorithm: the older baseline.
#[derive(Debug, Clone, PartialEq)]
pub struct ShortestEngine {
    /// Cost of turning back (a half turn), in edges.
    pub turn_cost: f64,
}

impl Default for ShortestEngine {
    fn default() -> Self {
        Self { turn_cost: 0.25 }
    }
}

impl Engine for ShortestEngine {
    fn name(&self) -> &'static str {
        EngineKind::Shortest.name()
    }

    fn identify(&self, drawing: &Drawing, progress: Progress<'_>) -> Result<Identification> {
        let graph = Graph::new(drawing);
        let mut search = Search::new(self, drawing, &graph);
        let mut predictions = Vec::new();
        let mut predict = |walk: Vec<CoEdge>| {
            predictions.push(Prediction {
                kind: kind_of(drawing, &walk),
                coedges: walk,
                votes: 1,
            });
        };
        for edge in 0..graph.edge_count() {
            if edge % 64 == 0 {
                progress.report(Stage::Identify, edge as f64 / graph.edge_count() as f64)?;
            }
            let start = CoEdge::new(edge, false);
            let Some(first) = search.least_loop(start, Banned::default()) else {
                continue;
            };
            let second = search.loop_beside(&first);
            predict(first);
            if let Some(second) = second {
                predict(second);
            }
        }
        let mut faces = postprocess(&graph, &predictions).faces;
        orient(&graph, &mut faces);
        if faces.is_empty() {
            return Err(IdentifyError::NoFaces {
                engine: self.name(),
                edge: 1,
            }
            .into());
        }
        Ok(Identification {
            engine: self.name().to_owned(),
            faces,
            alternatives: Vec::new(),
            notices: Vec::new(),
            vertices: Vec::new(),
        })
    }
}

/// Dijkstra's algorithm over the co-edges of one drawing, with its tables kept between searches.
struct Search<'a> {
    graph: &'a Graph,
    turn_cost: f64,
    /// Unit tangent with which each co-edge leaves its origin.
    leaving: Vec<DVec2>,
    /// Least cost so far, the co-edge before, and the search that wrote them, by co-edge.
    reached: Vec<(f64, CoEdge, u32)>,
    round: u32,
    queue: BinaryHeap<Reverse<Entry>>,
}

/// Corners that a loop through its start must not use.
#[derive(Clone, Copy, Default)]
struct Banned {
    after_start: Option<CoEdge>,
    before_start: Option<CoEdge>,
}

impl<'a> Search<'a> {
    fn new(engine: &ShortestEngine, drawing: &Drawing, graph: &'a Graph) -> Self {
        let nothing = (f64::INFINITY, CoEdge::from_index(0), 0);
        Self {
            graph,
            turn_cost: engine.turn_cost,
            leaving: graph.coedges().map(|c| tangent(drawing, c)).collect(),
            reached: vec![nothing; 2 * graph.edge_count()],
            round: 0,
            queue: BinaryHeap::new(),
        }
    }

    /// The least-cost loop through `start`, which it begins with; `None` if there is none.
    fn least_loop(&mut self, start: CoEdge, banned: Banned) -> Option<Vec<CoEdge>> {
        self.round += 1;
        self.queue.clear();
        self.expand(start, 0.0, start, banned);
        while let Some(Reverse(Entry { cost, coedge })) = self.queue.pop() {
            if coedge == start {
                return Some(self.walk_back(start));
            }
            if cost <= self.reached[coedge.index()].0 {
                self.expand(coedge, cost, start, banned);
            }
        }
        None
    }

    /// The least-cost loop through the mate of `first`'s first co-edge that uses none of the
    /// corners that `first` has at that edge.
    fn loop_beside(&mut self, first: &[CoEdge]) -> Option<Vec<CoEdge>> {
        let (&start, &last) = (first.first()?, first.last()?);
        let next = first.get(1).copied().unwrap_or(start);
        let ban = |vertex: usize, c: CoEdge| (self.graph.degree(vertex) > 2).then(|| c.mate());
        let banned = Banned {
            after_start: ban(self.graph.origin(start), last),
            before_start: ban(self.graph.head(start), next),
        };
        self.least_loop(start.mate(), banned)
    }

    /// Offers every step after `c`, which was reached at `cost`.
    fn expand(&mut self, c: CoEdge, cost: f64, start: CoEdge, banned: Banned) {
        let arriving = -self.leaving[c.mate().index()];
        for &next in self.graph.leaving(self.graph.head(c)) {
            let is_banned = (c == start && banned.after_start == Some(next))
                || (next == start && banned.before_start == Some(c));
            if next == c.mate() || is_banned {
                continue;
            }
            let turn = arriving.angle_to(self.leaving[next.index()]).abs();
            let cost = cost + 1.0 + self.turn_cost * turn / std::f64::consts::PI;
            let (least, before, round) = &mut self.reached[next.index()];
            if *round != self.round || cost < *least {
                (*least, *before, *round) = (cost, c, self.round);
                self.queue.push(Reverse(Entry { cost, coedge: next }));
            }
        }
    }

    /// The loop that ended at `start`, beginning with it.
    fn walk_back(&self, start: CoEdge) -> Vec<CoEdge> {
        let mut walk = vec![start];
        let mut c = self.reached[start.index()].1;
        while c != start {
            walk.push(c);
            c = self.reached[c.index()].1;
        }
        walk[1..].reverse();
        walk
    }
}

/// Unit tangent of a co-edge at its origin; zero if its first two points coincide.
fn tangent(drawing: &Drawing, c: CoEdge) -> DVec2 {
    let points = &drawing.edges[c.edge()].points;
    let chord = match (c.is_reversed(), points.as_slice()) {
        (false, [a, b, ..]) | (true, [.., b, a]) => *b - *a,
        _ => DVec2::ZERO,
    };
    chord.normalize_or_zero()
}

/// A reached co-edge in the queue.
#[derive(PartialEq)]
struct Entry {
    cost: f64,
    coedge: CoEdge,
}

impl Eq for Entry {}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        self.cost
            .total_cmp(&other.cost)
            .then(self.coedge.cmp(&other.coedge))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

#[cfg(test)]
mod tests {
    use super::super::metrics::DrawingScore;
    use super::super::testing;
    use super::*;
    use crate::Error;

    fn score(drawing: &Drawing) -> DrawingScore {
        let found = ShortestEngine::default()
            .identify(drawing, Progress::none())
            .unwrap();
        DrawingScore::of(drawing.truth.as_ref().unwrap(), &found, 0.0)
    }

    #[test]
    fn finds_the_faces_of_simple_solids() {
        use testing::{bracket, cube, tetrahedron, wedge};
        for solid in [cube(), tetrahedron(), wedge(), bracket()] {
            assert!(score(&solid).exact(), "{:?}", score(&solid));
        }
    }

    #[test]
    fn finds_the_loops_of_a_hole_as_faces_of_their_own() {
        let score = score(&testing::holed_cube());
        assert!(score.loops_exact());
        assert_eq!((score.matched, score.predicted, score.faces), (8, 12, 10));
    }

    #[test]
    fn a_whole_circle_is_a_loop() {
        let points: Vec<DVec2> = (0..=16)
            .map(|i| DVec2::from_angle(f64::from(i % 16) * std::f64::consts::FRAC_PI_8))
            .collect();
        let mut disc = testing::cube();
        disc.edges.truncate(1);
        disc.edges[0].v = [0, 0];
        disc.edges[0].curve = crate::drawing::Curve2::Polyline;
        disc.edges[0].points = points;
        let found = ShortestEngine::default()
            .identify(&disc, Progress::none())
            .unwrap();
        assert_eq!(found.faces.len(), 1);
        assert_eq!(found.faces[0].loops, [[CoEdge::new(0, false)]]);
    }

    #[test]
    fn a_tree_has_no_faces() {
        let mut tree = testing::cube();
        tree.edges.truncate(3);
        let error = ShortestEngine::default()
            .identify(&tree, Progress::none())
            .unwrap_err();
        assert!(
            matches!(error, Error::Identify(IdentifyError::NoFaces { .. })),
            "{error}"
        );
    }

    #[test]
    fn it_can_be_cancelled() {
        let stop = |_, _| false;
        let found = ShortestEngine::default().identify(&testing::cube(), Progress::new(&stop));
        assert_eq!(found, Err(Error::Cancelled));
    }
}
