//! The drawing with its vertices moved.

use super::solve::{Bundle, Fitted};
use crate::drawing::{Curve2, Drawing};

/// Share of the drawing's size within which a circle that is made exact is one.
const EXACT: f64 = 1e-7;

/// The drawing as it was fitted: straight edges between the vertices, arcs on their circles, and
/// other curves moved with their ends.
pub(super) fn applied(drawing: &Drawing, bundle: &Bundle<'_>, fitted: &Fitted) -> Drawing {
    let mut new = drawing.clone();
    new.vertices.clone_from(&fitted.vertices);
    for (e, edge) in new.edges.iter_mut().enumerate() {
        let last = edge.points.len() - 1;
        let ends = edge.v.map(|v| fitted.vertices[v]);
        let steps = [ends[0] - edge.points[0], ends[1] - edge.points[last]];
        let circle = bundle.circle_of(e);
        for (i, p) in edge.points.iter_mut().enumerate() {
            let t = i as f64 / last as f64;
            *p = if edge.curve == Curve2::Line {
                ends[0].lerp(ends[1], t)
            } else {
                let moved = *p + steps[0].lerp(steps[1], t);
                circle.map_or(moved, |c| c.onto(moved))
            };
        }
        (edge.points[0], edge.points[last]) = (ends[0], ends[1]);
        if edge.curve != Curve2::Line {
            let within = match circle {
                Some(_) => EXACT * drawing.size(),
                None => fitted.error,
            };
            let curve = Curve2::recognise_within(&edge.points, within);
            if curve != Curve2::Line {
                edge.curve = curve;
            }
        }
    }
    new
}
