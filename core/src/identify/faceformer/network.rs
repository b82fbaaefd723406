//! The network: an encoder over the tokens of a drawing, and a decoder that points at them.
//!
//! `training/faceformer_training/faceformer/model.py` is the same in PyTorch, and the names of
//! weights are the same in both.

use candle_core::{Device, Result, Tensor};
use candle_nn::{LayerNorm, Linear, Module, VarBuilder, linear};

use super::layers::{DecoderLayer, EncoderLayer, norm};
use super::{Config, Decoding, TOKENS};

/// The network with its weights.
#[derive(Debug, Clone)]
pub struct Network {
    pub(super) config: Config,
    /// `[TOKENS, width]`.
    token: Tensor,
    /// `[TOKENS + inputs, width]`.
    position: Tensor,
    /// `[steps, width]`.
    pub(super) step: Tensor,
    embed: Linear,
    embed_out: Linear,
    encoder: Vec<EncoderLayer>,
    encoder_norm: LayerNorm,
    pub(super) decoder: Vec<DecoderLayer>,
    pub(super) decoder_norm: LayerNorm,
    pub(super) pointer: Linear,
}

/// A drawing as the encoder sees it, with what every layer of the decoder asks of it.
#[derive(Debug, Clone)]
pub struct Memory {
    /// Special tokens and tokens of the drawing in their context, `[TOKENS + tokens, width]`.
    pub(super) tokens: Tensor,
    /// The same as columns, at which pointers are compared.
    pub(super) columns: Tensor,
    /// Keys and values for each layer of the decoder.
    pub(super) layers: Vec<(Tensor, Tensor)>,
}

impl Memory {
    /// The tokens in their context, `[TOKENS + tokens][width]`.
    ///
    /// # Errors
    /// candle's.
    pub fn tokens(&self) -> Result<Vec<Vec<f32>>> {
        self.tokens.to_vec2()
    }
}

impl Network {
    /// Takes the weights by name.
    ///
    /// # Errors
    /// candle's, if a weight is missing or of another shape.
    pub fn new(config: Config, vb: &VarBuilder<'_>) -> Result<Self> {
        let w = config.width;
        let (encoder, decoder) = (vb.pp("encoder"), vb.pp("decoder"));
        Ok(Self {
            config,
            token: vb.pp("token").get((TOKENS, w), "weight")?,
            position: vb
                .pp("position")
                .get((config.inputs + TOKENS, w), "weight")?,
            step: vb.pp("step").get((config.steps, w), "weight")?,
            embed: linear(2 * config.points, w, vb.pp("embed"))?,
            embed_out: linear(w, w, vb.pp("embed_out"))?,
            encoder: (0..config.encoder_layers)
                .map(|k| EncoderLayer::new(&config, &encoder.pp(k)))
                .collect::<Result<_>>()?,
            encoder_norm: norm(w, vb.pp("encoder_norm"))?,
            decoder: (0..config.decoder_layers)
                .map(|k| DecoderLayer::new(&config, &decoder.pp(k)))
                .collect::<Result<_>>()?,
            decoder_norm: norm(w, vb.pp("decoder_norm"))?,
            pointer: linear(w, w, vb.pp("pointer"))?,
        })
    }

    /// Size and conventions.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Encodes a drawing; `points` are its coordinates, `[tokens][points][2]`, at most
    /// [`Config::inputs`] tokens.
    ///
    /// # Errors
    /// candle's, if there are more tokens or their number of points is another one.
    pub fn encode(&self, points: &[f32]) -> Result<Memory> {
        let row = 2 * self.config.points;
        let tokens = points.len() / row;
        let points = Tensor::from_slice(points, (tokens, row), &Device::Cpu)?;
        let embedded = self.embed.forward(&points)?.relu()?;
        let embedded = self.embed_out.forward(&embedded)?;
        let mut x = Tensor::cat(&[&self.token, &embedded], 0)?;
        let position = self.position.narrow(0, 0, TOKENS + tokens)?;
        for layer in &self.encoder {
            x = layer.forward(&x, &position)?;
        }
        let tokens = self.encoder_norm.forward(&x)?;
        let layers = self
            .decoder
            .iter()
            .map(|layer| layer.cross.remember(&tokens, &position));
        Ok(Memory {
            columns: tokens.t()?.contiguous()?,
            layers: layers.collect::<Result<_>>()?,
            tokens,
        })
    }

    /// Begins to decode sequences over an encoded drawing; see [`Decoding::new`].
    pub fn decode<'a>(&'a self, memory: &'a Memory, causal: bool) -> Decoding<'a> {
        Decoding::new(self, memory, causal)
    }
}
