use glam::{DMat3, DQuat, DVec2, DVec3, EulerRot};
use proptest::prelude::*;

use super::*;
use crate::drawing::{Curve2, Edge, EllipseArc};

/// A drawing of straight segments and of circles (centre, axis, radius), each in two halves.
fn drawing(turn: DQuat, lines: &[[DVec3; 2]], circles: &[(DVec3, DVec3, f64)]) -> Drawing {
    let mut vertices: Vec<DVec2> = Vec::new();
    let mut edges = Vec::new();
    let mut vertex = |p: DVec2| {
        let known = vertices.iter().position(|q| q.distance(p) < 1e-9);
        known.unwrap_or_else(|| {
            vertices.push(p);
            vertices.len() - 1
        })
    };
    for line in lines {
        let [a, b] = line.map(|p| (turn * p).truncate());
        edges.push(Edge {
            v: [vertex(a), vertex(b)],
            points: vec![a, b],
            curve: Curve2::Line,
        });
    }
    for &(center, axis, radius) in circles {
        let (center, n) = ((turn * center).truncate(), (turn * axis).normalize());
        let ratio = n.z.abs();
        let major = n.truncate().normalize().perp() * radius;
        for start in [0.0, std::f64::consts::PI] {
            let arc = EllipseArc {
                center,
                major,
                ratio,
                start,
                sweep: std::f64::consts::PI,
                residual: 0.0,
                uncertainty: 0.0,
            };
            let points: Vec<DVec2> = (0..=12)
                .map(|i| arc.point(start + std::f64::consts::PI * f64::from(i) / 12.0))
                .collect();
            edges.push(Edge {
                v: [vertex(points[0]), vertex(points[12])],
                points,
                curve: Curve2::Ellipse(arc),
            });
        }
    }
    Drawing::orthographic(vertices, edges)
}

fn box_lines(size: DVec3) -> Vec<[DVec3; 2]> {
    let mut lines = Vec::new();
    for corner in 0..8u8 {
        let at =
            |c: u8| DVec3::new(f64::from(c & 1), f64::from(c >> 1 & 1), f64::from(c >> 2)) * size;
        for bit in [1, 2, 4] {
            if corner & bit == 0 {
                lines.push([at(corner), at(corner | bit)]);
            }
        }
    }
    lines
}

fn turned(x: f64, y: f64, z: f64) -> DQuat {
    DQuat::from_euler(EulerRot::ZXY, z, x, y)
}

/// Whether the axes are those of the turned model, as they are or reversed in depth.
fn has_axes(found: &Directions, turn: DQuat, tolerance: f64) -> bool {
    let truth = columns(&DMat3::from_quat(turn));
    [found.clone(), found.clone().reversed()].iter().any(|d| {
        let close = |a: &Axis| {
            truth
                .iter()
                .any(|t| t.cross(a.direction).length() < tolerance)
        };
        d.axes.iter().all(close)
    })
}

#[test]
fn a_box_shows_its_frame_from_above() {
    let turn = turned(0.6, 0.7, 0.0);
    let found =
        Directions::estimate(&drawing(turn, &box_lines(DVec3::new(1.0, 2.0, 0.7)), &[])).unwrap();
    assert!(found.is_frame() && has_axes(&found, turn, 1e-6));
    assert_eq!(found.axes.iter().map(|a| a.edges.len()).sum::<usize>(), 12);
    let up = found
        .axes
        .iter()
        .map(|a| a.direction)
        .max_by(|a, b| a.y.abs().total_cmp(&b.y.abs()));
    assert!(up.is_some_and(|d| d.y > 0.0 && d.z > 0.0), "{up:?}");
}

/// A prism over five corners of which two are level with an axis: any view of some block shows the
/// same, but only the isometric one at 30 degrees.
#[test]
fn an_isometric_view_is_known_by_its_angles() {
    let turn = turned(
        (1.0f64 / 3.0).sqrt().asin(),
        std::f64::consts::FRAC_PI_4,
        0.0,
    );
    let base = [[0.0, 0.0], [1.0, 0.0], [1.3, 0.8], [0.5, 1.4], [-0.2, 0.7]];
    let base = base.map(|[x, z]| DVec3::new(x, 0.0, z));
    let up = DVec3::Y * 0.9;
    let lines: Vec<[DVec3; 2]> = (0..5)
        .map(|i| (base[i], base[(i + 1) % 5]))
        .flat_map(|(a, b)| [[a, b], [a + up, b + up], [a, a + up]])
        .collect();
    let found = Directions::estimate(&drawing(turn, &lines, &[])).unwrap();
    assert!(
        found.is_frame() && has_axes(&found, turn, 1e-9),
        "{found:?}"
    );
}

#[test]
fn a_shaft_shows_its_axis() {
    let turn = turned(0.5, 0.8, 0.1);
    let side = |r: f64, z: f64, h: f64| {
        // Outlines of a cylinder around z: where the normal is at right angles to the view.
        let view = turn.inverse() * DVec3::Z;
        let across = DVec3::Z.cross(view).normalize() * r;
        [1.0, -1.0].map(|s| [s * across + z * DVec3::Z, s * across + (z + h) * DVec3::Z])
    };
    let lines: Vec<_> = side(1.0, 0.0, 2.0)
        .into_iter()
        .chain(side(0.5, 2.0, 3.0))
        .collect();
    let circle = |z: f64, r: f64| (z * DVec3::Z, DVec3::Z, r);
    let circles = [
        circle(0.0, 1.0),
        circle(2.0, 1.0),
        circle(2.0, 0.5),
        circle(5.0, 0.5),
    ];
    let found = Directions::estimate(&drawing(turn, &lines, &circles)).unwrap();
    assert_eq!(found.axes.len(), 1);
    assert!(has_axes(&found, turn, 1e-6));
    assert_eq!(
        (found.axes[0].edges.len(), found.axes[0].circles.len()),
        (4, 8)
    );
    assert_eq!(found.axis_of_edge(0), Some(0));
    assert_eq!(found.axis_of_circle(4), Some(0));
}

#[test]
fn a_front_view_is_refused() {
    let flat = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
    let lines: Vec<_> = (0..4).map(|i| [flat[i], flat[(i + 1) % 4]]).collect();
    let found = Directions::estimate(&drawing(DQuat::IDENTITY, &lines, &[]));
    assert!(matches!(found, Err(LiftError::DegenerateView { degrees }) if degrees < 1.0));
}

#[test]
fn rounded_coordinates_are_told_from_exact_ones_and_from_those_by_hand() {
    let rounded_to = |step: f64| {
        let boxes = [DVec3::ONE, DVec3::new(0.37, 0.61, 0.53)].map(box_lines);
        let mut d = drawing(turned(0.6, 0.7, 0.3), &boxes.concat(), &[]);
        for v in &mut d.vertices {
            *v = (*v / step).round() * step;
        }
        d
    };
    let told = |step| {
        let d = rounded_to(step);
        (is_exact(&d), is_rounded(&d))
    };
    assert_eq!(told(1e-9), (true, false));
    assert_eq!(told(1e-6), (true, false));
    assert_eq!(told(1e-4), (false, true));
    assert_eq!(told(3e-2), (false, false));
    // What was drawn on a grid was not rounded to it.
    let shear = |p: DVec3| DVec3::new(p.x + 0.5 * p.z, p.y + 0.2 * p.z, 0.0);
    let lines = box_lines(DVec3::new(4.0, 3.0, 2.0)).into_iter();
    let lines: Vec<_> = lines.map(|line| line.map(shear)).collect();
    assert!(is_exact(&drawing(DQuat::IDENTITY, &lines, &[])));
}

#[test]
fn lines_in_no_common_directions_are_refused() {
    let fan: Vec<_> = (0..5)
        .map(|i| {
            [
                DVec3::ZERO,
                DQuat::from_rotation_z(0.2 * f64::from(i)) * DVec3::X,
            ]
        })
        .collect();
    let found = Directions::estimate(&drawing(DQuat::IDENTITY, &fan, &[]));
    assert!(matches!(found, Err(LiftError::NoDirections(_))));
    let mut perspective = drawing(DQuat::IDENTITY, &fan, &[]);
    perspective.projection = Projection::Perspective { focal: None };
    let found = Directions::estimate(&perspective);
    assert_eq!(found, Err(LiftError::Focal { directions: 0 }));
}

proptest! {
    /// Any generic view of a box, drawn with any of the precisions, shows its frame.
    #[test]
    fn a_box_is_read_at_its_own_precision(
        x in 0.25..1.2f64, y in 0.25..1.3f64, z in -3.0..3.0f64,
        digits in 3..8i32, seed in prop::collection::vec(-0.5..0.5f64, 16),
    ) {
        let turn = turned(x, y, z);
        let mut d = drawing(turn, &box_lines(DVec3::new(1.0, 1.6, 0.8)), &[]);
        let noise = 10f64.powi(-digits);
        for (v, n) in d.vertices.iter_mut().zip(seed.chunks(2)) {
            *v += noise * DVec2::new(n[0], n[1]);
        }
        for e in &mut d.edges {
            e.points = e.v.map(|v| d.vertices[v]).to_vec();
        }
        let found = Directions::estimate(&d).unwrap();
        prop_assert!(found.is_frame());
        prop_assert!(has_axes(&found, turn, 20.0 * noise + 1e-9), "{:?}", found);
    }
}
