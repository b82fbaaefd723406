//! Numbers for corners: two co-edges that leave one vertex.

use std::f64::consts::TAU;

use super::nearby::{FAR, Nearby};
use super::{Corners, Table};
use crate::drawing::CoEdge;
use crate::identify::rotation::features::{Context, bell};
use crate::identify::rotation::frame::Fits;
use crate::identify::rotation::rings::Rings;

/// Numbers of a corner.
pub const CORNER: usize = 36;

/// Rows of all corners.
pub(super) fn rows(context: &Context<'_>, corners: &Corners, nearby: &Nearby) -> Vec<f32> {
    let graph = context.graph;
    let mut table = Table::new(corners.len(), CORNER);
    for (k, (v, outer, middle)) in corners.iter(graph).enumerate() {
        let (p, e) = (context.end(outer), context.end(middle));
        let leaving = graph.leaving(v);
        let degree = leaving.len();
        let smooth =
            |a: CoEdge, b: CoEdge| (context.end(a).tangent + context.end(b).tangent).length();
        table.push(p.tangent.dot(e.tangent));
        table.push(p.tangent.perp_dot(e.tangent).abs());
        let onwards = smooth(outer, middle);
        table.push(bell(onwards, 0.05));
        table.push(bell(onwards, 0.2));
        table.push(bell(p.tangent.distance(e.tangent), 0.05));
        let others = leaving.iter().filter(|&&c| c != outer && c != middle);
        table.flag(others.clone().all(|&c| smooth(c, middle) > onwards));
        table.flag(others.clone().all(|&c| smooth(c, outer) > onwards));
        table.flag(p.straight);
        table.flag(e.straight);
        table.flag(p.straight && e.straight);
        table.flag(!p.straight && !e.straight);
        let bend = p.curvature.abs() + e.curvature.abs() + 0.1 / context.size;
        table.push((p.curvature + e.curvature).abs() / bend);
        let (i, j) = (graph.position(outer), graph.position(middle));
        let (opposite, adjacent) = context.crossings.opposite_and_adjacent(v, i, j);
        table.push(opposite);
        table.push(adjacent);
        table.one_hot(degree, 2, 6);
        let length = nearby.length[k];
        table.one_hot(usize::from(length), 1, usize::from(FAR));
        let least = |pick: &dyn Fn(CoEdge, CoEdge) -> bool| {
            let pairs = leaving
                .iter()
                .flat_map(|&a| leaving.iter().map(move |&b| (a, b)));
            let lengths = pairs
                .filter(|&(a, b)| a != b && pick(a, b))
                .map(|(a, b)| nearby.length[corners.index(graph, a, b)]);
            lengths.min().unwrap_or(FAR)
        };
        let excess = |least: u8| f64::from(length.saturating_sub(least).min(4)) / 4.0;
        table.push(excess(least(&|_, b| b == middle)));
        table.push(excess(least(&|_, _| true)));
        let lengths = [outer, middle].map(|c| context.drawing.edges[c.edge()].length());
        table.push(
            (lengths[0].max(1e-9) / lengths[1].max(1e-9))
                .ln()
                .clamp(-4.0, 4.0)
                / 2.0,
        );
        table.push(between(context, v, outer, middle) / degree.max(1) as f64);
        let at = context.drawing.vertices[v];
        let slant = |ring: CoEdge, other: CoEdge| {
            let ellipse = context.rings.ellipse(ring.edge());
            ellipse.map_or(0.0, |x| {
                bell(Rings::slant(x, at, context.end(other).tangent), 0.1)
            })
        };
        table.push(slant(outer, middle));
        table.push(slant(middle, outer));
        let rings = [outer, middle].map(|c| context.rings.of(c.edge()));
        table.flag(rings[0].is_some() && rings[0] == rings[1]);
        let fits = [outer, middle].map(|c| context.frame.fits(c.edge()));
        let share = |f: fn(&Fits) -> u8| match &fits {
            [Some(a), Some(b)] => f(a) & f(b) != 0,
            _ => false,
        };
        table.flag(share(|x| x.planes));
    }
    table.finish()
}

/// Number of other edges between two at a vertex in the drawing, on the side with fewer.
fn between(context: &Context<'_>, v: usize, a: CoEdge, b: CoEdge) -> f64 {
    let angle = |c: CoEdge| {
        let t = context.end(c).tangent;
        t.y.atan2(t.x)
    };
    let from = angle(a);
    let turn = |c: CoEdge| (angle(c) - from).rem_euclid(TAU);
    let to = turn(b);
    let leaving = context.graph.leaving(v);
    let others = leaving.iter().filter(|&&c| c != a && c != b);
    let left = others.clone().filter(|&&c| turn(c) < to).count();
    let all = others.count();
    left.min(all - left) as f64
}
