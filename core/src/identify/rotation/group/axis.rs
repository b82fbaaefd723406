//! The axes that circles and surfaces of revolution are around, as drawn and lifted.

use glam::DVec2;

use crate::drawing::{Curve2, Drawing};
use crate::identify::Face;
use crate::lift::{Pieces, Tilt, circle_through};

/// The line that a loop's circles are around.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisLine {
    /// Which axis it follows.
    pub(super) axis: usize,
    /// Where a point of it is drawn.
    pub(super) at: DVec2,
    /// Level of that point in its part.
    pub(super) depth: f64,
}

/// Whether all edges of a loop are on one circle that they go around.
pub(super) fn is_ring(drawing: &Drawing, pieces: &Pieces, face: &Face) -> bool {
    let mut sweep = 0.0;
    let mut first: Option<(usize, DVec2, f64)> = None;
    for c in face.loops.iter().flatten() {
        let (Curve2::Ellipse(arc), Some((axis, circle))) =
            (drawing.edges[c.edge()].curve, pieces.circle(c.edge()))
        else {
            return false;
        };
        sweep += arc.sweep.abs();
        let (k, center, radius) = *first.get_or_insert((axis, circle.center, circle.radius));
        let off = center
            .distance(circle.center)
            .max((radius - circle.radius).abs());
        if k != axis || off > 0.05 * radius {
            return false;
        }
    }
    (sweep - std::f64::consts::TAU).abs() < 0.05
}

/// The plane of a loop that is a whole circle, unless it is seen from its edge.
pub(super) fn ring_plane(drawing: &Drawing, pieces: &Pieces, face: &Face) -> Option<Tilt> {
    let edge = face.loops.iter().flatten().next()?.edge();
    let (axis, _) = pieces.circle(edge)?;
    let v = drawing.edges[edge].v[0];
    let (normal, at) = (pieces.axes[axis], drawing.vertices[v]);
    Tilt::across(pieces.camera, normal, at, pieces.height(v))
}

/// Axis of the best shown circle of a loop without lines.
pub(super) fn axis_line(drawing: &Drawing, pieces: &Pieces, face: &Face) -> Option<AxisLine> {
    let edges = || face.loops.iter().flatten().map(|c| c.edge());
    if edges().any(|e| drawing.edges[e].is_straight()) {
        return None;
    }
    let circles = edges().filter_map(|e| pieces.circle(e).map(|c| (e, c)));
    let best = circles.min_by(|a, b| a.1.1.gain.total_cmp(&b.1.1.gain));
    if let Some((e, (axis, circle))) = best {
        return Some(AxisLine {
            axis,
            at: circle.center,
            depth: level_across(drawing, pieces, e, axis, circle.center),
        });
    }
    if let [only] = face.loops.concat().as_slice() {
        return silhouette_axis(drawing, pieces, only.edge());
    }
    // Corners on a circle, as where a cone cuts the sides of a prism.
    let corners: Vec<DVec2> = edges()
        .map(|e| drawing.edges[e].v[0])
        .map(|v| drawing.vertices[v])
        .collect();
    if corners.len() < 4 {
        return None;
    }
    let first = edges().next()?;
    pieces.axes.iter().enumerate().find_map(|(axis, &n)| {
        let circle = circle_through(&corners, n, &pieces.camera)?;
        let close = circle.residual < 1e-3 * circle.radius;
        close.then(|| AxisLine {
            axis,
            at: circle.center,
            depth: level_across(drawing, pieces, first, axis, circle.center),
        })
    })
}

/// Level of a point in the plane across an axis that an edge begins in.
fn level_across(drawing: &Drawing, pieces: &Pieces, edge: usize, axis: usize, at: DVec2) -> f64 {
    let v = drawing.edges[edge].v[0];
    let across = pieces
        .camera
        .across(pieces.axes[axis], drawing.vertices[v], at);
    let height = (across.from * pieces.height(v) + across.rise) / across.to;
    pieces.camera.level(height)
}

/// Axis of a closed silhouette, which is its own mirror image on the other side of the drawn axis.
/// Its depth is not known: the place on the axis stands for it.
fn silhouette_axis(drawing: &Drawing, pieces: &Pieces, edge: usize) -> Option<AxisLine> {
    let points = &drawing.edges[edge].points;
    let (low, high) = points
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| {
            (l.min(*p), h.max(*p))
        });
    let mut best: Option<(f64, AxisLine)> = None;
    for (axis, direction) in pieces.axes.iter().enumerate() {
        let along = pieces.camera.drawn(*direction, (low + high) / 2.0);
        let along = along.normalize_or_zero();
        let ends = |d: DVec2| {
            let (p, q) = points
                .iter()
                .map(|p| p.dot(d))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                    (l.min(x), h.max(x))
                });
            (p + q) / 2.0
        };
        let at = along * ends(along) + along.perp() * ends(along.perp());
        let far = points
            .iter()
            .map(|p| {
                let d = *p - at;
                let image = at + d - along.perp() * (2.0 * d.dot(along.perp()));
                nearest(points, image)
            })
            .fold(0.0, f64::max);
        if far < 0.01 * (high - low).length() && best.as_ref().is_none_or(|b| far < b.0) {
            let height = pieces.height(drawing.edges[edge].v[0]);
            let depth = pieces.camera.level(height);
            best = Some((far, AxisLine { axis, at, depth }));
        }
    }
    best.map(|b| b.1)
}

/// Distance of a point from a polyline.
fn nearest(points: &[DVec2], p: DVec2) -> f64 {
    let spans = points.windows(2).map(|w| {
        let d = w[1] - w[0];
        let t = (p - w[0]).dot(d) / d.length_squared().max(f64::MIN_POSITIVE);
        p.distance_squared(w[0] + d * t.clamp(0.0, 1.0))
    });
    spans.fold(f64::INFINITY, f64::min).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::group;
    use super::super::round::{Round, drawn};
    use crate::drawing::{Graph, SurfaceKind};
    use crate::lift::Readings;

    /// A hole, one of whose ends looks as if it bounded a cone.
    #[test]
    fn a_circle_is_in_a_plane_whatever_it_looks_like() {
        let cylinder = |x: f64, radius: f64| Round::cylinder([x, 0.5], radius, 0.0, 0.5);
        let (drawing, mut loops) = drawn(&[cylinder(0.0, 2.0), cylinder(1.0, 0.3)]);
        loops[4].kind = SurfaceKind::Cone;
        let found = group(&Readings::new(&drawing), &Graph::new(&drawing), &loops);
        let mut joined = found[0].faces.clone();
        joined.retain(|f| f.len() > 1);
        assert_eq!(joined, [[0, 4], [1, 5]]);
    }
}
