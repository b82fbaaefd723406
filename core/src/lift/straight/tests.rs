use glam::{DVec2, DVec3};

use super::parallelograms::{Sides, sides};
use super::{ends, straightened};
use crate::drawing::{Drawing, SurfaceKind};
use crate::identify::Face;
use crate::lift::directions::Directions;
use crate::lift::sheet::Sheet;
use crate::lift::testing::{Scene, extrusion, polygon, turned};

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

/// Two prisms: the comb, and one of six corners that follow no axis.
fn with_pocket() -> (Drawing, Vec<Face>, std::ops::Range<usize>) {
    let turn = turned(0.6, 0.7, 0.05);
    let mut scene = Scene::new(turn);
    let corners: Vec<[f64; 2]> = (0..6)
        .map(|i| {
            let angle = 0.2 + f64::from(i) * std::f64::consts::FRAC_PI_3;
            [0.3 + 0.08 * angle.cos(), 0.3 + 0.08 * angle.sin()]
        })
        .collect();
    let mut counts = Vec::new();
    for (profile, height) in [(COMB.to_vec(), 0.8), (corners, 0.25)] {
        let [bottom, top] = scene.prism(&polygon(&profile), DVec3::Z * height);
        counts.push(bottom.len());
        scene.face(SurfaceKind::Plane, &[bottom]);
        scene.face(SurfaceKind::Plane, &[top]);
    }
    let (drawing, faces) = scene.finish();
    let first = 3 * counts[0];
    (drawing, faces, first..first + 3 * counts[1])
}

#[test]
fn opposite_sides_of_parallelograms_become_one_vector() {
    let (exact, _, pocket) = with_pocket();
    let drawing = shaken(&exact, 0.002);
    let all = sides(&drawing, 0.002 * exact.size());
    // Six edges along the pocket, and six pairs at its ends.
    let own = |s: &&Sides| pocket.contains(&s.edges[0].0);
    let mut sizes: Vec<usize> = all.iter().filter(own).map(|r| r.edges.len()).collect();
    sizes.sort_unstable();
    assert_eq!(sizes, [2, 2, 2, 2, 2, 2, 6]);
    let straight = &straightened(&drawing)[0];
    let chord = |e: usize| {
        let [u, v] = straight.drawing.edges[e]
            .v
            .map(|v| straight.drawing.vertices[v]);
        v - u
    };
    for row in all.iter().filter(own) {
        let (first, sign) = row.edges[0];
        for &(e, s) in &row.edges {
            let off = chord(e) * s - chord(first) * sign;
            assert!(off.length() < 1e-6, "edges {first} and {e}: {off}");
        }
    }
}

#[test]
fn short_edges_take_their_axis_from_those_alike() {
    let (exact, _, pocket) = with_pocket();
    let drawing = shaken(&exact, 0.004);
    let straight = &straightened(&drawing)[0];
    let height = exact
        .edges
        .iter()
        .enumerate()
        .filter(|(e, edge)| {
            let places = &exact.truth.as_ref().unwrap().vertices3d;
            let [a, b] = edge.v.map(|v| places[v]);
            pocket.contains(e)
                && (b - a)
                    .normalize()
                    .dot(turned(0.6, 0.7, 0.05) * DVec3::Z)
                    .abs()
                    > 0.999
        })
        .map(|(e, _)| straight.directions.axis_of_edge(e));
    let height: Vec<Option<usize>> = height.collect();
    assert_eq!(height.len(), 6);
    assert!(
        height[0].is_some() && height.iter().all(|k| *k == height[0]),
        "{height:?}"
    );
}

#[test]
fn ends_of_prisms_are_across_what_leaves_them() {
    let (exact, faces, pocket) = with_pocket();
    let drawing = shaken(&exact, 0.004);
    let straight = &straightened(&drawing)[0];
    // One edge along the pocket and one of its floor are read wrongly.
    let mut directions = straight.directions.clone();
    let up = sides(&drawing, straight.directions.precision)
        .into_iter()
        .find(|r| r.edges.len() == 6 && pocket.contains(&r.edges[0].0))
        .unwrap()
        .edges;
    let axis = directions.axis_of_edge(up[0].0).unwrap();
    let wrong = (axis + 1) % 3;
    let floor = pocket
        .clone()
        .find(|e| up.iter().all(|m| m.0 != *e))
        .unwrap();
    directions.axes[axis].edges.retain(|e| *e != up[2].0);
    directions.axes[wrong].edges.extend([up[2].0, floor]);
    let sheet = Sheet::new(&straight.drawing, &faces, &directions);
    let ends = ends::ends(&sheet);
    let own: Vec<usize> = ends
        .faces
        .iter()
        .filter(|f| f.0 >= 10)
        .map(|f| f.1)
        .collect();
    assert_eq!(own, [axis, axis]);
    let told = ends.directions.unwrap();
    assert_eq!(told.axis_of_edge(up[2].0), Some(axis));
    assert_eq!(told.axis_of_edge(floor), None);
}
