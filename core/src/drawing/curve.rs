//! Plane curves of edges: lines, elliptic arcs, and the rest as polylines.

use glam::DVec2;
use serde::{Deserialize, Serialize};

/// What an edge's polyline was recognised as.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Curve2 {
    /// A straight segment between the edge's vertices.
    Line,
    /// An arc of an ellipse or circle, or a whole one.
    Ellipse(EllipseArc),
    /// None of the above within tolerance: the polyline is the curve.
    Polyline,
}

/// An arc of an ellipse, `center + cos(t) major + sin(t) minor` for `t` from `start` to
/// `start + sweep`; `minor` is `major` turned a quarter counter-clockwise, times `ratio`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EllipseArc {
    /// Centre, in drawing units.
    pub center: DVec2,
    /// Semi-major axis as a vector, in drawing units.
    pub major: DVec2,
    /// Minor over major semi-axis, in (0, 1]; 1 for a circle.
    pub ratio: f64,
    /// Parameter of the edge's first vertex, radians.
    pub start: f64,
    /// Signed parameter length, radians; positive is counter-clockwise, at most 2 pi in magnitude.
    pub sweep: f64,
    /// Largest distance of the edge's points from the fitted ellipse, in drawing units.
    pub residual: f64,
    /// Standard uncertainty that the points' scatter leaves, the larger of the relative one of the
    /// major axis and the one of `ratio`; at most 1.
    ///
    /// Points rounded to 1e-6 leave about 1e-6 at half a turn, 1e-4 at 70 degrees, 1e-2 at 30
    /// degrees, and below 15 degrees the curve is known but its axes are not.
    #[serde(default)]
    pub uncertainty: f64,
}

impl EllipseArc {
    /// Semi-minor axis as a vector.
    pub fn minor(&self) -> DVec2 {
        self.major.perp() * self.ratio
    }

    /// Point at parameter `t`, radians.
    pub fn point(&self, t: f64) -> DVec2 {
        self.center + self.major * t.cos() + self.minor() * t.sin()
    }

    /// Parameter of the point of the ellipse in the affine direction of `p`, -pi to pi.
    pub fn parameter(&self, p: DVec2) -> f64 {
        let q = p - self.center;
        self.minor()
            .dot(q)
            .atan2(self.major.dot(q) * self.ratio.powi(2))
    }

    /// Derivative of [`point`](Self::point) by `t`.
    pub fn derivative(&self, t: f64) -> DVec2 {
        self.minor() * t.cos() - self.major * t.sin()
    }
}
