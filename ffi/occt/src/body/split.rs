//! An edge cut in two where a seam ends on it.

use faceformer::drawing::CoEdge;
use faceformer::plan::Curve3;
use glam::DVec3;

use super::{Body, BodyEdge};

/// A point closer to a cut than this share of its distance from the next one is left out.
const CROWDED: f64 = 0.3;

/// Cuts an edge at a point of it, which lies on step `step` of `steps` along it or on the stretch
/// after it, and returns the new vertex.
pub(super) fn split(
    body: &mut Body,
    edge: usize,
    point: DVec3,
    step: usize,
    steps: usize,
) -> usize {
    let vertex = body.vertices.len();
    body.vertices.push(point);
    let second = body.edges.len();
    let old = body.edges[edge].clone();
    let (before, after) = match old.curve {
        Curve3::Points { points, tangents } => {
            // A polyline's steps are its points.
            let at = if points.len() == steps + 1 {
                step
            } else {
                step * (points.len() - 1) / steps
            };
            let middle = (points[at + 1] - points[at]).normalize_or_zero();
            // Points crowded at the cut would make the curve through them wave.
            let room = CROWDED * points[at].distance(points[at + 1]);
            let near = |p: &DVec3| p.distance(point) < room;
            let mut head = points[..=at].to_vec();
            if head.len() > 1 && head.last().is_some_and(near) {
                head.pop();
            }
            head.push(point);
            let mut tail = points[at + 1..].to_vec();
            if tail.len() > 1 && tail.first().is_some_and(near) {
                tail.remove(0);
            }
            tail.insert(0, point);
            (
                Curve3::Points {
                    tangents: tangents.map(|t| [t[0], middle]),
                    points: head,
                },
                Curve3::Points {
                    tangents: tangents.map(|t| [middle, t[1]]),
                    points: tail,
                },
            )
        }
        curve => (curve.clone(), curve),
    };
    body.edges[edge] = BodyEdge {
        v: [old.v[0], vertex],
        curve: before,
        source: old.source,
    };
    body.edges.push(BodyEdge {
        v: [vertex, old.v[1]],
        curve: after,
        source: old.source,
    });
    for walk in body.faces.iter_mut().flat_map(|f| &mut f.loops) {
        let mut i = 0;
        while i < walk.len() {
            if walk[i].edge() == edge {
                let back = walk[i].is_reversed();
                let other = CoEdge::new(second, back);
                walk.insert(if back { i } else { i + 1 }, other);
                i += 1;
            }
            i += 1;
        }
    }
    vertex
}
