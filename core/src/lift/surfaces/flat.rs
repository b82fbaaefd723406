//! Planes.

use glam::{DMat3, DVec3};

use super::evidence::vertex;
use crate::lift::Surface;
use crate::lift::heights::Heights;
use crate::lift::sheet::Sheet;

/// The plane of a face: what its rows say, else the best one through its vertices.
pub(super) fn plane(sheet: &Sheet<'_>, heights: &Heights, face: usize) -> Option<Surface> {
    if let Some([a, b, c]) = heights.plane(face) {
        return Some(Surface::Plane {
            origin: sheet.place(sheet.middles[face], -c),
            normal: sheet
                .camera()
                .normal([a, b, c], sheet.middles[face])
                .normalize(),
        });
    }
    through(&corners(sheet, heights, face))
}

/// The plane of a face of another kind whose edges are all straight, if its vertices are within a share
/// of the drawing's size of it.
pub(super) fn straight(
    sheet: &Sheet<'_>,
    heights: &Heights,
    face: usize,
    share: f64,
) -> Option<Surface> {
    let edges = sheet.edges_of(face);
    let points = corners(sheet, heights, face);
    let all = edges.iter().all(|&e| sheet.is_straight(e));
    let found = all.then(|| through(&points)).flatten()?;
    let on = |p: &DVec3| found.distance(*p).abs() <= share * sheet.size;
    points.iter().all(on).then_some(found)
}

fn corners(sheet: &Sheet<'_>, heights: &Heights, face: usize) -> Vec<DVec3> {
    let corners = sheet.corners[face].iter();
    corners.map(|&v| vertex(sheet, heights, v)).collect()
}

fn through(points: &[DVec3]) -> Option<Surface> {
    let (origin, normal) = best_plane(points)?;
    Some(Surface::Plane { origin, normal })
}

/// Plane through the mean of points, normal to the direction of their smallest spread; `None` if
/// they lie on a line.
pub(in crate::lift) fn best_plane(points: &[DVec3]) -> Option<(DVec3, DVec3)> {
    let origin = points.iter().sum::<DVec3>() / points.len() as f64;
    let mut spread = DMat3::ZERO;
    for p in points {
        let d = *p - origin;
        spread += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    }
    // The adjugate of a matrix of rank two is the projector on its null vector.
    let (x, y, z) = (spread.x_axis, spread.y_axis, spread.z_axis);
    let rows = [y.cross(z), z.cross(x), x.cross(y)];
    let longest = rows
        .into_iter()
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
    let scale = x.x + y.y + z.z;
    (longest.length() > 1e-8 * scale * scale).then(|| (origin, longest.normalize()))
}
