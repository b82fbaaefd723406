//! Known solids, drawn, for the tests of this crate.

use std::f64::consts::{PI, SQRT_2};

use glam::{DMat3, DVec3};

use crate::drawing::{CoEdge, Curve2, Drawing, Edge, Projection, SurfaceKind, Truth, TruthFace};

/// The drawing of a polyhedron, seen from a general direction, with its truth.
///
/// `faces` are lists of loops of vertex indices, the face on the left seen from outside. Edges are
/// numbered in the order in which the faces first walk them.
pub(crate) fn polyhedron(corners: &[[f64; 3]], faces: &[&[&[usize]]]) -> Drawing {
    let view = DMat3::from_rotation_x(-0.9) * DMat3::from_rotation_z(0.55);
    let vertices3d: Vec<DVec3> = corners.iter().map(|&p| view * DVec3::from(p)).collect();
    let mut edges: Vec<Edge> = Vec::new();
    let mut walk = |from: usize, to: usize| {
        let known = edges
            .iter()
            .position(|e| e.v == [from, to] || e.v == [to, from]);
        let edge = known.unwrap_or_else(|| {
            edges.push(Edge {
                v: [from, to],
                points: vec![vertices3d[from].truncate(), vertices3d[to].truncate()],
                curve: Curve2::Line,
            });
            edges.len() - 1
        });
        CoEdge::new(edge, edges[edge].v[0] != from)
    };
    let faces: Vec<TruthFace> = faces
        .iter()
        .map(|loops| TruthFace {
            kind: SurfaceKind::Plane,
            loops: loops
                .iter()
                .map(|l| {
                    (0..l.len())
                        .map(|i| walk(l[i], l[(i + 1) % l.len()]))
                        .collect()
                })
                .collect(),
        })
        .collect();
    Drawing {
        id: String::new(),
        source: String::new(),
        projection: Projection::Orthographic,
        vertices: vertices3d.iter().map(|p| p.truncate()).collect(),
        truth: Some(Truth {
            faces,
            edges3d: edges
                .iter()
                .map(|e| e.v.iter().map(|&v| vertices3d[v]).collect())
                .collect(),
            vertices3d,
            directions: vec![view.x_axis, view.y_axis, view.z_axis],
        }),
        edges,
    }
}

/// The same solid seen from another side.
pub(crate) fn seen(mut drawing: Drawing, turn: f64, tilt: f64) -> Drawing {
    let truth = drawing.truth.as_mut().unwrap();
    let to_model = DMat3::from_cols(
        truth.directions[0],
        truth.directions[1],
        truth.directions[2],
    )
    .transpose();
    let view = DMat3::from_rotation_x(tilt) * DMat3::from_rotation_z(turn) * to_model;
    let turned: Vec<DVec3> = truth.vertices3d.iter().map(|p| view * *p).collect();
    drawing.vertices = turned.iter().map(|p| p.truncate()).collect();
    for edge in &mut drawing.edges {
        edge.points = edge.v.map(|v| drawing.vertices[v]).to_vec();
    }
    truth.vertices3d = turned;
    drawing
}

/// A block with two chamfers and a pocket of three corners in its top, seen isometrically: both
/// ends of one chamfer are drawn parallel to an axis that they do not follow.
pub(crate) fn chamfered() -> Drawing {
    let corners = [
        [10.0, 2.4, 0.0],
        [10.0, 2.4, 10.0],
        [7.6, 0.0, 10.0],
        [7.6, 0.0, 1.6],
        [9.2, 1.6, 0.0],
        [0.0, 1.6, 0.0],
        [0.0, 10.0, 0.0],
        [10.0, 10.0, 0.0],
        [0.0, 0.0, 1.6],
        [10.0, 10.0, 10.0],
        [0.0, 0.0, 10.0],
        [0.0, 10.0, 10.0],
        [2.0, 4.0, 10.0],
        [3.0, 2.5, 10.0],
        [1.5, 2.5, 10.0],
        [2.0, 4.0, 5.0],
        [3.0, 2.5, 5.0],
        [1.5, 2.5, 5.0],
    ];
    let drawing = polyhedron(
        &corners,
        &[
            &[&[10, 2, 1, 9, 11], &[12, 13, 14]],
            &[&[5, 6, 7, 0, 4]],
            &[&[8, 3, 2, 10]],
            &[&[5, 4, 3, 8]],
            &[&[2, 3, 4, 0, 1]],
            &[&[0, 7, 9, 1]],
            &[&[7, 6, 11, 9]],
            &[&[5, 8, 10, 11, 6]],
            &[&[17, 16, 15]],
            &[&[13, 12, 15, 16]],
            &[&[14, 13, 16, 17]],
            &[&[12, 14, 17, 15]],
        ],
    );
    seen(drawing, 1.75 * PI, -SQRT_2.atan())
}

/// A right prism of height `height` over a simple polygon, counter-clockwise seen from above.
pub(crate) fn prism(outline: &[[f64; 2]], height: f64) -> Drawing {
    let n = outline.len();
    let level = |z: f64| outline.iter().map(move |&[x, y]| [x, y, z]);
    let corners: Vec<[f64; 3]> = level(0.0).chain(level(height)).collect();
    let top: Vec<usize> = (n..2 * n).collect();
    let bottom: Vec<usize> = (0..n).rev().collect();
    let sides: Vec<[usize; 4]> = (0..n)
        .map(|i| [i, (i + 1) % n, n + (i + 1) % n, n + i])
        .collect();
    let mut faces: Vec<Vec<&[usize]>> = vec![vec![&bottom], vec![&top]];
    faces.extend(sides.iter().map(|s| vec![s.as_slice()]));
    let faces: Vec<&[&[usize]]> = faces.iter().map(Vec::as_slice).collect();
    polyhedron(&corners, &faces)
}

/// A cube with edges of length 1: 8 vertices, 12 edges, 6 faces.
pub(crate) fn cube() -> Drawing {
    prism(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 1.0)
}

/// A tetrahedron: 4 vertices, 6 edges, 4 faces.
pub(crate) fn tetrahedron() -> Drawing {
    polyhedron(
        &[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.2, 0.9, 0.0],
            [0.4, 0.3, 0.8],
        ],
        &[&[&[0, 2, 1]], &[&[0, 1, 3]], &[&[1, 2, 3]], &[&[2, 0, 3]]],
    )
}

/// A wedge, a prism over a right triangle: 6 vertices, 9 edges, 5 faces.
pub(crate) fn wedge() -> Drawing {
    prism(&[[0.0, 0.0], [1.5, 0.0], [0.0, 0.7]], 1.0)
}

/// An L-bracket: 12 vertices, 18 edges, 8 faces, two of them hexagons.
pub(crate) fn bracket() -> Drawing {
    let outline = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 0.4],
        [0.5, 0.4],
        [0.5, 1.5],
        [0.0, 1.5],
    ];
    prism(&outline, 1.0)
}

/// A cube with a square hole through it: two components, two faces with an inner loop each.
pub(crate) fn holed_cube() -> Drawing {
    let square = |lo: f64, hi: f64| [[lo, lo], [hi, lo], [hi, hi], [lo, hi]];
    let mut corners = Vec::new();
    for outline in [square(0.0, 1.0), square(0.3, 0.6)] {
        for z in [0.0, 1.0] {
            corners.extend(outline.map(|[x, y]| [x, y, z]));
        }
    }
    polyhedron(
        &corners,
        &[
            &[&[3, 2, 1, 0], &[8, 9, 10, 11]],
            &[&[4, 5, 6, 7], &[15, 14, 13, 12]],
            &[&[0, 1, 5, 4]],
            &[&[1, 2, 6, 5]],
            &[&[2, 3, 7, 6]],
            &[&[3, 0, 4, 7]],
            &[&[8, 12, 13, 9]],
            &[&[9, 13, 14, 10]],
            &[&[10, 14, 15, 11]],
            &[&[11, 15, 12, 8]],
        ],
    )
}
