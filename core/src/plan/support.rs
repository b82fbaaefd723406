//! The surfaces that faces lie on.

use glam::DVec3;

pub(super) use crate::lift::Surface as Support;

use super::Surface3;

/// The surface that lifting found, with unit directions; the reason if it cannot be built.
pub(super) fn checked(surface: &Support) -> Result<Support, &'static str> {
    let support = match surface {
        Support::Sphere { .. } | Support::Unknown => *surface,
        _ => {
            let unit = surface.direction().try_normalize();
            surface.with_direction(unit.ok_or("it has no direction")?)
        }
    };
    if !support.origin().is_finite() {
        return Err("its position is not a finite number");
    }
    support.fault().map_or(Ok(support), Err)
}

/// The surface of a face whose outward normal is the gradient, or its opposite if `hollow`.
pub(super) fn oriented(support: &Support, hollow: bool) -> Surface3 {
    match *support {
        Support::Plane { origin, normal } => Surface3::Plane {
            origin,
            normal: if hollow { -normal } else { normal },
        },
        Support::Cylinder {
            origin,
            axis,
            radius,
        } => Surface3::Cylinder {
            origin,
            axis,
            radius,
            hollow,
        },
        Support::Cone { apex, axis, angle } => Surface3::Cone {
            apex,
            axis,
            angle,
            hollow,
        },
        Support::Sphere { center, radius } => Surface3::Sphere {
            center,
            radius,
            hollow,
        },
        Support::Torus {
            center,
            axis,
            major,
            minor,
        } => Surface3::Torus {
            center,
            axis,
            major,
            minor,
            hollow,
        },
        Support::Unknown => Surface3::Filled,
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
        fn meeting_points_lie_on_the_surfaces(offset in prop::array::uniform3(-0.05..0.05f64)) {
            let offset = DVec3::from_array(offset);
            let common = meet(DVec3::new(1.2, 2.2, 3.45), &[cylinder(), plane()]);
            let p = meet(common + offset, &[cylinder(), plane()]);
            prop_assert!(cylinder().distance(p).abs() < 1e-12);
            prop_assert!(plane().distance(p).abs() < 1e-12);
            prop_assert!(p.distance(common) < 3.0 * offset.length());
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
