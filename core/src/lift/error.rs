//! Errors of lifting. Faces and edges are numbered from 1, vertices from 0.

/// Why depth could not be recovered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LiftError {
    /// Too few edges follow common directions, and no circle helps.
    #[error("no dominant directions can be told from the drawing: {0}")]
    NoDirections(String),
    /// The view is too close to a model axis for depth to be told.
    #[error(
        "the view is only {degrees:.1} degrees away from a model axis; turn the part so that three \
         sides are seen"
    )]
    DegenerateView {
        /// Angle between the view direction and the nearest axis or axis plane.
        degrees: f64,
    },
    /// The rows leave some depths free.
    #[error("the drawing leaves the depth of vertices {vertices:?} open; add edges that fix them")]
    UnderConstrained {
        /// Vertex indices, from 0.
        vertices: Vec<usize>,
    },
    /// In the best reading of a perspective drawing, parts of the model are not in front of the
    /// camera.
    #[error(
        "vertices {vertices:?} would lie behind the camera; check the edges there, and whether the \
         drawing is in perspective"
    )]
    Behind {
        /// Vertex indices, from 0.
        vertices: Vec<usize>,
    },
    /// The vanishing points leave the focal length of a perspective drawing open.
    #[error(
        "{directions} vanishing points at right angles do not tell the focal length; give it with \
         the drawing"
    )]
    Focal {
        /// How many vanishing points at right angles to each other were found.
        directions: usize,
    },
    /// There is no mirror image in depth to take.
    #[error(
        "a perspective drawing has one reading in depth, no reversal; lift it without flipping"
    )]
    NoReversal,
    /// The solver gave up.
    #[error("the depth problem could not be solved: {0}")]
    Solver(String),
}

impl LiftError {
    /// Number of vertices left open, of those that say so; the fewer, the nearer the reading came.
    pub(super) const fn open(&self) -> usize {
        match self {
            Self::UnderConstrained { vertices } => vertices.len(),
            _ => usize::MAX,
        }
    }
}
