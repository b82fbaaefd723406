//! How the model was drawn, in the plan's frame.

use glam::{DMat3, DVec2, DVec3};

use crate::drawing::{Drawing, Projection};

use super::PlanError;

/// The projection, and the rotation from the camera frame to the plan's frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    rotation: DMat3,
    focal: Option<f64>,
}

impl View {
    pub(super) fn new(drawing: &Drawing, rotation: DMat3) -> Result<Self, PlanError> {
        let focal = match drawing.projection {
            Projection::Orthographic => None,
            Projection::Perspective { focal: Some(f) } if f.is_finite() && f > 0.0 => Some(f),
            Projection::Perspective { .. } => {
                let what = "a perspective drawing needs its focal length";
                return Err(PlanError::Input(what.to_owned()));
            }
        };
        Ok(Self { rotation, focal })
    }

    /// Rotation from the camera frame to the plan's frame.
    pub(super) fn rotation(&self) -> DMat3 {
        self.rotation
    }

    /// The point that is drawn at `p` and has the depth `z` in the camera frame.
    pub(super) fn place(&self, p: DVec2, z: f64) -> DVec3 {
        let p = match self.focal {
            Some(f) => p * (-z / f),
            None => p,
        };
        self.rotation * p.extend(z)
    }

    /// Whether the projection is parallel.
    pub(super) fn is_parallel(&self) -> bool {
        self.focal.is_none()
    }

    /// Where a point is drawn.
    pub(super) fn project(&self, p: DVec3) -> DVec2 {
        let p = self.rotation.transpose() * p;
        match self.focal {
            Some(f) => p.truncate() * (f / -p.z),
            None => p.truncate(),
        }
    }

    /// The line of all points drawn at `p`: a point and a unit direction, away from the viewer in
    /// perspective, towards the viewer else.
    pub(super) fn ray(&self, p: DVec2) -> (DVec3, DVec3) {
        match self.focal {
            Some(f) => (DVec3::ZERO, self.rotation * p.extend(-f).normalize()),
            None => (self.rotation * p.extend(0.0), self.rotation.z_axis),
        }
    }

    /// Unit direction from a point to the viewer.
    pub(super) fn toward(&self, p: DVec3) -> DVec3 {
        match self.focal {
            Some(_) => -p.normalize_or_zero(),
            None => self.rotation.z_axis,
        }
    }
}
