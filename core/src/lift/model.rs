//! What lifting takes and gives.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::Camera;

/// Options of lifting.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct LiftOptions {
    /// Take the Necker reversal of the default choice (the model seen from above).
    #[serde(default)]
    pub flip: bool,
}

/// Surface of a lifted face, in drawing units, camera frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Surface {
    /// Plane through `origin`; `normal` has unit length and no meaning of its sign.
    Plane {
        /// A point of the plane.
        origin: DVec3,
        /// Unit normal.
        normal: DVec3,
    },
    /// Circular cylinder.
    Cylinder {
        /// A point of the axis.
        origin: DVec3,
        /// Unit direction of the axis.
        axis: DVec3,
        /// Radius.
        radius: f64,
    },
    /// A surface that lifting does not know; its vertices still have depth.
    Unknown,
}

impl Surface {
    /// The surface moved away from the viewer by `depth`.
    pub(super) fn lowered(self, depth: f64) -> Self {
        let down = DVec3::new(0.0, 0.0, depth);
        match self {
            Self::Plane { origin, normal } => Self::Plane {
                origin: origin - down,
                normal,
            },
            Self::Cylinder {
                origin,
                axis,
                radius,
            } => Self::Cylinder {
                origin: origin - down,
                axis,
                radius,
            },
            Self::Unknown => Self::Unknown,
        }
    }
}

/// How the depths were found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LiftMethod {
    /// All rows agree: linear least squares.
    Exact,
    /// Rows conflicted: L1, then the rows that agree once more as least squares.
    L1,
}

/// A face that the lifted depths contradict.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Conflict {
    /// Face index, from 0.
    pub face: usize,
    /// Vertices (from 0) that lie off the face's surface.
    pub vertices: Vec<usize>,
    /// Other faces (from 0) at those vertices.
    pub others: Vec<usize>,
    /// Largest distance, in drawing units.
    pub residual: f64,
}

/// A lifted drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Lift {
    /// Depth z of every vertex, drawing units, towards the viewer. The mean is 0 in a parallel
    /// projection. In a central one the camera is at 0 and the scale, which the drawing does not
    /// tell, is such that the mean of f / -z is 1.
    pub depths: Vec<f64>,
    /// The projection: given, or estimated in a perspective drawing.
    #[serde(default)]
    pub camera: Camera,
    /// Surface of every face, in the order of the faces given.
    pub surfaces: Vec<Surface>,
    /// Dominant directions found, unit vectors in the camera frame; three if a full frame.
    pub directions: Vec<DVec3>,
    /// How the depths were found.
    pub method: LiftMethod,
    /// Largest residual of the rows that were kept, drawing units.
    pub residual: f64,
    /// Faces that the depths contradict; empty when consistent.
    pub conflicts: Vec<Conflict>,
}
