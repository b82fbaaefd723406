//! Errors of reading and checking a drawing. Edges are numbered from 1, as in loops; vertices from
//! 0, as in an edge's `v`.

/// Why a drawing cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawingError {
    /// The text is not JSON of the expected form.
    #[error("not a drawing: {0}")]
    Format(String),
    /// A coordinate is NaN or infinite.
    #[error("edge {edge} has a coordinate that is not a finite number; draw it again")]
    NotFinite {
        /// Edge number, from 1.
        edge: usize,
    },
    /// The drawing has no edges.
    #[error("the drawing has no edges")]
    Empty,
    /// More edges, vertices or points than [`Limits`](super::Limits) allows.
    #[error("the drawing has {found} {what}, more than the limit of {limit}")]
    TooLarge {
        /// What there is too much of: "edges", "vertices", "points".
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// An edge names a vertex that is not there.
    #[error("edge {edge} names vertex {vertex}, but there are only {vertices} (counted from 0)")]
    NoSuchVertex {
        /// Edge number, from 1.
        edge: usize,
        /// Vertex index, from 0.
        vertex: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// An edge has fewer than two points, or no length.
    #[error("edge {edge} has no length; delete it")]
    ZeroLength {
        /// Edge number, from 1.
        edge: usize,
    },
    /// An edge's polyline does not begin or end at its vertex.
    #[error("edge {edge} does not end at vertex {vertex}: they are {gap:.3e} apart")]
    EndMismatch {
        /// Edge number, from 1.
        edge: usize,
        /// Vertex index, from 0.
        vertex: usize,
        /// Distance in drawing units.
        gap: f64,
    },
    /// The truth names an edge or vertex that is not there, or has the wrong shape.
    #[error("the drawing's truth does not fit it: {0}")]
    Truth(String),
}
