//! Why a command failed, and the exit status that tells scripts so.

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use faceformer::drawing::DrawingError;
use faceformer::identify::IdentifyError;
use faceformer_occt::OcctError;

use crate::render::RenderError;

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// The command line asks for something that is not there.
    #[error("{0}")]
    Usage(String),
    /// A file cannot be read.
    #[error("{} cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error("{} cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The input is no drawing.
    #[error("{name}: {source}")]
    Drawing {
        /// The input as the user named it.
        name: String,
        /// Why.
        source: DrawingError,
    },
    /// Diagnosis found that the drawing shows no solid.
    #[error("{name}: {first}{}", more(*further))]
    Unusable {
        /// The input as the user named it.
        name: String,
        /// Message of the first finding.
        first: String,
        /// Number of further findings of that severity.
        further: usize,
    },
    /// A faces file is wrong.
    #[error("{name}: {source}")]
    Faces {
        /// The file.
        name: String,
        /// Why.
        source: IdentifyError,
    },
    /// A stage failed.
    #[error(transparent)]
    Stage(#[from] faceformer::Error),
    /// The CAD kernel could not build the solid.
    #[error(transparent)]
    Build(#[from] OcctError),
    /// The picture could not be made.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A result cannot be written as JSON.
    #[error("the result cannot be written as JSON: {0}")]
    Json(serde_json::Error),
}

impl Failure {
    /// 1 if the work failed, 2 if the input or the usage is wrong.
    pub(crate) fn exit_code(&self) -> ExitCode {
        let status = match self {
            Self::Usage(_)
            | Self::Read { .. }
            | Self::Write { .. }
            | Self::Drawing { .. }
            | Self::Unusable { .. }
            | Self::Faces { .. }
            | Self::Stage(faceformer::Error::Drawing(_)) => 2,
            Self::Stage(_) | Self::Build(_) | Self::Render(_) | Self::Json(_) => 1,
        };
        ExitCode::from(status)
    }
}

fn more(further: usize) -> String {
    match further {
        0 => String::new(),
        1 => ". There is one more error: `faceformer check` lists it".to_owned(),
        n => format!(". There are {n} more errors: `faceformer check` lists them"),
    }
}
