//! The plan in its final place and size.

use glam::DVec3;

use super::sample::polyline;
use super::{Curve3, Orientation, Plan, PlanOptions, Surface3};

/// Steps along a curve when the bounding box is sought; a box that is short by 1e-3 of a radius
/// only shifts the model.
const STEPS: usize = 64;

/// Moves an upright plan to the corner of the first octant, and scales.
pub(super) fn finish(mut plan: Plan, options: &PlanOptions) -> Plan {
    let offset = match options.orientation {
        Orientation::Upright => {
            let points = plan
                .edges
                .iter()
                .flat_map(|e| polyline(e, &plan.vertices, STEPS));
            -points.fold(DVec3::INFINITY, |m, p| m.min(p))
        }
        Orientation::Drawn => DVec3::ZERO,
    };
    let scale = options.scale;
    let place = |p: &mut DVec3| *p = (*p + offset) * scale;
    plan.vertices.iter_mut().for_each(place);
    for edge in &mut plan.edges {
        match &mut edge.curve {
            Curve3::Line => {}
            Curve3::Circle { center, radius, .. } => {
                place(center);
                *radius *= scale;
            }
            Curve3::Ellipse { center, major, .. } => {
                place(center);
                *major *= scale;
            }
            Curve3::Points { points, .. } => points.iter_mut().for_each(place),
        }
    }
    for face in &mut plan.faces {
        match &mut face.surface {
            Surface3::Plane { origin, .. } => place(origin),
            Surface3::Cylinder { origin, radius, .. } => {
                place(origin);
                *radius *= scale;
            }
            Surface3::Cone { apex, .. } => place(apex),
            Surface3::Sphere { center, radius, .. } => {
                place(center);
                *radius *= scale;
            }
            Surface3::Torus {
                center,
                major,
                minor,
                ..
            } => {
                place(center);
                *major *= scale;
                *minor *= scale;
            }
            Surface3::Filled => {}
        }
    }
    plan
}
