//! Surfaces as functions of space: distance, gradient, where a line meets them.

use glam::{DMat3, DVec3};

use super::Surface;
use super::ring_torus;
use crate::drawing::SurfaceKind;

impl Surface {
    /// What is wrong with its lengths and angles, if they are those of no surface.
    pub(crate) fn fault(&self) -> Option<&'static str> {
        let positive = |length: f64| length.is_finite() && length > 0.0;
        match *self {
            Self::Cylinder { radius, .. } | Self::Sphere { radius, .. } if !positive(radius) => {
                Some("its radius is not a positive number")
            }
            Self::Torus { major, minor, .. } if !positive(major) || !positive(minor) => {
                Some("its radius is not a positive number")
            }
            Self::Cone { angle, .. }
                if !positive(angle) || angle >= std::f64::consts::FRAC_PI_2 =>
            {
                Some("its angle is not between 0 and 90 degrees")
            }
            _ => None,
        }
    }

    /// The kind of surface, if it is known.
    pub fn kind(&self) -> Option<SurfaceKind> {
        match self {
            Self::Unknown => None,
            Self::Plane { .. } => Some(SurfaceKind::Plane),
            Self::Cylinder { .. } => Some(SurfaceKind::Cylinder),
            Self::Cone { .. } => Some(SurfaceKind::Cone),
            Self::Sphere { .. } => Some(SurfaceKind::Sphere),
            Self::Torus { .. } => Some(SurfaceKind::Torus),
        }
    }

    /// A point that places the surface: of a plane or an axis, a cone's apex, a centre; zero of an
    /// unknown surface.
    pub(crate) fn origin(&self) -> DVec3 {
        match *self {
            Self::Plane { origin, .. } | Self::Cylinder { origin, .. } => origin,
            Self::Cone { apex, .. } => apex,
            Self::Sphere { center, .. } | Self::Torus { center, .. } => center,
            Self::Unknown => DVec3::ZERO,
        }
    }

    /// Normal of a plane, or direction of an axis; zero where there is none.
    pub(crate) fn direction(&self) -> DVec3 {
        match *self {
            Self::Plane { normal, .. } => normal,
            Self::Cylinder { axis, .. } | Self::Cone { axis, .. } | Self::Torus { axis, .. } => {
                axis
            }
            Self::Sphere { .. } | Self::Unknown => DVec3::ZERO,
        }
    }

    /// A point and the unit direction of the axis of revolution; `None` for planes, which have one
    /// everywhere, spheres, which have all through their centre, and unknown surfaces.
    pub(crate) fn axis(&self) -> Option<(DVec3, DVec3)> {
        match *self {
            Self::Cylinder { .. } | Self::Cone { .. } | Self::Torus { .. } => {
                Some((self.origin(), self.direction()))
            }
            Self::Plane { .. } | Self::Sphere { .. } | Self::Unknown => None,
        }
    }

    /// The smallest radius that shapes the surface; infinite for planes and unknown surfaces.
    pub(crate) fn radius(&self) -> f64 {
        match *self {
            Self::Cylinder { radius, .. } | Self::Sphere { radius, .. } => radius,
            Self::Torus { major, minor, .. } => minor.min(major),
            Self::Plane { .. } | Self::Cone { .. } | Self::Unknown => f64::INFINITY,
        }
    }

    /// The same surface with another normal or axis, turned about its origin.
    pub(crate) fn with_direction(mut self, direction: DVec3) -> Self {
        match &mut self {
            Self::Plane { normal, .. } => *normal = direction,
            Self::Cylinder { axis, .. } | Self::Cone { axis, .. } | Self::Torus { axis, .. } => {
                *axis = direction;
            }
            Self::Sphere { .. } | Self::Unknown => {}
        }
        self
    }

    /// The same surface with another origin.
    pub(crate) fn with_origin(mut self, place: DVec3) -> Self {
        match &mut self {
            Self::Plane { origin, .. } | Self::Cylinder { origin, .. } => *origin = place,
            Self::Cone { apex, .. } => *apex = place,
            Self::Sphere { center, .. } | Self::Torus { center, .. } => *center = place,
            Self::Unknown => {}
        }
        self
    }

    /// The surface turned about the origin of space.
    pub(crate) fn turned(self, rotation: DMat3) -> Self {
        self.with_origin(rotation * self.origin())
            .with_direction(rotation * self.direction())
    }

    /// Signed distance of a point, positive on the side of [`gradient`](Self::gradient); zero
    /// everywhere for an unknown surface, which says nothing about points.
    pub fn distance(&self, p: DVec3) -> f64 {
        match *self {
            Self::Plane { origin, normal } => normal.dot(p - origin),
            Self::Cylinder {
                origin,
                axis,
                radius,
            } => (p - origin).reject_from_normalized(axis).length() - radius,
            Self::Cone { apex, axis, angle } => {
                let (sin, cos) = angle.sin_cos();
                let d = p - apex;
                d.reject_from_normalized(axis).length() * cos - axis.dot(d) * sin
            }
            Self::Sphere { center, radius } => p.distance(center) - radius,
            Self::Torus {
                center,
                axis,
                major,
                minor,
            } => {
                let d = p - center;
                let out = d.reject_from_normalized(axis).length() - major;
                let up = axis.dot(d);
                (out * out + up * up).sqrt() - minor
            }
            Self::Unknown => 0.0,
        }
    }

    /// Unit gradient of [`distance`](Self::distance): the plane's normal, or away from the axis,
    /// centre or spine; zero where it is not defined.
    pub(crate) fn gradient(&self, p: DVec3) -> DVec3 {
        let outwards = |origin: DVec3, axis: DVec3| {
            (p - origin)
                .reject_from_normalized(axis)
                .normalize_or_zero()
        };
        match *self {
            Self::Plane { normal, .. } => normal,
            Self::Cylinder { origin, axis, .. } => outwards(origin, axis),
            Self::Cone { apex, axis, angle } => {
                let (sin, cos) = angle.sin_cos();
                let out = outwards(apex, axis);
                if out == DVec3::ZERO {
                    out
                } else {
                    out * cos - axis * sin
                }
            }
            Self::Sphere { center, .. } => (p - center).normalize_or_zero(),
            Self::Torus {
                center,
                axis,
                major,
                ..
            } => (p - center - outwards(center, axis) * major).normalize_or_zero(),
            Self::Unknown => DVec3::ZERO,
        }
    }

    /// The [`crossings`](Self::crossings), the one nearest to a value of t first.
    pub(crate) fn crossings_from(&self, from: DVec3, direction: DVec3, near: f64) -> Vec<f64> {
        let mut all = self.crossings(from, direction);
        all.sort_by(|a, b| (a - near).abs().total_cmp(&(b - near).abs()));
        all
    }

    /// Where the line `from + t direction` meets the surface: the values of t, none for an unknown
    /// surface. A line that just misses a round surface touches it at its nearest point.
    pub(crate) fn crossings(&self, from: DVec3, direction: DVec3) -> Vec<f64> {
        match *self {
            Self::Plane { origin, normal } => {
                let slope = normal.dot(direction);
                let t = normal.dot(origin - from) / slope;
                t.is_finite().then_some(t).into_iter().collect()
            }
            Self::Cylinder {
                origin,
                axis,
                radius,
            } => {
                let d = direction.reject_from_normalized(axis);
                let o = (from - origin).reject_from_normalized(axis);
                roots(
                    d.length_squared(),
                    d.dot(o),
                    o.length_squared() - radius * radius,
                )
            }
            Self::Cone { apex, axis, angle } => {
                // |p|^2 cos^2 = (axis.p)^2, of which one nappe is meant.
                let (o, cos2) = (from - apex, angle.cos().powi(2));
                let (dh, oh) = (axis.dot(direction), axis.dot(o));
                let all = roots(
                    direction.length_squared() * cos2 - dh * dh,
                    direction.dot(o) * cos2 - dh * oh,
                    o.length_squared() * cos2 - oh * oh,
                );
                all.into_iter().filter(|t| oh + t * dh >= 0.0).collect()
            }
            Self::Sphere { center, radius } => {
                let o = from - center;
                roots(
                    direction.length_squared(),
                    direction.dot(o),
                    o.length_squared() - radius * radius,
                )
            }
            Self::Torus { .. } => ring_torus::crossings(self, from, direction),
            Self::Unknown => Vec::new(),
        }
    }
}

/// Real roots of `a t^2 + 2 b t + c`; the place of the extreme value if there are none.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let half = -b / a;
    if !half.is_finite() {
        let t = -c / (2.0 * b);
        return t.is_finite().then_some(t).into_iter().collect();
    }
    let root = (half * half - c / a).max(0.0).sqrt();
    [half - root, half + root]
        .into_iter()
        .filter(|t| t.is_finite())
        .collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn surfaces() -> Vec<Surface> {
        let axis = DVec3::new(1.0, 1.0, 0.5).normalize();
        let at = DVec3::new(1.0, 2.0, 3.0);
        vec![
            Surface::Plane {
                origin: at,
                normal: axis,
            },
            Surface::Cylinder {
                origin: at,
                axis,
                radius: 0.5,
            },
            Surface::Cone {
                apex: at,
                axis,
                angle: 0.5,
            },
            Surface::Sphere {
                center: at,
                radius: 0.7,
            },
            Surface::Torus {
                center: at,
                axis,
                major: 0.8,
                minor: 0.3,
            },
        ]
    }

    proptest! {
        #[test]
        fn gradient_is_the_slope_of_distance(p in prop::array::uniform3(-2.0..2.0f64)) {
            let p = DVec3::from_array(p);
            let h = 1e-6;
            for s in surfaces() {
                let slope = DVec3::from_array(DVec3::AXES.map(|a| {
                    (s.distance(p + a * h) - s.distance(p - a * h)) / (2.0 * h)
                }));
                prop_assert!(slope.distance(s.gradient(p)) < 1e-5, "{s:?}");
            }
        }

        #[test]
        fn lines_through_points_of_the_surface_meet_it_there(
            aim in prop::array::uniform3(-1.0..1.0f64),
            around in -3.0..3.0f64,
            along in 0.1..1.0f64,
        ) {
            let aim = DVec3::from_array(aim).normalize_or(DVec3::X);
            for s in surfaces() {
                // A point of the surface by walking down the gradient.
                let (u, v) = s.direction().try_normalize().unwrap_or(DVec3::Z).any_orthonormal_pair();
                let start = s.origin() + s.direction() * along + (u * around.cos() + v * around.sin()) * 0.9;
                let p = start - s.gradient(start) * s.distance(start);
                prop_assert!(s.distance(p).abs() < 1e-9, "{s:?}");
                prop_assume!(s.gradient(p).dot(aim).abs() > 0.05);
                let from = p - aim * 2.3;
                let found = s.crossings(from, aim);
                for &t in &found {
                    prop_assert!(s.distance(from + aim * t).abs() < 0.02, "{s:?}");
                }
                prop_assert!(found.iter().any(|t| (t - 2.3).abs() < 1e-6), "{s:?} {found:?}");
            }
        }
    }
}
