//! What a loop adds to the volume: the flux through the part of a surface that it bounds.
//!
//! A face of a drawing is seen from the front or from behind all over, since outlines are drawn
//! and split it. So a face on a sphere lies in the near or in the far half, and one on a torus on
//! one side of the tube, and flux is counted from a point or line in the middle of that half.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::support::Support;

/// How a face is seen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sight {
    /// Unit direction from the face to the viewer.
    pub(super) toward: DVec3,
    /// Whether the gradient of its surface points to the viewer.
    pub(super) front: bool,
}

/// A third of the flux of the position vector, along the gradient, through the area to the left of
/// a closed polyline seen against the gradient: a face's share of the volume (divergence theorem).
/// The polyline's last point is not its first again.
pub(super) fn volume(support: &Support, points: &[DVec3], sight: Sight) -> f64 {
    // Green's theorem: the integral of f(u, v) over the area is the one of -F(u, v) du, F_v = f.
    let around = |axis: DVec3, origin: DVec3, part: &dyn Fn(DVec3, DVec3) -> f64| {
        let (x, y) = axis.any_orthonormal_pair();
        // Right-handed: x, y, axis.
        let y = if x.cross(y).dot(axis) < 0.0 { -y } else { y };
        let angle = |p: DVec3| y.dot(p - origin).atan2(x.dot(p - origin));
        let mut flux = 0.0;
        for (p, q) in sides(points) {
            let u = angle(p);
            let du = (angle(q) - u + PI).rem_euclid(TAU) - PI;
            let (sin, cos) = (u + du / 2.0).sin_cos();
            flux -= part(p.midpoint(q) - origin, x * cos + y * sin) * du;
        }
        flux / 3.0
    };
    match *support {
        Support::Plane { origin, normal } => {
            let area: f64 = sides(points)
                .map(|(p, q)| 0.5 * normal.dot((p - origin).cross(q - origin)))
                .sum();
            normal.dot(origin) * area / 3.0
        }
        Support::Cylinder {
            origin,
            axis,
            radius,
        } => around(axis, origin, &|d, out| {
            axis.dot(d) * radius * (origin.dot(out) + radius)
        }),
        Support::Cone { apex, axis, angle } => {
            let (sin, cos) = angle.sin_cos();
            around(axis, apex, &|d, out| {
                let along = axis.dot(d) / cos;
                0.5 * along * along * sin * apex.dot(out * cos - axis * sin)
            })
        }
        Support::Sphere { center, radius } => {
            let up = sight.toward;
            around(up, center, &|d, out| {
                // From the pole to the polar angle t.
                let flux = |t: f64| {
                    center.dot(out) * (t / 2.0 - (2.0 * t).sin() / 4.0)
                        + center.dot(up) * t.sin().powi(2) / 2.0
                        + radius * (1.0 - t.cos())
                };
                let t = d.dot(out).atan2(d.dot(up));
                let from = if sight.front { 0.0 } else { flux(PI) };
                (from - flux(t)) * radius * radius
            })
        }
        Support::Torus {
            center,
            axis,
            major,
            minor,
        } => around(axis, center, &|d, out| {
            let (a, b) = (center.dot(out) + major, center.dot(axis));
            let flux = |v: f64| {
                let (sin, cos) = v.sin_cos();
                a * major * sin + a * minor * (v + sin * cos) / 2.0
                    - b * major * cos
                    - b * minor * cos * cos / 2.0
                    + minor * (major * v + minor * sin)
            };
            let seen = if sight.front {
                sight.toward
            } else {
                -sight.toward
            };
            let middle = seen.dot(axis).atan2(seen.dot(out));
            let v = d.dot(axis).atan2(d.dot(out) - major);
            let v = middle + (v - middle + PI).rem_euclid(TAU) - PI;
            minor * (flux(v) - flux(middle))
        }),
        Support::Unknown => {
            // Roughly: triangles from the middle.
            let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
            let part = |(p, q): (DVec3, DVec3)| middle.dot(p.cross(q)) / 6.0;
            sides(points).map(part).sum()
        }
    }
}

pub(super) fn sides(points: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    let next = points.iter().skip(1).chain(points.first());
    points.iter().copied().zip(next.copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume of a region on a surface, given by its boundary as a function of a full turn.
    fn of(support: &Support, at: impl Fn(f64) -> DVec3, toward: DVec3, front: bool) -> f64 {
        let n = 2000;
        let points: Vec<DVec3> = (0..n).map(|i| at(TAU * i as f64 / n as f64)).collect();
        volume(support, &points, Sight { toward, front })
    }

    #[test]
    fn square_has_its_pyramid() {
        let plane = Support::Plane {
            origin: DVec3::new(0.0, 0.0, 3.0),
            normal: DVec3::Z,
        };
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let points: Vec<DVec3> = corners
            .iter()
            .map(|c| DVec3::new(c[0], c[1], 3.0))
            .collect();
        let sight = Sight {
            toward: DVec3::Z,
            front: true,
        };
        assert_eq!(volume(&plane, &points, sight), 4.0);
    }

    #[test]
    fn halves_of_a_sphere_make_it_whole() {
        let center = DVec3::new(0.3, -0.2, 0.5);
        let sphere = Support::Sphere {
            center,
            radius: 0.7,
        };
        let toward = DVec3::new(0.2, 0.3, 0.8).normalize();
        let (u, v) = toward.any_orthonormal_pair();
        let v = if u.cross(v).dot(toward) < 0.0 { -v } else { v };
        let outline = |t: f64| center + (u * t.cos() + v * t.sin()) * 0.7;
        let near = of(&sphere, outline, toward, true);
        let far = of(&sphere, |t| outline(-t), toward, false);
        let whole = 4.0 / 3.0 * PI * 0.7f64.powi(3);
        assert!((near + far - whole).abs() < 1e-4, "{near} {far} {whole}");
    }

    #[test]
    fn halves_of_a_ring_make_it_whole() {
        let center = DVec3::new(0.3, -0.2, 0.5);
        let torus = Support::Torus {
            center,
            axis: DVec3::Z,
            major: 1.0,
            minor: 0.25,
        };
        let at =
            |t: f64, side: f64| center + DVec3::new(t.cos(), t.sin(), 0.0) * (1.0 + side * 0.25);
        let mut total = 0.0;
        for (side, way) in [(1.0, 1.0), (-1.0, -1.0)] {
            total += of(&torus, |t| at(way * t, side), DVec3::Z, true);
            total += of(&torus, |t| at(-way * t, side), DVec3::Z, false);
        }
        let whole = 2.0 * PI * PI * 0.25f64.powi(2);
        assert!((total - whole).abs() < 1e-4, "{total} {whole}");
    }

    #[test]
    fn cone_has_a_third_of_its_box() {
        let cone = Support::Cone {
            apex: DVec3::new(0.0, 0.0, 2.0),
            axis: -DVec3::Z,
            angle: 0.5f64.atan(),
        };
        // Seen against the gradient, the cone is on the left of the circle walked like this.
        let lower = of(&cone, |t| DVec3::new(t.cos(), t.sin(), 0.0), DVec3::Z, true);
        // The base is in the plane z = 0 and adds nothing.
        assert!((lower - PI * 2.0 / 3.0).abs() < 1e-4, "{lower}");
    }
}
