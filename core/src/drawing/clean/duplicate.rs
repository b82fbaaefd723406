//! Pieces that lie on each other become one.

use std::collections::HashMap;

use super::super::{Curve2, FindingKind};
use super::net::{Net, union};
use super::piece::Piece;

/// Merges pieces with the same ends and, to within `reach`, the same curve.
pub(super) fn merge_duplicates(net: &mut Net<'_>, reach: f64) {
    let mut by_ends: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
    let mut kept: Vec<Piece> = Vec::with_capacity(net.pieces.len());
    for piece in std::mem::take(&mut net.pieces) {
        let [a, b] = piece.v;
        let same_ends = by_ends.entry([a.min(b), a.max(b)]).or_default();
        let twin = same_ends
            .iter()
            .copied()
            .find(|&k| lie_on_each_other(&kept[k], &piece, reach));
        let Some(k) = twin else {
            same_ends.push(kept.len());
            kept.push(piece);
            continue;
        };
        let all = union(&kept[k].sources, &piece.sources);
        if all.len() > kept[k].sources.len() {
            let message = format!(
                "{} lie on each other and were made one; delete all but one",
                net.names(&all)
            );
            net.note(
                FindingKind::Duplicate,
                message,
                all.clone(),
                piece.points.clone(),
            );
        }
        if says_more(&piece, &kept[k]) {
            let turned = piece.v != kept[k].v;
            kept[k] = if turned { piece.reversed() } else { piece };
        }
        kept[k].sources = all;
    }
    net.pieces = kept;
}

/// Whether two pieces with the same ends are the same curve.
fn lie_on_each_other(a: &Piece, b: &Piece, reach: f64) -> bool {
    let lines = matches!((&a.curve, &b.curve), (Curve2::Line, Curve2::Line));
    lines || (a.lies_on(b, reach) && b.lies_on(a, reach))
}

/// Whether the curve of `a` is the better known one of two twins.
fn says_more(a: &Piece, b: &Piece) -> bool {
    match (&a.curve, &b.curve) {
        (Curve2::Ellipse(x), Curve2::Ellipse(y)) => x.uncertainty < y.uncertainty,
        (Curve2::Ellipse(_), Curve2::Polyline) => true,
        (Curve2::Polyline, Curve2::Polyline) => a.points.len() > b.points.len(),
        _ => false,
    }
}
