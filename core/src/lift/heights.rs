//! Heights of vertices and planes, as far as they are known.

/// Heights of vertices and slopes of planes.
#[derive(Debug, Clone)]
pub(super) struct Heights {
    pub(super) vertices: Vec<f64>,
    /// (a, b, c) of planar faces.
    pub(super) planes: Vec<Option<[f64; 3]>>,
    /// Which vertices are known relative to each other.
    pub(super) known: Vec<bool>,
}

impl Heights {
    /// Height of a vertex.
    pub(super) fn of(&self, vertex: usize) -> f64 {
        self.vertices[vertex]
    }

    /// (a, b, c) of a planar face, if its slope is known.
    pub(super) fn plane(&self, face: usize) -> Option<[f64; 3]> {
        self.planes[face]
    }

    /// Whether the heights of all vertices are known.
    pub(super) fn are_known(&self, vertices: &[usize]) -> bool {
        vertices.iter().all(|&v| self.known[v])
    }
}
