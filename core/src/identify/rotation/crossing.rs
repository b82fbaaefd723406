//! Vertices where two smooth curves cross.

use super::ends::End;
use super::rings::Rings;
use crate::drawing::{CoEdge, Graph};

/// How likely two co-edges at a vertex of degree 4 lie opposite each other on the surface because
/// two smooth curves cross there.
///
/// Where a silhouette crosses a smooth edge, both curves run on through the vertex and alternate
/// around it. Which ends belong together shows in the drawing: tangents oppose each other and the
/// curvature goes on. Two straight lines that cross are no such case: planar faces turn there.
#[derive(Debug)]
pub(super) struct Crossings {
    /// Likelihood by vertex and by pairing: first end with the second, third, fourth.
    pairings: Vec<[f64; 3]>,
}

/// Angle that counts as much as a full change of curvature, radians.
const ANGLE: f64 = 0.08;
/// Weight of a full mismatch of curvature.
const BEND: f64 = 2.0;
/// What two arcs of one circle are worth.
const RING: f64 = 2.0;
/// Cost at which a crossing is as likely as none.
const NONE: f64 = 3.0;

impl Crossings {
    /// Looks at every vertex of degree 4; `size` is the drawing's.
    pub(super) fn new(graph: &Graph, ends: &[End], rings: &Rings, size: f64) -> Self {
        let pairings = (0..graph.vertex_count())
            .map(|v| match graph.leaving(v) {
                [a, b, c, d] => {
                    let cost = |x: [&CoEdge; 2], y: [&CoEdge; 2]| {
                        let pairs = [x, y].map(|pair| pair.map(|c| &ends[c.index()]));
                        if pairs.iter().flatten().all(|end| end.straight) {
                            return f64::INFINITY;
                        }
                        let ring = |[a, b]: [&CoEdge; 2]| {
                            let ring = rings.of(a.edge());
                            ring.is_some() && ring == rings.of(b.edge())
                        };
                        let bonus = if ring(x) || ring(y) { RING } else { 0.0 };
                        pairs.iter().map(|[a, b]| through(a, b, size)).sum::<f64>() - bonus
                    };
                    let costs = [
                        cost([a, b], [c, d]),
                        cost([a, c], [b, d]),
                        cost([a, d], [b, c]),
                    ];
                    let weights = costs.map(|c| (-c).exp());
                    let sum = weights.iter().sum::<f64>() + (-NONE).exp();
                    weights.map(|w| w / sum)
                }
                _ => [0.0; 3],
            })
            .collect();
        Self { pairings }
    }

    /// Likelihood that the ends at positions `i` and `j` of the vertex are opposite, and that they
    /// are neighbours; both 0 if nothing speaks for a crossing.
    pub(super) fn opposite_and_adjacent(&self, vertex: usize, i: usize, j: usize) -> (f64, f64) {
        let pairings = &self.pairings[vertex];
        // Complementary pairs are the same pairing: {1, 2} goes with {0, 3}.
        let k = match (i.min(j), i.max(j)) {
            (0, k @ 1..=3) => k,
            (1, 2) => 3,
            (1, 3) => 2,
            (2, 3) => 1,
            _ => return (0.0, 0.0),
        };
        let opposite = pairings[k - 1];
        (opposite, pairings.iter().sum::<f64>() - opposite)
    }
}

/// Cost of one curve running through both ends.
fn through(a: &End, b: &End, size: f64) -> f64 {
    let angle = a
        .tangent
        .perp_dot(b.tangent)
        .atan2(-a.tangent.dot(b.tangent))
        .abs();
    // Leaving the vertex both ways, one curve turns left by as much as it turns right.
    let jump = (a.curvature + b.curvature).abs();
    let bend = jump / (a.curvature.abs() + b.curvature.abs() + 0.1 / size);
    angle / ANGLE + BEND * bend
}
