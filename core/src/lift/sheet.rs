//! What lifting knows of a drawing before it solves: directions of edges, circles, faces' corners.

use glam::{DVec2, DVec3};

use super::circle::{DrawnCircle, circle_through};
use super::directions::{AGREE, Directions};
use crate::drawing::{Curve2, Drawing, SurfaceKind};
use crate::identify::Face;

/// A drawing with its faces and one reading of its directions.
pub(super) struct Sheet<'a> {
    pub(super) drawing: &'a Drawing,
    pub(super) faces: &'a [Face],
    pub(super) directions: &'a Directions,
    pub(super) size: f64,
    /// Axis of each straight edge.
    pub(super) edge_axis: Vec<Option<usize>>,
    /// Axis that each arc is a circle around, with the circle.
    pub(super) circles: Vec<Option<(usize, DrawnCircle)>>,
    /// Vertices of each face, sorted, each once.
    pub(super) corners: Vec<Vec<usize>>,
    /// Mean of each face's vertices.
    pub(super) middles: Vec<DVec2>,
    /// Edges of each face, sorted, each once.
    edges: Vec<Vec<usize>>,
    /// Faces at each edge.
    faces_of: Vec<Vec<usize>>,
}

impl<'a> Sheet<'a> {
    pub(super) fn new(drawing: &'a Drawing, faces: &'a [Face], directions: &'a Directions) -> Self {
        let edges = drawing.edges.len();
        let mut edge_axis = vec![None; edges];
        let mut circles = vec![None; edges];
        for (k, axis) in directions.axes.iter().enumerate() {
            for &e in &axis.edges {
                edge_axis[e] = Some(k);
            }
            for &e in &axis.circles {
                let tolerance = 3.0 * AGREE * directions.precision / axis.direction.z.abs();
                circles[e] = circle_through(&drawing.edges[e].points, axis.direction)
                    .filter(|c| c.residual < tolerance + AGREE * directions.error * c.radius)
                    .map(|c| (k, c));
            }
        }
        let corners: Vec<Vec<usize>> = faces.iter().map(|f| corners(drawing, f)).collect();
        let middles = corners
            .iter()
            .map(|vs| {
                let sum: DVec2 = vs.iter().map(|&v| drawing.vertices[v]).sum();
                sum / vs.len().max(1) as f64
            })
            .collect();
        let face_edges: Vec<Vec<usize>> = faces
            .iter()
            .map(|f| f.edge_set().into_iter().filter(|&e| e < edges).collect())
            .collect();
        let mut faces_of = vec![Vec::new(); edges];
        for (face, list) in face_edges.iter().enumerate() {
            list.iter().for_each(|&e| faces_of[e].push(face));
        }
        Self {
            edges: face_edges,
            faces_of,
            drawing,
            faces,
            directions,
            size: drawing.size(),
            edge_axis,
            circles,
            corners,
            middles,
        }
    }

    pub(super) fn axis(&self, k: usize) -> DVec3 {
        self.directions.axes[k].direction
    }

    pub(super) fn is_planar(&self, face: usize) -> bool {
        self.faces[face].kind == SurfaceKind::Plane
    }

    /// Edges of a face, sorted, each once; a face may name edges that the drawing does not have.
    pub(super) fn edges_of(&self, face: usize) -> &[usize] {
        &self.edges[face]
    }

    /// Faces at an edge.
    pub(super) fn neighbours(&self, edge: usize) -> &[usize] {
        &self.faces_of[edge]
    }

    pub(super) fn is_straight(&self, edge: usize) -> bool {
        matches!(self.drawing.edges[edge].curve, Curve2::Line)
    }
}

fn corners(drawing: &Drawing, face: &Face) -> Vec<usize> {
    let mut all: Vec<usize> = face
        .loops
        .iter()
        .flatten()
        .filter_map(|c| drawing.edges.get(c.edge()))
        .flat_map(|e| e.v)
        .collect();
    all.sort_unstable();
    all.dedup();
    all
}
