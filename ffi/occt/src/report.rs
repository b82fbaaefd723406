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

/// In words: planes and cylinders, and of the others what there is.
impl std::fmt::Display for FaceCounts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} planes, {} cylinders", self.plane, self.cylinder)?;
        let others = [
            ("cones", self.cone),
            ("spheres", self.sphere),
            ("tori", self.torus),
            ("others", self.other),
        ];
        for (name, count) in others.into_iter().filter(|(_, count)| *count > 0) {
            write!(f, ", {count} {name}")?;
        }
        Ok(())
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
    /// Faces whose surface was laid through their edges because its kind is not known.
    pub filled: Vec<FilledFace>,
}

/// A face on a surface that was laid through its edges.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FilledFace {
    /// Face of the plan, from 0.
    pub face: usize,
    /// Largest distance of its edges from the surface, in the plan's units.
    pub deviation: f64,
}

impl SolidReport {
    /// `sources` are the plan's faces (from 0) that the kernel's came from.
    pub(crate) fn new(outcome: &ffi::Outcome, sources: &[usize]) -> Self {
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
            filled: outcome
                .filled
                .iter()
                .zip(&outcome.deviations)
                .filter_map(|(number, &deviation)| {
                    let face = *sources.get((*number as usize).checked_sub(1)?)?;
                    Some(FilledFace { face, deviation })
                })
                .collect(),
        }
    }
}
