//! Numbers for triples: the hand-made scorer's features and a few more.

use super::Table;
use crate::drawing::CoEdge;
use crate::identify::rotation::Triples;
use crate::identify::rotation::features::{COUNT, Context, Row};

/// Numbers of a triple.
pub const TRIPLE: usize = COUNT + 15;

/// Rows of all triples; `hand` are the hand-made log-odds that `features` add up to.
pub(super) fn rows(
    context: &Context<'_>,
    triples: &Triples,
    cycles: &[u8],
    features: &[Row],
    hand: &[f64],
) -> Vec<f32> {
    let mut table = Table::new(triples.len(), TRIPLE);
    for t in 0..triples.len() {
        for &x in &features[t] {
            table.push(x);
        }
        table.push(hand[t] / 4.0);
        let edge = CoEdge::new(triples.edge(t), false);
        let (before, after) = (triples.before(t), triples.after(t));
        let [p, n, e, m] = [before, after, edge, edge.mate()].map(|c| context.end(c));
        table.push(p.tangent.dot(n.tangent));
        table.push(p.tangent.perp_dot(n.tangent).abs());
        // Positive if both leave to one side of the edge, however far they lean.
        table.push(-e.tangent.perp_dot(p.tangent) * m.tangent.perp_dot(n.tangent));
        for length in 7..=9 {
            table.flag(cycles[t] == length);
        }
        table.flag(before.edge() == after.edge());
        let far = [before, after].map(|c| context.graph.head(c));
        let gap = context.drawing.vertices[far[1]] - context.drawing.vertices[far[0]];
        table.flag(far[0] == far[1]);
        table.push(gap.length() / context.size);
        // The line that would close a quadrilateral, against the edge.
        table.push(
            gap.normalize_or_zero()
                .perp_dot(e.chord.normalize_or_zero())
                .abs(),
        );
        let length = |c: CoEdge| context.drawing.edges[c.edge()].length().max(1e-9);
        let ratio = (length(before) / length(after)).ln().abs();
        table.push(ratio.min(4.0) / 2.0);
        table.flag(p.straight && e.straight && n.straight);
        table.flag(!p.straight && !e.straight && !n.straight);
        let bends = p.curvature.abs() + n.curvature.abs() + 0.1 / context.size;
        table.push((p.curvature.abs() - n.curvature.abs()).abs() / bends);
    }
    table.finish()
}
