//! The surfaces that faces lie on, as functions of space.

use glam::DVec3;

use crate::lift::Surface;

use super::Surface3;

/// A surface without orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Support {
    /// All p with `normal . (p - origin) = 0`.
    Plane { origin: DVec3, normal: DVec3 },
    /// All p at the distance `radius` from the axis.
    Cylinder {
        origin: DVec3,
        axis: DVec3,
        radius: f64,
    },
}

impl Support {
    /// The surface that lifting found; the reason if it cannot be built.
    pub(super) fn from_lift(surface: &Surface) -> Result<Self, &'static str> {
        let unit = |v: DVec3| v.try_normalize().ok_or("it has no direction");
        let support = match *surface {
            Surface::Plane { origin, normal } => Self::Plane {
                origin,
                normal: unit(normal)?,
            },
            Surface::Cylinder {
                origin,
                axis,
                radius,
            } => Self::Cylinder {
                origin,
                axis: unit(axis)?,
                radius,
            },
            Surface::Unknown => return Err("only planes and cylinders can be built"),
        };
        match support {
            Self::Cylinder { radius, .. } if !radius.is_finite() || radius <= 0.0 => {
                Err("its radius is not a positive number")
            }
            _ if !support.origin().is_finite() => Err("its position is not a finite number"),
            _ => Ok(support),
        }
    }

    /// A point of the plane, or of the cylinder's axis.
    pub(super) fn origin(&self) -> DVec3 {
        match *self {
            Self::Plane { origin, .. } | Self::Cylinder { origin, .. } => origin,
        }
    }

    /// Normal of the plane, or direction of the cylinder's axis.
    pub(super) fn direction(&self) -> DVec3 {
        match *self {
            Self::Plane { normal, .. } => normal,
            Self::Cylinder { axis, .. } => axis,
        }
    }

    /// The same surface with another direction; a cylinder is turned about its origin.
    pub(super) fn with_direction(self, direction: DVec3) -> Self {
        match self {
            Self::Plane { origin, .. } => Self::Plane {
                origin,
                normal: direction,
            },
            Self::Cylinder { origin, radius, .. } => Self::Cylinder {
                origin,
                axis: direction,
                radius,
            },
        }
    }

    /// The same surface with another origin.
    pub(super) fn with_origin(self, origin: DVec3) -> Self {
        match self {
            Self::Plane { normal, .. } => Self::Plane { origin, normal },
            Self::Cylinder { axis, radius, .. } => Self::Cylinder {
                origin,
                axis,
                radius,
            },
        }
    }

    /// The surface turned about the origin of space.
    pub(super) fn turned(self, rotation: glam::DMat3) -> Self {
        self.with_origin(rotation * self.origin())
            .with_direction(rotation * self.direction())
    }

    /// Signed distance of a point, positive on the side of [`gradient`](Self::gradient).
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        match *self {
            Self::Plane { origin, normal } => normal.dot(p - origin),
            Self::Cylinder {
                origin,
                axis,
                radius,
            } => (p - origin).reject_from_normalized(axis).length() - radius,
        }
    }

    /// Unit gradient of [`distance`](Self::distance): the plane's normal, or away from the axis;
    /// zero on the axis.
    pub(super) fn gradient(&self, p: DVec3) -> DVec3 {
        match *self {
            Self::Plane { normal, .. } => normal,
            Self::Cylinder { origin, axis, .. } => (p - origin)
                .reject_from_normalized(axis)
                .normalize_or_zero(),
        }
    }

    /// Where the line `origin + t direction` meets the surface: none, one or two values of t.
    pub(super) fn crossings(&self, from: DVec3, direction: DVec3) -> Vec<f64> {
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
                let a = d.length_squared();
                let half = d.dot(o) / a;
                // A line that just misses touches the surface at its nearest point.
                let root = (half * half - (o.length_squared() - radius * radius) / a).max(0.0);
                let roots = [-half - root.sqrt(), -half + root.sqrt()];
                roots.into_iter().filter(|t| t.is_finite()).collect()
            }
        }
    }

    /// The surface of a face whose outward normal is the gradient, or its opposite if `reversed`.
    pub(super) fn oriented(&self, reversed: bool) -> Surface3 {
        match *self {
            Self::Plane { origin, normal } => Surface3::Plane {
                origin,
                normal: if reversed { -normal } else { normal },
            },
            Self::Cylinder {
                origin,
                axis,
                radius,
            } => Surface3::Cylinder {
                origin,
                axis,
                radius,
                hollow: reversed,
            },
        }
    }
}

/// The point near `start` that lies on all surfaces.
///
/// Damped Gauss-Newton (Levenberg 1944): what the surfaces leave open, or nearly open as where two
/// of them touch, stays as it is in `start`.
pub(super) fn meet(start: DVec3, surfaces: &[Support]) -> DVec3 {
    /// Surfaces that meet at an angle below the root of this hardly move the point.
    const DAMPING: f64 = 1e-4;
    const STEPS: usize = 50;
    let mut p = start;
    for _ in 0..STEPS {
        let mut matrix = glam::DMat3::from_diagonal(DVec3::splat(DAMPING));
        let mut right = DVec3::ZERO;
        for surface in surfaces {
            let g = surface.gradient(p);
            matrix += glam::DMat3::from_cols(g * g.x, g * g.y, g * g.z);
            right -= g * surface.distance(p);
        }
        let step = matrix.inverse() * right;
        if !step.is_finite() {
            break;
        }
        p += step;
        if step.length() <= f64::EPSILON * p.length() {
            break;
        }
    }
    p
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn cylinder() -> Support {
        Support::Cylinder {
            origin: DVec3::new(1.0, 2.0, 3.0),
            axis: DVec3::new(1.0, 1.0, 0.0).normalize(),
            radius: 0.5,
        }
    }

    fn plane() -> Support {
        Support::Plane {
            origin: DVec3::new(1.2, 2.0, 3.0),
            normal: DVec3::new(0.2, 1.0, 0.3).normalize(),
        }
    }

    proptest! {
        #[test]
        fn gradient_is_the_slope_of_distance(p in prop::array::uniform3(-2.0..2.0f64)) {
            let p = DVec3::from_array(p);
            let h = 1e-6;
            for s in [cylinder(), plane()] {
                let slope = DVec3::from_array(DVec3::AXES.map(|a| {
                    (s.distance(p + a * h) - s.distance(p - a * h)) / (2.0 * h)
                }));
                prop_assert!(slope.distance(s.gradient(p)) < 1e-6);
            }
        }

        #[test]
        fn meeting_points_lie_on_the_surfaces(offset in prop::array::uniform3(-0.05..0.05f64)) {
            let offset = DVec3::from_array(offset);
            let common = meet(DVec3::new(1.2, 2.2, 3.45), &[cylinder(), plane()]);
            let p = meet(common + offset, &[cylinder(), plane()]);
            prop_assert!(cylinder().distance(p).abs() < 1e-12);
            prop_assert!(plane().distance(p).abs() < 1e-12);
            prop_assert!(p.distance(common) < 3.0 * offset.length());
        }

        #[test]
        fn crossings_lie_on_the_surface(from in prop::array::uniform3(-2.0..2.0f64)) {
            let from = DVec3::from_array(from);
            for s in [cylinder(), plane()] {
                let aim = (s.origin() + DVec3::new(0.1, -0.1, 0.2) - from).normalize();
                for t in s.crossings(from, aim) {
                    prop_assert!(s.distance(from + aim * t).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn touching_surfaces_leave_the_point_along_them() {
        // A plane that misses touching the cylinder by a hair: no common point, and none far away.
        let axis = DVec3::X;
        let cylinder = Support::Cylinder {
            origin: DVec3::ZERO,
            axis,
            radius: 1.0,
        };
        let plane = Support::Plane {
            origin: DVec3::new(0.0, 0.0, 1.0 - 1e-7),
            normal: DVec3::Z,
        };
        let start = DVec3::new(0.3, 1e-3, 1.0);
        assert!(meet(start, &[cylinder, plane]).distance(start) < 1e-3);
    }
}
