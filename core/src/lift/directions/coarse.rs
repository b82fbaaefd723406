//! Frames of drawings by hand, by likelihood.
//!
//! With errors of half a percent most edges agree with several directions, and counting those that
//! do picks frames at random. So each edge speaks for a frame by how much better it is explained by
//! an axis than by chance: `ln(p(offset | axis) / p(offset | any direction))`, which is large for
//! long edges that agree well and nothing for short ones. The level of noise is the one under which
//! the best frame explains most.

use std::f64::consts::{PI, SQRT_2, TAU};

use glam::{DMat3, DQuat, DVec3};

use super::evidence::{CircleGroup, Evidence, Segment};
use super::hypotheses::{Hypothesis, frames};
use super::refine::aside;
use super::{Axis, Directions, columns, towards_viewer};
use crate::drawing::{Curve2, Drawing};
use crate::lift::Camera;

/// Standard errors of coordinates that are tried, in units of the drawing's size.
const PRECISIONS: [f64; 6] = [5e-4, 1e-3, 2e-3, 4e-3, 8e-3, 1.6e-2];

/// The same of drawings that are nearly exact, as by rounded coordinates; the first are exact.
const FINE: [f64; 6] = [1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 2.5e-4];

/// Half of all edges are turned against their parallels by less, in standard errors of their ends.
const TYPICAL: f64 = 0.5;

/// Largest step of rounded coordinates, relative to the size, and how near they are to multiples.
const COARSEST: f64 = 0.02;
const GRID: f64 = 1e-6;

/// Rounding parts edges into at least so many times as many directions.
const PARTED: f64 = 1.25;

/// Points of an arc are off its ellipse by at most so many standard errors.
const OFF_ARC: f64 = 5.0;

/// Hypotheses that are refined.
const REFINED: usize = 16;

/// Steps of refinement.
const STEPS: usize = 8;

/// Readings that are given.
const READINGS: usize = 4;

/// Errors within which a curve may be an ellipse.
const CURVE_ERRORS: f64 = 3.0;

/// Groups of circles whose axes are tried alone.
const ALONE: usize = 3;

/// Share of the best reading's score that a reading has to have.
const RIVAL: f64 = 0.75;

/// What an axis seen almost from its end or its side costs: few people draw parts so, and such
/// frames explain edges by chance.
const FLAT: f64 = 4.0;

/// An axis with a smaller share of depth is seen from its side.
const FLATTEST: f64 = 0.12;

/// An edge that follows no axis by this much better than another follows neither.
const CLEAR: f64 = 1.5;

/// No circle by hand tells its axis better than to this many radians.
const ROUND: f64 = 0.01;

/// Parallel circles count as so many at most: they tell the same direction.
const CIRCLES: f64 = 3.0;

/// A frame is tried again with the noise this many times as large.
const LOUDER: f64 = 2.5;

/// A frame with what it explains.
struct Scored {
    frame: DMat3,
    /// How many of its axes count: three, or the first alone.
    axes: usize,
    score: f64,
}

pub(super) fn candidates(drawing: &Drawing) -> Vec<Directions> {
    let size = drawing.size();
    let mut best: Option<(Evidence, Vec<Scored>)> = None;
    for relative in level(drawing).into_iter().chain(PRECISIONS) {
        let evidence = evidence(drawing, relative * size);
        let all = scored(&evidence);
        let top = |all: &[Scored]| all.first().map_or(f64::NEG_INFINITY, |s| s.score);
        if best.as_ref().is_none_or(|b| top(&all) > top(&b.1)) {
            best = Some((evidence, all));
        }
    }
    let Some((evidence, all)) = best else {
        return Vec::new();
    };
    let least = RIVAL * all.first().map_or(0.0, |s| s.score.max(0.0));
    let mut readings: Vec<Directions> = all
        .iter()
        .enumerate()
        .take_while(|(i, s)| *i == 0 || s.score >= least)
        .take(READINGS)
        .map(|(_, s)| reading(&evidence, s).seen_from_above())
        .collect();
    // Few edges agree with each other by chance more than with what they were meant to be.
    let louder = self::evidence(drawing, LOUDER * evidence.precision);
    if let Some(first) = all.first() {
        let again = reading(&louder, first).seen_from_above();
        readings.insert(1.min(readings.len()), again);
    }
    readings
}

/// Whether a drawing's straight edges and arcs are exact.
pub(crate) fn is_exact(drawing: &Drawing) -> bool {
    level(drawing) == Some(FINE[0])
}

/// Whether a drawing is all but exact, as by coordinates that were rounded.
pub(crate) fn is_rounded(drawing: &Drawing) -> bool {
    level(drawing).is_some_and(|error| error > FINE[0])
}

/// Standard error of an exact or nearly exact drawing's coordinates, relative to its size.
fn level(drawing: &Drawing) -> Option<f64> {
    let size = drawing.size();
    match rounding(drawing) {
        Some(error) => Some(error / size).filter(|e| *e < PRECISIONS[0]),
        None => FINE.into_iter().find(|p| agrees(drawing, p * size)),
    }
}

/// Standard error of coordinates that were rounded to decimals, if that parted edges that are
/// parallel. Many rounded edges are the same vector, so that it does not show in how near they are.
fn rounding(drawing: &Drawing) -> Option<f64> {
    let size = drawing.size();
    // Rounding errors are spread evenly over a step.
    let spread = 12f64.sqrt().recip();
    let finest = FINE[0] * size / spread;
    let coarsest = (COARSEST * size).log10().floor() as i32;
    let on_grid = |step: f64| {
        let off = |x: f64| (x / step - (x / step).round()).abs() < GRID;
        drawing.vertices.iter().all(|v| off(v.x) && off(v.y))
    };
    let steps = (0..10).map(|k| 10f64.powi(coarsest - k));
    let step = steps.take_while(|s| *s > finest).find(|s| on_grid(*s))?;
    let error = step * spread;
    let [parted, meant] =
        [FINE[0] * size, error].map(|precision| Evidence::new(drawing, precision).clusters);
    // Short edges have no direction at the coarser precision.
    let told: usize = meant.iter().map(|c| c.members.len()).sum();
    let parted = parted
        .iter()
        .filter(|c| c.members.iter().any(|&m| m < told));
    (parted.count() as f64 > PARTED * meant.len() as f64).then_some(error)
}

/// Whether a drawing's coordinates have a standard error of no more: most edges have a parallel one,
/// as near as that makes them, most arcs are ellipses. Whole circles are left out, as they are
/// shifted but not bent by errors of their one vertex; so are other curves, which may be anything.
fn agrees(drawing: &Drawing, error: f64) -> bool {
    let evidence = Evidence::new(drawing, error);
    let mut turned: Vec<f64> = Vec::new();
    for cluster in evidence.clusters.iter().filter(|c| c.members.len() > 1) {
        turned.extend(cluster.members.iter().map(|&m| {
            let segment = &evidence.segments[m];
            (segment.direction.perp_dot(cluster.direction) * segment.length).abs()
        }));
    }
    turned.sort_by(f64::total_cmp);
    let arcs = drawing.edges.iter().filter_map(|e| match e.curve {
        Curve2::Ellipse(arc) if e.v[0] != e.v[1] => Some(arc.residual < OFF_ARC * error),
        _ => None,
    });
    let (sharp, all) = arcs.fold((0, 0), |(sharp, all), is| {
        (sharp + usize::from(is), all + 1)
    });
    let straight = evidence.segments.len();
    // Of many edges that are not quite parallel each is near to some other one by chance.
    let near = |typical: &f64| *typical < TYPICAL * SQRT_2 * error;
    // The lower one of two middle ones: few edges of an exact drawing may happen to be rounded far.
    turned
        .get(turned.len().saturating_sub(1) / 2)
        .is_none_or(near)
        && (straight < 2 || 2 * (turned.len() + sharp) > straight + all)
}

/// The evidence at one precision, with what may be a circle at it.
fn evidence(drawing: &Drawing, precision: f64) -> Evidence {
    Evidence::new(&recognised(drawing, precision), precision)
}

/// The drawing with curves recognised that are ellipses within the errors of its coordinates.
pub(crate) fn recognised(drawing: &Drawing, precision: f64) -> Drawing {
    let mut drawing = drawing.clone();
    for edge in &mut drawing.edges {
        if matches!(edge.curve, Curve2::Polyline)
            && let curve @ Curve2::Ellipse(_) =
                Curve2::recognise_within(&edge.points, CURVE_ERRORS * precision)
        {
            edge.curve = curve;
        }
    }
    drawing
}

/// Frames and single axes, the one that explains most first.
fn scored(evidence: &Evidence) -> Vec<Scored> {
    let mut starts: Vec<Scored> = frames(evidence)
        .into_iter()
        .map(|h: Hypothesis| Scored {
            score: score(evidence, &h.frame, 3, 2.0),
            axes: 3,
            frame: h.frame,
        })
        .collect();
    starts.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut found: Vec<Scored> = Vec::new();
    let mut tried: Vec<DMat3> = Vec::new();
    for start in starts {
        if tried.len() >= REFINED {
            break;
        }
        if tried.iter().any(|f| is_same(f, &start.frame)) {
            continue;
        }
        tried.push(start.frame);
        let frame = refined(evidence, start.frame, 3);
        if !found.iter().any(|f| is_same(&f.frame, &frame)) {
            found.push(Scored {
                score: score(evidence, &frame, 3, 1.0),
                axes: 3,
                frame,
            });
        }
    }
    // A shaft shows one axis.
    for group in evidence.circles.iter().take(ALONE) {
        let (u, v) = group.normal.any_orthonormal_pair();
        let frame = refined(evidence, DMat3::from_cols(group.normal, u, v), 1);
        found.push(Scored {
            score: score(evidence, &frame, 1, 1.0),
            axes: 1,
            frame,
        });
    }
    found.sort_by(|a, b| b.score.total_cmp(&a.score));
    found
}

/// What a frame explains, in natural logarithms of likelihood; errors are `loose` times as large
/// as the drawing's for a frame that is not refined.
fn score(evidence: &Evidence, frame: &DMat3, axes: usize, loose: f64) -> f64 {
    let straight: f64 = evidence
        .segments
        .iter()
        .map(|s| {
            (0..axes)
                .map(|k| gain(evidence, s, frame.col(k), loose))
                .fold(0.0, f64::max)
        })
        .sum();
    let round: f64 = evidence
        .circles
        .iter()
        .map(|g| {
            let gains = (0..axes).map(|k| round_gain(g, frame.col(k), loose));
            gains.fold(0.0, f64::max) * (g.edges.len() as f64).min(CIRCLES)
        })
        .sum();
    let flat = columns(frame)
        .iter()
        .take(axes)
        .filter(|a| a.z.abs() < FLATTEST)
        .count() as f64;
    // Three edges fit some frame whatever they are, and two numbers an axis.
    let fitted = (axes as f64).max(2.0) * (0.3 * evidence.size / evidence.precision).ln();
    straight + round - FLAT * flat - fitted
}

/// How much better an edge is explained by an axis than by chance.
fn gain(evidence: &Evidence, segment: &Segment, axis: DVec3, loose: f64) -> f64 {
    let drawn = axis.truncate();
    let length = drawn.length();
    if length < 1e-3 {
        return 0.0;
    }
    let error = SQRT_2 * evidence.precision * loose;
    let off = segment.direction.perp_dot(drawn) / length * segment.length;
    // Of three axes the best is taken.
    let chance = PI * segment.length / (3.0 * error * TAU.sqrt());
    chance.ln() - 0.5 * (off / error).powi(2)
}

fn round_gain(group: &CircleGroup, axis: DVec3, loose: f64) -> f64 {
    let error = (group.error * loose).max(ROUND);
    let off = group.fold(axis).0.distance(group.normal) / error;
    -(3.0 * error * error).ln() - 0.5 * off * off
}

/// Gauss-Newton on SO(3) over what a frame explains at each step.
fn refined(evidence: &Evidence, mut frame: DMat3, axes: usize) -> DMat3 {
    for step in 0..STEPS {
        let loose = if step < STEPS / 2 { 2.0 } else { 1.0 };
        let (mut information, mut right) = (DMat3::from_diagonal(DVec3::splat(1.0)), DVec3::ZERO);
        let mut add = |residual: f64, slope: DVec3, error: f64| {
            let s = slope / error;
            information += DMat3::from_cols(s * s.x, s * s.y, s * s.z);
            right -= s * (residual / error);
        };
        for s in &evidence.segments {
            let Some(k) = best(axes, |k| gain(evidence, s, frame.col(k), loose)) else {
                continue;
            };
            let (residual, slope) = aside(s.direction, frame.col(k));
            let error = SQRT_2 * evidence.precision / s.length;
            add(residual, slope, error);
        }
        for g in &evidence.circles {
            let Some(k) = best(axes, |k| round_gain(g, frame.col(k), loose)) else {
                continue;
            };
            let n = frame.col(k);
            let (folded, signs) = g.fold(n);
            let off = folded - g.normal;
            let error = g.error.max(ROUND);
            add(off.x, signs.x * DVec3::new(0.0, n.z, -n.y), error);
            add(off.y, signs.y * DVec3::new(-n.z, 0.0, n.x), error);
            add(off.z, signs.z * DVec3::new(n.y, -n.x, 0.0), error);
        }
        let turn = information.inverse() * right;
        let turn = turn.clamp_length_max(0.2);
        if !turn.is_finite() {
            break;
        }
        frame = DMat3::from_quat(DQuat::from_scaled_axis(turn)) * frame;
    }
    frame
}

/// The axis of the largest positive gain.
fn best(axes: usize, gain: impl Fn(usize) -> f64) -> Option<usize> {
    let found = (0..axes)
        .map(|k| (gain(k), k))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    found.filter(|(g, _)| *g > 0.0).map(|(_, k)| k)
}

/// Which edges and circles follow a frame's axes, where no other axis would do.
fn reading(evidence: &Evidence, found: &Scored) -> Directions {
    let (frame, count) = (&found.frame, found.axes);
    let mut axes: Vec<Axis> = columns(frame)[..count]
        .iter()
        .map(|&direction| Axis {
            direction: towards_viewer(direction),
            edges: Vec::new(),
            circles: Vec::new(),
        })
        .collect();
    let clear = |gains: [f64; 3]| {
        let k = best(count, |k| gains[k])?;
        let rival = (0..count)
            .filter(|j| *j != k)
            .map(|j| gains[j])
            .fold(0.0, f64::max);
        (gains[k] > rival + CLEAR).then_some(k)
    };
    let mut information: f64 = 0.0;
    for s in &evidence.segments {
        if let Some(k) = clear([0, 1, 2].map(|k| gain(evidence, s, frame.col(k), 1.0))) {
            axes[k].edges.push(s.edge);
            information += (s.length / evidence.precision).powi(2);
        }
    }
    for g in &evidence.circles {
        if let Some(k) = clear([0, 1, 2].map(|k| round_gain(g, frame.col(k), 1.0))) {
            axes[k].circles.extend(&g.edges);
            information += g.error.max(evidence.precision / evidence.size).powi(-2);
        }
    }
    Directions {
        axes,
        slanted: Vec::new(),
        swept: Vec::new(),
        camera: Camera::Parallel,
        error: 2.0 * information.max(1.0).sqrt().recip(),
        precision: evidence.precision,
    }
}

/// Whether two frames have nearly the same axes, as they are or reversed in depth.
fn is_same(a: &DMat3, b: &DMat3) -> bool {
    const NEAR: f64 = 0.04;
    [1.0, -1.0].iter().any(|&sign| {
        columns(b).iter().all(|v| {
            let v = DVec3::new(v.x, v.y, sign * v.z);
            columns(a).iter().any(|u| u.cross(v).length() < NEAR)
        })
    })
}
