//! Points along the curve in which surfaces meet, following what is drawn.

use glam::DVec3;

use crate::plan::support::{Support, meet};
use crate::plan::view::View;

use super::drawn::Drawn;

/// Steps along the curve: a cubic spline through that many points of a half turn is within 1e-7 of
/// it, relative to its radius.
const STEPS: usize = 48;

/// How much a jump in depth counts against being off the other surface.
const JUMP: f64 = 0.2;

/// Points on all surfaces, drawn along the edge, from its first vertex to its last.
///
/// Each drawn point is lifted onto one surface, the crossing picked that goes on smoothly and is
/// near the others, and then moved to where all of them meet.
pub(super) fn trace(
    drawn: &Drawn<'_>,
    view: &View,
    surfaces: &[Support],
    ends: [DVec3; 2],
) -> Vec<DVec3> {
    let flat = drawn.points(STEPS);
    let mut points = vec![ends[0]];
    for p in &flat[1..flat.len() - 1] {
        let (from, direction) = view.ray(*p);
        let depth = |q: DVec3| direction.dot(q - from);
        let expected = match points[..] {
            [.., a, b] => 2.0 * depth(b) - depth(a),
            _ => depth(ends[0]),
        };
        let candidates = surfaces.iter().flat_map(|s| s.crossings(from, direction));
        let best = candidates.min_by(|a, b| {
            let cost = |t: f64| {
                let q = from + direction * t;
                let off: f64 = surfaces.iter().map(|s| s.distance(q).abs()).sum();
                off + JUMP * (t - expected).abs()
            };
            cost(*a).total_cmp(&cost(*b))
        });
        if let Some(t) = best {
            points.push(meet(from + direction * t, surfaces));
        }
    }
    points.push(ends[1]);
    points
}
