//! Points along the plan's curves.

use glam::DVec3;

use super::conic::Conic;
use super::{Curve3, PlanEdge};

/// Points along an edge from its first vertex to its last, both included: two for a line, `steps`
/// and one more for a circle or ellipse, the points themselves else.
pub fn polyline(edge: &PlanEdge, vertices: &[DVec3], steps: usize) -> Vec<DVec3> {
    let [start, end] = edge.v.map(|v| vertices[v]);
    match (&edge.curve, Conic::of(&edge.curve, start)) {
        (Curve3::Points { points, .. }, _) => points.clone(),
        (_, None) => vec![start, end],
        (_, Some(conic)) => arc(&conic, start, end, edge.v[0] == edge.v[1], steps),
    }
}

/// Points along an arc at equal steps of the parameter; the ends are the points given.
pub(super) fn arc(
    conic: &Conic,
    start: DVec3,
    end: DVec3,
    whole: bool,
    steps: usize,
) -> Vec<DVec3> {
    let (first, sweep) = conic.range(start, end, whole);
    let inner = (1..steps).map(|i| conic.point(first + sweep * i as f64 / steps as f64));
    let mut points = vec![start];
    points.extend(inner);
    points.push(end);
    points
}
