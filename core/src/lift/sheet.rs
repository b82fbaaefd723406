//! What lifting knows of a drawing before it solves: directions of edges, circles, faces' corners.

use glam::{DVec2, DVec3};

use super::Camera;
use super::chance::Witness;
use super::circle::{DrawnCircle, circle_through};
use super::directions::{AGREE, Directions, Evidence};
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
    /// Axis or further normal that each arc is a circle around, with the circle.
    pub(super) circles: Vec<Option<(usize, DrawnCircle)>>,
    /// Vertices of each face, sorted, each once.
    pub(super) corners: Vec<Vec<usize>>,
    /// Mean of each face's vertices.
    pub(super) middles: Vec<DVec2>,
    /// Straight edges without an axis that are drawn parallel, longest first; in a parallel
    /// projection.
    pub(super) parallels: Vec<Vec<usize>>,
    /// Planar faces that are known to be across an axis, each with that axis.
    pub(super) ends: Vec<(usize, usize)>,
    /// Edges of each face, sorted, each once.
    edges: Vec<Vec<usize>>,
    /// Edges at each vertex.
    edges_at: Vec<Vec<usize>>,
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
        }
        for (k, (normal, arcs)) in directions.normals().enumerate() {
            for &e in arcs {
                let points = &drawing.edges[e].points;
                let camera = &directions.camera;
                let facing = camera.facing(normal, points[points.len() / 2]);
                let tolerance = 3.0 * AGREE * directions.precision / facing.abs();
                circles[e] = circle_through(points, normal, camera)
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
        for (axis, beside) in edge_axis.iter_mut().zip(&faces_of) {
            if are_cones(faces, beside) {
                *axis = None;
            }
        }
        let witness = Witness {
            faces,
            edges: &face_edges,
            faces_of: &faces_of,
        };
        witness.release(&mut edge_axis);
        let mut edges_at = vec![Vec::new(); drawing.vertices.len()];
        for (e, edge) in drawing.edges.iter().enumerate() {
            edges_at[edge.v[0]].push(e);
            if edge.v[1] != edge.v[0] {
                edges_at[edge.v[1]].push(e);
            }
        }
        let parallels = if directions.camera.is_parallel() {
            let evidence = Evidence::new(drawing, directions.precision);
            let clusters = evidence.clusters.iter();
            clusters
                .map(|c| evidence.edges_of(c).collect())
                .filter(|c: &Vec<usize>| c.len() > 1 && c.iter().all(|&e| edge_axis[e].is_none()))
                .collect()
        } else {
            Vec::new()
        };
        Self {
            parallels,
            ends: Vec::new(),
            edges: face_edges,
            edges_at,
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

    /// Takes edges for parallel that are known to be, of each set, and no others.
    pub(super) fn set_parallels(&mut self, mut sets: Vec<Vec<usize>>) {
        sets.retain(|set| set.iter().all(|&e| self.edge_axis[e].is_none()));
        self.parallels = sets;
    }

    /// Direction of an axis, or the normal that circles beside the axes have.
    pub(super) fn axis(&self, k: usize) -> DVec3 {
        self.directions.normal(k)
    }

    /// Number of axes and of normals that circles beside them have.
    pub(super) fn normals(&self) -> usize {
        self.directions.normals().count()
    }

    pub(super) fn camera(&self) -> &Camera {
        &self.directions.camera
    }

    /// Whether an edge is between cones. If it is straight it leads to an apex, and that it follows an
    /// axis or others with a vanishing point is chance.
    pub(super) fn is_cone_line(&self, edge: usize) -> bool {
        are_cones(self.faces, &self.faces_of[edge])
    }

    /// The point drawn at `p` with a height.
    pub(super) fn place(&self, p: DVec2, height: f64) -> DVec3 {
        self.camera().place(p, self.camera().depth(height))
    }

    pub(super) fn is_planar(&self, face: usize) -> bool {
        self.faces[face].kind == SurfaceKind::Plane
    }

    /// Whether an edge of a face is swept along a helix.
    pub(super) fn is_swept(&self, face: usize) -> bool {
        let mut swept = self.directions.swept.iter().flat_map(|s| &s.edges);
        swept.any(|s| self.edges[face].binary_search(&s.edge).is_ok())
    }

    /// Edges of a face, sorted, each once; a face may name edges that the drawing does not have.
    pub(super) fn edges_of(&self, face: usize) -> &[usize] {
        &self.edges[face]
    }

    /// Faces at an edge.
    pub(super) fn neighbours(&self, edge: usize) -> &[usize] {
        &self.faces_of[edge]
    }

    /// Edges at a vertex.
    pub(super) fn edges_at(&self, vertex: usize) -> &[usize] {
        &self.edges_at[vertex]
    }

    /// Vertices of a face with the straight edges that leave it there.
    pub(super) fn leaving(&self, face: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.corners[face].iter().flat_map(move |&v| {
            let edges = self.edges_at[v].iter().copied();
            let outside = move |&e: &usize| !self.edges[face].contains(&e) && self.is_straight(e);
            edges.filter(outside).map(move |e| (v, e))
        })
    }

    /// The axis that a planar face is normal to, if its straight edges follow the two others.
    pub(super) fn normal_axis(&self, face: usize) -> Option<usize> {
        let mut follows = [false; 3];
        for k in self.edges[face].iter().filter_map(|&e| self.edge_axis[e]) {
            follows[k] = true;
        }
        match follows {
            [false, true, true] => Some(0),
            [true, false, true] => Some(1),
            [true, true, false] => Some(2),
            _ => None,
        }
    }

    /// Points of a curved edge: its ends, and points at thirds.
    pub(super) fn samples(&self, edge: usize) -> impl Iterator<Item = DVec2> + '_ {
        let points = &self.drawing.edges[edge].points;
        let last = points.len() - 1;
        [0, last / 3, 2 * last / 3, last]
            .into_iter()
            .map(|i| points[i])
    }

    pub(super) fn is_straight(&self, edge: usize) -> bool {
        matches!(self.drawing.edges[edge].curve, Curve2::Line)
    }
}

/// Whether there are two faces and both are cones.
fn are_cones(faces: &[Face], beside: &[usize]) -> bool {
    beside.len() == 2 && beside.iter().all(|&f| faces[f].kind == SurfaceKind::Cone)
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
