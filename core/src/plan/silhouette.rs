//! Silhouettes: outlines of curved faces, which are drawn but are no edges of the solid.

use glam::{DVec2, DVec3};

use crate::drawing::{Drawing, Edge};

use super::support::Support;
use super::view::View;

/// Largest cosine between the surface normal and the view along a straight silhouette, about 3
/// degrees: an outline that is drawn this far off is still meant as one.
const ACROSS: f64 = 0.05;

/// The same at the ends of a curved one and along it: a line of sight that is off by d leaves a
/// surface of radius r by an angle of sqrt(2 d / r).
const CURVED: f64 = 0.2;

/// Sine of the angle within which edges go on smoothly into each other in the drawing.
const SMOOTH: f64 = 0.25;

/// Whether the drawn edge between two faces of one surface is the surface's outline.
pub(super) fn is_outline(surface: &Support, edge: &Edge, ends: [DVec3; 2], view: &View) -> bool {
    let toward = view.toward(ends[0].midpoint(ends[1]));
    if edge.is_straight() {
        let outwards = surface.gradient(ends[0]) + surface.gradient(ends[1]);
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

/// Whether an edge between two surfaces that say nothing is drawn like an outline: it leaves the
/// edges at its ends by the tangent, as a fold does, or meets no other edge.
pub(super) fn is_fold(drawing: &Drawing, edge: usize) -> bool {
    let [a, b] = drawing.edges[edge].v;
    let at = |v: usize| {
        let others = drawing.edges.iter().enumerate();
        let mut others = others.filter(move |(e, other)| *e != edge && other.v.contains(&v));
        let own = tangent(&drawing.edges[edge], drawing, v);
        let mut count = 0;
        let smooth = others.all(|(_, other)| {
            count += 1;
            tangent(other, drawing, v).perp_dot(own).abs() < SMOOTH
        });
        smooth && (count >= 2 || (count == 0 && a == b))
    };
    at(a) && at(b)
}

/// Unit tangent of an edge at one of its vertices, away from it: of the parabola through three points.
fn tangent(edge: &Edge, drawing: &Drawing, v: usize) -> DVec2 {
    let points = &edge.points;
    let at = |i: usize| {
        let i = if edge.v[0] == v {
            Some(i)
        } else {
            points.len().checked_sub(1 + i)
        };
        i.and_then(|i| points.get(i)).copied()
    };
    let start = drawing.vertices[v];
    let Some(d) = at(1).map(|p| p - start) else {
        return DVec2::ZERO;
    };
    let Some(e) = at(2).map(|p| p - start - d) else {
        return d.normalize_or_zero();
    };
    let (s, t) = (d.length(), e.length());
    let slope = d / s - (e / t - d / s) * (s / (s + t));
    slope.try_normalize().unwrap_or(d.normalize_or_zero())
}
