//! Pairs of loops that may be one face.

use glam::DVec2;

use super::shapes::{Outline, Shapes};
use crate::lift::Tilt;

/// Sine of the angle between normals up to which planes are parallel.
pub(super) const PARALLEL: f64 = 5e-3;

/// Share of the inner loop's points that must be drawn inside the outer one.
const INSIDE: f64 = 0.9;

/// Distance from a drawn axis, relative to the drawing's size, up to which a centre is on it.
const ON_AXIS: f64 = 2e-3;

/// Points of a loop that are looked at.
const POINTS: usize = 32;

/// What makes two loops one face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LinkKind {
    /// One plane.
    Coplanar,
    /// One surface of revolution without a silhouette between two circles.
    Coaxial,
}

/// Two loops that may be one face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Link {
    pub(super) kind: LinkKind,
    pub(super) outer: usize,
    pub(super) inner: usize,
    /// Depth that the inner loop's part moves, against the outer one's, to be in the same face.
    pub(super) offset: f64,
    /// Whether both loops are walked in the same sense, so that one part has to be turned over.
    pub(super) same_sense: bool,
    /// Whether two circles would be in one plane although they are drawn around one axis.
    pub(super) doubtful: bool,
}

/// All pairs of loops that may be one face, also of one part.
pub(super) fn links(shapes: &Shapes) -> Vec<Link> {
    let mut links = Vec::new();
    let slack = DVec2::splat(1e-6 * shapes.size);
    for (i, a) in shapes.loops.iter().enumerate() {
        for (j, b) in shapes.loops.iter().enumerate() {
            let apart = b.low.cmplt(a.low - slack).any() || b.high.cmpgt(a.high + slack).any();
            if i == j || apart || b.area.abs() >= a.area.abs() {
                continue;
            }
            let coplanar = parallel(a, b).map(|(p, q)| {
                let middle = (b.low + b.high) / 2.0;
                p.level(middle) - q.level(middle)
            });
            let coaxial = coaxial(shapes, a, b);
            if coplanar.is_none() && coaxial.is_none() || inside(a, b) < INSIDE {
                continue;
            }
            let doubtful = match (coplanar, coaxial) {
                (Some(p), Some(q)) => (p - q).abs() > shapes.tolerance,
                _ => false,
            };
            let link = |kind, offset| Link {
                kind,
                outer: i,
                inner: j,
                offset,
                same_sense: a.area * b.area > 0.0,
                doubtful,
            };
            links.extend(coplanar.map(|offset| link(LinkKind::Coplanar, offset)));
            if coplanar.is_none() || doubtful {
                links.extend(coaxial.map(|offset| link(LinkKind::Coaxial, offset)));
            }
        }
    }
    links
}

fn parallel(a: &Outline, b: &Outline) -> Option<(Tilt, Tilt)> {
    let (p, q) = (a.plane?, b.plane?);
    (p.normal().cross(q.normal()).length() < PARALLEL).then_some((p, q))
}

/// Offset in depth that puts two loops' axes into one line, if they are drawn so.
fn coaxial(shapes: &Shapes, a: &Outline, b: &Outline) -> Option<f64> {
    let (p, q) = (a.line?, b.line?);
    if p.axis != q.axis {
        return None;
    }
    let axis = shapes.axes[p.axis];
    let drawn = shapes.camera.drawn(axis, p.at);
    let length = drawn.length();
    let apart = q.at - p.at;
    if length < 1e-3 || apart.perp_dot(drawn).abs() > ON_AXIS * shapes.size * length {
        return None;
    }
    Some(p.depth + shapes.camera.climb(axis, p.at, q.at) - q.depth)
}

/// Share of loop `b`'s points drawn inside loop `a`.
fn inside(a: &Outline, b: &Outline) -> f64 {
    let step = b.polygon.len().div_ceil(POINTS).max(1);
    let points = b.polygon.iter().step_by(step);
    let count = points.len();
    let hits = points.filter(|p| a.contains(**p)).count();
    hits as f64 / count.max(1) as f64
}
