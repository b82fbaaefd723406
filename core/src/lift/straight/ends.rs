//! Ends of prisms, once loops are known.
//!
//! The sides of a small pocket of six corners are short, and one of them agrees with an axis by
//! chance, which tilts its floor. But all edges that leave the floor are long and follow one axis,
//! so it is across that axis whatever its own edges look like, and these need not be trusted.

use std::f64::consts::SQRT_2;

use crate::lift::directions::Directions;
use crate::lift::sheet::Sheet;

/// Errors beyond which an edge is long.
const LONG: f64 = 60.0;

/// The directions of a sheet without the short edges around ends of prisms whose sides are longer.
pub(in crate::lift) fn trusted(sheet: &Sheet<'_>) -> Directions {
    let errors = |e: usize| {
        let length = sheet.drawing.edges[e].length();
        length / (SQRT_2 * sheet.directions.precision)
    };
    let mut doubted = vec![false; sheet.drawing.edges.len()];
    let mut sides = vec![false; sheet.drawing.edges.len()];
    for face in (0..sheet.faces.len()).filter(|&f| sheet.is_planar(f)) {
        let leaving: Vec<usize> = sheet.leaving(face).map(|(_, e)| e).collect();
        let Some(axis) = leaving.first().and_then(|&e| sheet.edge_axis[e]) else {
            continue;
        };
        let shortest = leaving
            .iter()
            .map(|&e| errors(e))
            .fold(f64::INFINITY, f64::min);
        let follows = |e: &usize| sheet.edge_axis[*e] == Some(axis);
        let own = sheet.edges_of(face);
        if leaving.len() < sheet.corners[face].len()
            || !leaving.iter().all(follows)
            || own.iter().any(follows)
        {
            continue;
        }
        let short = own.iter().filter(|&&e| errors(e) < shortest.min(LONG));
        short.for_each(|&e| doubted[e] = true);
        leaving.iter().for_each(|&e| sides[e] = true);
    }
    let mut trusted = sheet.directions.clone();
    for axis in &mut trusted.axes {
        axis.edges.retain(|&e| !doubted[e] || sides[e]);
    }
    trusted
}
