//! Loops in the parameter plane of their surface: area, turns, and what they add to the volume.

use std::f64::consts::TAU;

use glam::DVec3;

use super::support::Support;

/// A loop, measured on its surface; left is counter-clockwise seen against the gradient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Measure {
    /// Signed area, positive if the inside is on the left; of a loop that runs around a cylinder,
    /// the area between it and the height 0.
    pub(super) area: f64,
    /// How often the loop runs around a cylinder, with its sign.
    pub(super) turns: i32,
    /// A third of the flux of the position vector through that area, along the gradient: a face's
    /// share of the volume (divergence theorem).
    pub(super) volume: f64,
}

/// Measures a closed polyline, whose last point is not its first again.
pub(super) fn measure(support: &Support, points: &[DVec3]) -> Measure {
    match *support {
        Support::Plane { origin, normal } => {
            let mut area = 0.0;
            for (p, q) in sides(points) {
                area += 0.5 * normal.dot((p - origin).cross(q - origin));
            }
            Measure {
                area,
                turns: 0,
                volume: normal.dot(origin) * area / 3.0,
            }
        }
        Support::Cylinder {
            origin,
            axis,
            radius,
        } => {
            let (x, y) = axis.any_orthonormal_pair();
            // Right-handed: x, y, axis.
            let y = if x.cross(y).dot(axis) < 0.0 { -y } else { y };
            let place = |p: DVec3| {
                let d = p - origin;
                (y.dot(d).atan2(x.dot(d)), axis.dot(d))
            };
            let (mut area, mut flux, mut turned) = (0.0, 0.0, 0.0);
            for (p, q) in sides(points) {
                let ((u, v), (u_next, v_next)) = (place(p), place(q));
                let du = (u_next - u + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
                let (v, u) = ((v + v_next) / 2.0, u + du / 2.0);
                let outwards = x * u.cos() + y * u.sin();
                // Green's theorem: the integral of f(u) over the area is the one of -v f(u) du.
                area -= v * radius * du;
                flux -= v * radius * du * (origin.dot(outwards) + radius);
                turned += du;
            }
            Measure {
                area,
                turns: (turned / TAU).round() as i32,
                volume: flux / 3.0,
            }
        }
    }
}

fn sides(points: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> {
    let next = points.iter().skip(1).chain(points.first());
    points.iter().copied().zip(next.copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_has_its_area_and_pyramid() {
        let plane = Support::Plane {
            origin: DVec3::new(0.0, 0.0, 3.0),
            normal: DVec3::Z,
        };
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let mut points: Vec<DVec3> = corners
            .iter()
            .map(|c| DVec3::new(c[0], c[1], 3.0))
            .collect();
        let m = measure(&plane, &points);
        assert_eq!((m.area, m.turns, m.volume), (4.0, 0, 4.0));
        points.reverse();
        assert_eq!(measure(&plane, &points).area, -4.0);
    }

    #[test]
    fn half_a_tube_has_its_area_and_volume() {
        let tube = Support::Cylinder {
            origin: DVec3::ZERO,
            axis: DVec3::Z,
            radius: 0.5,
        };
        let n = 400;
        let arc = |i: usize, z: f64| {
            let (sin, cos) = (TAU / 2.0 * i as f64 / n as f64).sin_cos();
            DVec3::new(0.5 * cos, 0.5 * sin, z)
        };
        let mut points: Vec<DVec3> = (0..=n).map(|i| arc(i, 0.0)).collect();
        points.extend((0..=n).rev().map(|i| arc(i, 2.0)));
        let m = measure(&tube, &points);
        assert_eq!(m.turns, 0);
        assert!((m.area - TAU / 2.0).abs() < 1e-9);
        assert!((m.volume - TAU / 2.0 * 0.5 / 3.0).abs() < 1e-9);
    }

    #[test]
    fn circle_runs_around_its_cylinder_once() {
        let tube = Support::Cylinder {
            origin: DVec3::X,
            axis: DVec3::Y,
            radius: 1.0,
        };
        let ring: Vec<DVec3> = (0..30)
            .map(|i| {
                let (sin, cos) = (TAU * f64::from(i) / 30.0).sin_cos();
                DVec3::new(1.0 + sin, 2.0, cos)
            })
            .collect();
        assert_eq!(measure(&tube, &ring).turns.abs(), 1);
    }
}
