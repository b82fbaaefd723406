//! Normals of circles beside the axes that their angles with an axis tell, in a parallel projection.
//!
//! A circle is drawn as one of two, mirrored in depth. Where a hole is drilled at an angle, one of them
//! is at a usual angle with the axis of the part, or as holes spread around it at one angle are; that
//! the other one is so too would be chance.

use glam::DVec3;

use super::directions::{AGREE, Directions, DrawnNormals, Slant, drawn_normals, towards_viewer};
use crate::drawing::Drawing;

/// Angles with an axis that are usual are multiples of this, radians.
const USUAL: f64 = std::f64::consts::PI / 12.0;

/// Errors, radians, up to which it is no chance that an angle is a usual one.
const SHARP: f64 = 1e-3;

/// Circles that are drawn with the same normals.
struct Look {
    normals: [DVec3; 2],
    error: f64,
    edges: Vec<usize>,
}

/// A reading with the normals of circles that are at a telling angle with its axis; with three axes
/// those at right angles with one of them.
pub(super) fn extended(drawing: &Drawing, mut reading: Directions) -> Directions {
    if !reading.camera.is_parallel() {
        return reading;
    }
    let mut normals = drawn_normals(drawing, &reading.camera, reading.precision);
    let known: Vec<usize> = reading.normals().flat_map(|n| n.1).copied().collect();
    normals.retain(|n| !known.contains(&n.edge));
    let looks = looks(normals);
    let told: Vec<Option<usize>> = looks.iter().map(|look| look.usual(&reading)).collect();
    for (i, look) in looks.iter().enumerate() {
        let alike = || {
            let others = looks.iter().enumerate().filter(|(j, _)| *j != i);
            let mut ways = others.filter_map(|(_, other)| look.inclined_as(other, &reading));
            let first = ways.next()?;
            ways.all(|way| way == first).then_some(first)
        };
        if let Some(which) = told[i].or_else(alike) {
            reading.slanted.push(Slant {
                direction: towards_viewer(look.normals[which]),
                edges: Vec::new(),
                circles: look.edges.clone(),
                error: look.error,
                usual: false,
            });
        }
    }
    reading
}

fn looks(mut normals: Vec<DrawnNormals>) -> Vec<Look> {
    normals.sort_by(|a, b| a.error.total_cmp(&b.error));
    let mut looks: Vec<Look> = Vec::new();
    for n in normals {
        let same = |look: &&mut Look| n.agrees(look.normals[0], look.error);
        match looks.iter_mut().find(same) {
            Some(look) => look.edges.push(n.edge),
            None => looks.push(Look {
                normals: n.normals,
                error: n.error,
                edges: vec![n.edge],
            }),
        }
    }
    looks
}

impl Look {
    /// Error of an angle with an axis, if it tells anything.
    fn reach(&self, reading: &Directions) -> Option<f64> {
        let reach = AGREE * (self.error + reading.error);
        (reach < SHARP).then_some(reach)
    }

    /// Which of the two normals is at a usual angle, if one is.
    fn usual(&self, reading: &Directions) -> Option<usize> {
        let reach = self.reach(reading)?;
        let is_usual = |n: &DVec3| {
            let mut angles = reading.axes.iter().map(|a| angle(*n, a.direction));
            if reading.is_frame() {
                angles.any(|angle| (angle - std::f64::consts::FRAC_PI_2).abs() < reach)
            } else {
                angles.any(|angle| (angle / USUAL - (angle / USUAL).round()).abs() * USUAL < reach)
            }
        };
        match self.normals.each_ref().map(is_usual) {
            [true, false] => Some(0),
            [false, true] => Some(1),
            _ => None,
        }
    }

    /// Which of the two normals makes the same angle with a lone axis as one of another circle, if one
    /// does.
    fn inclined_as(&self, other: &Self, reading: &Directions) -> Option<usize> {
        let [axis] = &reading.axes[..] else {
            return None;
        };
        let reach = self.reach(reading)? + other.reach(reading)?;
        let [own, theirs] = [self, other].map(|l| l.normals.map(|n| angle(n, axis.direction)));
        let is_alike = |a: f64| theirs.iter().filter(|b| (a - **b).abs() < reach).count();
        match own.map(is_alike) {
            [1, 0] => Some(0),
            [0, 1] => Some(1),
            _ => None,
        }
    }
}

/// Angle between two lines, radians, up to a right one.
fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b).abs())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::Camera;
    use super::super::directions::Axis;
    use super::super::testing::{Scene, turned};
    use super::*;

    /// A disc whose axis is known, and round walls at these angles from it, degrees, spread around it:
    /// the directions of the walls, and the normals that they are said to have.
    fn told(angles: &[f64]) -> (Vec<DVec3>, Vec<DVec3>) {
        let turn = turned(0.6, 0.7, 0.05);
        let mut scene = Scene::new(turn);
        scene.wall(DVec3::ZERO, DVec3::Z * 0.3, 2.0);
        let along = |(i, angle): (usize, &f64)| {
            let (sin, cos) = angle.to_radians().sin_cos();
            let (y, x) = (TAU * i as f64 / 3.0 + 0.4).sin_cos();
            DVec3::new(x * sin, y * sin, cos)
        };
        let ways: Vec<DVec3> = angles.iter().enumerate().map(along).collect();
        for way in &ways {
            scene.wall(*way * 3.0, *way * 0.5, 0.2);
        }
        let (drawing, _) = scene.finish();
        let reading = Directions {
            axes: vec![Axis {
                direction: turn * DVec3::Z,
                edges: Vec::new(),
                circles: vec![0, 1, 2, 3],
            }],
            slanted: Vec::new(),
            swept: Vec::new(),
            camera: Camera::Parallel,
            error: 1e-6,
            precision: 1e-6,
        };
        let slanted = extended(&drawing, reading).slanted.into_iter();
        let ways = ways.into_iter().map(|way| turn * way);
        (ways.collect(), slanted.map(|s| s.direction).collect())
    }

    #[test]
    fn a_hole_at_a_usual_angle_is_told() {
        for angle in [30.0, 45.0, 75.0] {
            let (ways, told) = told(&[angle]);
            assert_eq!(told.len(), 1, "{angle}");
            assert!(told[0].cross(ways[0]).length() < 1e-6, "{angle}");
        }
        assert!(told(&[37.0]).1.is_empty());
    }

    #[test]
    fn holes_around_an_axis_are_told_by_each_other() {
        let (ways, told) = told(&[37.0; 3]);
        assert_eq!(told.len(), 3);
        let near = |way: &DVec3| told.iter().any(|n| n.cross(*way).length() < 1e-6);
        assert!(ways.iter().all(near));
    }
}
