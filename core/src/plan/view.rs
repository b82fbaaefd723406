//! How the model was drawn, in the plan's frame.

use glam::{DMat3, DVec2, DVec3};

use crate::lift::Camera;

/// The projection, and the rotation from the camera frame to the plan's frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    rotation: DMat3,
    camera: Camera,
}

impl View {
    pub(super) const fn new(camera: Camera, rotation: DMat3) -> Self {
        Self { rotation, camera }
    }

    /// Rotation from the camera frame to the plan's frame.
    pub(super) fn rotation(&self) -> DMat3 {
        self.rotation
    }

    /// The point that is drawn at `p` and has the depth `z` in the camera frame.
    pub(super) fn place(&self, p: DVec2, z: f64) -> DVec3 {
        self.rotation * self.camera.place(p, z)
    }

    /// Whether the projection is parallel.
    pub(super) fn is_parallel(&self) -> bool {
        self.camera.is_parallel()
    }

    /// Where a point is drawn.
    pub(super) fn project(&self, p: DVec3) -> DVec2 {
        self.camera.project(self.rotation.transpose() * p)
    }

    /// The line of all points drawn at `p`: a point and a unit direction, away from the viewer in
    /// perspective, towards the viewer else.
    pub(super) fn ray(&self, p: DVec2) -> (DVec3, DVec3) {
        let (from, direction) = self.camera.ray(p);
        (self.rotation * from, self.rotation * direction.normalize())
    }

    /// Unit direction from a point to the viewer.
    pub(super) fn toward(&self, p: DVec3) -> DVec3 {
        if self.is_parallel() {
            self.rotation.z_axis
        } else {
            -p.normalize_or_zero()
        }
    }
}
