//! Small drawings for tests.

use glam::{DVec2, DVec3};

use super::{HandScorer, TripleScorer, Triples};
use crate::Progress;
use crate::drawing::{Curve2, Drawing, Edge, Graph};
use crate::lift::directions::Directions;

/// What the hand-made scorer says of a drawing's triples.
pub(super) fn hand_scores(drawing: &Drawing, graph: &Graph, triples: &Triples) -> Vec<f64> {
    let directions = Directions::estimate(drawing).ok();
    let scorer = HandScorer::default();
    let scores = scorer.score(
        drawing,
        graph,
        triples,
        directions.as_ref(),
        Progress::none(),
    );
    scores.unwrap().log_odds
}

/// A drawing of 3D points joined by straight edges, seen from a generic direction.
pub(super) fn wireframe(points: &[DVec3], edges: &[[usize; 2]]) -> Drawing {
    let view = |p: DVec3| DVec2::new(0.8 * p.x - 0.5 * p.y, 0.2 * p.x + 0.35 * p.y + 0.9 * p.z);
    let vertices: Vec<DVec2> = points.iter().map(|p| view(*p)).collect();
    let edges = edges
        .iter()
        .map(|&v| Edge {
            v,
            points: vec![vertices[v[0]], vertices[v[1]]],
            curve: Curve2::Line,
        })
        .collect();
    Drawing::orthographic(vertices, edges)
}

/// A cube: 8 vertices, 12 edges, 6 loops.
pub(super) fn cube() -> Drawing {
    let corner = |k: usize| DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64);
    let points: Vec<DVec3> = (0..8).map(corner).collect();
    let mut edges = Vec::new();
    for a in 0..8usize {
        for bit in [1, 2, 4] {
            if a & bit == 0 {
                edges.push([a, a | bit]);
            }
        }
    }
    wireframe(&points, &edges)
}

/// A pyramid over a square: a vertex of degree 4.
pub(super) fn pyramid() -> Drawing {
    let points = [
        DVec3::ZERO,
        DVec3::X,
        DVec3::X + DVec3::Y,
        DVec3::Y,
        DVec3::new(0.5, 0.5, 1.0),
    ];
    let edges = [
        [0, 1],
        [1, 2],
        [2, 3],
        [3, 0],
        [0, 4],
        [1, 4],
        [2, 4],
        [3, 4],
    ];
    wireframe(&points, &edges)
}

/// One closed edge.
pub(super) fn circle() -> Drawing {
    arcs(&[[0, 0]], &[(0.0, std::f64::consts::TAU)])
}

/// Two arcs that make a circle: two vertices of degree 2.
pub(super) fn two_arcs() -> Drawing {
    let pi = std::f64::consts::PI;
    arcs(&[[0, 1], [1, 0]], &[(0.0, pi), (pi, pi)])
}

fn arcs(ends: &[[usize; 2]], sweeps: &[(f64, f64)]) -> Drawing {
    let edges: Vec<Edge> = ends
        .iter()
        .zip(sweeps)
        .map(|(&v, &(start, sweep))| {
            let point = |k| DVec2::from_angle(start + sweep * f64::from(k) / 32.0);
            let points: Vec<DVec2> = (0..=32).map(point).collect();
            Edge::drawn(v, points)
        })
        .collect();
    let vertices = (0..ends.len()).map(|k| edges[k].points[0]).collect();
    Drawing::orthographic(vertices, edges)
}
