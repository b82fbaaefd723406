//! What speaks for and against a triple of edges, as numbers.

use super::Triples;
use super::crossing::Crossings;
use super::cycles::{LONG, shortest_cycles};
use super::ends::{End, ends};
use crate::drawing::{CoEdge, Drawing, Graph};

/// Names of the features, in the order of a row.
pub const NAMES: [&str; COUNT] = [
    "parallel same way, straight",
    "parallel opposite way, straight",
    "nearly parallel same way, straight",
    "nearly parallel opposite way, straight",
    "tangents parallel same way, curved",
    "tangents parallel opposite way, curved",
    "tangents parallel same way, mixed",
    "tangents parallel opposite way, mixed",
    "congruent straight",
    "congruent curved",
    "same side of straight edge",
    "same side of curved edge",
    "cycle of 1",
    "cycle of 2",
    "cycle of 3",
    "cycle of 4",
    "cycle of 5",
    "cycle of 6",
    "no short cycle",
    "cycle longer than of others here",
    "cycle longer than of others at first end",
    "cycle longer than of others at second end",
    "edges before and after cross",
    "opposite at a crossing",
    "adjacent at a crossing",
    "smooth at one end",
    "smooth at both ends",
    "straight on at a vertex of degree 4",
    "smooth on at a vertex of degree 4",
    "folds back at a vertex of degree 4",
    "three directions",
];

/// Number of features.
pub const COUNT: usize = 31;

/// A row of features.
pub type Row = [f64; COUNT];

/// Computes the features of every triple.
pub fn features(drawing: &Drawing, graph: &Graph, triples: &Triples) -> Vec<Row> {
    let size = drawing.size().max(f64::MIN_POSITIVE);
    let ends = ends(drawing);
    let cycles = shortest_cycles(graph, triples);
    let crossings = Crossings::new(graph, &ends, size);
    let context = Context {
        drawing,
        graph,
        ends: &ends,
        crossings: &crossings,
        size,
    };
    let mut rows = Vec::with_capacity(triples.len());
    for e in 0..graph.edge_count() {
        let block = triples.of_edge(e);
        let shortest = |f: &dyn Fn(usize) -> bool| {
            block
                .clone()
                .filter(|&t| f(t))
                .map(|t| cycles[t])
                .min()
                .unwrap_or(LONG)
        };
        let all = shortest(&|_| true);
        for t in block.clone() {
            let (before, after) = (triples.before(t), triples.after(t));
            let mut row = [0.0; COUNT];
            context.local(&mut row, before, CoEdge::new(e, false), after);
            let length = cycles[t];
            match length {
                1..=6 => row[11 + usize::from(length)] = 1.0,
                LONG => row[18] = 1.0,
                _ => {}
            }
            let excess = |least: u8| f64::from((length - least).min(4));
            row[19] = excess(all);
            let first = excess(shortest(&|x| triples.before(x) == before));
            let second = excess(shortest(&|x| triples.after(x) == after));
            row[20] = first + second;
            row[21] = first.max(second);
            rows.push(row);
        }
    }
    rows
}

struct Context<'a> {
    drawing: &'a Drawing,
    graph: &'a Graph,
    ends: &'a [End],
    crossings: &'a Crossings,
    size: f64,
}

impl Context<'_> {
    fn local(&self, row: &mut Row, before: CoEdge, edge: CoEdge, after: CoEdge) {
        let end = |c: CoEdge| &self.ends[c.index()];
        let (p, n) = (end(before), end(after));
        let (e, m) = (end(edge), end(edge.mate()));
        let sine = p.tangent.perp_dot(n.tangent).abs();
        let same = p.tangent.dot(n.tangent) > 0.0;
        let way = usize::from(!same);
        let tight = bell(sine, 0.003 + self.noise(p) + self.noise(n));
        match (p.straight, n.straight) {
            (true, true) => {
                row[way] = tight;
                row[2 + way] = bell(sine, 0.03);
            }
            (false, false) => row[4 + way] = bell(sine, 0.03),
            _ => row[6 + way] = bell(sine, 0.03),
        }
        let longer = p.chord.length().max(n.chord.length()).max(1e-3 * self.size);
        let shift = (p.chord - n.chord).length() + (p.bulge - n.bulge).length();
        if p.straight == n.straight && before.edge() != after.edge() {
            row[if p.straight { 8 } else { 9 }] = bell(shift / longer, 0.02);
        }
        let sides = e.tangent.perp_dot(p.tangent).signum() * m.tangent.perp_dot(n.tangent).signum();
        row[if e.straight { 10 } else { 11 }] = -sides;
        row[22] = f64::from(u8::from(self.cross(before, after)));
        let smooth_first = smooth(p, e);
        let smooth_second = smooth(n, m);
        row[25] = smooth_first.max(smooth_second) - smooth_first.min(smooth_second);
        row[26] = smooth_first.min(smooth_second);
        for (at, other, this, s) in [
            (before, edge, p, smooth_first),
            (after, edge.mate(), n, smooth_second),
        ] {
            let v = self.graph.origin(at);
            if self.graph.degree(v) < 4 {
                continue;
            }
            let (i, j) = (self.graph.position(at), self.graph.position(other));
            let (opposite, adjacent) = self.crossings.opposite_and_adjacent(v, i, j);
            row[23] += opposite;
            row[24] += adjacent;
            let that = end(other);
            if this.straight && that.straight {
                row[27] += s;
            } else {
                row[28] += s;
            }
            row[29] += bell(this.tangent.distance(that.tangent), 0.05);
        }
    }

    /// Angle that rounding of coordinates can turn a straight edge by, radians.
    fn noise(&self, end: &End) -> f64 {
        1e-5 * self.size / end.chord.length().max(1e-6 * self.size)
    }

    fn cross(&self, a: CoEdge, b: CoEdge) -> bool {
        let (a, b) = (&self.drawing.edges[a.edge()], &self.drawing.edges[b.edge()]);
        if a.v.iter().any(|v| b.v.contains(v)) {
            return false;
        }
        a.points.windows(2).any(|s| {
            b.points.windows(2).any(|t| {
                let side = |o: glam::DVec2, d: glam::DVec2, x: glam::DVec2| (d - o).perp_dot(x - o);
                side(s[0], s[1], t[0]) * side(s[0], s[1], t[1]) < 0.0
                    && side(t[0], t[1], s[0]) * side(t[0], t[1], s[1]) < 0.0
            })
        })
    }
}

fn smooth(a: &End, b: &End) -> f64 {
    bell((a.tangent + b.tangent).length(), 0.05)
}

/// 1 at 0, falling to 0.6 at `width` and to nothing at three times that.
fn bell(x: f64, width: f64) -> f64 {
    (-0.5 * (x / width).powi(2)).exp()
}
