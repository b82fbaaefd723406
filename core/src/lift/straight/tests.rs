use glam::{DVec2, DVec3};

use super::straightened;
use crate::drawing::Drawing;
use crate::lift::directions::Directions;
use crate::lift::testing::{extrusion, turned};

/// A comb: many edges along the axes, some of them short.
const COMB: [[f64; 2]; 8] = [
    [0.0, 0.0],
    [1.4, 0.0],
    [1.4, 0.9],
    [1.0, 0.9],
    [1.0, 0.4],
    [0.5, 0.4],
    [0.5, 0.7],
    [0.0, 0.7],
];

/// Moves every vertex by a share of the drawing's size to a side of its own.
fn shaken(drawing: &Drawing, share: f64) -> Drawing {
    let mut drawing = drawing.clone();
    let size = drawing.size();
    for (i, p) in drawing.vertices.iter_mut().enumerate() {
        *p += DVec2::from_angle(2.4 * (i * i) as f64) * share * size;
    }
    for edge in &mut drawing.edges {
        edge.points = edge.v.map(|v| drawing.vertices[v]).to_vec();
    }
    drawing
}

#[test]
fn an_exact_drawing_is_not_straightened() {
    let (drawing, _) = extrusion(turned(0.6, 0.7, 0.05), &COMB, 0.8);
    assert!(straightened(&drawing).is_empty());
}

#[test]
fn edges_follow_axes_exactly_and_vertices_stay_near() {
    let (exact, _) = extrusion(turned(0.6, 0.7, 0.05), &COMB, 0.8);
    let drawing = shaken(&exact, 0.004);
    let all = straightened(&drawing);
    let first = &all[0];
    let mut along = 0;
    for axis in &first.directions.axes {
        let d = axis.direction.truncate().normalize();
        for &e in &axis.edges {
            let [u, v] = first.drawing.edges[e].v.map(|v| first.drawing.vertices[v]);
            assert!((v - u).perp_dot(d).abs() < 1e-6, "edge {e}");
            along += 1;
        }
    }
    assert!(along >= 20, "{along} of {} edges", exact.edges.len());
    let size = exact.size();
    for (p, q) in first.drawing.vertices.iter().zip(&drawing.vertices) {
        assert!(p.distance(*q) < 0.02 * size);
    }
    let error = first.directions.precision / size;
    assert!((0.001..0.008).contains(&error), "{error}");
    // Right angles of the model are right again.
    let directions: Vec<DVec3> = first.directions.axes.iter().map(|a| a.direction).collect();
    assert!(directions[0].dot(directions[1]).abs() < 1e-9);
    assert!(Directions::estimate(&first.drawing).is_ok());
}

#[test]
fn edges_aside_of_an_axis_together_are_let_go() {
    // A small prism whose sides are turned four degrees away from the two axes.
    let turn = 4f64.to_radians();
    let corners: Vec<[f64; 2]> = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.4], [0.0, 0.4]]
        .map(|[x, y]: [f64; 2]| {
            [
                x * turn.cos() - y * turn.sin(),
                x * turn.sin() + y * turn.cos(),
            ]
        })
        .to_vec();
    let (mut drawing, _) = extrusion(turned(0.6, 0.7, 0.05), &COMB, 0.8);
    let (aside, _) = extrusion(turned(0.6, 0.7, 0.05), &corners, 0.3);
    let first = drawing.edges.len();
    let base = drawing.vertices.len();
    drawing.vertices.extend(&aside.vertices);
    drawing.edges.extend(aside.edges.into_iter().map(|mut e| {
        e.v = e.v.map(|v| v + base);
        e
    }));
    let drawing = shaken(&drawing, 0.003);
    let all = straightened(&drawing);
    let taken: usize = all[0]
        .directions
        .axes
        .iter()
        .flat_map(|a| &a.edges)
        .filter(|e| **e >= first)
        .count();
    // The four edges along its height stay.
    assert!(taken <= 5, "{taken}");
}
