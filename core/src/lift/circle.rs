//! Circles of a known normal through drawn points.

use glam::{DVec2, DVec3};

use super::Camera;

/// A circle in space as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DrawnCircle {
    /// Where its centre is drawn.
    pub(crate) center: DVec2,
    /// Its radius, drawing units; in a central projection that of a circle whose centre is at the
    /// distance where lengths are drawn as they are.
    pub(crate) radius: f64,
    /// Largest distance of the points from it, in its own plane.
    pub(crate) residual: f64,
    /// Error of its centre in its own plane, for a unit error of the points: about 1 for half a
    /// circle, large for a short arc.
    pub(crate) gain: f64,
}

/// Circle of unit normal `normal` whose drawing passes through the points.
///
/// The points are taken back to the circle's plane at the distance where lengths are drawn as they
/// are; there a circle is fitted algebraically (Kasa 1976). `None` for fewer than three points,
/// points on a line, or a plane seen edge-on.
pub(crate) fn circle_through(
    points: &[DVec2],
    normal: DVec3,
    camera: &Camera,
) -> Option<DrawnCircle> {
    let middle = points.iter().sum::<DVec2>() / points.len().max(1) as f64;
    let facing = camera.facing(normal, middle);
    if points.len() < 3 || facing.abs() < 1e-9 {
        return None;
    }
    let along = normal.truncate().normalize_or(DVec2::X);
    let u = along.perp().extend(0.0);
    let w = normal.cross(u);
    let origin = camera.unit(middle);
    let unfold = |p: DVec2| {
        let d = camera.on_plane(p, normal, origin) - origin;
        DVec2::new(d.dot(u), d.dot(w))
    };
    let (center, radius, gain) = circle_fit(points.iter().map(|&p| unfold(p)))?;
    let residual = points
        .iter()
        .map(|&p| (unfold(p).distance(center) - radius).abs())
        .fold(0.0, f64::max);
    let place = origin + u * center.x + w * center.y;
    let scale = match camera {
        Camera::Parallel => 1.0,
        Camera::Central { focal, .. } => focal / -place.z,
    };
    Some(DrawnCircle {
        center: camera.project(place),
        radius: radius * scale,
        residual,
        gain,
    })
}

/// Centre, radius and gain (see [`DrawnCircle::gain`]) of the circle with the least sum of
/// `(|p - c|^2 - r^2)^2` (Kasa 1976).
pub(crate) fn circle_fit(points: impl Iterator<Item = DVec2> + Clone) -> Option<(DVec2, f64, f64)> {
    let count = points.clone().count() as f64;
    let middle = points.clone().sum::<DVec2>() / count;
    let (mut xx, mut xy, mut yy, mut xs, mut ys, mut s2) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for p in points {
        let p = p - middle;
        let s = p.length_squared();
        xx += p.x * p.x;
        xy += p.x * p.y;
        yy += p.y * p.y;
        xs += p.x * s;
        ys += p.y * s;
        s2 += s;
    }
    let determinant = xx * yy - xy * xy;
    // The spread across the best line is below rounding: no circle, or any.
    if determinant <= 1e-14 * (xx + yy).powi(2) {
        return None;
    }
    let center = DVec2::new(xs * yy - ys * xy, ys * xx - xs * xy) / (2.0 * determinant);
    let radius = (center.length_squared() + s2 / count).sqrt();
    // An error e of a point is one of 2 r e in the equation that is linear in the centre.
    let smallest = (xx + yy) / 2.0 - ((xx - yy) / 2.0).hypot(xy);
    let gain = radius / smallest.max(determinant / (xx + yy)).sqrt();
    radius
        .is_finite()
        .then_some((middle + center, radius, gain))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_circle_is_found_from_a_short_arc() {
        let normal = DVec3::new(0.3, -0.5, 0.7).normalize();
        let u = normal.any_orthonormal_vector();
        let w = normal.cross(u);
        let center = DVec3::new(2.0, 1.0, 5.0);
        let points: Vec<DVec2> = (0..7)
            .map(|i| 0.2 + 0.1 * f64::from(i))
            .map(|t| (center + 0.8 * (t.cos() * u + t.sin() * w)).truncate())
            .collect();
        let found = circle_through(&points, normal, &Camera::Parallel).unwrap();
        assert!(found.center.distance(center.truncate()) < 1e-9);
        assert!((found.radius - 0.8).abs() < 1e-9);
        assert!(found.residual < 1e-12);
        let other = circle_through(
            &points,
            DVec3::new(0.6, 0.2, 0.4).normalize(),
            &Camera::Parallel,
        )
        .unwrap();
        assert!(other.residual > 1e-6);
    }

    #[test]
    fn a_circle_in_perspective_is_drawn_off_its_centre() {
        let camera = Camera::Central {
            principal: DVec2::new(0.1, -0.2),
            focal: 2.5,
        };
        let normal = DVec3::new(0.3, -0.5, 0.7).normalize();
        let u = normal.any_orthonormal_vector();
        let w = normal.cross(u);
        let center = DVec3::new(0.4, 0.1, -3.0);
        let points: Vec<DVec2> = (0..9)
            .map(|i| 0.3 * f64::from(i))
            .map(|t| camera.project(center + 0.8 * (t.cos() * u + t.sin() * w)))
            .collect();
        let found = circle_through(&points, normal, &camera).unwrap();
        assert!(found.center.distance(camera.project(center)) < 1e-9);
        assert!((found.radius - 0.8 * 2.5 / 3.0).abs() < 1e-9);
        assert!(found.residual < 1e-12);
    }

    #[test]
    fn points_on_a_line_have_no_circle() {
        let points: Vec<DVec2> = (0..5)
            .map(|i| DVec2::new(f64::from(i), 2.0 * f64::from(i)))
            .collect();
        assert_eq!(circle_through(&points, DVec3::Z, &Camera::Parallel), None);
        assert_eq!(
            circle_through(&points[..2], DVec3::Z, &Camera::Parallel),
            None
        );
        assert_eq!(circle_through(&points, DVec3::X, &Camera::Parallel), None);
    }
}
