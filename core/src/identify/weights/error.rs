//! Why a model cannot be used.

/// Why a model cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// A file cannot be read.
    #[error("{path} cannot be read: {what}")]
    Read {
        /// The file.
        path: String,
        /// What the file system says.
        what: String,
    },
    /// The weights are larger than any model of this program.
    #[error("the weights have {bytes} bytes, more than the limit of {limit}")]
    TooLarge {
        /// Size.
        bytes: u64,
        /// Most that is read.
        limit: u64,
    },
    /// The description beside the weights is not of the documented form.
    #[error("the description beside the weights is not understood: {0}")]
    Description(String),
    /// The network takes other inputs than this version computes, or its size is absurd.
    #[error("the model is for another version of the program; export it again")]
    Version,
    /// The weights are not those that the description was written for.
    #[error("the weights' SHA-256 is {found}, not {expected}: the file is damaged or another one")]
    Hash {
        /// In the description.
        expected: String,
        /// Of the file.
        found: String,
    },
    /// The weights are no safetensors.
    #[error("the weights are no safetensors: {0}")]
    Weights(String),
    /// A weight that the network needs is not there.
    #[error("the weight {0:?} is missing")]
    Missing(String),
    /// There is a weight that the network does not have.
    #[error("the weight {0:?} is none of the network's")]
    Unexpected(String),
    /// A weight has another shape.
    #[error("the weight {name:?} has the shape {found:?}, not {expected:?}")]
    Shape {
        /// Weight.
        name: String,
        /// As the description says.
        expected: Vec<usize>,
        /// As it is.
        found: Vec<usize>,
    },
    /// A weight holds something that is no number.
    #[error("the weight {0:?} holds values that are no finite f16 or f32 numbers")]
    Values(String),
}
