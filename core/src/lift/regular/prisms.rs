//! Short edges take their direction from the prism that they are of.
//!
//! The side of a prism, be it a plate, a slot or a step, is a row of faces with four edges, of which
//! every second one follows the prism's axis. Each of them may be no longer than the noise, so that
//! it follows any axis; together they tell which one.

use crate::drawing::{CoEdge, Drawing};
use crate::identify::Face;
use crate::lift::directions::Directions;
use crate::sets::Sets;

/// Errors by which an edge may be off an axis that it follows.
const ERRORS: f64 = 3.5;

/// A row follows the axis that fits better than the others by this, in squared errors.
const CLEAR: f64 = 8.0;

/// An axis that is drawn shorter is seen from its end and has no direction in the drawing.
const END_ON: f64 = 0.05;

/// The reading, with the edges of rows along the axes that the rows tell.
pub(super) fn completed(drawing: &Drawing, faces: &[Face], mut reading: Directions) -> Directions {
    let rows = rows(drawing, faces, reading.precision);
    for row in rows.iter().filter(|row| row.len() > 1) {
        let error = std::f64::consts::SQRT_2 * reading.precision;
        let misses = |k: usize| -> Vec<f64> {
            let offs = row.iter().map(|&e| off(drawing, &reading, e, k) / error);
            offs.collect()
        };
        let mut fits: Vec<(f64, usize)> = (0..reading.axes.len())
            .map(|k| (misses(k).iter().map(|m| m * m).sum(), k))
            .collect();
        fits.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some(&(best, k)) = fits.first() else {
            continue;
        };
        let clear = fits.get(1).is_none_or(|second| second.0 > best + CLEAR);
        if !clear || misses(k).iter().any(|m| m.abs() > ERRORS) {
            continue;
        }
        for axis in &mut reading.axes {
            axis.edges.retain(|e| !row.contains(e));
        }
        reading.axes[k].edges.extend(row);
        reading.axes[k].edges.sort_unstable();
    }
    reading
}

/// How far an edge's second end is drawn off the line along an axis through its first.
fn off(drawing: &Drawing, reading: &Directions, edge: usize, axis: usize) -> f64 {
    let [a, b] = drawing.edges[edge].v.map(|v| drawing.vertices[v]);
    let drawn = reading
        .camera
        .drawn(reading.axes[axis].direction, a.midpoint(b));
    if drawn.length() < END_ON {
        (b - a).length()
    } else {
        drawn.normalize().perp_dot(b - a)
    }
}

/// Straight edges in rows of faces with four edges, each opposite the next.
fn rows(drawing: &Drawing, faces: &[Face], precision: f64) -> Vec<Vec<usize>> {
    let mut sets = Sets::new(drawing.edges.len());
    let vector = |c: &CoEdge| {
        let [a, b] = drawing.edges[c.edge()].v.map(|v| drawing.vertices[v]);
        if c.is_reversed() { a - b } else { b - a }
    };
    for face in faces {
        let [walk] = &face.loops[..] else {
            continue;
        };
        let [a, b, c, d] = &walk[..] else {
            continue;
        };
        for [one, two] in [[a, c], [b, d]] {
            let straight = [one, two].map(|c| drawing.edges[c.edge()].is_straight());
            if straight != [true; 2] {
                continue;
            }
            // Opposite sides of a loop run against each other.
            let (s, t) = (vector(one), -vector(two));
            let (short, long) = if s.length() < t.length() { (s, t) } else { (t, s) };
            let off = long.normalize_or_zero().perp_dot(short);
            if off.abs() < ERRORS * std::f64::consts::SQRT_2 * precision {
                sets.join(one.edge(), two.edge());
            }
        }
    }
    let mut rows = vec![Vec::new(); drawing.edges.len()];
    for e in (0..drawing.edges.len()).filter(|&e| drawing.edges[e].is_straight()) {
        rows[sets.find(e)].push(e);
    }
    rows
}
