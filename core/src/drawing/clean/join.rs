//! Pieces that continue each other become one.

use std::mem;

use glam::DVec2;

use super::super::{Curve2, FindingKind};
use super::net::{Net, union};
use super::piece::Piece;

/// Largest turn between two pieces of one curve where they meet; a coarse polyline's first chord
/// is off by half a step.
const LARGEST_TURN: f64 = 0.45;

/// Largest turn between two pieces of one smooth curve that is no ellipse.
const SMOOTH_TURN: f64 = 0.05;

/// Points that are enough to recognise a curve by.
const ENOUGH: usize = 129;

/// Joins the two pieces at every vertex where only they end and one continues the other: lines on
/// one line, arcs of one ellipse, and smooth curves.
pub(super) fn join_pieces(net: &mut Net<'_>, reach: f64) {
    let mut incidence = net.incidence();
    let mut gone = vec![false; net.pieces.len()];
    let mut joined = vec![false; net.pieces.len()];
    let mut again: Vec<usize> = (0..net.vertices.len()).collect();
    while let Some(v) = again.pop() {
        let &[i, k] = incidence[v].as_slice() else {
            continue;
        };
        if i == k {
            continue;
        }
        let Some(piece) = continued(&net.pieces[i], &net.pieces[k], v, reach) else {
            continue;
        };
        for w in piece.v {
            for p in incidence[w].iter_mut().filter(|p| **p == k) {
                *p = i;
            }
        }
        // A longer piece may be recognised where a short one was not: look at its ends again.
        again.extend(piece.v);
        net.pieces[i] = piece;
        gone[k] = true;
        joined[i] = true;
    }
    let pieces = mem::take(&mut net.pieces);
    for (i, piece) in pieces.into_iter().enumerate() {
        if gone[i] {
            continue;
        }
        if joined[i] && piece.sources.len() > 1 {
            let message = format!(
                "{} are parts of one edge and were joined",
                net.names(&piece.sources)
            );
            let ends = vec![piece.end(0), piece.end(1)];
            net.note(FindingKind::Joined, message, piece.sources.clone(), ends);
        }
        net.pieces.push(piece);
    }
}

/// The one curve that two pieces with the common vertex `v` are parts of.
fn continued(a: &Piece, b: &Piece, v: usize, reach: f64) -> Option<Piece> {
    // A ring of two pieces meets at both vertices; `v` is the end of a and the beginning of b.
    let a = if a.v[1] == v {
        a.clone()
    } else {
        a.clone().reversed()
    };
    let b = if b.v[0] == v {
        b.clone()
    } else {
        b.clone().reversed()
    };
    let (before, after) = (a.tangent(1.0), b.tangent(0.0));
    let turn = before.angle_to(after).abs();
    let (curve, points) = match (&a.curve, &b.curve) {
        _ if turn.is_nan() || turn > LARGEST_TURN => return None,
        (Curve2::Line, Curve2::Line) => {
            let ends = [a.end(0), b.end(1)];
            let passed = a.passed.iter().chain(&b.passed).chain([&a.points[1]]);
            let along = (ends[1] - ends[0]).try_normalize()?;
            let off = passed.map(|p| along.perp_dot(*p - ends[0]).abs());
            if off.fold(0.0, f64::max) > reach {
                return None;
            }
            (Curve2::Line, ends.to_vec())
        }
        (x, y) => {
            let mut points = a.points.clone();
            points.extend_from_slice(&b.points[1..]);
            let thin = thinned(&points);
            let curve = Curve2::recognise_within(&thin, reach);
            let lines = [x, y].iter().any(|c| matches!(c, Curve2::Line));
            // Short pieces of any smooth curve look like ellipses, but leave a residual.
            let exact = |c: &Curve2| matches!(c, Curve2::Ellipse(arc) if arc.residual <= reach);
            match curve {
                Curve2::Ellipse(_) => (curve, thin),
                _ if lines || turn > SMOOTH_TURN => return None,
                _ if exact(x) && exact(y) => return None,
                _ if !same_bend(&a, &b) => return None,
                _ => (Curve2::Polyline, points),
            }
        }
    };
    let mut passed = [a.passed, b.passed].concat();
    if let Curve2::Line = curve {
        passed.push(a.points[1]);
        passed = thinned(&passed);
    }
    Some(Piece {
        v: [a.v[0], b.v[1]],
        points,
        curve,
        sources: union(&a.sources, &b.sources),
        passed,
    })
}

/// Evenly chosen points, the first and last among them.
fn thinned(points: &[DVec2]) -> Vec<DVec2> {
    if points.len() <= ENOUGH {
        return points.to_vec();
    }
    let step = (points.len() - 1) as f64 / (ENOUGH - 1) as f64;
    (0..ENOUGH)
        .map(|i| points[((i as f64 * step).round() as usize).min(points.len() - 1)])
        .collect()
}

/// Whether two pieces bend alike where they meet: both nearly flat there, or curvatures of one sign
/// that differ by less than half.
fn same_bend(a: &Piece, b: &Piece) -> bool {
    let bend = |p: &[DVec2]| {
        let (d, e) = (p[1] - p[0], p[2] - p[1]);
        let step = (d.length() + e.length()) / 2.0;
        (d.angle_to(e) / step.max(f64::MIN_POSITIVE), step)
    };
    let (n, m) = (a.points.len(), b.points.len());
    if n < 3 || m < 3 {
        return false;
    }
    let ((x, h), (y, k)) = (bend(&a.points[n - 3..]), bend(&b.points[..3]));
    (x - y).abs() <= 0.5 * x.abs().max(y.abs()) || (x - y).abs() * h.max(k) < SMOOTH_TURN
}
