//! Circles around axes, as unknowns.

use glam::{DMat2, DVec2, DVec3};

use crate::drawing::Drawing;
use crate::lift::directions::Directions;
use crate::lift::{Camera, circle_through};

/// Errors, and share of the radius, within which arcs that share a vertex are of one circle.
const ONE: f64 = 4.0;
const ALIKE: f64 = 0.2;

/// A circle around an axis in a parallel projection.
#[derive(Debug, Clone)]
pub(super) struct Circle {
    pub(super) axis: usize,
    /// Edges that are arcs of it.
    pub(super) edges: Vec<usize>,
    pub(super) center: DVec2,
    pub(super) radius: f64,
    /// Error of its centre for a unit error of its points.
    pub(super) gain: f64,
    /// From the drawing to the circle's plane.
    pub(super) unfold: DMat2,
}

impl Circle {
    /// How far a drawn point is outside, in its plane.
    pub(super) fn outside(&self, p: DVec2) -> f64 {
        (self.unfold * (p - self.center)).length() - self.radius
    }

    /// How that changes with the point.
    pub(super) fn slope(&self, p: DVec2) -> DVec2 {
        let q = (self.unfold * (p - self.center)).normalize_or(DVec2::X);
        self.unfold.transpose() * q
    }

    /// The point of the circle in the direction of `p` from its centre.
    pub(super) fn onto(&self, p: DVec2) -> DVec2 {
        let q = (self.unfold * (p - self.center)).normalize_or(DVec2::X);
        self.center + self.unfold.inverse() * (q * self.radius)
    }
}

/// The map from the drawing to a plane of the unit normal `n`.
fn unfold(n: DVec3) -> DMat2 {
    let along = n.truncate().normalize_or(DVec2::X);
    let across = along.perp();
    // Rows: across the drawn normal lengths are drawn as they are, along it shortened.
    DMat2::from_cols(across, along / n.z.abs()).transpose()
}

/// Errors within which the points of a circle are on it, and how many times as badly they fit
/// circles around other axes.
const ON: f64 = 3.0;
const CLEARLY: f64 = 3.0;

/// Adds arcs to the axes that they are drawn as circles around, which alone are too short or too
/// inexact to tell an axis: two arcs between the same vertices are taken together.
pub(super) fn take_in(drawing: &Drawing, directions: &mut Directions) {
    let free =
        |e: &usize| !drawing.edges[*e].is_straight() && directions.axis_of_circle(*e).is_none();
    let open: Vec<usize> = (0..drawing.edges.len()).filter(free).collect();
    let ends = |e: usize| {
        let [a, b] = drawing.edges[e].v;
        [a.min(b), a.max(b)]
    };
    let mut found: Vec<(usize, Vec<usize>)> = Vec::new();
    for (i, &e) in open.iter().enumerate() {
        let twins = open
            .iter()
            .copied()
            .filter(|&f| f != e && ends(f) == ends(e));
        let twins: Vec<usize> = twins.collect();
        let group = match twins[..] {
            [] if ends(e)[0] == ends(e)[1] => vec![e],
            [f] if open[..i].contains(&f) => continue,
            [f] => vec![e, f],
            _ => continue,
        };
        let points: Vec<DVec2> = group
            .iter()
            .flat_map(|&e| drawing.edges[e].points.iter().copied())
            .collect();
        let misses = directions.axes.iter().map(|axis| {
            let circle = circle_through(&points, axis.direction, &Camera::Parallel);
            circle.map_or(f64::INFINITY, |c| c.residual * axis.direction.z.abs())
        });
        let misses: Vec<f64> = misses.collect();
        let best = (0..misses.len()).min_by(|&a, &b| misses[a].total_cmp(&misses[b]));
        let Some(best) = best else { continue };
        let rival = (0..misses.len())
            .filter(|&k| k != best)
            .map(|k| misses[k])
            .fold(f64::INFINITY, f64::min);
        if misses[best] < ON * directions.precision && rival > CLEARLY * misses[best] {
            found.push((best, group));
        }
    }
    for (axis, edges) in found {
        directions.axes[axis].circles.extend(edges);
    }
}

/// The circles that a reading tells, arcs of one circle together.
pub(super) fn circles(drawing: &Drawing, directions: &Directions) -> Vec<Circle> {
    let mut all: Vec<Circle> = Vec::new();
    for (k, axis) in directions.axes.iter().enumerate() {
        for &e in &axis.circles {
            let edge = &drawing.edges[e];
            let Some(c) = circle_through(&edge.points, axis.direction, &Camera::Parallel) else {
                continue;
            };
            let new = Circle {
                axis: k,
                edges: vec![e],
                center: c.center,
                radius: c.radius,
                gain: c.gain,
                unfold: unfold(axis.direction),
            };
            let same = |old: &&mut Circle| {
                let shared = old
                    .edges
                    .iter()
                    .any(|&f| drawing.edges[f].v.iter().any(|v| edge.v.contains(v)));
                let near = ONE * directions.precision * (1.0 + old.gain.hypot(new.gain));
                let near = near.min(ALIKE * old.radius.min(new.radius));
                shared
                    && old.axis == k
                    && (old.unfold * (old.center - new.center)).length() < near
                    && (old.radius - new.radius).abs() < near
            };
            match all.iter_mut().find(same) {
                Some(old) => {
                    if new.gain < old.gain {
                        (old.center, old.radius, old.gain) = (new.center, new.radius, new.gain);
                    }
                    old.edges.push(e);
                }
                None => all.push(new),
            }
        }
    }
    all
}

/// Pairs of circles around one line, each with the one that shows it best: across the drawn axis
/// their centres are as near as their errors allow.
pub(super) fn coaxial(circles: &[Circle], directions: &Directions) -> Vec<[usize; 2]> {
    const ERRORS: f64 = 2.5;
    let mut order: Vec<usize> = (0..circles.len()).collect();
    order.sort_by(|&a, &b| circles[a].gain.total_cmp(&circles[b].gain));
    let mut heads: Vec<usize> = Vec::new();
    let mut pairs = Vec::new();
    for i in order {
        let c = &circles[i];
        let along = directions.axes[c.axis].direction.truncate();
        let off = |h: &usize| {
            let head = &circles[*h];
            let apart = (c.center - head.center).perp_dot(along.normalize_or(DVec2::X));
            apart.abs() / (directions.precision * c.gain.hypot(head.gain).max(1.0))
        };
        let heads_near = heads.iter().copied().filter(|&h| circles[h].axis == c.axis);
        let nearest = heads_near.min_by(|a, b| off(a).total_cmp(&off(b)));
        match nearest {
            Some(h) if off(&h) < ERRORS => pairs.push([h, i]),
            _ => heads.push(i),
        }
    }
    pairs
}
