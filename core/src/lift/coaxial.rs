//! Rows from circles that are drawn on one axis, whatever lies between them, and from discs whose circles
//! came as splines. They are among the assumed rows.

use glam::DVec2;

use super::circle::{DrawnCircle, circle_through};
use super::revolved::{Center, center_of, link};
use super::rows::{Tag, Unknowns, normal_to};
use super::sheet::Sheet;
use super::system::System;

/// Splines that stand for circles are within this of them, as a share of the radius.
const SPLINE: f64 = 3e-4;

/// A circle in a plane across one of the normals.
struct Across {
    normal: usize,
    vertex: usize,
    circle: DrawnCircle,
}

/// A planar face with a hole or rim of splines that are drawn as a circle around an axis is normal to it.
pub(super) fn discs(sheet: &Sheet<'_>, unknowns: &Unknowns, system: &mut System<Tag>) {
    for face in 0..sheet.faces.len() {
        if let (Some(p), Some(rim)) = (unknowns.plane(face), spline_rim(sheet, face)) {
            let normal = sheet.axis(rim.normal);
            normal_to(sheet, face, p, normal, Tag::Disc { face }, system);
        }
    }
}

/// Circles around one direction whose centres are drawn on one line along it are around one axis.
pub(super) fn on_one_line(sheet: &Sheet<'_>, _: &Unknowns, system: &mut System<Tag>) {
    let arcs = sheet.circles.iter().enumerate();
    let arcs = arcs.filter_map(|(e, circle)| {
        circle.map(|(normal, circle)| Across {
            normal,
            vertex: sheet.drawing.edges[e].v[0],
            circle,
        })
    });
    let rims = (0..sheet.faces.len()).filter_map(|face| spline_rim(sheet, face));
    let all: Vec<Across> = arcs.chain(rims).collect();
    for k in 0..sheet.normals() {
        let around = all.iter().filter(|a| a.normal == k);
        let mut centers: Vec<Center> = around
            .map(|a| {
                let mut center = center_of(sheet, a.vertex, k, &a.circle);
                center.error = center.error.max(a.circle.residual);
                center
            })
            .collect();
        // Each one is linked to the others on its line, of which the surest comes first.
        centers.sort_by(|a, b| a.error.total_cmp(&b.error));
        for i in 0..centers.len() {
            link(sheet, &centers[i..], k, Tag::Coaxial, system);
        }
    }
}

/// The circle around an axis that a loop of splines of a planar face is drawn as.
fn spline_rim(sheet: &Sheet<'_>, face: usize) -> Option<Across> {
    if !sheet.is_planar(face) {
        return None;
    }
    sheet.faces[face].loops.iter().find_map(|coedges| {
        let mut points: Vec<DVec2> = Vec::new();
        for coedge in coedges {
            let edge = sheet.drawing.edges.get(coedge.edge())?;
            if edge.is_straight() || sheet.circles[coedge.edge()].is_some() {
                return None;
            }
            points.extend(&edge.points);
        }
        let vertex = sheet.drawing.edges[coedges.first()?.edge()].v[0];
        let mut fitting = (0..sheet.directions.axes.len()).filter_map(|normal| {
            let circle = circle_through(&points, sheet.axis(normal), sheet.camera())?;
            (circle.residual < SPLINE * circle.radius).then_some(Across {
                normal,
                vertex,
                circle,
            })
        });
        let only = fitting.next()?;
        fitting.next().is_none().then_some(only)
    })
}
