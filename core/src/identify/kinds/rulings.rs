//! What the straight edges of a loop rule out, in an exact drawing.
//!
//! Straight edges of cylinders and cones are rulings. In a parallel projection those of a cylinder are
//! drawn parallel, and two of a cone meet where its apex is drawn: what is parallel is no cone, what
//! is not is no cylinder.

use glam::DVec2;

use crate::drawing::{CoEdge, Curve2, Drawing, Projection, SurfaceKind};

/// Share of its size by which a vertex of an exact drawing may be off.
const OFF: f64 = 1e-5;

/// Sine of the angle up to which long edges are parallel, and beyond which they are not.
const PARALLEL: f64 = 1e-4;
const APART: f64 = 2e-3;

/// The kind of surface that no loop with these straight edges bounds.
pub(crate) fn ruled_out(drawing: &Drawing, walk: &[CoEdge]) -> Option<SurfaceKind> {
    if drawing.projection != Projection::Orthographic {
        return None;
    }
    let off = OFF * drawing.size();
    let lines: Vec<(DVec2, DVec2)> = walk
        .iter()
        .map(|c| &drawing.edges[c.edge()])
        .filter(|e| e.curve == Curve2::Line)
        .map(|e| (e.points[0], e.points[e.points.len() - 1] - e.points[0]))
        .filter(|(_, along)| along.length() > off)
        .collect();
    // Whether all are parallel, and whether there are two rulings.
    let (mut all, mut two) = (true, false);
    for (k, (p, a)) in lines.iter().enumerate() {
        for (q, b) in &lines[..k] {
            let error = 2.0 * off * (1.0 / a.length() + 1.0 / b.length());
            let sine = a.normalize().perp_dot(b.normalize()).abs();
            if sine > APART + error {
                return Some(SurfaceKind::Cylinder);
            }
            all &= sine <= PARALLEL + error;
            // Two pieces of one ruling tell nothing.
            let width = a.normalize().perp_dot(*q - *p).abs();
            two |= width > (PARALLEL + error) * a.length().max(b.length()).max(p.distance(*q));
        }
    }
    (all && two).then_some(SurfaceKind::Cone)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Edge;

    /// A band between two curves, its left side from (0, 0) to (0, 1).
    fn band(right: [DVec2; 2]) -> (Drawing, Vec<CoEdge>) {
        let vertices = vec![DVec2::ZERO, right[0], right[1], DVec2::Y];
        let edge = |v: [usize; 2], curve| {
            let [a, b] = v.map(|k| vertices[k]);
            let points = match curve {
                Curve2::Line => vec![a, b],
                _ => vec![a, (a + b) / 2.0 + DVec2::new(0.0, 0.2), b],
            };
            Edge { v, points, curve }
        };
        let edges = vec![
            edge([0, 1], Curve2::Polyline),
            edge([1, 2], Curve2::Line),
            edge([2, 3], Curve2::Polyline),
            edge([3, 0], Curve2::Line),
        ];
        let drawing = Drawing::orthographic(vertices, edges);
        (drawing, (0..4).map(|e| CoEdge::new(e, false)).collect())
    }

    #[test]
    fn parallel_sides_are_no_cone_and_others_no_cylinder() {
        let (drawing, walk) = band([DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0)]);
        assert_eq!(ruled_out(&drawing, &walk), Some(SurfaceKind::Cone));
        let (drawing, walk) = band([DVec2::new(1.0, 0.0), DVec2::new(0.95, 1.0)]);
        assert_eq!(ruled_out(&drawing, &walk), Some(SurfaceKind::Cylinder));
    }

    #[test]
    fn what_is_hardly_parallel_and_one_ruling_in_two_pieces_tell_nothing() {
        let (drawing, walk) = band([DVec2::new(1.0, 0.0), DVec2::new(1.001, 1.0)]);
        assert_eq!(ruled_out(&drawing, &walk), None);
        let (drawing, walk) = band([DVec2::new(0.0, 2.0), DVec2::new(0.0, 3.0)]);
        assert_eq!(ruled_out(&drawing, &walk), None);
        let central = Drawing {
            projection: Projection::Perspective { focal: None },
            ..band([DVec2::new(1.0, 0.0), DVec2::new(0.95, 1.0)]).0
        };
        assert_eq!(ruled_out(&central, &walk), None);
    }
}
