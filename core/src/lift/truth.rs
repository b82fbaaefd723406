//! The lift that a drawing's truth gives, for measuring.

use glam::{DVec2, DVec3};

use super::surfaces::true_surfaces;
use super::{Camera, Lift, LiftMethod};
use crate::drawing::{Drawing, Projection, Truth};

/// Coordinates of a truth are rounded to about this, drawing units.
const ROUNDED: f64 = 1e-6;

/// The lift of the truth: its depths, and surfaces fitted to its curves in space, in the order of
/// its faces. A plan and a solid of it are what those of a lifted drawing are compared with.
///
/// A face whose boundary does not tell its surface is [`Surface::Unknown`](super::Surface::Unknown).
/// `None` without a truth in space, or for a perspective drawing without a focal length.
pub fn true_lift(drawing: &Drawing) -> Option<Lift> {
    let truth = drawing.truth.as_ref()?;
    let complete = truth.vertices3d.len() == drawing.vertices.len()
        && truth.edges3d.len() == drawing.edges.len()
        && !truth.vertices3d.is_empty();
    if !complete {
        return None;
    }
    let (mean, camera) = match drawing.projection {
        Projection::Orthographic => {
            let sum: f64 = truth.vertices3d.iter().map(|p| p.z).sum();
            (sum / truth.vertices3d.len() as f64, Camera::Parallel)
        }
        Projection::Perspective { focal } => {
            let principal = DVec2::ZERO;
            let focal = focal?;
            (0.0, Camera::Central { principal, focal })
        }
    };
    let shift = DVec3::new(0.0, 0.0, mean);
    let lowered = Truth {
        faces: truth.faces.clone(),
        vertices3d: truth.vertices3d.iter().map(|p| *p - shift).collect(),
        edges3d: truth
            .edges3d
            .iter()
            .map(|line| line.iter().map(|p| *p - shift).collect())
            .collect(),
        directions: truth.directions.clone(),
    };
    Some(Lift {
        depths: lowered.vertices3d.iter().map(|p| p.z).collect(),
        camera,
        surfaces: true_surfaces(&lowered, drawing.size()),
        directions: lowered.directions,
        method: LiftMethod::Exact,
        residual: ROUNDED,
        conflicts: Vec::new(),
        regular: None,
        curves: Vec::new(),
    })
}
