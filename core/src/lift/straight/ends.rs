//! Ends of prisms, once loops are known.
//!
//! The sides of a small pocket of six corners are short, and one of them agrees with an axis by
//! chance, which tilts its floor. But all edges that leave the floor are long and follow one axis,
//! so it is across that axis whatever its own edges look like, and these need not be trusted. Where
//! another pocket cuts some of the leaving edges short, the others tell their axis, too.

use std::f64::consts::SQRT_2;

use glam::DVec2;

use crate::lift::directions::Directions;
use crate::lift::sheet::Sheet;

/// Errors beyond which an edge is long.
const LONG: f64 = 60.0;

/// Errors within which an edge may follow an axis.
const NEAR: f64 = 4.0;

/// Ends of prisms.
pub(in crate::lift) struct Ends {
    /// The faces, each with the axis that it is across.
    pub(in crate::lift) faces: Vec<(usize, usize)>,
    /// The directions of the sheet with all edges that leave these faces along their axes, and
    /// without the short edges around them if the sides are longer; `None` if they are so already.
    pub(in crate::lift) directions: Option<Directions>,
}

/// The ends of prisms of a drawing by hand.
pub(in crate::lift) fn ends(sheet: &Sheet<'_>) -> Ends {
    let precision = SQRT_2 * sheet.directions.precision;
    let errors = |e: usize| sheet.drawing.edges[e].length() / precision;
    let may_follow = |e: usize, k: usize| {
        let [a, b] = sheet.drawing.edges[e].v.map(|v| sheet.drawing.vertices[v]);
        let drawn = sheet.axis(k).truncate().normalize_or(DVec2::X);
        drawn.perp_dot(b - a).abs() < NEAR * precision
    };
    let count = sheet.drawing.edges.len();
    let mut faces = Vec::new();
    let mut doubted = vec![false; count];
    let mut sides: Vec<Option<usize>> = vec![None; count];
    for face in (0..sheet.faces.len()).filter(|&f| sheet.is_planar(f)) {
        let leaving: Vec<usize> = sheet.leaving(face).map(|(_, e)| e).collect();
        let following = |k: usize| {
            let own = leaving.iter().filter(|&&e| sheet.edge_axis[e] == Some(k));
            own.count()
        };
        let Some(axis) = (0..sheet.directions.axes.len()).max_by_key(|&k| following(k)) else {
            continue;
        };
        let own = sheet.edges_of(face);
        if leaving.len() < sheet.corners[face].len()
            || 2 * following(axis) < leaving.len()
            || following(axis) < leaving.len().min(2)
            || !leaving.iter().all(|&e| may_follow(e, axis))
            || own.iter().any(|&e| sheet.edge_axis[e] == Some(axis))
        {
            continue;
        }
        faces.push((face, axis));
        let shortest = leaving
            .iter()
            .filter(|&&e| sheet.edge_axis[e] == Some(axis))
            .map(|&e| errors(e))
            .fold(f64::INFINITY, f64::min);
        let short = own.iter().filter(|&&e| errors(e) < shortest.min(LONG));
        short.for_each(|&e| doubted[e] = true);
        leaving.iter().for_each(|&e| sides[e] = Some(axis));
    }
    let mut trusted = sheet.directions.clone();
    let mut changed = false;
    for (k, axis) in trusted.axes.iter_mut().enumerate() {
        let before = std::mem::take(&mut axis.edges);
        let follows = |&e: &usize| match sides[e] {
            Some(side) => side == k,
            None => !doubted[e] && before.contains(&e),
        };
        axis.edges = (0..count).filter(follows).collect();
        changed |= axis.edges != before;
    }
    Ends {
        faces,
        directions: changed.then_some(trusted),
    }
}
