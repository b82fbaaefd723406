//! Silhouettes: outlines of curved faces, which are drawn but are no edges of the solid.

use glam::{DVec2, DVec3};

use crate::drawing::Edge;

use super::support::Support;
use super::view::View;

/// Largest cosine between the surface normal and the view along a straight silhouette, about 3
/// degrees: an outline that is drawn this far off is still meant as one.
const ACROSS: f64 = 0.05;

/// The same at the ends of a curved one and along it: a line of sight that is off by d leaves a
/// surface of radius r by an angle of sqrt(2 d / r).
const CURVED: f64 = 0.2;

/// Whether the drawn edge between two faces of one surface is the surface's outline.
pub(super) fn is_outline(surface: &Support, edge: &Edge, ends: [DVec3; 2], view: &View) -> bool {
    let toward = view.toward(ends[0].midpoint(ends[1]));
    if edge.is_straight() {
        // Not at the ends: one may be the apex of a cone.
        let outwards = surface.gradient(ends[0].midpoint(ends[1]));
        let (Some((_, axis)), Some(outwards), Some(along)) = (
            surface.axis(),
            outwards.try_normalize(),
            (ends[1] - ends[0]).try_normalize(),
        ) else {
            return false;
        };
        return match surface {
            Support::Cylinder { .. } => {
                along.cross(axis).length() < ACROSS && outwards.dot(toward).abs() < ACROSS
            }
            Support::Cone { .. } => outwards.dot(toward).abs() < ACROSS,
            _ => false,
        };
    }
    match surface {
        Support::Sphere { .. } | Support::Torus { .. } => {
            edge.points.iter().all(|p| touches(surface, *p, view))
        }
        _ => false,
    }
}

/// Whether the surface is seen edge-on where a point is drawn.
fn touches(surface: &Support, p: DVec2, view: &View) -> bool {
    let (from, direction) = view.ray(p);
    let mut crossings = surface.crossings(from, direction).into_iter();
    crossings.any(|t| surface.gradient(from + direction * t).dot(direction).abs() < CURVED)
}

/// The plane in which the ends of a silhouette lie: along the edge that they end on, the surfaces
/// leave them free. `None` where an outline is no plane curve.
pub(super) fn plane_of(surface: &Support, ends: [DVec3; 2], view: &View) -> Option<Support> {
    match *surface {
        // Through the axis, with the line of touch.
        Support::Cylinder { origin, axis, .. }
        | Support::Cone {
            apex: origin, axis, ..
        } => {
            let out = ends.map(|p| (p - origin).reject_from_normalized(axis));
            let normal = axis.cross(out[0] + out[1]).try_normalize()?;
            Some(Support::Plane { origin, normal })
        }
        // The polar plane of the viewer, who is at the origin or infinitely far away.
        Support::Sphere { center, radius } => {
            let toward = view.toward(center);
            let nearer = if view.is_parallel() {
                0.0
            } else {
                radius * radius / center.length()
            };
            Some(Support::Plane {
                origin: center + toward * nearer,
                normal: toward,
            })
        }
        _ => None,
    }
}
