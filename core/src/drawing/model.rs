//! The drawing itself and its truth, as in the interchange format.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::{CoEdge, Curve2};

/// Kind of projection that made a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Projection {
    /// Parallel projection along z: (x, y, z) is drawn at (x, y).
    #[default]
    Orthographic,
    /// Central projection, camera at the origin looking along -z: (x, y, z) is drawn at
    /// (f x / -z, f y / -z).
    Perspective {
        /// Focal length f, in drawing units, if known.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        focal: Option<f64>,
    },
}

/// Kind of surface a face lies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceKind {
    /// Plane.
    Plane,
    /// Circular cylinder.
    Cylinder,
    /// Circular cone.
    Cone,
    /// Sphere.
    Sphere,
    /// Torus.
    Torus,
    /// Any other surface.
    Other,
}

impl SurfaceKind {
    /// All kinds in their order, so that `ALL[kind as usize] == kind`.
    pub const ALL: [Self; 6] = [
        Self::Plane,
        Self::Cylinder,
        Self::Cone,
        Self::Sphere,
        Self::Torus,
        Self::Other,
    ];

    /// Name, as in the drawing format.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Cylinder => "cylinder",
            Self::Cone => "cone",
            Self::Sphere => "sphere",
            Self::Torus => "torus",
            Self::Other => "other",
        }
    }

    /// The paper's three classes: 0 plane, 1 cylinder, 2 everything else.
    pub const fn paper_class(self) -> usize {
        match self {
            Self::Plane => 0,
            Self::Cylinder => 1,
            _ => 2,
        }
    }
}

/// An edge of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// First and second vertex, indices from 0; equal for a closed edge.
    pub v: [usize; 2],
    /// Polyline from `v[0]` to `v[1]`, both ends included; at least two points.
    pub points: Vec<DVec2>,
    /// What the polyline was recognised as.
    pub curve: Curve2,
}

impl Edge {
    /// An edge along points, with the curve that they are recognised as.
    #[cfg(test)]
    pub(crate) fn drawn(v: [usize; 2], points: Vec<DVec2>) -> Self {
        Self {
            v,
            curve: Curve2::recognise(&points),
            points,
        }
    }

    /// Whether the edge is a straight segment.
    pub fn is_straight(&self) -> bool {
        matches!(self.curve, Curve2::Line)
    }

    /// Length of the polyline, in drawing units.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }
}

/// A true face of a drawing made from a known solid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TruthFace {
    /// Surface kind.
    #[serde(rename = "type")]
    pub kind: SurfaceKind,
    /// Loops of co-edges; seen from outside the face is on the left.
    pub loops: Vec<Vec<CoEdge>>,
}

/// What is known of the solid that a drawing was made from.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Truth {
    /// Faces; each co-edge is in one loop of one face.
    pub faces: Vec<TruthFace>,
    /// Vertices in the camera frame, one for each drawn vertex.
    #[serde(default)]
    pub vertices3d: Vec<DVec3>,
    /// Polylines in the camera frame, one for each edge, as many points as drawn.
    #[serde(default)]
    pub edges3d: Vec<Vec<DVec3>>,
    /// Model axes in the camera frame.
    #[serde(default)]
    pub directions: Vec<DVec3>,
}

/// A wireframe drawing: camera frame, x to the right, y up, z towards the viewer.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Name, unique within a data set; may be empty.
    pub id: String,
    /// Where the solid came from; may be empty.
    pub source: String,
    /// Kind of projection.
    pub projection: Projection,
    /// Vertices, in drawing units.
    pub vertices: Vec<DVec2>,
    /// Edges.
    pub edges: Vec<Edge>,
    /// What is known of the solid, if anything.
    pub truth: Option<Truth>,
}

/// Largest drawing that is worked on; larger ones are refused by name of the limit. There may be
/// twice as many vertices as edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Edges of a drawing.
    pub edges: usize,
    /// Points of one edge's polyline.
    pub points: usize,
    /// Points of all edges together.
    pub total_points: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            edges: 5_000,
            points: 10_000,
            total_points: 500_000,
        }
    }
}

impl Drawing {
    /// A parallel projection without a name, a source and the truth, for tests.
    #[cfg(test)]
    pub(crate) fn orthographic(vertices: Vec<DVec2>, edges: Vec<Edge>) -> Self {
        Self {
            id: String::new(),
            source: String::new(),
            projection: Projection::Orthographic,
            vertices,
            edges,
            truth: None,
        }
    }

    /// Half diagonal of the bounding box of all points, in drawing units; the scale for tolerances.
    pub fn size(&self) -> f64 {
        let points = || self.edges.iter().flat_map(|e| &e.points);
        let min = points().fold(DVec2::INFINITY, |m, p| m.min(*p));
        let max = points().fold(DVec2::NEG_INFINITY, |m, p| m.max(*p));
        if min.is_finite() && max.is_finite() {
            (max - min).length() / 2.0
        } else {
            0.0
        }
    }

    /// The same drawing with other numbers, its truth too: `vertices` and `edges` hold the present
    /// index of each vertex and edge, in the new order.
    ///
    /// # Panics
    /// If a list does not hold each index once.
    #[must_use]
    pub fn renumbered(&self, vertices: &[usize], edges: &[usize]) -> Self {
        let [vertex, edge] = [inverse(vertices), inverse(edges)];
        assert_eq!(
            [vertex.len(), edge.len()],
            [self.vertices.len(), self.edges.len()]
        );
        let truth = self.truth.as_ref().map(|truth| {
            let mut truth = truth.clone();
            for c in truth.faces.iter_mut().flat_map(|f| &mut f.loops).flatten() {
                *c = CoEdge::new(edge[c.edge()], c.is_reversed());
            }
            if !truth.vertices3d.is_empty() {
                truth.vertices3d = vertices.iter().map(|&v| truth.vertices3d[v]).collect();
            }
            if !truth.edges3d.is_empty() {
                let polylines = edges.iter().map(|&e| truth.edges3d[e].clone());
                truth.edges3d = polylines.collect();
            }
            truth
        });
        let moved = |&old: &usize| {
            let old = &self.edges[old];
            Edge {
                v: old.v.map(|v| vertex[v]),
                ..old.clone()
            }
        };
        Self {
            vertices: vertices.iter().map(|&v| self.vertices[v]).collect(),
            edges: edges.iter().map(moved).collect(),
            truth,
            ..self.clone()
        }
    }
}

/// Where each index is in a list that holds each once.
fn inverse(list: &[usize]) -> Vec<usize> {
    let mut inverse = vec![usize::MAX; list.len()];
    for (k, &i) in list.iter().enumerate() {
        inverse[i] = k;
    }
    assert!(!inverse.contains(&usize::MAX), "an index is missing");
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_numbers_name_the_same_things() {
        let edge = |v: [usize; 2]| Edge {
            v,
            points: v.map(|v| DVec2::splat(v as f64)).to_vec(),
            curve: Curve2::Line,
        };
        let loops = vec![vec![CoEdge::new(0, false), CoEdge::new(2, true)]];
        let kind = SurfaceKind::Plane;
        let drawing = Drawing {
            id: String::new(),
            source: String::new(),
            projection: Projection::Orthographic,
            vertices: [0.0, 1.0, 2.0].map(DVec2::splat).to_vec(),
            edges: [[0, 1], [1, 2], [2, 0]].map(edge).to_vec(),
            truth: Some(Truth {
                faces: vec![TruthFace { kind, loops }],
                vertices3d: [0.0, 1.0, 2.0].map(DVec3::splat).to_vec(),
                ..Truth::default()
            }),
        };
        let other = drawing.renumbered(&[2, 0, 1], &[1, 2, 0]);
        assert_eq!(other.vertices, [2.0, 0.0, 1.0].map(DVec2::splat));
        for edge in &other.edges {
            assert_eq!(edge.points, edge.v.map(|v| other.vertices[v]));
        }
        let truth = other.truth.as_ref().unwrap();
        assert_eq!(truth.vertices3d, [2.0, 0.0, 1.0].map(DVec3::splat));
        let walk = [CoEdge::new(2, false), CoEdge::new(1, true)];
        assert_eq!(truth.faces[0].loops[0], walk);
        // Back again.
        assert_eq!(other.renumbered(&[1, 2, 0], &[2, 0, 1]), drawing);
    }
}
