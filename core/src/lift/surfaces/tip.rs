//! Tips of holes: cones that only one circle bounds, seen so steeply that nothing shows their apex.

use super::evidence::{Evidence, Sight, vertex};
use crate::lift::Surface;
use crate::lift::heights::Heights;
use crate::lift::sheet::Sheet;

/// Half angles of what makes such tips, radians, the likeliest first: drills of 118, 135 and 140 degrees.
const HALVES: [f64; 3] = [1.029_744, 1.178_097, 1.221_730];

/// Share of a ring's radius by which circles are one.
const SAME: f64 = 1e-3;

/// The tip beyond the cylinder that ends in the circle, of the likeliest angle whose outlines would
/// not be seen.
pub(super) fn hidden(
    sheet: &Sheet<'_>,
    heights: &Heights,
    whole: &[usize],
    known: &[Surface],
) -> Option<Surface> {
    let evidence = Evidence::new(sheet, heights, whole, known);
    let (ring, _) = evidence.rings().next()?;
    let all_one = evidence.rings().count() == evidence.bounds.len()
        && evidence.rings().all(|(r, _)| {
            r.center.distance(ring.center) < SAME * ring.radius
                && (r.radius - ring.radius).abs() < SAME * ring.radius
        });
    let round = |b: &super::evidence::Bound| matches!(b.beside, Surface::Cylinder { .. });
    if !all_one || !evidence.outlines.is_empty() || !evidence.bounds.iter().all(round) {
        return None;
    }
    // The cylinder is on the other side of the circle.
    let edges = whole.iter().flat_map(|&f| sheet.edges_of(f));
    let mut beside: Vec<usize> = edges
        .flat_map(|&e| sheet.neighbours(e))
        .filter(|f| !whole.contains(f))
        .flat_map(|&f| &sheet.corners[f])
        .copied()
        .filter(|&v| heights.known[v])
        .collect();
    beside.sort_unstable();
    beside.dedup();
    let rise: f64 = beside
        .iter()
        .map(|&v| (vertex(sheet, heights, v) - ring.center).dot(ring.normal))
        .sum();
    if rise.abs() < SAME * ring.radius {
        return None;
    }
    let axis = ring.normal * rise.signum();
    let sight = Sight::new(sheet.camera(), sheet.camera().project(ring.center));
    let view = axis.dot(sight.direction).abs().min(1.0).acos();
    let angle = HALVES.into_iter().find(|half| *half > view);
    let angle = angle.unwrap_or_else(|| f64::midpoint(view, std::f64::consts::FRAC_PI_2));
    Some(Surface::Cone {
        apex: ring.center - axis * (ring.radius / angle.tan()),
        axis,
        angle,
    })
}
