//! Errors of planning. Faces and edges are numbered from 1, vertices from 0.

/// Why no consistent B-rep follows from the faces and depths.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
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
}
