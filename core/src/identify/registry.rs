//! The engines by name.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::faceformer::{DecodeOptions, FaceformerEngine, Variant};
use super::rotation::RotationEngine;
use super::{Engine, IdentifyError, ShortestEngine, VarleyEngine};

/// Names of the engines (design, section 3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum EngineKind {
    /// Rotation system decoded from scores per triple of edges; the default.
    #[default]
    Rotation,
    /// String merging of Varley and Company (2010); straight edges only.
    Varley,
    /// Least-cost loop through each co-edge.
    Shortest,
    /// The paper's model: a sequence of co-edges from every co-edge. Needs a trained model.
    Faceformer,
    /// The paper's variant that gives all faces in one sequence of co-edges. Needs a trained model.
    Seq2seqCoedge,
    /// The paper's variant that gives all faces in one sequence of edges. Needs a trained model.
    Seq2seq,
}

impl EngineKind {
    /// Every engine, the default first.
    pub const ALL: [Self; 6] = [
        Self::Rotation,
        Self::Varley,
        Self::Shortest,
        Self::Faceformer,
        Self::Seq2seqCoedge,
        Self::Seq2seq,
    ];

    /// Whether the engine can do nothing without a trained model that the user names.
    pub const fn needs_model(self) -> bool {
        matches!(self, Self::Faceformer | Self::Seq2seqCoedge | Self::Seq2seq)
    }

    /// All names, for messages: "rotation, varley, shortest, ...".
    pub fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }

    /// Name on the command line, in the C ABI and in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rotation => "rotation",
            Self::Varley => "varley",
            Self::Shortest => "shortest",
            Self::Faceformer => "faceformer",
            Self::Seq2seqCoedge => "seq2seq-coedge",
            Self::Seq2seq => "seq2seq",
        }
    }
}

impl fmt::Display for EngineKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for EngineKind {
    type Err = IdentifyError;

    /// The engine of that name.
    ///
    /// # Errors
    /// [`IdentifyError::UnknownEngine`], whose message lists the names there are.
    fn from_str(name: &str) -> Result<Self, IdentifyError> {
        Self::ALL
            .into_iter()
            .find(|kind| kind.name() == name)
            .ok_or_else(|| IdentifyError::UnknownEngine(name.to_owned()))
    }
}

/// The engine of that kind, with its default settings.
///
/// The rotation engine looks for a trained model, see [`RotationEngine::with_model`].
pub fn engine(kind: EngineKind) -> Box<dyn Engine> {
    engine_with_model(kind, None)
}

/// The engine of that kind; those with a trained model take the one that `model` names: a file, or
/// "none" for none at all.
pub fn engine_with_model(kind: EngineKind, model: Option<&str>) -> Box<dyn Engine> {
    engine_with(kind, model, DecodeOptions::default())
}

/// The same; those that decode sequences do it by `options`.
pub fn engine_with(
    kind: EngineKind,
    model: Option<&str>,
    options: DecodeOptions,
) -> Box<dyn Engine> {
    let pointer = |variant| Box::new(FaceformerEngine::with_model(variant, model, options));
    match kind {
        EngineKind::Shortest => Box::new(ShortestEngine::default()),
        EngineKind::Varley => Box::new(VarleyEngine),
        EngineKind::Rotation => Box::new(RotationEngine::with_model(model)),
        EngineKind::Faceformer => pointer(Variant::Faceformer),
        EngineKind::Seq2seqCoedge => pointer(Variant::Seq2seqCoedge),
        EngineKind::Seq2seq => pointer(Variant::Seq2seq),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip() {
        for kind in EngineKind::ALL {
            assert_eq!(kind.to_string().parse(), Ok(kind));
            assert_eq!(serde_json::to_value(kind).unwrap(), kind.name());
        }
        let unknown = "Varley".parse::<EngineKind>().unwrap_err();
        assert!(unknown.to_string().contains("varley"), "{unknown}");
    }
}
