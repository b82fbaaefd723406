//! A drawing by hand made straight before its faces are known.
//!
//! Which edges follow an axis and which arcs are circles around one is told by the frame alone. So
//! the vertices are moved as little as possible until such edges are exactly along their axes, such
//! arcs exactly circles, and opposite sides of parallelograms exactly alike. Loops of edges along
//! axes close in depth then, whatever the faces are, and only what is oblique keeps its errors.
//! An edge that seemed to follow an axis and pulls its ends too far away is let go.

mod circles;
mod doubts;
pub(super) mod ends;
mod parallelograms;
mod redraw;
mod solve;
#[cfg(test)]
mod tests;

use super::directions::{Directions, is_exact, recognised};
use crate::drawing::{Drawing, Projection};
use parallelograms::{Sides, sides};
use solve::Bundle;

/// A drawing as it is drawn or made straight, with one reading of its directions.
#[derive(Debug, Clone)]
pub(crate) struct Straight {
    pub(crate) drawing: Drawing,
    /// Its directions; the precision is the error of the drawing as it was drawn.
    pub(crate) directions: Directions,
    sides: Vec<Sides>,
}

impl Straight {
    /// Edges that are parallel, of each set.
    pub(super) fn parallels(&self) -> Vec<Vec<usize>> {
        let all = self.sides.iter();
        all.map(|s| s.edges.iter().map(|m| m.0).collect()).collect()
    }

    /// The drawing, as it was drawn, made straight anew by other directions; `None` if it cannot be
    /// solved.
    pub(super) fn anew(&self, drawn: &Drawing, directions: Directions) -> Option<Self> {
        straighten(drawn, directions, self.sides.clone())
    }
}

/// Readings of a drawing by hand, most likely first; none if it is exact or nothing is told.
pub(crate) fn straightened(drawing: &Drawing) -> Vec<Straight> {
    if !matches!(drawing.projection, Projection::Orthographic) || is_exact(drawing) {
        return Vec::new();
    }
    let readings = Directions::coarse(drawing).into_iter();
    readings
        .flat_map(|reading| {
            let sides = sides(drawing, reading.precision);
            let reading = doubts::without_aside(drawing, reading);
            let long = doubts::long(drawing, &reading);
            [reading, long].map(|r| (parallelograms::told(&sides, r), sides.clone()))
        })
        .filter_map(|(reading, sides)| straighten(drawing, reading, sides))
        .collect()
}

/// The drawing made straight by one reading; `None` if it cannot be solved.
fn straighten(drawing: &Drawing, mut reading: Directions, sides: Vec<Sides>) -> Option<Straight> {
    let drawing = recognised(drawing, reading.precision);
    circles::take_in(&drawing, &mut reading);
    let mut bundle = Bundle::new(&drawing, &reading, &sides);
    let fitted = bundle.solve()?;
    let mut directions = reading.clone();
    directions.precision = fitted.error;
    for axis in &mut directions.axes {
        axis.edges.retain(|e| bundle.follows(*e));
        axis.circles.retain(|e| bundle.circle_of(*e).is_some());
    }
    Some(Straight {
        drawing: redraw::applied(&drawing, &bundle, &fitted),
        directions,
        sides,
    })
}
