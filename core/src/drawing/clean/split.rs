//! Pieces are cut where others end on them.

use std::collections::{BTreeMap, HashMap};

use glam::DVec2;

use super::super::grid::PointGrid;
use super::super::{Curve2, DrawingError, FindingKind};
use super::net::{self, Net, union};
use super::piece::{Foot, Piece};

/// Most touches of a drawing: several for each of the most edges that it may have.
const MOST_TOUCHES: usize = 50_000;

/// A vertex on the inside of a piece that does not end there.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Touch {
    pub(in super::super) piece: usize,
    pub(in super::super) vertex: usize,
    pub(in super::super) foot: Foot,
}

/// All touches within `reach`, but no more than `limit`. A vertex nearer than `margin` to the
/// piece's ends is not on its inside.
pub(in super::super) fn touches(
    pieces: &[Piece],
    vertices: &[DVec2],
    reach: f64,
    margin: f64,
    limit: usize,
) -> Vec<Touch> {
    let grid = PointGrid::new(vertices);
    let mut found = Vec::new();
    for (piece, p) in pieces.iter().enumerate() {
        // A polyline's chords miss its curve by up to a per cent of its size.
        let missed = if p.points.len() > 2 {
            sag(&p.points)
        } else {
            0.0
        };
        for vertex in grid.near(&p.points, reach + missed) {
            let at = vertices[vertex];
            let inside = |end: usize| vertices[end].distance(at) > margin;
            if p.v.contains(&vertex) || !p.v.iter().all(|&end| inside(end)) {
                continue;
            }
            let foot = p.foot(at);
            if foot.distance <= reach && foot.u > 0.0 && foot.u < 1.0 {
                found.push(Touch {
                    piece,
                    vertex,
                    foot,
                });
                if found.len() == limit {
                    return found;
                }
            }
        }
    }
    found
}

/// Largest second difference of a polyline: more than its chords can miss a smooth curve by.
fn sag(points: &[DVec2]) -> f64 {
    points
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).length())
        .fold(0.0, f64::max)
}

/// Whether `other`, which ends at the touching vertex, runs along `piece` from there, and not only
/// crosses or leaves it.
pub(in super::super) fn runs_along(
    piece: &Piece,
    touch: &Touch,
    other: &Piece,
    reach: f64,
) -> bool {
    // A line that leaves an arc by the tangent, as a silhouette does, is near it for a while.
    let line = |p: &Piece| matches!(p.curve, Curve2::Line);
    if line(piece) != line(other) {
        return false;
    }
    let ends = (0..2).filter(|&end| other.v[end] == touch.vertex);
    ends.into_iter().any(|end| {
        let sign = if end == 0 { 1.0 } else { -1.0 };
        let leaving = other.tangent(end as f64) * sign;
        let forward = leaving.dot(piece.tangent(touch.foot.u)) > 0.0;
        let rest = if forward {
            1.0 - touch.foot.u
        } else {
            touch.foot.u
        };
        let share = (rest * piece.length() / other.length()).min(1.0);
        share * other.length() > 4.0 * reach
            && [0.45, 0.9].iter().all(|f| {
                let at = other.point(end as f64 + sign * share * f);
                piece.foot(at).distance <= reach
            })
    })
}

/// Cuts pieces at the ends of others that lie on them along a stretch, so that the common stretch
/// becomes a pair of duplicates. No parts shorter than `margin` come off: the ends of twins miss
/// each other by as much. Ends at complete vertices cut nothing: from some directions one edge of a
/// solid is seen before another.
///
/// # Errors
/// [`DrawingError::TooLarge`] if so many ends lie on edges that cutting would multiply the edges.
pub(super) fn split_overlaps(
    net: &mut Net<'_>,
    reach: f64,
    margin: f64,
) -> Result<(), DrawingError> {
    let incidence = net.incidence();
    let mut cuts = all_touches(net, reach, margin)?;
    let wanting = net.wanting();
    cuts.retain(|t| {
        let piece = &net.pieces[t.piece];
        let along = |&i: &usize| i != t.piece && runs_along(piece, t, &net.pieces[i], reach);
        wanting[t.vertex] && incidence[t.vertex].iter().any(along)
    });
    split(net, &cuts, reach);
    Ok(())
}

/// Cuts pieces where a vertex that wants more edges lies on them, and moves that vertex onto the
/// piece. A vertex that is complete without it only seems to lie there in the projection.
///
/// # Errors
/// [`DrawingError::TooLarge`] if so many ends lie on edges that cutting would multiply the edges.
pub(super) fn split_at_ends(net: &mut Net<'_>, reach: f64, exact: f64) -> Result<(), DrawingError> {
    let wanting = net.wanting();
    let mut nearest: HashMap<usize, f64> = HashMap::new();
    let mut cuts = all_touches(net, reach, reach)?;
    cuts.retain(|t| wanting[t.vertex]);
    for t in &cuts {
        let d = nearest.entry(t.vertex).or_insert(f64::INFINITY);
        *d = d.min(t.foot.distance);
    }
    cuts.retain(|t| t.foot.distance <= nearest[&t.vertex] + exact);
    let incidence = net.incidence();
    for t in &cuts {
        let piece = &net.pieces[t.piece];
        let ends: Vec<usize> = incidence[t.vertex]
            .iter()
            .flat_map(|&i| net.pieces[i].sources.clone())
            .collect();
        let ends = union(&ends, &[]);
        let place = piece.point(t.foot.u);
        let message = format!(
            "{} was cut where {} {} on it; draw a vertex there",
            net::joint_name(net.labels, &piece.sources),
            net.names(&ends),
            if ends.len() == 1 { "ends" } else { "end" }
        );
        let edges = union(&ends, &piece.sources);
        net.note(FindingKind::Split, message, edges, vec![place]);
        net.vertices[t.vertex] = place;
    }
    split(net, &cuts, exact);
    net.follow_vertices();
    Ok(())
}

fn all_touches(net: &Net<'_>, reach: f64, margin: f64) -> Result<Vec<Touch>, DrawingError> {
    let found = touches(&net.pieces, &net.vertices, reach, margin, MOST_TOUCHES);
    if found.len() == MOST_TOUCHES {
        return Err(DrawingError::TooLarge {
            what: "ends on the inside of edges",
            found: found.len(),
            limit: MOST_TOUCHES,
        });
    }
    Ok(found)
}

/// Cuts the touched pieces; cuts nearer to each other than `apart` are one.
fn split(net: &mut Net<'_>, cuts: &[Touch], apart: f64) {
    // In order, so that the same input gives the same numbers.
    let mut by_piece: BTreeMap<usize, Vec<(f64, usize, DVec2)>> = BTreeMap::new();
    for t in cuts {
        let stop = (t.foot.u, t.vertex, net.vertices[t.vertex]);
        by_piece.entry(t.piece).or_default().push(stop);
    }
    for (i, mut stops) in by_piece {
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        stops.dedup_by(|b, a| a.2.distance(b.2) <= apart);
        let mut parts = net.pieces[i].split(&stops);
        if let Some(first) = parts.pop() {
            net.pieces[i] = first;
            net.pieces.append(&mut parts);
        }
    }
}
