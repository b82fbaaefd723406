//! Options of planning.

use serde::{Deserialize, Serialize};

/// How the planned solid lies in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Orientation {
    /// Standing on model axes in the corner of the first octant: the dominant direction that is
    /// drawn most steeply is Z, the viewer looks from the quarter +X, -Y as in FreeCAD's isometric
    /// view, and the lower corner of the bounding box is the origin.
    #[default]
    Upright,
    /// In the camera frame: seen along -z, the solid covers its drawing.
    Drawn,
}

/// Options of [`plan`](super::plan).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlanOptions {
    /// Model units per drawing unit; a positive number.
    #[serde(default = "one")]
    pub scale: f64,
    /// How the solid lies in space.
    #[serde(default)]
    pub orientation: Orientation,
}

fn one() -> f64 {
    1.0
}

impl Default for PlanOptions {
    fn default() -> Self {
        Self {
            scale: 1.0,
            orientation: Orientation::Upright,
        }
    }
}
