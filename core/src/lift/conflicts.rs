//! Faces that the lifted depths contradict.
//!
//! - A planar face's vertices lie in its plane.
//! - A cylinder's straight edges are along its axis.
//! - A face is nothing that is wrong by itself ([`evident`]).
//! - Faces that were blamed so that the others agree are named in any case.

use glam::DVec3;

use super::evident::evident;
use super::sheet::Sheet;
use super::{Conflict, Surface};
use crate::drawing::SurfaceKind;

/// Distance, in standard errors of a coordinate, from which on a vertex is off its surface.
const OFF: f64 = 50.0;

/// Conflicts of all faces, given depths and surfaces. `blamed` are faces that the depths were found
/// without.
pub(super) fn conflicts(
    sheet: &Sheet<'_>,
    depths: &[f64],
    surfaces: &[Surface],
    blamed: &[usize],
) -> Vec<Conflict> {
    let limit = OFF * sheet.directions.precision;
    let mut faces_at: Vec<Vec<usize>> = vec![Vec::new(); depths.len()];
    for (face, corners) in sheet.corners.iter().enumerate() {
        corners.iter().for_each(|&v| faces_at[v].push(face));
    }
    let place = |v: usize| sheet.camera().place(sheet.drawing.vertices[v], depths[v]);
    let mut all = Vec::new();
    for (face, surface) in surfaces.iter().enumerate() {
        let mut off: Vec<(usize, f64)> = match surface {
            Surface::Plane { origin, normal } => {
                let distance = |v: usize| (place(v) - *origin).dot(*normal).abs();
                let corners = sheet.corners[face].iter();
                corners.map(|&v| (v, distance(v))).collect()
            }
            _ if sheet.faces[face].kind == SurfaceKind::Cylinder => askew(sheet, face, &place),
            _ => Vec::new(),
        };
        if blamed.contains(&face) && sheet.is_planar(face) {
            off.extend(off_most(&sheet.corners[face], &place, limit));
        }
        off.retain(|(_, distance)| *distance > limit);
        off.extend(evident(sheet, face).into_iter().map(|v| (v, 0.0)));
        if off.is_empty() && blamed.contains(&face) {
            off = sheet.corners[face].iter().map(|&v| (v, 0.0)).collect();
        }
        if off.is_empty() {
            continue;
        }
        let residual = off.iter().map(|o| o.1).fold(0.0, f64::max);
        let mut vertices: Vec<usize> = off.iter().map(|o| o.0).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut others: Vec<usize> = vertices.iter().flat_map(|&v| faces_at[v].clone()).collect();
        others.sort_unstable();
        others.dedup();
        others.retain(|&f| f != face);
        all.push(Conflict {
            face,
            vertices,
            others,
            residual,
        });
    }
    all
}

/// Ends of the straight edges that are not along a cylinder's axis, with how much they are off: the
/// axis that most edges and circles of the face show.
fn askew(sheet: &Sheet<'_>, face: usize, place: &dyn Fn(usize) -> DVec3) -> Vec<(usize, f64)> {
    let edges = sheet.edges_of(face);
    let straight: Vec<([usize; 2], DVec3)> = edges
        .iter()
        .filter(|&&e| sheet.is_straight(e))
        .map(|&e| {
            let [a, b] = sheet.drawing.edges[e].v;
            ([a, b], place(b) - place(a))
        })
        .collect();
    let circles: Vec<DVec3> = edges
        .iter()
        .filter_map(|&e| Some(sheet.axis(sheet.circles[e].as_ref()?.0)))
        .collect();
    let limit = OFF * sheet.directions.precision;
    let aside = |d: &DVec3, axis: DVec3| d.cross(axis).length();
    let votes = |axis: DVec3| {
        let lines = straight.iter().filter(|(_, d)| aside(d, axis) < limit);
        let round = circles.iter().filter(|n| n.cross(axis).length() < 1e-6);
        lines.count() + 2 * round.count()
    };
    let directions = straight.iter().filter_map(|(_, d)| d.try_normalize());
    let Some(axis) = circles
        .iter()
        .copied()
        .chain(directions)
        .max_by_key(|a| votes(*a))
    else {
        return Vec::new();
    };
    let off = |(ends, d): &([usize; 2], DVec3)| ends.map(|v| (v, aside(d, axis)));
    straight.iter().flat_map(off).collect()
}

/// Corners that a plane may be laid through, at most.
const CORNERS: usize = 16;

/// Distances of corners from the plane through three of them that most of them lie in.
fn off_most(corners: &[usize], place: &dyn Fn(usize) -> DVec3, limit: f64) -> Vec<(usize, f64)> {
    let points: Vec<DVec3> = corners.iter().map(|&v| place(v)).collect();
    let some: Vec<DVec3> = points
        .iter()
        .copied()
        .step_by(points.len().div_ceil(CORNERS).max(1))
        .collect();
    let mut best: Option<(usize, DVec3, DVec3)> = None;
    for (i, &a) in some.iter().enumerate() {
        for (j, &b) in some.iter().enumerate().skip(i + 1) {
            for &c in &some[j + 1..] {
                let Some(n) = (b - a).cross(c - a).try_normalize() else {
                    continue;
                };
                let on = points.iter().filter(|p| (**p - a).dot(n).abs() < limit);
                let count = on.count();
                if best.is_none_or(|(most, ..)| count > most) {
                    best = Some((count, a, n));
                }
            }
        }
    }
    let Some((_, a, n)) = best else {
        return Vec::new();
    };
    let distances = points.iter().map(|p| (*p - a).dot(n).abs());
    corners.iter().copied().zip(distances).collect()
}
