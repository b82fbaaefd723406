//! Local geometry at both ends of every edge.

use glam::DVec2;

use crate::drawing::{Curve2, Drawing, Edge};

/// How an edge looks from one of its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct End {
    /// Unit tangent that leaves the end along the edge; zero for an edge without length.
    pub(super) tangent: DVec2,
    /// Signed curvature there, positive if the edge turns left as it leaves, per drawing unit.
    pub(super) curvature: f64,
    /// From this end to the other one, drawing units.
    pub(super) chord: DVec2,
    /// From the chord's middle to the middle of the edge, drawing units; zero if straight.
    pub(super) bulge: DVec2,
    /// Whether the edge is straight.
    pub(super) straight: bool,
}

/// Ends of all edges, by index of the co-edge that leaves there.
pub(super) fn ends(drawing: &Drawing) -> Vec<End> {
    drawing
        .edges
        .iter()
        .flat_map(|e| [end(e, false), end(e, true)])
        .collect()
}

fn end(edge: &Edge, reversed: bool) -> End {
    let n = edge.points.len();
    let at = |k: usize| edge.points[if reversed { n - 1 - k } else { k }];
    let chord = at(n - 1) - at(0);
    let bulge = middle(edge) - (at(0) + at(n - 1)) / 2.0;
    let (tangent, curvature) = match edge.curve {
        Curve2::Line => (chord.normalize_or_zero(), 0.0),
        Curve2::Ellipse(arc) => {
            let t = arc.start + if reversed { arc.sweep } else { 0.0 };
            let ahead = arc.derivative(t) * arc.sweep.signum() * if reversed { -1.0 } else { 1.0 };
            // Curvature of an ellipse is a b / |derivative|^3.
            let area = arc.major.length_squared() * arc.ratio;
            let turn = if (arc.sweep > 0.0) == reversed {
                -1.0
            } else {
                1.0
            };
            let speed = ahead.length();
            (ahead / speed, turn * area / speed.powi(3))
        }
        Curve2::Polyline => parabola(at(0), at(1), at(2.min(n - 1))),
    };
    End {
        tangent,
        curvature,
        chord,
        bulge: if edge.is_straight() {
            DVec2::ZERO
        } else {
            bulge
        },
        straight: edge.is_straight(),
    }
}

/// Tangent and signed curvature at `a` of the parabola through three points, its parameter the
/// polyline's length: second order, where the first chord is only first order.
fn parabola(a: DVec2, b: DVec2, c: DVec2) -> (DVec2, f64) {
    let (h, k) = (a.distance(b), b.distance(c));
    if h <= 0.0 || k <= 0.0 {
        return ((c - a).normalize_or_zero(), 0.0);
    }
    let (first, second) = ((b - a) / h, (c - b) / k);
    let bend = (second - first) * 2.0 / (h + k);
    let ahead = first - bend * (h / 2.0);
    let speed = ahead.length();
    if speed <= 0.0 {
        return (first, 0.0);
    }
    (ahead / speed, ahead.perp_dot(bend) / speed.powi(3))
}

/// Point half way along a polyline.
fn middle(edge: &Edge) -> DVec2 {
    let mut left = edge.length() / 2.0;
    for w in edge.points.windows(2) {
        let step = w[0].distance(w[1]);
        if step >= left && step > 0.0 {
            return w[0].lerp(w[1], left / step);
        }
        left -= step;
    }
    edge.points[edge.points.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::EllipseArc;

    fn arc(curve: bool) -> Edge {
        let arc = EllipseArc {
            center: DVec2::new(0.3, -0.1),
            major: DVec2::new(1.5, 0.5),
            ratio: 0.4,
            start: 0.4,
            sweep: -2.0,
            residual: 0.0,
            uncertainty: 0.0,
        };
        let points: Vec<DVec2> = (0..=64)
            .map(|k| arc.point(arc.start + arc.sweep * f64::from(k) / 64.0))
            .collect();
        Edge {
            v: [0, 1],
            points,
            curve: if curve {
                Curve2::Ellipse(arc)
            } else {
                Curve2::Polyline
            },
        }
    }

    #[test]
    fn a_polyline_looks_like_the_ellipse_it_samples() {
        for reversed in [false, true] {
            let exact = end(&arc(true), reversed);
            let sampled = end(&arc(false), reversed);
            assert!(exact.tangent.distance(sampled.tangent) < 3e-3);
            let bend = sampled.curvature / exact.curvature;
            assert!((0.8..1.2).contains(&bend), "{bend}");
        }
        let (a, b) = (end(&arc(true), false), end(&arc(true), true));
        assert!(a.curvature * b.curvature < 0.0);
        assert_eq!(a.chord, -b.chord);
        assert_eq!(a.bulge, b.bulge);
    }

    #[test]
    fn an_edge_without_length_is_finite() {
        let edge = Edge {
            v: [0, 0],
            points: vec![DVec2::ONE; 3],
            curve: Curve2::Polyline,
        };
        let e = end(&edge, false);
        assert!(e.tangent == DVec2::ZERO && e.curvature == 0.0 && e.bulge == DVec2::ZERO);
    }
}
