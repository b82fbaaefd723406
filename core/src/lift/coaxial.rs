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

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::super::testing::{Scene, turned};
    use super::super::{LiftError, LiftOptions, depth_error, lift};
    use crate::drawing::{Curve2, Drawing, SurfaceKind};
    use crate::identify::Face;
    use crate::{Error, Progress};

    /// Two discs that share nothing, the second `aside` of the first one's axis.
    fn discs(central: bool, aside: DVec3) -> (Drawing, Vec<Face>) {
        let turn = turned(0.6, 0.7, 0.05);
        let mut scene = if central {
            Scene::central(turn, DVec3::Z * -9.0, DVec2::ZERO, 4.0)
        } else {
            Scene::new(turn)
        };
        for (at, radius) in [(DVec3::ZERO, 1.0), (aside + DVec3::Z * 1.5, 0.4)] {
            let ends = scene.wall(at, DVec3::Z * 0.5, radius);
            for end in ends {
                scene.face(SurfaceKind::Plane, &[end]);
            }
        }
        scene.finish()
    }

    fn error(drawing: &Drawing, faces: &[Face]) -> crate::Result<f64> {
        let found = lift(drawing, faces, &LiftOptions::default(), Progress::none())?;
        let truth = drawing.truth.as_ref().expect("it is drawn with its truth");
        Ok(depth_error(&found, truth))
    }

    #[test]
    fn discs_on_one_axis_are_tied() {
        for central in [false, true] {
            let (drawing, faces) = discs(central, DVec3::ZERO);
            assert!(error(&drawing, &faces).unwrap() < 1e-6, "{central}");
            let (drawing, faces) = discs(central, DVec3::X * 0.3);
            let open = error(&drawing, &faces);
            let is_open = matches!(open, Err(Error::Lift(LiftError::UnderConstrained { .. })));
            assert!(is_open, "{central} {open:?}");
        }
    }

    /// A disc over another one, with a rim of splines that are off their circle by a ten-thousandth of the
    /// radius, and nothing between the two.
    #[test]
    fn a_splined_rim_is_a_circle() {
        let mut scene = Scene::new(turned(0.6, 0.7, 0.05));
        for end in scene.wall(DVec3::ZERO, DVec3::Z * 0.5, 1.0) {
            scene.face(SurfaceKind::Plane, &[end]);
        }
        let halves = [DVec3::X * 0.4, DVec3::X * -0.4];
        let rim = halves.map(|from| scene.arc(DVec3::Z * 1.5, DVec3::Z, from, -from));
        scene.face(SurfaceKind::Plane, &[rim.to_vec()]);
        let (mut drawing, faces) = scene.finish();
        for e in rim {
            let edge = &mut drawing.edges[e];
            let last = edge.points.len() - 1;
            for (i, p) in edge.points.iter_mut().enumerate().take(last).skip(1) {
                p.x += 4e-5 * if i % 2 == 0 { 1.0 } else { -1.0 };
            }
            edge.curve = Curve2::Polyline;
        }
        assert!(error(&drawing, &faces).unwrap() < 1e-3);
    }
}
