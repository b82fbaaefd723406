//! Cylinders: axis, then radius and centre from the boundary seen along the axis.

use glam::{DVec2, DVec3};

use super::evidence::vertex;
use crate::lift::Surface;
use crate::lift::circle::circle_fit;
use crate::lift::heights::Heights;
use crate::lift::sheet::Sheet;

/// Largest distance, relative to the drawing's size, of a boundary point from a cylinder.
const OFF_CYLINDER: f64 = 1e-3;

/// Radians around a cylinder below which its outline fixes the radius better than a circle through
/// its points.
const NARROW: f64 = 0.7;

/// Axis, then radius and centre from the boundary seen along the axis.
pub(super) fn cylinder(sheet: &Sheet<'_>, heights: &Heights, face: usize) -> Option<Surface> {
    let axis = cylinder_axis(sheet, heights, face)?;
    let u = axis.any_orthonormal_vector();
    let w = axis.cross(u);
    let boundary = boundary_points(sheet, heights, face);
    let flat: Vec<DVec2> = boundary
        .iter()
        .map(|p| DVec2::new(p.dot(u), p.dot(w)))
        .collect();
    let through = circle_fit(flat.iter().copied());
    let by_outline = outlines(sheet, face).filter_map(|v| {
        let p = vertex(sheet, heights, v);
        // On an outline the radius is at right angles to the view.
        let (_, ray) = sheet.camera().ray(sheet.drawing.vertices[v]);
        let side = axis.cross(ray).try_normalize()?;
        let side = DVec2::new(side.dot(u), side.dot(w));
        touching(&flat, DVec2::new(p.dot(u), p.dot(w)), side)
    });
    let narrow = through.is_none_or(|(center, _, _)| arc_width(&flat, center) < NARROW);
    let mut found: Vec<(DVec2, f64)> = through.iter().map(|c| (c.0, c.1)).collect();
    if narrow {
        found.extend(by_outline);
    }
    let worst = |(center, radius): &(DVec2, f64)| {
        let off = flat.iter().map(|p| (p.distance(*center) - radius).abs());
        off.fold(0.0, f64::max)
    };
    let (center, radius) = found
        .into_iter()
        .min_by(|a, b| worst(a).total_cmp(&worst(b)))?;
    (worst(&(center, radius)) < OFF_CYLINDER * sheet.size).then(|| {
        let middle = boundary.iter().sum::<DVec3>() / boundary.len() as f64;
        Surface::Cylinder {
            origin: u * center.x + w * center.y + axis * middle.dot(axis),
            axis,
            radius,
        }
    })
}

/// Direction of the straight edges of a cylinder, else the normal of a circle that bounds it.
fn cylinder_axis(sheet: &Sheet<'_>, heights: &Heights, face: usize) -> Option<DVec3> {
    let edges = sheet.edges_of(face);
    let known = edges.iter().find_map(|&e| sheet.edge_axis[e]);
    let around = edges.iter().find_map(|&e| sheet.circles[e].map(|c| c.0));
    if let Some(k) = known.or(around) {
        return Some(sheet.axis(k));
    }
    let mut sum = DVec3::ZERO;
    for &e in edges.iter().filter(|&&e| sheet.is_straight(e)) {
        let [a, b] = sheet.drawing.edges[e].v.map(|v| vertex(sheet, heights, v));
        let d = b - a;
        sum += if d.dot(sum) < 0.0 { -d } else { d };
    }
    sum.try_normalize()
}

/// Vertices of the boundary, and the points of its arcs that lie in known planes.
fn boundary_points(sheet: &Sheet<'_>, heights: &Heights, face: usize) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = sheet.corners[face]
        .iter()
        .map(|&v| vertex(sheet, heights, v))
        .collect();
    for &e in sheet.edges_of(face) {
        if sheet.is_straight(e) {
            continue;
        }
        let edge = &sheet.drawing.edges[e];
        let inner = edge.points.get(1..edge.points.len() - 1).unwrap_or(&[]);
        let start = vertex(sheet, heights, edge.v[0]);
        let normal = match sheet.circles[e] {
            Some((k, _)) => Some(sheet.axis(k)),
            None => sheet.neighbours(e).iter().find_map(|&f| {
                let plane = heights.plane(f)?;
                Some(sheet.camera().normal(plane, sheet.middles[f]))
            }),
        };
        if let Some(n) = normal {
            points.extend(inner.iter().map(|p| {
                let (from, ray) = sheet.camera().ray(*p);
                from + ray * (n.dot(start - from) / n.dot(ray))
            }));
        }
    }
    points
}

/// Vertices on straight edges between two curved faces: outlines, as far as a drawing tells.
fn outlines<'a>(sheet: &'a Sheet<'_>, face: usize) -> impl Iterator<Item = usize> + 'a {
    sheet
        .edges_of(face)
        .iter()
        .filter(|&&e| {
            sheet.is_straight(e) && sheet.neighbours(e).iter().all(|&f| !sheet.is_planar(f))
        })
        .map(|&e| sheet.drawing.edges[e].v[0])
}

/// Circle through `p` whose centre lies along `side` from it, closest to the other points: a point
/// q on it has `|q - p|^2 = 2 r side.(q - p)`.
pub(in crate::lift) fn touching(points: &[DVec2], p: DVec2, side: DVec2) -> Option<(DVec2, f64)> {
    let (mut top, mut bottom) = (0.0, 0.0);
    for q in points.iter().map(|q| *q - p) {
        let s = 2.0 * side.dot(q);
        top += s * q.length_squared();
        bottom += s * s;
    }
    let r = top / bottom;
    r.is_finite().then(|| (p + side * r, r.abs()))
}

/// Angle that points take around a centre: a full turn less the widest gap.
fn arc_width(points: &[DVec2], center: DVec2) -> f64 {
    let mut angles: Vec<f64> = points.iter().map(|p| (*p - center).to_angle()).collect();
    angles.sort_by(f64::total_cmp);
    let around = angles.first().map(|a| a + std::f64::consts::TAU);
    let next = angles.iter().skip(1).copied().chain(around);
    let gap = angles
        .iter()
        .zip(next)
        .map(|(a, b)| b - a)
        .fold(0.0, f64::max);
    std::f64::consts::TAU - gap
}
