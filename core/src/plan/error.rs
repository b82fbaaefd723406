//! Errors of planning. Faces and edges are numbered from 1, vertices from 0.

/// Why no consistent B-rep follows from the faces and depths.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// Drawing, faces and lift do not belong together, or the options make no sense.
    #[error("the solid cannot be planned: {0}")]
    Input(String),
    /// An edge is not used by exactly two face loops.
    #[error("edge {edge} borders {uses} faces instead of two; correct the faces {faces:?}")]
    EdgeUse {
        /// Edge number, from 1.
        edge: usize,
        /// How many co-edges of it the faces hold.
        uses: usize,
        /// Face numbers, from 1.
        faces: Vec<usize>,
    },
    /// An edge has the same face on both sides.
    #[error("edge {edge} is in face {face} twice; a face cannot be its own neighbour")]
    OwnNeighbour {
        /// Edge number, from 1.
        edge: usize,
        /// Face number, from 1.
        face: usize,
    },
    /// A loop of a face is not a closed walk.
    #[error("a loop of face {face} is open after edge {edge}; correct the face")]
    OpenLoop {
        /// Face number, from 1.
        face: usize,
        /// Edge number, from 1.
        edge: usize,
    },
    /// The faces cannot all be oriented outwards.
    #[error("faces {faces:?} cannot be oriented consistently along edge {edge}")]
    NotOrientable {
        /// Edge number, from 1.
        edge: usize,
        /// Face numbers, from 1.
        faces: Vec<usize>,
    },
    /// A face has a surface that cannot be built yet.
    #[error("face {face} lies on a surface that cannot be built: {what}")]
    Surface {
        /// Face number, from 1.
        face: usize,
        /// Why.
        what: String,
    },
    /// An edge does not lie on the surfaces of its faces.
    #[error("edge {edge} lies {gap:.3e} off the surface of face {face}")]
    OffSurface {
        /// Edge number, from 1.
        edge: usize,
        /// Face number, from 1.
        face: usize,
        /// Distance, drawing units.
        gap: f64,
    },
    /// The faces beside an edge do not meet along the curve that is drawn.
    #[error("faces {faces:?} do not meet along edge {edge} as it is drawn: {gap:.3e} apart")]
    Curve {
        /// Edge number, from 1.
        edge: usize,
        /// Face numbers, from 1.
        faces: [usize; 2],
        /// Distance in the drawing, drawing units.
        gap: f64,
    },
}
