//! An edge cut in two where a seam ends on it.

use faceformer::drawing::CoEdge;
use faceformer::plan::Curve3;
use glam::DVec3;

use super::{Body, BodyEdge};

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
        Curve3::Points { points } => {
            // A polyline's steps are its points.
            let at = if points.len() == steps + 1 {
                step
            } else {
                step * (points.len() - 1) / steps
            };
            let mut head = points[..=at].to_vec();
            head.push(point);
            let mut tail = vec![point];
            tail.extend_from_slice(&points[at + 1..]);
            (
                Curve3::Points { points: head },
                Curve3::Points { points: tail },
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
