//! What is known of a finished solid.

use faceformer::drawing::SurfaceKind;
use serde::{Deserialize, Serialize};

use crate::bridge::ffi;

/// Number of faces on each kind of surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct FaceCounts {
    /// Planes.
    pub plane: usize,
    /// Cylinders.
    pub cylinder: usize,
    /// Cones.
    pub cone: usize,
    /// Spheres.
    pub sphere: usize,
    /// Tori.
    pub torus: usize,
    /// All others.
    pub other: usize,
}

impl FaceCounts {
    /// Number of faces on one kind of surface.
    pub const fn of(&self, kind: SurfaceKind) -> usize {
        match kind {
            SurfaceKind::Plane => self.plane,
            SurfaceKind::Cylinder => self.cylinder,
            SurfaceKind::Cone => self.cone,
            SurfaceKind::Sphere => self.sphere,
            SurfaceKind::Torus => self.torus,
            SurfaceKind::Other => self.other,
        }
    }

    /// Number of all faces.
    pub const fn total(&self) -> usize {
        self.plane + self.cylinder + self.cone + self.sphere + self.torus + self.other
    }
}

/// Figures of a valid, closed solid, measured by OpenCASCADE, in the plan's units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SolidReport {
    /// Volume, positive.
    pub volume: f64,
    /// Area of all faces.
    pub area: f64,
    /// Lower and upper corner of the bounding box.
    pub bounds: [[f64; 3]; 2],
    /// Faces by the kind of their surface.
    pub face_counts: FaceCounts,
    /// Number of faces.
    pub faces: usize,
    /// Number of edges, seams included.
    pub edges: usize,
    /// Number of vertices.
    pub vertices: usize,
    /// Number of shells: 1, and one more for each void inside.
    pub shells: usize,
    /// Largest tolerance of a vertex, edge or face.
    pub largest_tolerance: f64,
    /// Whether all faces that only silhouettes part were merged. `false` if the kernel could not:
    /// the solid is valid all the same, but a hole is made of several cylinder faces.
    pub merged: bool,
}

impl SolidReport {
    pub(crate) fn new(outcome: &ffi::Outcome) -> Self {
        let [plane, cylinder, cone, sphere, torus, other] = outcome.kinds.map(|k| k as usize);
        let face_counts = FaceCounts {
            plane,
            cylinder,
            cone,
            sphere,
            torus,
            other,
        };
        let corner = |p: ffi::Point| [p.x, p.y, p.z];
        Self {
            volume: outcome.volume,
            area: outcome.area,
            bounds: [corner(outcome.lower), corner(outcome.upper)],
            face_counts,
            faces: face_counts.total(),
            edges: outcome.edges as usize,
            vertices: outcome.vertices as usize,
            shells: outcome.shells as usize,
            largest_tolerance: outcome.largest_tolerance,
            merged: outcome.merged,
        }
    }
}
