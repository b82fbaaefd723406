//! The parameter plane of a round surface: an angle around the axis, and what runs across it.

use std::f64::consts::{PI, TAU};

use faceformer::plan::Surface3;
use glam::DVec3;

/// Parameters of points on a surface of revolution.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chart {
    pub(super) origin: DVec3,
    pub(super) axis: DVec3,
    x: DVec3,
    y: DVec3,
    across: Across,
}

/// What the second parameter is.
#[derive(Debug, Clone, Copy)]
enum Across {
    /// Height along the axis.
    Height,
    /// Latitude.
    Sphere,
    /// Angle around the tube, of a spine of that radius.
    Tube(f64),
}

/// An angle in (-pi, pi].
pub(super) fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

impl Chart {
    /// The chart of a surface; `axis` is that of a sphere. `None` for planes and filled surfaces.
    pub(super) fn new(surface: &Surface3, axis: DVec3) -> Option<Self> {
        let (origin, axis, across) = match *surface {
            Surface3::Cylinder { origin, axis, .. } => (origin, axis, Across::Height),
            Surface3::Cone { apex, axis, .. } => (apex, axis, Across::Height),
            Surface3::Sphere { center, .. } => (center, axis, Across::Sphere),
            Surface3::Torus {
                center,
                axis,
                major,
                ..
            } => (center, axis, Across::Tube(major)),
            Surface3::Plane { .. } | Surface3::Filled => return None,
        };
        let x = axis.try_normalize()?.any_orthonormal_vector();
        Some(Self {
            origin,
            axis,
            x,
            y: axis.cross(x),
            across,
        })
    }

    /// Whether the second parameter is an angle as well.
    pub(super) fn is_torus(&self) -> bool {
        matches!(self.across, Across::Tube(_))
    }

    /// Parameters of a point beside the surface.
    pub(super) fn place(&self, p: DVec3) -> [f64; 2] {
        let d = p - self.origin;
        let (x, y, h) = (d.dot(self.x), d.dot(self.y), d.dot(self.axis));
        let v = match self.across {
            Across::Height => h,
            Across::Sphere => h.atan2(x.hypot(y)),
            Across::Tube(major) => h.atan2(x.hypot(y) - major),
        };
        [y.atan2(x), v]
    }

    /// Unit direction away from the axis at an angle.
    pub(super) fn outwards(&self, u: f64) -> DVec3 {
        self.x * u.cos() + self.y * u.sin()
    }

    /// How far a point is from the axis, relative to its distance from the origin.
    pub(super) fn off_axis(&self, p: DVec3) -> f64 {
        let d = p - self.origin;
        d.reject_from_normalized(self.axis).length() / d.length().max(f64::MIN_POSITIVE)
    }
}
