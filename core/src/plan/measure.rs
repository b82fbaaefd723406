//! Surfaces of a plan as functions of space.

use glam::DVec3;

use super::Surface3;
use super::support::Support;

impl Surface3 {
    fn support(&self) -> (Support, bool) {
        match *self {
            Self::Plane { origin, normal } => (Support::Plane { origin, normal }, false),
            Self::Cylinder {
                origin,
                axis,
                radius,
                hollow,
            } => {
                let support = Support::Cylinder {
                    origin,
                    axis,
                    radius,
                };
                (support, hollow)
            }
            Self::Cone {
                apex,
                axis,
                angle,
                hollow,
            } => (Support::Cone { apex, axis, angle }, hollow),
            Self::Sphere {
                center,
                radius,
                hollow,
            } => (Support::Sphere { center, radius }, hollow),
            Self::Torus {
                center,
                axis,
                major,
                minor,
                hollow,
            } => {
                let support = Support::Torus {
                    center,
                    axis,
                    major,
                    minor,
                };
                (support, hollow)
            }
            Self::Filled => (Support::Unknown, false),
        }
    }

    /// Distance of a point from the surface, negative inside the solid; zero for a filled surface,
    /// which is not known before it is built.
    pub fn distance(&self, p: DVec3) -> f64 {
        let (support, hollow) = self.support();
        let distance = support.distance(p);
        if hollow { -distance } else { distance }
    }

    /// Unit normal out of the solid beside a point of the surface; zero for a filled surface.
    pub fn normal(&self, p: DVec3) -> DVec3 {
        let (support, hollow) = self.support();
        let normal = support.gradient(p);
        if hollow { -normal } else { normal }
    }
}
