//! How well a surface agrees with what is known of its boundary.

use glam::DVec3;

use super::evidence::Evidence;
use super::refine::{Freedom, refined};
use crate::lift::Surface;
use crate::lift::ring_torus::touching_gap;

/// A boundary where the surface does not go on smoothly into its neighbour counts as much as this
/// distance, relative to the drawing's size: it decides between surfaces that fit alike.
const KINK: f64 = 1e-6;

/// A stand-in passes through known points within this share of the drawing's size.
const STAND_IN: f64 = 8e-5;

/// A tube with a spine of less than this share of its radius is a sphere, on which any two equal
/// circles lie.
const SPHERE: f64 = 1e-3;

/// A candidate this close, relative to the drawing's size, is as good as the drawing.
const EXACT: f64 = 2e-6;

/// So many of the best candidates are refined.
const RIVALS: usize = 4;

/// The candidate that agrees best, if it does within `tolerance`, a length.
pub(super) fn best(
    evidence: &Evidence,
    candidates: Vec<Surface>,
    tolerance: f64,
) -> Option<Surface> {
    let mut judged: Vec<(f64, Surface)> = candidates
        .into_iter()
        .map(|surface| (misfit(evidence, &surface), surface))
        .filter(|(off, _)| *off < 0.05 * evidence.size)
        .collect();
    judged.sort_by(|a, b| a.0.total_cmp(&b.0));
    judged.truncate(RIVALS);
    judged
        .into_iter()
        .filter_map(|(off, surface)| settled(evidence, surface, off, tolerance))
        .min_by(|a, b| {
            let cost = |(off, surface): &(f64, Surface)| off + kinks(evidence, surface);
            cost(a).total_cmp(&cost(b))
        })
        .map(|(_, surface)| surface)
}

/// A candidate with its misfit, refined no further than it takes to agree within `tolerance`.
fn settled(
    evidence: &Evidence,
    surface: Surface,
    off: f64,
    tolerance: f64,
) -> Option<(f64, Surface)> {
    let mut best = (off, surface);
    if off <= EXACT * evidence.size {
        return Some(best);
    }
    for freedom in [Freedom::AlongAxis, Freedom::Shifts, Freedom::All] {
        let better = refined(evidence, surface, freedom);
        let new = misfit(evidence, &better);
        if new < best.0 {
            best = (new, better);
        }
        if best.0 <= tolerance {
            return Some(best);
        }
    }
    None
}

/// A surface between whole circles only that does not agree with the outlines, if none does: it
/// passes through all known points, and is the one that outlines and smooth neighbours speak for
/// most. A band between two circles is better closed by it than by a surface of no kind.
pub(super) fn stand_in(evidence: &Evidence, candidates: Vec<Surface>) -> Option<Surface> {
    let mut rings = evidence.bounds.iter();
    if evidence.bounds.len() < 2 || !rings.all(|b| b.ring.is_some()) {
        return None;
    }
    let off = |surface: &Surface| {
        let distances = evidence.points().map(|p| surface.distance(p).abs());
        distances.fold(0.0, f64::max)
    };
    candidates
        .into_iter()
        .filter(|surface| off(surface) <= STAND_IN * evidence.size)
        .min_by(|a, b| {
            let cost = |s: &Surface| misfit(evidence, s) + kinks(evidence, s);
            cost(a).total_cmp(&cost(b))
        })
}

/// Residuals of a surface: distances of known points, and of lines of sight that are to touch it.
pub(super) fn residuals(evidence: &Evidence, surface: &Surface, out: &mut Vec<f64>) {
    out.clear();
    out.extend(evidence.points().map(|p| surface.distance(p)));
    let outlines = evidence.outlines.iter();
    match *surface {
        Surface::Torus { .. } => {
            out.extend(outlines.map(|line| touching_gap(surface, line.from, line.direction)));
        }
        Surface::Sphere { center, radius } => {
            out.extend(outlines.map(|line| line.distance(center) - radius));
        }
        // The outlines of others are straight, and their ends say it all.
        _ => {}
    }
}

/// Largest residual.
pub(super) fn misfit(evidence: &Evidence, surface: &Surface) -> f64 {
    if matches!(*surface, Surface::Torus { major, minor, .. } if major < SPHERE * minor) {
        return f64::INFINITY;
    }
    let mut all = Vec::new();
    residuals(evidence, surface, &mut all);
    let worst = |m: f64, r: &f64| {
        if r.is_nan() {
            f64::INFINITY
        } else {
            m.max(r.abs())
        }
    };
    all.iter().fold(0.0, worst)
}

/// What boundaries cost where the surface does not touch its neighbour.
fn kinks(evidence: &Evidence, surface: &Surface) -> f64 {
    let bent = |b: &&super::evidence::Bound| {
        let p = b.points[b.points.len() / 2];
        let (g, h) = (surface.gradient(p), b.beside.gradient(p));
        h != DVec3::ZERO && g.cross(h).length() > 0.01
    };
    evidence.bounds.iter().filter(bent).count() as f64 * KINK * evidence.size
}
