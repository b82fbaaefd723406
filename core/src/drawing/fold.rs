//! How edges leave their vertices, and which are drawn like outlines of curved surfaces.

use glam::DVec2;

use super::{CoEdge, Curve2, Drawing};

/// Sine of the angle within which edges go on smoothly into each other.
const SMOOTH: f64 = 0.25;

impl Drawing {
    /// Unit tangent with which a co-edge leaves its origin.
    pub(crate) fn tangent(&self, c: CoEdge) -> DVec2 {
        let edge = &self.edges[c.edge()];
        let n = edge.points.len();
        let at = |k: usize| edge.points[if c.is_reversed() { n - 1 - k } else { k }];
        match edge.curve {
            Curve2::Line => (at(n - 1) - at(0)).normalize_or_zero(),
            Curve2::Ellipse(arc) => {
                let t = arc.start + if c.is_reversed() { arc.sweep } else { 0.0 };
                let sense = arc.sweep.signum() * if c.is_reversed() { -1.0 } else { 1.0 };
                arc.derivative(t).normalize_or_zero() * sense
            }
            Curve2::Polyline => {
                // Of the parabola through three points, its parameter the polyline's length.
                let (a, b, c) = (at(0), at(1), at(2.min(n - 1)));
                let (h, k) = (a.distance(b), b.distance(c));
                if h <= 0.0 || k <= 0.0 {
                    return (c - a).normalize_or_zero();
                }
                let (first, second) = ((b - a) / h, (c - b) / k);
                (first - (second - first) * (h / (h + k))).normalize_or_zero()
            }
        }
    }

    /// Whether an edge is drawn like an outline: it leaves the edges at its ends by the tangent, as a
    /// fold does, or is closed and meets no other edge.
    pub(crate) fn is_fold(&self, edge: usize) -> bool {
        let [a, b] = self.edges[edge].v;
        let at = |v: usize| {
            let leaving = |e: usize| self.tangent(CoEdge::new(e, self.edges[e].v[0] != v));
            let own = leaving(edge);
            let others = (0..self.edges.len()).filter(|&e| e != edge && self.edges[e].v.contains(&v));
            let mut count = 0;
            let mut smooth = true;
            for e in others {
                count += 1;
                smooth &= leaving(e).perp_dot(own).abs() < SMOOTH;
            }
            smooth && (count >= 2 || (count == 0 && a == b))
        };
        at(a) && at(b)
    }
}
