//! Frustums whose ends follow no axes: drafted and lofted prisms of any outline.

use super::assumed::centred;
use super::directions::AGREE;
use super::rows::{Tag, Unknowns, normal_to};
use super::sheet::Sheet;
use super::system::System;

/// Two faces of parallel sides that edges join corner by corner are the ends of a frustum. If the
/// mean of these edges is drawn along one axis only, they are across it, one centred over the other.
pub(super) fn ends(sheet: &Sheet<'_>, unknowns: &Unknowns, system: &mut System<Tag>) {
    if !sheet.camera().is_parallel() {
        return;
    }
    for face in 0..sheet.faces.len() {
        let Some((p, leaving)) = unknowns.plane(face).zip(similar(sheet, face)) else {
            continue;
        };
        let axes = 0..sheet.directions.axes.len();
        let mut along = axes.filter_map(|k| Some((k, centred(sheet, face, &leaving, k)?)));
        if let (Some((k, row)), None) = (along.next(), along.next()) {
            normal_to(sheet, face, p, sheet.axis(k), row.tag, system);
            system.push(row.terms, row.rhs, row.weight, row.tag);
        }
    }
}

/// The edges from the corners of a planar face to those of another one whose sides are parallel to
/// its own.
fn similar(sheet: &Sheet<'_>, face: usize) -> Option<Vec<[usize; 2]>> {
    let far = |(v, e): (usize, usize)| {
        let [a, b] = sheet.drawing.edges[e].v;
        [v, if a == v { b } else { a }]
    };
    let leaving: Vec<[usize; 2]> = sheet.leaving(face).map(far).collect();
    let to = |v: usize| {
        let mut own = leaving.iter().filter(|l| l[0] == v);
        own.next().filter(|_| own.next().is_none()).map(|l| l[1])
    };
    let count = sheet.corners[face].len();
    let ends: Vec<usize> = sheet.corners[face].iter().filter_map(|&v| to(v)).collect();
    if count < 3 || leaving.len() != count || ends.len() != count {
        return None;
    }
    let has_ends = |g: usize| {
        let own = &sheet.corners[g];
        g != face && own.len() == count && own.iter().all(|v| ends.contains(v))
    };
    if !(0..sheet.faces.len()).any(|g| sheet.is_planar(g) && has_ends(g)) {
        return None;
    }
    let at = |v: usize| sheet.drawing.vertices[v];
    let parallel = |&e: &usize| {
        let [u, v] = sheet.drawing.edges[e].v;
        let (Some(s), Some(t)) = (to(u), to(v)) else {
            return false;
        };
        let (side, like) = (at(v) - at(u), at(t) - at(s));
        let error = 4.0 * sheet.directions.precision;
        sheet.is_straight(e)
            && side.perp_dot(like).abs() < AGREE * error * side.length().max(like.length())
    };
    let sides = sheet.edges_of(face);
    sides.iter().all(parallel).then_some(leaving)
}
