//! Sizes and conventions of a network, as the description beside its weights says them.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::Network;
use crate::identify::weights::{self, Described, ModelError};

/// Version of the inputs and tables; a model is good for one.
pub const FORMAT: u32 = 1;

/// Special tokens before those of the drawing. 0 pads and is never predicted. After it come, for
/// faces one by one, PLANE, CYLINDER and OTHERS, and for all faces at once SOS, SEP and EOS.
pub const TOKENS: usize = 4;

/// Most bytes of weights: twice those of the paper's size in single precision.
pub const LIMIT: u64 = 256 << 20;

/// What a token of the drawing is, and what a sequence holds (paper, section 4.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Variant {
    /// Co-edges; a sequence is one face and begins with one of its co-edges.
    Faceformer,
    /// Co-edges; a sequence holds all faces.
    Seq2seqCoedge,
    /// Edges; a sequence holds all faces.
    Seq2seq,
}

impl Variant {
    /// SOS, with which a sequence of all faces begins.
    pub const SOS: u32 = 1;
    /// SEP, which stands between two faces.
    pub const SEP: u32 = 2;
    /// EOS, which stands after the last face.
    pub const EOS: u32 = 3;

    /// Whether a token ends a sequence: a face type, or EOS.
    pub fn ends(self, token: u32) -> bool {
        match self {
            Self::Faceformer => (1..TOKENS as u32).contains(&token),
            Self::Seq2seqCoedge | Self::Seq2seq => token == Self::EOS,
        }
    }

    /// Whether a token can follow others at all: not padding, and not SOS.
    pub fn follows(self, token: usize) -> bool {
        token > 0 && (self == Self::Faceformer || token != Self::SOS as usize)
    }
}

/// How coordinates are given to the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Frame {
    /// Moved and scaled so that the drawing's bounding box has its centre at 0 and the half
    /// diagonal 1: the size of a drawing does not matter.
    Fitted,
    /// As drawn. The paper's data have a solid's half diagonal as their unit.
    Drawn,
}

/// Order of the co-edges of the loops that do not hold a face's first co-edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FurtherLoops {
    /// From lowest to highest, as in the paper's text (section 4.1).
    Sorted,
    /// Walked, beginning with the lowest, as in the authors' released program.
    Walked,
}

/// Size and conventions of a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// What it predicts.
    pub variant: Variant,
    /// Numbers for each token between layers; the paper has 512.
    pub width: usize,
    /// Attention heads; they divide the width. The paper has 8.
    pub heads: usize,
    /// Layers of the encoder; the paper has 6.
    pub encoder_layers: usize,
    /// Layers of the decoder; the paper has 6.
    pub decoder_layers: usize,
    /// Numbers for each token inside a layer; the paper has 1024.
    pub hidden: usize,
    /// Points of an edge; the authors have 50.
    pub points: usize,
    /// Most tokens of a drawing, without the special ones: it has a learned position for each.
    pub inputs: usize,
    /// Most tokens of a sequence that are fed back, with its first one and without its end.
    pub steps: usize,
    /// How coordinates are given.
    pub frame: Frame,
    /// Order of co-edges in the sequences it was trained on.
    pub further_loops: FurtherLoops,
    /// Version of the inputs, [`FORMAT`].
    pub format: u32,
}

impl Described for Config {
    fn is_supported(&self) -> bool {
        self.format == FORMAT
            && (1..=1024).contains(&self.width)
            && (1..=4096).contains(&self.hidden)
            && (1..=24).contains(&self.encoder_layers)
            && (1..=24).contains(&self.decoder_layers)
            && (1..=64).contains(&self.heads)
            && self.width.is_multiple_of(self.heads)
            && (2..=1024).contains(&self.points)
            && (1..=8192).contains(&self.inputs)
            && (1..=8192).contains(&self.steps)
    }

    fn shapes(&self) -> Vec<(String, Vec<usize>)> {
        let (w, hidden) = (self.width, self.hidden);
        let mut shapes = vec![
            ("token.weight".to_owned(), vec![TOKENS, w]),
            ("position.weight".to_owned(), vec![self.inputs + TOKENS, w]),
            ("step.weight".to_owned(), vec![self.steps, w]),
        ];
        let mut add = |name: String, shape: Vec<usize>| {
            shapes.push((format!("{name}.bias"), vec![shape[0]]));
            shapes.push((format!("{name}.weight"), shape));
        };
        add("embed".to_owned(), vec![w, 2 * self.points]);
        add("embed_out".to_owned(), vec![w, w]);
        add("pointer".to_owned(), vec![w, w]);
        for (stack, layers, attentions) in [
            ("encoder", self.encoder_layers, &["self"][..]),
            ("decoder", self.decoder_layers, &["self", "cross"][..]),
        ] {
            add(format!("{stack}_norm"), vec![w]);
            for k in 0..layers {
                let layer = format!("{stack}.{k}");
                for name in attentions {
                    add(format!("{layer}.{name}_norm"), vec![w]);
                    add(format!("{layer}.{name}_qkv"), vec![3 * w, w]);
                    add(format!("{layer}.{name}_out"), vec![w, w]);
                }
                add(format!("{layer}.hidden_norm"), vec![w]);
                add(format!("{layer}.up"), vec![hidden, w]);
                add(format!("{layer}.down"), vec![w, hidden]);
            }
        }
        shapes
    }
}

impl Network {
    /// Reads a model from its two files.
    ///
    /// # Errors
    /// [`ModelError`].
    pub fn read(weights: &Path) -> Result<Self, ModelError> {
        let (bytes, description) = weights::read(weights, LIMIT)?;
        Self::load(bytes, &description)
    }

    /// Checks weights against their description and makes the network.
    ///
    /// # Errors
    /// [`ModelError`].
    pub fn load(weights: Vec<u8>, description: &str) -> Result<Self, ModelError> {
        let (config, vb) = weights::checked(weights, description, LIMIT)?;
        Self::new(config, &vb).map_err(|e| ModelError::Weights(e.to_string()))
    }
}
