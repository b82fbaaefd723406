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

/// A candidate this far off, relative to the drawing's size, is no start for refining.
const FAR: f64 = 0.05;

/// So many of the best candidates are refined.
const RIVALS: usize = 4;

/// The candidate that agrees best, if it does within `tolerance`, a length.
pub(super) fn best(
    evidence: &Evidence,
    candidates: Vec<Surface>,
    tolerance: f64,
) -> Option<Surface> {
    // Outlines cost most, and can only add to the misfit of points.
    let mut points: Vec<(f64, Surface)> = candidates
        .into_iter()
        .map(|surface| (points_off(evidence, &surface), surface))
        .filter(|(off, _)| *off < FAR * evidence.size)
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut judged: Vec<(f64, Surface)> = Vec::new();
    for (least, surface) in points {
        let last = judged.get(RIVALS - 1).map(|j| j.0);
        let most = last.unwrap_or(FAR * evidence.size);
        if least >= most {
            break;
        }
        let off = misfit_below(evidence, &surface, most);
        if off < most {
            let at = judged.partition_point(|(other, _)| *other <= off);
            judged.insert(at, (off, surface));
            judged.truncate(RIVALS);
        }
    }
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
        if new < best.0 && better.fault().is_none() {
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
/// most; a cylinder or cone, which builds most easily, need not have curved outlines. A band between
/// two circles is better closed by it than by a surface of no kind.
pub(super) fn stand_in(evidence: &Evidence, candidates: Vec<Surface>) -> Option<Surface> {
    let mut rings = evidence.bounds.iter();
    if evidence.bounds.len() < 2 || !rings.all(|b| b.ring.is_some()) {
        return None;
    }
    candidates
        .into_iter()
        .filter(|surface| points_off(evidence, surface) <= STAND_IN * evidence.size)
        .min_by(|a, b| {
            let off = |s: &Surface| match s {
                Surface::Cylinder { .. } | Surface::Cone { .. } => points_off(evidence, s),
                _ => misfit(evidence, s),
            };
            let cost = |s: &Surface| off(s) + kinks(evidence, s);
            cost(a).total_cmp(&cost(b))
        })
}

/// Residuals of a surface: distances of known points, and of lines of sight that are to touch it.
pub(super) fn residuals(evidence: &Evidence, surface: &Surface, out: &mut Vec<f64>) {
    out.clear();
    out.extend(evidence.points().map(|p| surface.distance(p)));
    out.extend(sights(evidence, surface));
}

/// Residuals of lines of sight: how far each is from touching the surface. Of straight outlines the ends
/// say it all.
fn sights<'a>(evidence: &'a Evidence, surface: &'a Surface) -> impl Iterator<Item = f64> + 'a {
    let outlines = evidence.outlines.iter();
    outlines.map_while(|line| match *surface {
        Surface::Torus { .. } => Some(touching_gap(surface, line.from, line.direction)),
        Surface::Sphere { center, radius } => Some(line.distance(center) - radius),
        Surface::Cylinder {
            origin,
            axis,
            radius,
        } if evidence.bent => Some(line.apart(origin, axis) - radius),
        Surface::Cone { apex, axis, angle } if evidence.bent => {
            Some(line.cone_gap(apex, axis, angle))
        }
        _ => None,
    })
}

/// Largest distance of a known point.
fn points_off(evidence: &Evidence, surface: &Surface) -> f64 {
    let distances = evidence.points().map(|p| surface.distance(p));
    distances.fold(0.0, largest)
}

/// Largest residual.
pub(super) fn misfit(evidence: &Evidence, surface: &Surface) -> f64 {
    misfit_below(evidence, surface, f64::INFINITY)
}

/// The same, of lines of sight only up to the first that is not below a limit.
fn misfit_below(evidence: &Evidence, surface: &Surface, limit: f64) -> f64 {
    if matches!(*surface, Surface::Torus { major, minor, .. } if major < SPHERE * minor) {
        return f64::INFINITY;
    }
    let mut most = points_off(evidence, surface);
    for residual in sights(evidence, surface) {
        if most >= limit {
            break;
        }
        most = largest(most, residual);
    }
    most
}

/// The larger magnitude; what is no number is infinite.
fn largest(most: f64, residual: f64) -> f64 {
    if residual.is_nan() {
        f64::INFINITY
    } else {
        most.max(residual.abs())
    }
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
