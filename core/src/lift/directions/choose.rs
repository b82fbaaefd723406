//! Which of the frames that the evidence allows.

use glam::{DMat3, DVec2, DVec3};

use super::evidence::{CircleGroup, Cluster, Evidence, Shown};
use super::hypotheses::{Hypothesis, frames};
use super::model_frame::USUAL;
use super::refine::{Followers, refine};
use super::{AGREE, Axis, Directions, columns, towards_viewer};
use crate::drawing::Drawing;
use crate::lift::{Camera, LiftError};

/// Standard errors of coordinates that are tried, in units of the drawing's size: rounded to 1e-6,
/// to fewer digits, drawn by hand.
const PRECISIONS: [f64; 4] = [6e-7, 1e-5, 1e-4, 1e-3];

/// Chance agreement is told from a match by how much smaller than this share of the size the error
/// is.
const CHANCE: f64 = 0.1;

/// Standard error of the axes, radians, beyond which depth cannot be told.
const MAX_ERROR: f64 = 0.01;

/// Readings that are worth a second look when the first one leads to conflicts.
const READINGS: usize = 4;

/// Hypotheses that are refined, the most telling ones.
const REFINED: usize = 24;

/// What a vertex adds to a frame's score if all its edges follow the frame.
const CORNER: f64 = 0.7;

/// What an arc that is a circle around an axis adds, and one that is certainly none takes away.
const CIRCLE: f64 = 2.0;
const STRAY_CIRCLE: f64 = 1.0;

/// Standard error, radians, of a normal that is certain.
const SURE: f64 = 1e-3;

/// What an axis that is drawn vertically adds: people keep a part's upright edges upright.
const UPRIGHT: f64 = 1.0;

/// A reading of the evidence.
struct Reading {
    directions: Directions,
    /// Straight edges and circles explained, in votes.
    votes: f64,
    /// How much it looks like the axes of a part.
    score: f64,
}

pub(super) fn candidates(drawing: &Drawing) -> Result<Vec<Directions>, LiftError> {
    let size = drawing.size();
    let mut best: Option<(f64, Vec<Reading>)> = None;
    for relative in PRECISIONS {
        let worth = (CHANCE / relative).ln();
        let evidence = Evidence::new(drawing, relative * size);
        let all = evidence.segments.len() as f64
            + evidence
                .circles
                .iter()
                .map(|c| 2.0 * c.edges.len() as f64)
                .sum::<f64>();
        // Coarser precision is worth less a vote and can win by explaining more only.
        if best.as_ref().is_some_and(|(bits, _)| *bits >= all * worth) {
            break;
        }
        let readings = readings(&evidence);
        let bits = readings.first().map_or(0.0, |r| r.votes * worth);
        if bits > best.as_ref().map_or(0.0, |b| b.0) {
            best = Some((bits, readings));
        }
    }
    let Some((_, readings)) = best else {
        return Err(refusal(drawing, size));
    };
    let good: Vec<Directions> = readings
        .iter()
        .filter(|r| r.directions.error < MAX_ERROR)
        .take(READINGS)
        .map(|r| r.directions.clone().seen_from_above())
        .collect();
    if good.is_empty() {
        let flattest = readings
            .iter()
            .flat_map(|r| &r.directions.axes)
            .map(|a| a.direction.z.abs().asin())
            .fold(f64::INFINITY, f64::min);
        return Err(LiftError::DegenerateView {
            degrees: flattest.to_degrees(),
        });
    }
    Ok(good)
}

/// Why nothing was found: a view along an axis shows two directions at right angles and no more.
fn refusal(drawing: &Drawing, size: f64) -> LiftError {
    let evidence = Evidence::new(drawing, PRECISIONS[2] * size);
    if let [a, b, ..] = &evidence.clusters[..] {
        let skew = a.direction.dot(b.direction).abs();
        if skew < 0.01 && a.members.len() > 1 && b.members.len() > 1 {
            return LiftError::DegenerateView {
                degrees: skew.asin().to_degrees(),
            };
        }
    }
    LiftError::NoDirections(format!(
        "{} straight edges in {} directions and {} circles fit no axes; add edges along three axes at \
         right angles, or a circle",
        evidence.segments.len(),
        evidence.clusters.len(),
        evidence
            .circles
            .iter()
            .map(|c| c.edges.len())
            .sum::<usize>(),
    ))
}

/// All readings, most likely first.
fn readings(evidence: &Evidence) -> Vec<Reading> {
    let mut starts: Vec<(f64, Hypothesis)> = frames(evidence)
        .into_iter()
        .map(|h| (explained(evidence, &Followers::new(evidence, &h)), h))
        .collect();
    starts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut seen: Vec<DMat3> = Vec::new();
    let mut all: Vec<Reading> = Vec::new();
    for (_, start) in starts {
        if seen.len() >= REFINED {
            break;
        }
        if seen
            .iter()
            .any(|f| is_same(f, &start.frame, 5.0 * start.error))
        {
            continue;
        }
        let Some((found, followers)) = refine(evidence, start) else {
            continue;
        };
        if !seen
            .iter()
            .any(|f| is_same(f, &found.frame, 5.0 * found.error))
        {
            seen.push(found.frame);
            all.extend(frame_reading(evidence, &found, &followers));
        }
    }
    all.extend(
        evidence
            .circles
            .iter()
            .filter_map(|c| axis_reading(evidence, c)),
    );
    all.extend(isometric_reading(evidence));
    all.sort_by(|a, b| b.score.total_cmp(&a.score));
    all
}

/// How much of the evidence follows a frame, less what contradicts it.
fn explained(evidence: &Evidence, followers: &Followers) -> f64 {
    let clusters = evidence.clusters.iter().zip(&followers.clusters);
    let circles = evidence.circles.iter().zip(&followers.circles);
    let straight: f64 = clusters
        .filter_map(|(c, i)| Some(evidence.salience(c) * USUAL[(*i)?].weight))
        .sum();
    let round: f64 = circles.map(|(g, k)| roundness(g, k.is_some())).sum();
    straight + round
}

/// What a group of circles adds to or takes from a frame's score.
fn roundness(group: &CircleGroup, explained: bool) -> f64 {
    let count = group.edges.len() as f64;
    match explained {
        true => CIRCLE * count,
        false if group.error < SURE => -STRAY_CIRCLE * count,
        false => 0.0,
    }
}

/// Vertices whose every edge follows the frame and which are no plane figure, by the weight of
/// their least usual edge. Edges of one plane can pass for the three axes, but do not meet so.
fn corners(evidence: &Evidence, followers: &Followers) -> f64 {
    let corner = |edges: &Vec<Shown>| {
        let mut weight: f64 = 1.0;
        let mut directions = Vec::with_capacity(edges.len());
        let mut round = false;
        for edge in edges {
            match *edge {
                Shown::Straight(c) => {
                    let usual = USUAL[followers.clusters[c]?];
                    weight = weight.min(usual.weight);
                    directions.push(usual.direction);
                }
                Shown::Circle(g) => {
                    followers.circles[g]?;
                    round = true;
                }
                Shown::Other => return None,
            }
        }
        let solid = directions.iter().enumerate().any(|(i, a)| {
            let normal = directions[i + 1..].iter().map(|b| a.cross(*b));
            normal
                .into_iter()
                .any(|n| directions.iter().any(|c| n.dot(*c).abs() > 0.1))
        });
        (edges.len() > 2 && (round || solid)).then_some(weight)
    };
    evidence.corners.iter().filter_map(corner).sum()
}

/// The axes of a frame with the edges and circles that follow them, in how many votes, and how many
/// numbers of a frame they and slanted edges would fix.
fn followed(
    evidence: &Evidence,
    found: &Hypothesis,
    followers: &Followers,
) -> ([Axis; 3], usize, usize) {
    let mut axes = columns(&found.frame).map(|direction| Axis {
        direction: towards_viewer(direction),
        edges: Vec::new(),
        circles: Vec::new(),
    });
    let mut constraints = 0;
    let mut votes = 0;
    for (cluster, i) in evidence.clusters.iter().zip(&followers.clusters) {
        constraints += usize::from(i.is_some());
        if let Some(axis) = i.and_then(|i| axes.get_mut(i)) {
            axis.edges.extend(evidence.edges_of(cluster));
            votes += cluster.members.len();
        }
    }
    for (group, k) in evidence.circles.iter().zip(&followers.circles) {
        if let Some(axis) = k.and_then(|k| axes.get_mut(k)) {
            axis.circles.extend(&group.edges);
            constraints += 2;
            votes += 2 * group.edges.len();
        }
    }
    (axes, votes, constraints)
}

fn frame_reading(
    evidence: &Evidence,
    found: &Hypothesis,
    followers: &Followers,
) -> Option<Reading> {
    let (axes, votes, constraints) = followed(evidence, found, followers);
    // Three constraints fix a frame. One without an edge or circle on some axis needs more to be
    // believed: two directions at a known angle beside an axis, or circles around two axes.
    let complete = axes
        .iter()
        .all(|a| !(a.edges.is_empty() && a.circles.is_empty()));
    let slanted = followers.clusters.iter().flatten().any(|&i| i > 2);
    let around_two = axes.iter().filter(|a| !a.circles.is_empty()).count() > 1;
    if constraints < 3 || !(complete || constraints > 3 && (slanted || around_two)) {
        return None;
    }
    Some(reading(evidence, found, followers, axes, votes))
}

fn reading(
    evidence: &Evidence,
    found: &Hypothesis,
    followers: &Followers,
    axes: [Axis; 3],
    votes: usize,
) -> Reading {
    let upright = axes.iter().any(|a| {
        let drawn = a.direction.truncate();
        drawn.x.abs() < AGREE * found.error && drawn.y.abs() > 0.1
    });
    Reading {
        score: explained(evidence, followers)
            + CORNER * corners(evidence, followers)
            + if upright { UPRIGHT } else { 0.0 },
        directions: Directions {
            axes: axes.into(),
            slanted: Vec::new(),
            swept: Vec::new(),
            camera: Camera::Parallel,
            error: found.error,
            precision: evidence.precision,
        },
        votes: votes as f64 - 3.0,
    }
}

/// The isometric view with one axis upright, if edges are drawn at 30 degrees to the page's horizontal:
/// no other view shows them so but by chance, and the less chance the better they are drawn.
fn isometric_reading(evidence: &Evidence) -> Option<Reading> {
    let frame = isometric();
    let error_of = |c: &Cluster| {
        let error = c.error(evidence.precision);
        let off = (c.direction.y.abs() - 0.5).abs();
        (off < AGREE * error && error < CHANCE).then_some(error)
    };
    let errors: Vec<f64> = evidence.clusters.iter().filter_map(error_of).collect();
    let error = errors.iter().copied().reduce(f64::min)?;
    let surprise: f64 = errors.iter().map(|e| (CHANCE / e).ln()).sum();
    let found = Hypothesis { frame, error };
    let followers = Followers::new(evidence, &found);
    let (axes, votes, _) = followed(evidence, &found, &followers);
    let mut reading = reading(evidence, &found, &followers, axes, votes);
    reading.score += surprise;
    // Nothing is fitted.
    reading.votes = votes as f64;
    Some(reading)
}

/// Axes of the isometric view: along the page's vertical, and 30 degrees up to either side of it.
fn isometric() -> DMat3 {
    let rise = (1.0f64 / 3.0).sqrt();
    let axis = |degrees: f64| {
        let drawn = DVec2::from_angle(degrees.to_radians()) * (2.0f64 / 3.0).sqrt();
        drawn.extend(rise)
    };
    DMat3::from_cols(axis(90.0), axis(210.0), axis(330.0))
}

/// The axis of a group of circles, from the circles and the straight edges along it.
fn axis_reading(evidence: &Evidence, group: &CircleGroup) -> Option<Reading> {
    let (normal, error) = (group.normal, group.error);
    let slant = normal.truncate().length();
    let drawn = normal.truncate() / slant;
    let along = evidence.clusters.iter().find(|c| {
        c.direction.perp_dot(drawn).abs() < AGREE * (error + c.error(evidence.precision))
    });
    let direction = match along {
        Some(c) if c.error(evidence.precision) < error => {
            let xy = c.direction * c.direction.dot(drawn).signum() * slant;
            DVec3::new(xy.x, xy.y, normal.z)
        }
        _ => normal,
    };
    let edges: Vec<usize> = along.map_or_else(Vec::new, |c| evidence.edges_of(c).collect());
    let others = evidence
        .circles
        .iter()
        .filter(|other| !std::ptr::eq(*other, group));
    let score = roundness(group, true)
        + others.map(|g| roundness(g, false)).sum::<f64>()
        + along.map_or(0.0, |c| evidence.salience(c));
    let votes = (2 * group.edges.len() + edges.len()) as f64 - 2.0;
    Some(Reading {
        directions: Directions {
            axes: vec![Axis {
                direction,
                edges,
                circles: group.edges.clone(),
            }],
            slanted: Vec::new(),
            swept: Vec::new(),
            camera: Camera::Parallel,
            error,
            precision: evidence.precision,
        },
        votes,
        score,
    })
    .filter(|r| r.votes > 0.0)
}

/// Whether two frames have the same axes, as they are or reversed in depth.
fn is_same(a: &DMat3, b: &DMat3, tolerance: f64) -> bool {
    [1.0, -1.0].iter().any(|&sign| {
        columns(b).iter().all(|v| {
            let v = DVec3::new(v.x, v.y, sign * v.z);
            columns(a).iter().any(|u| u.cross(v).length() < tolerance)
        })
    })
}
