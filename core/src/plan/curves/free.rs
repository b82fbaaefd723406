//! Edges between two surfaces that say nothing.

use glam::DVec3;

use crate::drawing::Curve2;
use crate::plan::conic::Conic;
use crate::plan::lengths::Lengths;
use crate::plan::view::View;
use crate::plan::{Curve3, PlanError};

use super::drawn::Drawn;
use super::{Place, fitted};

/// Points along the curve.
const STEPS: usize = 24;

/// The curve of an edge that only its ends fix in space: a circle if it is drawn as one can be
/// through them, else a curve whose depth changes evenly along the chord.
pub(super) fn free(
    place: &Place<'_>,
    drawn: &Drawn<'_>,
    view: &View,
    lengths: Lengths,
) -> Result<Curve3, PlanError> {
    let [start, end] = place.ends;
    let chord = end - start;
    if let (Curve2::Ellipse(arc), true) = (&place.drawn.curve, view.is_parallel())
        && arc.ratio < 0.999
        && arc.uncertainty < 1e-3
        && chord.length() > lengths.limit
    {
        let slant = (1.0 - arc.ratio * arc.ratio).sqrt();
        let side = arc.minor().normalize() * slant;
        let normals = [side.extend(arc.ratio), (-side).extend(arc.ratio)];
        let normals = normals.map(|n| view.rotation() * n);
        let off = normals.map(|n| chord.normalize().dot(n).abs());
        let best = usize::from(off[1] < off[0]);
        if off[best] < 0.01 {
            // Across the chord by what is left, so that both ends are on the circle.
            let normal = normals[best]
                .reject_from_normalized(chord.normalize())
                .normalize();
            let (from, toward) = view.ray(arc.center);
            let t = normal.dot(start - from) / normal.dot(toward);
            let center = from + toward * t;
            if let Some(conic) = Conic::around(center, normal, start) {
                return fitted(place, drawn, conic, lengths);
            }
        }
    }
    let flat = drawn.points(STEPS);
    let mut along = vec![0.0];
    for pair in flat.windows(2) {
        along.push(along[along.len() - 1] + pair[0].distance(pair[1]));
    }
    let total = along[along.len() - 1];
    let (from, toward) = view.ray(flat[0]);
    let depth = |p: DVec3| toward.dot(p - from);
    let (first, last) = (depth(start), depth(end));
    let mut points: Vec<DVec3> = flat
        .iter()
        .zip(&along)
        .map(|(p, s)| {
            let (from, toward) = view.ray(*p);
            from + toward * (first + (last - first) * s / total)
        })
        .collect();
    let count = points.len();
    points[0] = start;
    points[count - 1] = end;
    Ok(Curve3::Points {
        points,
        tangents: None,
    })
}
