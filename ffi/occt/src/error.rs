//! Errors of building a solid. Faces and edges of the plan are numbered from 1, vertices from 0.

/// Why no valid solid came out.
///
/// `partial` is what could be built of the shell, as BREP text for inspection; empty if nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OcctError {
    /// The plan itself cannot be built from: an index out of range, a number that is not finite.
    #[error("the plan cannot be built: {0}")]
    Plan(String),
    /// An edge cannot be built, or is not valid.
    #[error("edge {edge} cannot be built: {what}")]
    Edge {
        /// Edge number, from 1.
        edge: usize,
        /// What is wrong.
        what: String,
        /// BREP text of the partial shell.
        partial: Vec<u8>,
    },
    /// A face cannot be built, or is not valid.
    #[error("face {face} cannot be built: {what}")]
    Face {
        /// Face number, from 1.
        face: usize,
        /// What is wrong.
        what: String,
        /// BREP text of the partial shell.
        partial: Vec<u8>,
    },
    /// The faces do not make one closed solid.
    #[error("the faces do not make one closed solid: {what}")]
    Shell {
        /// What is wrong.
        what: String,
        /// BREP text of the partial shell.
        partial: Vec<u8>,
    },
    /// Edges and faces meet only within a tolerance that is too large to be trusted.
    #[error("the solid is not tight: {what}")]
    Tolerance {
        /// What is wrong.
        what: String,
        /// BREP text of the shell.
        partial: Vec<u8>,
    },
    /// A file could not be written.
    #[error("{path} cannot be written: {what}")]
    Write {
        /// The file.
        path: String,
        /// What the kernel or the system said.
        what: String,
    },
    /// OpenCASCADE threw an exception.
    #[error("OpenCASCADE failed: {0}")]
    Kernel(String),
    /// The caller's progress asked to stop.
    #[error("cancelled")]
    Cancelled,
}

impl OcctError {
    /// What could be built before the error, as BREP text.
    pub fn partial(&self) -> Option<&[u8]> {
        match self {
            Self::Edge { partial, .. }
            | Self::Face { partial, .. }
            | Self::Shell { partial, .. }
            | Self::Tolerance { partial, .. }
                if !partial.is_empty() =>
            {
                Some(partial)
            }
            _ => None,
        }
    }
}
