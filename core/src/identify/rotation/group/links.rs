//! Pairs of loops that may be one face.

use glam::DVec2;

use super::shapes::{Outline, Shapes};
use crate::drawing::SurfaceKind;

/// Share of the inner loop's points that must be drawn inside the outer one.
const INSIDE: f64 = 0.9;

/// Points of a loop that are looked at.
const POINTS: usize = 32;

/// What makes two loops one face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LinkKind {
    /// One plane.
    Coplanar,
    /// One surface of revolution without a silhouette between two circles.
    Coaxial,
    /// One curved surface that the inner loop is a hole in.
    Pierced,
}

/// Two loops that may be one face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Link {
    pub(super) kind: LinkKind,
    pub(super) outer: usize,
    pub(super) inner: usize,
    /// Depth that the inner loop's part moves, against the outer one's, to be in the same face.
    pub(super) offset: f64,
    /// Standard error of that, as far as the drawing's own tells.
    pub(super) error: f64,
    /// Whether both loops are walked in the same sense, so that one part has to be turned over.
    pub(super) same_sense: bool,
    /// Whether two circles would be in one plane although they are drawn around one axis.
    pub(super) doubtful: bool,
    /// Whether all of the inner loop lies on the outer one's curved surface.
    pub(super) fits: bool,
}

/// All pairs of loops that may be one face, also of one part.
pub(super) fn links(shapes: &Shapes) -> Vec<Link> {
    let mut links = flat_or_coaxial(shapes);
    let mut linked = vec![false; shapes.parts.len()];
    for link in &links {
        let [a, b] = [link.outer, link.inner].map(|i| shapes.loops[i].part);
        if a != b {
            (linked[a], linked[b]) = (true, true);
        }
    }
    pierced(shapes, &linked, &mut links);
    links
}

fn flat_or_coaxial(shapes: &Shapes) -> Vec<Link> {
    let mut links = Vec::new();
    let slack = DVec2::splat((1e-6 * shapes.size).max(shapes.error));
    for (i, a) in shapes.loops.iter().enumerate() {
        for (j, b) in shapes.loops.iter().enumerate() {
            let apart = b.low.cmplt(a.low - slack).any() || b.high.cmpgt(a.high + slack).any();
            if i == j || apart || b.area.abs() >= a.area.abs() {
                continue;
            }
            let coplanar = shapes.parallel(a, b).map(|(p, q)| {
                let middle = (b.low + b.high) / 2.0;
                p.level(middle) - q.level(middle)
            });
            let coaxial = coaxial(shapes, a, b);
            if coplanar.is_none() && coaxial.is_none() || inside(a, b) < INSIDE {
                continue;
            }
            let error = a
                .depth_error(shapes.error)
                .hypot(b.depth_error(shapes.error));
            let doubtful = match (coplanar, coaxial) {
                (Some(p), Some(q)) => (p - q).abs() > shapes.slack(error),
                _ => false,
            };
            let link = |kind, offset| Link {
                error,
                kind,
                outer: i,
                inner: j,
                offset,
                same_sense: a.area * b.area > 0.0,
                doubtful,
                fits: false,
            };
            links.extend(coplanar.map(|offset| link(LinkKind::Coplanar, offset)));
            if coplanar.is_none() || doubtful {
                links.extend(coaxial.map(|offset| link(LinkKind::Coaxial, offset)));
            }
        }
    }
    links
}

/// Adds holes in curved surfaces. What is drawn over a curved face need not be in it, so of a part
/// that other links may join only loops are taken that are no whole faces, or that fit on the surface.
/// Other parts have to be joined somehow.
fn pierced(shapes: &Shapes, linked: &[bool], links: &mut Vec<Link>) {
    for (p, part) in shapes.parts.iter().enumerate() {
        let mut all: Vec<(usize, Link)> = Vec::new();
        for &j in &part.loops {
            let b = &shapes.loops[j];
            let trimmed = is_trimmed(b);
            if linked[p] && !b.curved {
                continue;
            }
            for (i, a) in shapes.loops.iter().enumerate() {
                let around = a.low.cmple(b.low).all() && a.high.cmpge(b.high).all();
                let same = a.kind == b.kind && a.curved;
                let rank = match (same, b.ruling.is_some()) {
                    (true, false) => 0,
                    (false, false) if a.ring && b.curved || a.curved && b.ring => 1,
                    (true, true) => 2,
                    _ => continue,
                };
                if a.part == p
                    || !around
                    || linked[p] && !same
                    || b.area.abs() >= a.area.abs()
                    || inside(a, b) < INSIDE
                {
                    continue;
                }
                let Some(offset) = depth_on(a, b) else {
                    continue;
                };
                let fits = same && fits(shapes, a, b);
                if linked[p] && !(trimmed || fits) {
                    continue;
                }
                let rank = if fits { 0 } else { rank };
                let link = Link {
                    kind: LinkKind::Pierced,
                    outer: i,
                    inner: j,
                    offset,
                    error: b.depth_error(shapes.error),
                    same_sense: a.area * b.area > 0.0,
                    doubtful: false,
                    fits,
                };
                all.push((rank, link));
            }
        }
        // The likeliest sort that there is.
        let first = all.iter().map(|a| a.0).min();
        links.extend(all.into_iter().filter(|a| Some(a.0) == first).map(|a| a.1));
    }
}

/// Whether a curved loop is no whole face: a whole cylinder or cone has rulings, and other surfaces
/// have a line through their circles' middles.
fn is_trimmed(b: &Outline) -> bool {
    let corners = match b.kind {
        SurfaceKind::Cylinder | SurfaceKind::Cone => 0,
        // Fillets have up to four.
        _ => 5,
    };
    b.curved && b.corners.len() >= corners && b.ruling.is_none() && b.line.is_none()
}

/// Whether loop `b` lies on the ruled surface of loop `a`, all of it at the same depth from it.
fn fits(shapes: &Shapes, a: &Outline, b: &Outline) -> bool {
    if a.ruling.is_none() || b.corners.len() < 3 {
        return false;
    }
    let (low, high) = b
        .boundary()
        .map(|(p, depth)| a.depth(p) - depth)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(x), h.max(x))
        });
    high - low < shapes.slack(b.depth_error(shapes.error))
}

/// Depth by which loop `b` has to move so that its corners are on loop `a`'s surface.
fn depth_on(a: &Outline, b: &Outline) -> Option<f64> {
    let all = b.corners.iter().map(|&(p, depth)| a.depth(p) - depth);
    let count = b.corners.len();
    (count > 0).then(|| all.sum::<f64>() / count as f64)
}

/// Offset in depth that puts two loops' axes into one line, if they are drawn so.
fn coaxial(shapes: &Shapes, a: &Outline, b: &Outline) -> Option<f64> {
    let (p, q) = (a.line?, b.line?);
    if p.axis != q.axis {
        return None;
    }
    let axis = shapes.axes[p.axis];
    let drawn = shapes.camera.drawn(axis, p.at);
    let length = drawn.length();
    let apart = q.at - p.at;
    if length < 1e-3 || apart.perp_dot(drawn).abs() > shapes.on_axis() * length {
        return None;
    }
    Some(p.depth + shapes.camera.climb(axis, p.at, q.at) - q.depth)
}

/// Share of loop `b`'s points drawn inside loop `a`.
fn inside(a: &Outline, b: &Outline) -> f64 {
    let step = b.polygon.len().div_ceil(POINTS).max(1);
    let points = b.polygon.iter().step_by(step);
    let count = points.len();
    let hits = points.filter(|p| a.contains(**p)).count();
    hits as f64 / count.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::super::round::{Round, drawn, lifted};
    use super::*;

    #[test]
    fn what_lies_on_a_cylinder_fits() {
        let pipe = Round::cylinder([0.0, 0.0], 1.0, 0.0, 3.0);
        let patch = Round::patch([0.0, 0.0], 1.0, [1.0, 2.0], 0.4);
        let other = Round::patch([0.0, 0.3], 0.7, [1.0, 2.0], 0.4);
        for (inner, on) in [(patch, true), (other, false)] {
            let (drawing, loops) = drawn(&[pipe, inner]);
            lifted(&drawing, &loops, |shapes, links| {
                let part = |i: usize| shapes.loops[i].part;
                let own = links.iter().filter(|l| part(l.outer) != part(l.inner));
                let fits = own.filter(|l| l.kind == LinkKind::Pierced && l.fits);
                assert_eq!(fits.count() > 0, on, "{links:?}");
            });
        }
    }
}
