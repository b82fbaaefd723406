//! Faces that the lifted depths contradict.

use super::sheet::Sheet;
use super::{Conflict, Surface};

/// Distance of a vertex from its face's plane, in standard errors of a coordinate, from which on it
/// is off the plane.
const OFF: f64 = 50.0;

/// Conflicts of planar faces, given all depths and surfaces.
pub(super) fn conflicts(sheet: &Sheet<'_>, depths: &[f64], surfaces: &[Surface]) -> Vec<Conflict> {
    let limit = OFF * sheet.directions.precision;
    let mut faces_at: Vec<Vec<usize>> = vec![Vec::new(); depths.len()];
    for (face, corners) in sheet.corners.iter().enumerate() {
        corners.iter().for_each(|&v| faces_at[v].push(face));
    }
    let mut all = Vec::new();
    for (face, surface) in surfaces.iter().enumerate() {
        let Surface::Plane { origin, normal } = surface else {
            continue;
        };
        let off = |v: usize| {
            let p = sheet.camera().place(sheet.drawing.vertices[v], depths[v]);
            (p - *origin).dot(*normal).abs()
        };
        let corners = &sheet.corners[face];
        let vertices: Vec<usize> = corners
            .iter()
            .copied()
            .filter(|&v| off(v) > limit)
            .collect();
        if vertices.is_empty() {
            continue;
        }
        let mut others: Vec<usize> = vertices.iter().flat_map(|&v| faces_at[v].clone()).collect();
        others.sort_unstable();
        others.dedup();
        others.retain(|&f| f != face);
        all.push(Conflict {
            face,
            residual: vertices.iter().map(|&v| off(v)).fold(0.0, f64::max),
            vertices,
            others,
        });
    }
    all
}
