//! How edges leave their vertices, and which are drawn like outlines of curved surfaces.

use glam::DVec2;

use super::{CoEdge, Curve2, Drawing};

/// Sine of the angle within which edges go on smoothly into each other.
const SMOOTH: f64 = 0.25;

/// Unit tangent with which a polyline leaves the first of three points: that of the parabola through
/// them whose parameter is the polyline's length.
pub(crate) fn leaving([a, b, c]: [DVec2; 3]) -> DVec2 {
    let (h, k) = (a.distance(b), b.distance(c));
    if h <= 0.0 || k <= 0.0 {
        return (c - a).normalize_or_zero();
    }
    let (first, second) = ((b - a) / h, (c - b) / k);
    (first - (second - first) * (h / (h + k))).normalize_or_zero()
}

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
            Curve2::Polyline => leaving([at(0), at(1), at(2.min(n - 1))]),
        }
    }

    /// Whether an edge is drawn like an outline: it leaves the edges at its ends by the tangent, as a
    /// fold does, or is closed and meets no other edge.
    pub(crate) fn is_fold(&self, edge: usize) -> bool {
        let [a, b] = self.edges[edge].v;
        let at = |v: usize| {
            let leaving = |e: usize| self.tangent(CoEdge::new(e, self.edges[e].v[0] != v));
            let own = leaving(edge);
            let others =
                (0..self.edges.len()).filter(|&e| e != edge && self.edges[e].v.contains(&v));
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

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    use super::*;
    use crate::drawing::Edge;

    /// Two circles, cut in two by the ends of an outline, and a circle that one of them meets.
    #[test]
    fn an_outline_leaves_by_the_tangent() {
        let arc = |center: DVec2, from: f64, to: f64| -> Vec<DVec2> {
            let at = |k: i32| from + (to - from) * f64::from(k) / 16.0;
            let point = |k: i32| center + DVec2::from_angle(at(k));
            (0..=16).map(point).collect()
        };
        let (low, high) = (DVec2::X, DVec2::new(1.3, 2.0));
        let bow = |k: i32| {
            let t = f64::from(k) / 16.0;
            // Both ends are upright.
            low.lerp(high, t) + DVec2::X * (0.3 * t * (1.0 - t) * (2.0 * t - 1.0))
        };
        let center = high - DVec2::X;
        let curves = [
            ([0, 1], arc(DVec2::ZERO, 0.0, FRAC_PI_2)),
            ([1, 0], arc(DVec2::ZERO, FRAC_PI_2, TAU)),
            ([0, 2], (0..=16).map(bow).collect()),
            ([2, 3], arc(center, 0.0, PI)),
            ([3, 2], arc(center, PI, TAU)),
            ([1, 1], arc(DVec2::new(-1.0, 1.0), 0.0, TAU)),
        ];
        let edges: Vec<Edge> = curves
            .into_iter()
            .map(|(v, points)| Edge::drawn(v, points))
            .collect();
        let vertices = vec![low, DVec2::Y, high, center - DVec2::X];
        let drawing = Drawing::orthographic(vertices, edges);
        let ahead = drawing.tangent(CoEdge::new(2, false));
        assert!(ahead.x.abs() < 0.05, "{ahead}");
        let back = drawing.tangent(CoEdge::new(0, true));
        assert!(back.distance(DVec2::X) < 1e-6, "{back}");
        assert!(drawing.is_fold(2));
        // At its other end a circle is met at right angles.
        assert!(!drawing.is_fold(0));
    }
}
