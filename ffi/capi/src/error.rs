//! Why a call did not succeed, and the status that says so.

use faceformer::identify::IdentifyError;
use faceformer_occt::OcctError;

use crate::FaceformerStatus;

/// Why a call did not succeed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CallError {
    /// A pointer that is needed is null.
    #[error("the argument {0} is null")]
    Null(&'static str),
    /// An input is longer than the library reads.
    #[error("the argument {what} has {len} bytes, more than the limit of {limit}")]
    TooLong {
        /// Argument.
        what: &'static str,
        /// Its length, bytes.
        len: usize,
        /// Most bytes that are read.
        limit: usize,
    },
    /// An input is no UTF-8.
    #[error("the argument {what} is not UTF-8 from byte {at} on")]
    Utf8 {
        /// Argument.
        what: &'static str,
        /// First byte that is wrong, from 0.
        at: usize,
    },
    /// The options are not of the documented form.
    #[error("the options are not understood: {0}")]
    Options(#[source] serde_json::Error),
    /// The scale makes no model.
    #[error("the option scale is {0}; give a number above 0")]
    Scale(f64),
    /// No file format of that name.
    #[error("there is no file format {0:?}; there are step, brep and stl")]
    Format(String),
    /// A partial shell was to be written to a file.
    #[error("this is only a partial shell; faceformer_solid_brep gives it for inspection")]
    PartialWrite,
    /// A faces handle was used with a drawing that it does not belong to.
    #[error("the faces belong to another drawing; identify or read them with this one")]
    OtherDrawing,
    /// A result cannot be written as JSON.
    #[error("the result cannot be written as JSON: {0}")]
    Json(#[source] serde_json::Error),
    /// A stage before the CAD kernel failed.
    #[error(transparent)]
    Stage(#[from] faceformer::Error),
    /// The CAD kernel failed.
    #[error(transparent)]
    Kernel(#[from] OcctError),
}

impl CallError {
    /// The status that tells the caller which kind of error this is.
    pub(crate) fn status(&self) -> FaceformerStatus {
        use faceformer::Error as Stage;
        match self {
            Self::Stage(Stage::Cancelled) | Self::Kernel(OcctError::Cancelled) => {
                FaceformerStatus::Cancelled
            }
            Self::Stage(
                Stage::Drawing(_)
                | Stage::Identify(
                    IdentifyError::Format(_)
                    | IdentifyError::Mismatch { .. }
                    | IdentifyError::UnknownEngine(_),
                ),
            ) => FaceformerStatus::BadInput,
            Self::Stage(_) | Self::Kernel(_) | Self::PartialWrite | Self::Json(_) => {
                FaceformerStatus::Failed
            }
            Self::Null(_)
            | Self::TooLong { .. }
            | Self::Utf8 { .. }
            | Self::Options(_)
            | Self::Scale(_)
            | Self::Format(_)
            | Self::OtherDrawing => FaceformerStatus::BadInput,
        }
    }
}
