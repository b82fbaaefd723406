//! Edges that a reading takes for along an axis although they may not be.
//!
//! A short edge agrees with an axis by chance. What is drilled or milled is a prism, though, so that
//! each of its edges is there several times, parallel and of one length: together these tell.

use std::f64::consts::SQRT_2;

use glam::DVec2;

use crate::drawing::Drawing;
use crate::lift::directions::Directions;

/// Errors within which lengths are one, and within which an edge may follow an axis at all.
const ALIKE: f64 = 3.0;
const NEAR: f64 = 4.0;

/// Errors of their mean by which edges of one length are aside of an axis.
const ASIDE: f64 = 2.7;

/// Errors beyond which an edge is long, and within which it is along an axis for sure.
const LONG: f64 = 30.0;
const CLOSE: f64 = 2.0;

/// How an edge is drawn against an axis.
struct Against {
    edge: usize,
    length: f64,
    /// Distance of one end from the line along the axis through the other, in errors; signed.
    off: f64,
}

/// The reading without edges that are aside of their axes together with others of their length.
pub(super) fn without_aside(drawing: &Drawing, mut reading: Directions) -> Directions {
    let error = SQRT_2 * reading.precision;
    for k in 0..reading.axes.len() {
        let mut all = against(drawing, &reading, k);
        all.retain(|a| a.off.abs() < NEAR);
        let is_aside = |edge: &usize| {
            let Some(own) = all.iter().find(|a| a.edge == *edge) else {
                return false;
            };
            let alike = all
                .iter()
                .filter(|a| (a.length - own.length).abs() < ALIKE * error);
            let (sum, count) = alike.fold((0.0, 0.0), |(s, n), a| (s + a.off, n + 1.0));
            count > 1.0 && f64::abs(sum) > ASIDE * f64::sqrt(count)
        };
        let aside: Vec<usize> = reading.axes[k]
            .edges
            .iter()
            .copied()
            .filter(is_aside)
            .collect();
        reading.axes[k].edges.retain(|e| !aside.contains(e));
    }
    reading
}

/// The reading with those edges only that are long enough to be told from others.
pub(super) fn long(drawing: &Drawing, reading: &Directions) -> Directions {
    let error = SQRT_2 * reading.precision;
    let mut long = reading.clone();
    for (k, axis) in long.axes.iter_mut().enumerate() {
        let all = against(drawing, reading, k);
        axis.edges.retain(|e| {
            let own = all.iter().find(|a| a.edge == *e);
            own.is_some_and(|a| a.length > LONG * error && a.off.abs() < CLOSE)
        });
    }
    long
}

/// All straight edges against an axis.
fn against(drawing: &Drawing, reading: &Directions, axis: usize) -> Vec<Against> {
    let direction = reading.axes[axis].direction;
    let along = direction.truncate().normalize_or(DVec2::X);
    let straight = drawing
        .edges
        .iter()
        .enumerate()
        .filter(|(_, e)| e.is_straight());
    straight
        .map(|(edge, e)| {
            let [u, v] = e.v.map(|v| drawing.vertices[v]);
            let chord = v - u;
            Against {
                edge,
                length: chord.length(),
                off: chord.perp_dot(along) * chord.dot(along).signum()
                    / (SQRT_2 * reading.precision),
            }
        })
        .collect()
}
