//! Loose parts of a drawing, tied by the surfaces that the other depths fix.
//!
//! A vertex on a known cylinder, cone, sphere or torus lies where its line of sight meets the
//! surface: at two depths or four, of which the vertices of one loose part agree on one in a
//! parallel projection. A vertex
//! of outlines only lies where its line of sight touches the surface.

use super::Surface;
use super::heights::Heights;
use super::ring_torus::touches;
use super::sheet::Sheet;
use super::surfaces::surfaces_of;

/// Shifts of a part that differ by less than this share of the drawing's size agree.
const AGREE: f64 = 1e-4;

/// A line of sight at a smaller angle to the surface (its sine) does not tell the depth.
const GRAZING: f64 = 0.05;

/// A height that a surface gives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tie {
    pub(super) vertex: usize,
    pub(super) height: f64,
    /// Expected error.
    pub(super) error: f64,
    /// The face whose surface it is.
    pub(super) face: usize,
}

/// Ties for those of the loose groups that known surfaces place.
pub(super) fn ties(sheet: &Sheet<'_>, heights: &Heights, groups: &[Vec<usize>]) -> Vec<Tie> {
    // Only faces of loose vertices can tie them, and what is beside these faces may tell their
    // surface.
    let mut near = vec![false; sheet.faces.len()];
    for (face, corners) in sheet.corners.iter().enumerate() {
        if !heights.are_known(corners) {
            near[face] = true;
            let beside = sheet.edges_of(face).iter();
            beside
                .flat_map(|&e| sheet.neighbours(e))
                .for_each(|&f| near[f] = true);
        }
    }
    let surfaces = surfaces_of(sheet, heights, |face| near[face]);
    groups
        .iter()
        .filter_map(|group| tie(sheet, heights, &surfaces, group))
        .collect()
}

/// A shift of a whole group in depth that one of its vertices asks for.
struct Shift {
    by: f64,
    tie: Tie,
}

fn tie(sheet: &Sheet<'_>, heights: &Heights, surfaces: &[Surface], group: &[usize]) -> Option<Tie> {
    let mut asked: Vec<Vec<Shift>> = Vec::new();
    for &vertex in group {
        for (face, surface) in surfaces.iter().enumerate() {
            let round = !matches!(surface, Surface::Plane { .. } | Surface::Unknown);
            if round && sheet.corners[face].binary_search(&vertex).is_ok() {
                let found = heights_on(sheet, surface, vertex, face);
                let shift = |tie: Tie| Shift {
                    by: tie.height - heights.of(vertex),
                    tie,
                };
                asked.push(found.into_iter().map(shift).collect());
            }
        }
    }
    // The shift that most of them agree on; with one vertex, one that is the only one.
    let near = AGREE * sheet.size;
    let support = |by: f64| {
        let fits = |list: &&Vec<Shift>| list.iter().any(|s| (s.by - by).abs() < near + s.tie.error);
        asked.iter().filter(fits).count()
    };
    let all: Vec<&Shift> = asked.iter().flatten().collect();
    let best = all.iter().max_by(|a, b| {
        let (s, t) = (support(a.by), support(b.by));
        s.cmp(&t).then(b.tie.error.total_cmp(&a.tie.error))
    })?;
    let most = support(best.by);
    let rival = all
        .iter()
        .any(|s| (s.by - best.by).abs() > 2.0 * near + s.tie.error && support(s.by) == most);
    (!rival).then_some(best.tie)
}

/// Heights at which a vertex may lie on a surface.
fn heights_on(sheet: &Sheet<'_>, surface: &Surface, vertex: usize, face: usize) -> Vec<Tie> {
    let (from, ray) = sheet.camera().ray(sheet.drawing.vertices[vertex]);
    let precision = sheet.directions.precision;
    let inside = |e: &usize| {
        let faces = sheet.neighbours(*e);
        faces.len() == 2
            && faces
                .iter()
                .all(|&f| sheet.faces[f].kind == sheet.faces[face].kind)
            && sheet.circles[*e].is_none()
    };
    let tie = |t: f64, error: f64| Tie {
        vertex,
        height: sheet.camera().height((from + ray * t).z),
        error,
        face,
    };
    let at = sheet.edges_at(vertex);
    let outline = !at.is_empty() && at.iter().all(inside);
    if outline {
        let found = match *surface {
            Surface::Sphere { center, .. } => vec![(center - from).dot(ray) / ray.length_squared()],
            Surface::Torus { .. } => touches(surface, from, ray, 1e-3 * sheet.size),
            _ => Vec::new(),
        };
        return found
            .into_iter()
            .map(|t| tie(t, 10.0 * precision))
            .collect();
    }
    surface
        .crossings(from, ray)
        .into_iter()
        .filter_map(|t| {
            let slope = surface.gradient(from + ray * t).dot(ray.normalize()).abs();
            (slope > GRAZING).then(|| tie(t, 4.0 * precision / slope))
        })
        .collect()
}
