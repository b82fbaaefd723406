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
    /// A vertex has a coordinate that is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not a finite number; draw it again")]
    VertexNotFinite {
        /// Vertex index, from 0.
        vertex: usize,
    },
    /// The drawing's size, or its distance from the origin, is beyond what doubles can compute.
    #[error(
        "the drawing is {size:.1e} in size and up to {far:.1e} from the origin; \
         scale it and move it to the origin"
    )]
    Scale {
        /// Half diagonal of the bounding box, in drawing units.
        size: f64,
        /// Largest coordinate, in drawing units.
        far: f64,
    },
    /// The drawing has no edges.
    #[error("the drawing has no edges")]
    Empty,
    /// More edges, vertices or points than [`Limits`](super::Limits) allows.
    #[error("the drawing has {found} {what} or more; the limit is {limit}")]
    TooLarge {
        /// What there is too much of: "edges", "vertices", "points", "points in one edge".
        what: &'static str,
        /// How many there are, or how many were read until the limit was passed.
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
    /// An edge names no vertices in a drawing that lists them.
    #[error("edge {edge} does not name its two vertices in `v`")]
    NoVertices {
        /// Edge number, from 1.
        edge: usize,
    },
    /// A vertex belongs to no edge.
    #[error("vertex {vertex} belongs to no edge; delete it")]
    UnusedVertex {
        /// Vertex index, from 0.
        vertex: usize,
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
    /// A file cannot be read.
    #[error("cannot read {path}: {what}")]
    File {
        /// The path as it was given.
        path: String,
        /// The system's or the decoder's message.
        what: String,
    },
    /// A line of a data set is no drawing.
    #[error("line {line}: {error}")]
    Line {
        /// Line number, from 1.
        line: usize,
        /// What is wrong with it.
        error: Box<DrawingError>,
    },
    /// A data set has no drawing of that id.
    #[error("{path} has no drawing with the id {id:?}")]
    NoSuchDrawing {
        /// The path as it was given.
        path: String,
        /// The id that was looked for.
        id: String,
    },
}
