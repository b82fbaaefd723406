//! Silhouettes: outlines of cylinders, which are drawn but are no edges of the solid.

use glam::DVec3;

use super::support::Support;
use super::view::View;

/// Largest cosine between the surface normal and the view along a silhouette, about 3 degrees: an
/// outline that is drawn this far off is still meant as one.
const ACROSS: f64 = 0.05;

/// The plane through the axis in which a straight edge between two faces of one cylinder runs, if
/// it is the cylinder's outline.
///
/// The ends of a silhouette are held by this plane: along the edge that they end on, the surfaces
/// leave them free.
pub(super) fn outline(tube: &Support, ends: [DVec3; 2], view: &View) -> Option<Support> {
    let Support::Cylinder { origin, axis, .. } = *tube else {
        return None;
    };
    let outwards = (tube.gradient(ends[0]) + tube.gradient(ends[1])).try_normalize()?;
    let middle = ends[0].midpoint(ends[1]);
    let along = (ends[1] - ends[0]).try_normalize()?;
    let straight = along.cross(axis).length() < ACROSS;
    let normal = axis.cross(outwards).try_normalize()?;
    (straight && outwards.dot(view.toward(middle)).abs() < ACROSS)
        .then_some(Support::Plane { origin, normal })
}
