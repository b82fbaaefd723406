//! Circles in planes across none of the drawing's axes.
//!
//! An ellipse alone says how its circle's plane slopes, but for the sign: the minor axis is drawn
//! along the normal, and the ratio of the axes is the normal's share towards the viewer. A plane that
//! the circle lies in, or another circle of that slope, tells the sign.

use glam::{DVec2, DVec3};

use super::axis::AxisLine;
use super::shapes::{Outline, Shapes};
use crate::drawing::{Curve2, Drawing, EllipseArc};
use crate::identify::Face;
use crate::lift::{Pieces, Tilt};

/// Uncertainty of an ellipse from which it tells no slope.
const VAGUE: f64 = 0.01;

/// Ratio of axes below which a circle is seen from its edge, and above which from its axis.
const FLAT: f64 = 0.02;
const ROUND: f64 = 0.999;

/// Sine of the angle between normals up to which they are one.
const SAME: f64 = 0.02;

/// The same for one of the drawing's own axes, whose arcs have been looked for already.
const OWN: f64 = 5e-3;

/// Gives whole circles that no axis fits an axis of their own.
pub(super) fn add(shapes: &mut Shapes, drawing: &Drawing, pieces: &Pieces, faces: &[Face]) {
    if !shapes.camera.is_parallel() {
        return;
    }
    let known = shapes.axes.len();
    for (i, face) in faces.iter().enumerate() {
        let outline = &shapes.loops[i];
        if outline.line.is_some() || outline.fold || outline.curved {
            continue;
        }
        let Some(ellipse) = whole(drawing, face) else {
            continue;
        };
        let slopes = normals(&ellipse);
        let around = |o: &Outline| o.contains(ellipse.center) && o.area.abs() > outline.area.abs();
        let planes = shapes.loops.iter().filter(|o| around(o));
        let planes = planes.filter_map(|o| o.plane);
        let told = outline
            .plane
            .into_iter()
            .chain(planes)
            .find_map(|p| slopes.into_iter().find(|n| is_near(*n, p.normal(), SAME)));
        let axis = axis_of(&shapes.axes, known, slopes, told);
        let axis = axis.unwrap_or_else(|| {
            shapes.axes.push(told.unwrap_or(slopes[0]));
            shapes.axes.len() - 1
        });
        let normal = shapes.axes[axis];
        let (a, b) = (normal.x / normal.z, normal.y / normal.z);
        // Its vertices are on the plane, as far as they are lifted.
        let ends = face.loops[0].iter().map(|c| drawing.edges[c.edge()].v[0]);
        let heights: Vec<f64> = ends
            .map(|v| {
                let p = drawing.vertices[v];
                pieces.height(v) + a * p.x + b * p.y
            })
            .collect();
        let plane = outline.plane.unwrap_or(Tilt {
            a,
            b,
            c: -heights.iter().sum::<f64>() / heights.len() as f64,
            camera: shapes.camera,
        });
        let outline = &mut shapes.loops[i];
        outline.plane = Some(plane);
        outline.ring = true;
        outline.line = Some(AxisLine {
            axis,
            at: ellipse.center,
            depth: plane.level(ellipse.center),
        });
    }
}

/// The axis that a circle is around, of which the first `known` are the drawing's own: that of the
/// plane that tells its slope, else one that either of its slopes is.
fn axis_of(axes: &[DVec3], known: usize, slopes: [DVec3; 2], told: Option<DVec3>) -> Option<usize> {
    let own = |n: DVec3| axes[..known].iter().position(|a| is_near(n, *a, OWN));
    let further = |n: DVec3| {
        let further = axes[known..].iter().position(|a| is_near(n, *a, SAME));
        further.map(|k| known + k)
    };
    match told {
        Some(n) => own(n).or_else(|| further(n)),
        None => {
            let either = |find: &dyn Fn(DVec3) -> Option<usize>| slopes.into_iter().find_map(find);
            either(&own).or_else(|| either(&further))
        }
    }
}

/// Whether two normals are one, to the sine of an angle.
fn is_near(a: DVec3, b: DVec3, limit: f64) -> bool {
    a.cross(b).length() < limit
}

/// The ellipse that all edges of a loop are on and that they go around once.
fn whole(drawing: &Drawing, face: &Face) -> Option<EllipseArc> {
    let mut best: Option<EllipseArc> = None;
    let mut sweep = 0.0;
    for c in face.loops.iter().flatten() {
        let Curve2::Ellipse(arc) = drawing.edges[c.edge()].curve else {
            return None;
        };
        sweep += arc.sweep.abs();
        if let Some(b) = best {
            let size = b.major.length();
            let off = b.center.distance(arc.center) / size;
            if off > 0.05 || (arc.major.length() / size - 1.0).abs() > 0.05 {
                return None;
            }
        }
        if best.is_none_or(|b| arc.uncertainty < b.uncertainty) {
            best = Some(arc);
        }
    }
    best.filter(|b| {
        (sweep - std::f64::consts::TAU).abs() < 0.05
            && b.uncertainty < VAGUE
            && (FLAT..ROUND).contains(&b.ratio)
    })
}

/// The two unit normals, towards the viewer, of planes in which a circle is drawn as an ellipse.
fn normals(ellipse: &EllipseArc) -> [DVec3; 2] {
    let along: DVec2 = ellipse.minor().normalize_or_zero();
    let share = (1.0 - ellipse.ratio * ellipse.ratio).max(0.0).sqrt();
    [1.0, -1.0].map(|sign| (along * sign * share).extend(ellipse.ratio))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_around_an_axis_that_is_there() {
        let slopes = [DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.6, 0.0, 0.8)];
        let bent = |n: DVec3| (n + DVec3::new(0.0, 0.01, 0.0)).normalize();
        let axes = [slopes[0], DVec3::Y, bent(slopes[1])];
        assert_eq!(axis_of(&axes, 2, slopes, None), Some(0));
        assert_eq!(axis_of(&axes, 2, slopes, Some(slopes[1])), Some(2));
        // The drawing's own arcs are looked for more exactly.
        assert_eq!(axis_of(&[bent(slopes[0])], 1, slopes, None), None);
    }

    #[test]
    fn a_circle_is_across_one_of_two_normals() {
        let turned = glam::DMat3::from_rotation_z(0.7) * glam::DMat3::from_rotation_x(-0.8);
        let points: Vec<DVec2> = (0..=64)
            .map(|k| DVec2::from_angle(std::f64::consts::TAU * f64::from(k % 64) / 64.0))
            .map(|p| (turned * p.extend(0.0)).truncate())
            .collect();
        let Curve2::Ellipse(arc) = Curve2::recognise(&points) else {
            panic!("no ellipse");
        };
        let normal = turned * DVec3::Z;
        let near = |n: &DVec3| n.distance(normal) < 1e-4;
        let both = normals(&arc);
        assert_eq!(both.iter().filter(|n| near(n)).count(), 1, "{both:?}");
        assert!(
            both.iter()
                .all(|n| (n.length() - 1.0).abs() < 1e-9 && n.z > 0.0)
        );
    }
}
