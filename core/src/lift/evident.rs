//! What is wrong about a face whatever the depths are.
//!
//! - No face has both co-edges of an edge, or one of them twice.
//! - One loop of a planar face, the outer one, is drawn around all its others.

use glam::DVec2;

use super::sheet::Sheet;
use crate::drawing::{CoEdge, Drawing};
use crate::polygon::{contains, signed_area};

/// Area in the drawing, as a share of the square of its size, below which a face is a line.
const THIN: f64 = 1e-5;

/// Vertices, sorted, at which a face is wrong by itself; none if it is not.
pub(super) fn evident(sheet: &Sheet<'_>, face: usize) -> Vec<usize> {
    let mut vertices = doubled(sheet, face);
    // A loop that shares an edge with another one is beside it, and that is said already.
    if vertices.is_empty() && sheet.is_planar(face) {
        vertices = misplaced(sheet.drawing, &sheet.faces[face].loops);
    }
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// Ends of edges that a face holds twice.
fn doubled(sheet: &Sheet<'_>, face: usize) -> Vec<usize> {
    let edges = sheet.faces[face].loops.iter().flatten().map(|c| c.edge());
    let mut edges: Vec<usize> = edges.filter(|&e| e < sheet.drawing.edges.len()).collect();
    edges.sort_unstable();
    let twice = edges.windows(2).filter(|w| w[0] == w[1]);
    twice.flat_map(|w| sheet.drawing.edges[w[0]].v).collect()
}

/// Vertices of loops that are drawn outside of the first one, if none is around all the others.
fn misplaced(drawing: &Drawing, loops: &[Vec<CoEdge>]) -> Vec<usize> {
    if loops.len() < 2 {
        return Vec::new();
    }
    // A face that is seen from its edge has no inside in the drawing.
    let thin = THIN * drawing.size().powi(2);
    if loops
        .iter()
        .all(|l| signed_area(&outline(drawing, l)).abs() < thin)
    {
        return Vec::new();
    }
    let outside = |ring: &[CoEdge]| -> Vec<usize> {
        let others = loops.iter().filter(|l| l.as_slice() != ring);
        let out = others.filter(|l| !is_around(drawing, ring, l));
        out.flat_map(|l| corners(drawing, l)).collect()
    };
    let mut found = loops.iter().map(|ring| outside(ring));
    let first = found.next().unwrap_or_default();
    if first.is_empty() || found.any(|out| out.is_empty()) {
        return Vec::new();
    }
    first
}

/// Whether one loop is drawn around another, but for points that both have.
pub(super) fn is_around(drawing: &Drawing, ring: &[CoEdge], inner: &[CoEdge]) -> bool {
    let outline = outline(drawing, ring);
    let own = corners(drawing, ring);
    let free: Vec<DVec2> = corners(drawing, inner)
        .into_iter()
        .filter(|v| !own.contains(v))
        .map(|v| drawing.vertices[v])
        .collect();
    let inside = free.iter().filter(|p| contains(&outline, **p)).count();
    2 * inside > free.len()
}

/// Whether a loop is drawn around all vertices.
pub(super) fn encloses(drawing: &Drawing, ring: &[CoEdge], vertices: &[usize]) -> bool {
    let outline = outline(drawing, ring);
    vertices
        .iter()
        .all(|&v| contains(&outline, drawing.vertices[v]))
}

fn corners(drawing: &Drawing, ring: &[CoEdge]) -> Vec<usize> {
    let edges = ring.iter().filter_map(|c| drawing.edges.get(c.edge()));
    edges.flat_map(|e| e.v).collect()
}

/// A loop as a closed polyline; the last point is not repeated.
fn outline(drawing: &Drawing, ring: &[CoEdge]) -> Vec<DVec2> {
    let mut outline: Vec<DVec2> = Vec::new();
    for c in ring {
        if let Some(edge) = drawing.edges.get(c.edge()) {
            let mut points = edge.points.clone();
            if c.is_reversed() {
                points.reverse();
            }
            points.pop();
            outline.extend(points);
        }
    }
    outline
}
