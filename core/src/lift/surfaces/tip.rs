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
    evidence: &Evidence,
) -> Option<Surface> {
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

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::Progress;
    use crate::drawing::SurfaceKind;
    use crate::lift::testing::{Scene, polygon, turned};
    use crate::lift::{LiftOptions, lift};

    /// A blind hole whose tip is seen from so far above that no outline of it is drawn.
    #[test]
    fn a_tip_that_is_not_seen_is_a_drills() {
        for (view, half) in [(0.3, HALVES[0]), (1.1, HALVES[1])] {
            let mut scene = Scene::new(turned(view, 0.2, 0.1));
            let corners = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.5], [0.0, 1.5]]);
            let [bottom, top] = scene.prism(&corners, DVec3::Z);
            let at = DVec2::new(0.8, 0.7).extend(0.4);
            let [low, high] = scene.wall(at, DVec3::Z * 0.6, 0.3);
            scene.face(SurfaceKind::Plane, &[bottom]);
            scene.face(SurfaceKind::Plane, &[top, high]);
            scene.face(SurfaceKind::Cone, &[low]);
            let (drawing, faces) = scene.finish();
            let found = lift(&drawing, &faces, &LiftOptions::default(), Progress::none()).unwrap();
            let Some(&Surface::Cone { apex, angle, .. }) = found.surfaces.last() else {
                panic!("{:?}", found.surfaces);
            };
            assert_eq!(angle, half);
            // Below the hole, not in it.
            let ring = drawing.edges[faces.last().unwrap().loops[0][0].edge()].v[0];
            let rim = drawing.edges[faces[faces.len() - 2].loops[1][0].edge()].v[0];
            let place = |v: usize| drawing.vertices[v].extend(found.depths[v]);
            let down = place(ring) - place(rim);
            assert!((apex - place(ring)).dot(down) > 0.0);
        }
    }
}
