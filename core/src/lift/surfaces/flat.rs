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
    let points: Vec<DVec3> = sheet.corners[face]
        .iter()
        .map(|&v| vertex(sheet, heights, v))
        .collect();
    let (origin, normal) = best_plane(&points)?;
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
