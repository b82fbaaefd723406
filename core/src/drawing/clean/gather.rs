//! Ends of a drawing by hand, gathered into vertices.
//!
//! Where most ends miss those that they were meant to meet, no fixed distance says which belong
//! together. Those nearest to each other are joined first, and never two vertices that are complete
//! already or the two ends of a short edge. How far ends may be apart is the least distance at which
//! about as few are left alone as at any.

use glam::DVec2;

use super::super::grid::PointGrid;
use super::super::{Curve2, FindingKind};
use super::net::Net;
use super::piece::Piece;

/// Share of ends without a partner within the usual reach from which on a drawing is by hand.
const LONELY: f64 = 0.5;

/// No ends farther apart than this share of the drawing's size are joined.
const FARTHEST: f64 = 0.012;

/// Each distance that is tried is so many times the one before.
const STEP: f64 = 1.25;

/// Share of ends that may be left alone beyond the fewest.
const FEW: f64 = 0.02;

/// A curve so many times as long as the distance may close on itself.
const LONG: f64 = 10.0;

/// Ends that make a vertex complete.
const COMPLETE: usize = 3;

/// An end of a piece.
#[derive(Debug, Clone, Copy)]
struct End {
    piece: usize,
    at: DVec2,
}

/// Gives the pieces of a drawing by hand their vertices, and returns how far ends that were joined
/// are apart at most; none if most ends have a partner within `reach`, and nothing is changed then.
pub(super) fn gather(net: &mut Net<'_>, reach: f64, size: f64) -> Option<f64> {
    let ends: Vec<End> = net
        .pieces
        .iter()
        .enumerate()
        .flat_map(|(piece, p)| {
            [0, 1].map(|k| End {
                piece,
                at: p.end(k),
            })
        })
        .collect();
    let places: Vec<DVec2> = ends.iter().map(|e| e.at).collect();
    let grid = PointGrid::new(&places);
    let is_alone = |i: &usize| {
        let at = places[*i];
        let mut others = grid.near(&[at, at], reach).into_iter();
        !others.any(|k| k != *i && at.distance(places[k]) <= reach)
    };
    let alone = (0..ends.len()).filter(is_alone).count();
    if alone as f64 <= LONELY * ends.len() as f64 {
        return None;
    }
    let pairs = pairs(&places, &grid, FARTHEST * size);
    let mut tried: Vec<(f64, usize, Vec<usize>)> = Vec::new();
    let mut limit = reach;
    while limit <= FARTHEST * size {
        let clusters = clusters(&net.pieces, &ends, &pairs, limit);
        tried.push((limit, missing(&ends, &clusters), clusters));
        limit *= STEP;
    }
    let fewest = tried.iter().map(|t| t.1).min()?;
    let enough = fewest + (FEW * ends.len() as f64) as usize;
    let (limit, _, clusters) = tried.into_iter().find(|t| t.1 <= enough)?;
    let mut number = vec![usize::MAX; ends.len()];
    let mut sums: Vec<(DVec2, f64)> = Vec::new();
    for (i, end) in ends.iter().enumerate() {
        let vertex = &mut number[clusters[i]];
        if *vertex == usize::MAX {
            *vertex = sums.len();
            sums.push((DVec2::ZERO, 0.0));
        }
        sums[*vertex].0 += end.at;
        sums[*vertex].1 += 1.0;
        net.pieces[end.piece].v[i % 2] = *vertex;
    }
    net.vertices = sums.iter().map(|(sum, n)| *sum / *n).collect();
    net.follow_vertices();
    let mut joined: Vec<usize> = ends.iter().map(|e| e.piece).collect();
    joined.dedup();
    let sources = joined.iter().flat_map(|&p| net.pieces[p].sources.clone());
    let sources: Vec<usize> = sources.collect();
    let message = format!(
        "ends up to {limit:.1e} apart were joined, as most miss each other; draw them to one point"
    );
    net.note(FindingKind::Snapped, message, sources, Vec::new());
    Some(limit)
}

/// All pairs of places within `reach`, the nearest first.
fn pairs(places: &[DVec2], grid: &PointGrid, reach: f64) -> Vec<(f64, usize, usize)> {
    let mut pairs = Vec::new();
    for (i, &at) in places.iter().enumerate() {
        let others = grid.near(&[at, at], reach).into_iter();
        let others = others.map(|k| (at.distance(places[k]), i, k));
        pairs.extend(others.filter(|&(d, i, k)| k > i && d <= reach));
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    pairs
}

/// The cluster of each end, named by one of its ends; no two ends of one are farther apart than
/// `limit`.
fn clusters(
    pieces: &[Piece],
    ends: &[End],
    pairs: &[(f64, usize, usize)],
    limit: f64,
) -> Vec<usize> {
    let mut cluster: Vec<usize> = (0..ends.len()).collect();
    let mut members: Vec<Vec<usize>> = (0..ends.len()).map(|i| vec![i]).collect();
    for &(_, i, k) in pairs.iter().take_while(|p| p.0 <= limit) {
        let (a, b) = (cluster[i], cluster[k]);
        if a == b || members[a].len() >= COMPLETE && members[b].len() >= COMPLETE {
            continue;
        }
        let fits = |p: usize, q: usize| {
            let (p, q) = (ends[p], ends[q]);
            let may_close = p.piece != q.piece || {
                let piece = &pieces[p.piece];
                piece.curve != Curve2::Line && piece.length() > LONG * limit
            };
            may_close && p.at.distance(q.at) <= limit
        };
        let all = |p: &usize| members[b].iter().all(|&q| fits(*p, q));
        if members[a].iter().all(all) {
            let moved = std::mem::take(&mut members[b]);
            moved.iter().for_each(|&q| cluster[q] = a);
            members[a].extend(moved);
        }
    }
    cluster
}

/// What is missing: ends alone, and half as much those in pairs, but for the two of one curve.
fn missing(ends: &[End], clusters: &[usize]) -> usize {
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); ends.len()];
    for (i, &c) in clusters.iter().enumerate() {
        members[c].push(ends[i].piece);
    }
    let missing = members.iter().map(|m| match m[..] {
        [_] => 2,
        [a, b] if a != b => 2,
        _ => 0,
    });
    missing.sum::<usize>() / 2
}
