//! Cylinders whose vertices are not all known: fillets, which an outline parts.
//!
//! The two edges of a fillet run along its axis, each in a plane that it touches. The circle across
//! the axis through both that touches one of the planes is the fillet if the lines of sight to its
//! outlines touch it.

use glam::{DVec2, DVec3};

use super::Surface;
use super::heights::Heights;
use super::sheet::Sheet;
use super::surfaces::{touching, touching_circle};
use crate::drawing::SurfaceKind;

/// Largest distance, relative to the drawing's size, of a line of sight to an outline from touching.
const OFF: f64 = 1e-4;

/// Fills in the cylinders that are not known.
pub(super) fn fill(sheet: &Sheet<'_>, heights: &Heights, surfaces: &mut [Surface]) {
    for whole in touching(sheet) {
        // Other cylinders may meet these along edges that are no outlines.
        for pair in pairs(sheet, &whole) {
            let is_open = |f: &usize| {
                sheet.faces[*f].kind == SurfaceKind::Cylinder && surfaces[*f] == Surface::Unknown
            };
            if pair.iter().all(is_open)
                && let Some(found) = fillet(sheet, heights, pair)
            {
                pair.iter().for_each(|&f| surfaces[f] = found);
            }
        }
    }
}

/// Pairs of faces with a straight edge between them: outlines of cylinders.
fn pairs(sheet: &Sheet<'_>, whole: &[usize]) -> Vec<[usize; 2]> {
    let edges = whole.iter().flat_map(|&f| sheet.edges_of(f));
    let mut pairs: Vec<[usize; 2]> = edges
        .filter(|&&e| sheet.is_straight(e))
        .filter_map(|&e| match *sheet.neighbours(e) {
            [a, b] if whole.contains(&a) && whole.contains(&b) => Some([a.min(b), a.max(b)]),
            _ => None,
        })
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

fn fillet(sheet: &Sheet<'_>, heights: &Heights, pair: [usize; 2]) -> Option<Surface> {
    let edges = || pair.iter().flat_map(|&f| sheet.edges_of(f)).copied();
    let axis = edges().find_map(|e| sheet.edge_axis[e])?;
    let axis = sheet.axis(axis);
    let u = axis.any_orthonormal_vector();
    let w = axis.cross(u);
    let flat = |p: DVec3| DVec2::new(p.dot(u), p.dot(w));
    let place = |v: usize| sheet.place(sheet.drawing.vertices[v], heights.of(v));
    let mut points: Vec<DVec3> = Vec::new();
    // Edges along the axis in planes, with the planes' normals.
    let mut sides: Vec<(DVec2, DVec2)> = Vec::new();
    let mut outlines: Vec<usize> = Vec::new();
    for e in edges() {
        let ends = sheet.drawing.edges[e].v;
        points.extend(
            ends.iter()
                .filter(|&&v| heights.known[v])
                .map(|&v| place(v)),
        );
        if !sheet.is_straight(e) {
            continue;
        }
        let beside = sheet.neighbours(e);
        if beside.iter().all(|f| pair.contains(f)) {
            outlines.extend(ends);
        }
        let Some(&v) = ends.iter().find(|&&v| heights.known[v]) else {
            continue;
        };
        for &f in beside {
            if let Some(plane) = heights.plane(f) {
                let normal = sheet.camera().normal(plane, sheet.middles[f]);
                sides.extend(flat(normal).try_normalize().map(|n| (flat(place(v)), n)));
            }
        }
    }
    let flat_points: Vec<DVec2> = points.iter().map(|&p| flat(p)).collect();
    let gap = |(center, radius): &(DVec2, f64)| {
        let known = flat_points
            .iter()
            .map(|p| (p.distance(*center) - radius).abs());
        let seen = outlines.iter().map(|&v| {
            let (from, ray) = sheet.camera().ray(sheet.drawing.vertices[v]);
            let side = flat(ray).perp().normalize_or_zero();
            (side.dot(*center - flat(from)).abs() - radius).abs()
        });
        known.chain(seen).fold(0.0, f64::max)
    };
    let (center, radius) = sides
        .iter()
        .filter_map(|&(p, normal)| touching_circle(&flat_points, p, normal))
        .min_by(|a, b| gap(a).total_cmp(&gap(b)))?;
    let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    (gap(&(center, radius)) < OFF * sheet.size).then(|| Surface::Cylinder {
        origin: u * center.x + w * center.y + axis * middle.dot(axis),
        axis,
        radius,
    })
}
