//! The layers of encoder and decoder: pre-norm Transformer layers (Xiong et al. 2020, "On Layer
//! Normalization in the Transformer Architecture") with ReLU, and learned positions added to the
//! queries and keys of every attention, but not to its values (Carion et al. 2020, "End-to-End Object
//! Detection with Transformers").

use candle_core::{Result, Tensor};
use candle_nn::{LayerNorm, Linear, Module, VarBuilder, layer_norm, linear, ops};

use super::Config;

/// Added to variances, as PyTorch does by default.
const EPSILON: f64 = 1e-5;

/// A norm over `width` numbers.
pub(super) fn norm(width: usize, vb: VarBuilder<'_>) -> Result<LayerNorm> {
    layer_norm(width, EPSILON, vb)
}

/// One attention with the norm before it; the maps to queries, keys and values are apart, for they
/// see different things.
#[derive(Debug, Clone)]
pub(super) struct Attention {
    heads: usize,
    norm: LayerNorm,
    query: Linear,
    key: Linear,
    value: Linear,
    out: Linear,
}

impl Attention {
    fn new(config: &Config, name: &str, vb: &VarBuilder<'_>) -> Result<Self> {
        let w = config.width;
        let qkv = vb.pp(format!("{name}_qkv"));
        let (weight, bias) = (qkv.get((3 * w, w), "weight")?, qkv.get(3 * w, "bias")?);
        let part = |k: usize| -> Result<Linear> {
            let bias = bias.narrow(0, k * w, w)?.contiguous()?;
            Ok(Linear::new(
                weight.narrow(0, k * w, w)?.contiguous()?,
                Some(bias),
            ))
        };
        Ok(Self {
            heads: config.heads,
            norm: norm(w, vb.pp(format!("{name}_norm")))?,
            query: part(0)?,
            key: part(1)?,
            value: part(2)?,
            out: linear(w, w, vb.pp(format!("{name}_out")))?,
        })
    }

    /// Queries, keys and values of tokens among themselves, each `[M, width]`; `position` is of the
    /// same shape, or one row for all.
    pub(super) fn own(&self, x: &Tensor, position: &Tensor) -> Result<[Tensor; 3]> {
        let x = self.norm.forward(x)?;
        let placed = x.broadcast_add(position)?;
        Ok([
            self.query.forward(&placed)?,
            self.key.forward(&placed)?,
            self.value.forward(&x)?,
        ])
    }

    /// The queries alone, `[M, width]`.
    pub(super) fn queries(&self, x: &Tensor, position: &Tensor) -> Result<Tensor> {
        let placed = self.norm.forward(x)?.broadcast_add(position)?;
        self.query.forward(&placed)
    }

    /// Keys `[heads, size, N]` and values `[heads, N, size]` of a memory `[N, width]`, made once for
    /// all that asks it.
    pub(super) fn remember(&self, memory: &Tensor, position: &Tensor) -> Result<(Tensor, Tensor)> {
        let placed = memory.broadcast_add(position)?;
        let keys = self.split(&self.key.forward(&placed)?)?;
        let values = self.split(&self.value.forward(memory)?)?;
        Ok((keys.transpose(1, 2)?.contiguous()?, values))
    }

    /// `[M, width]` to `[heads, M, size]`.
    pub(super) fn split(&self, x: &Tensor) -> Result<Tensor> {
        let (m, width) = x.dims2()?;
        let shape = (m, self.heads, width / self.heads);
        x.reshape(shape)?.transpose(0, 1)?.contiguous()
    }

    /// What queries `[M, width]` get of keys `[heads, size, N]` and values `[heads, N, size]`, after
    /// the last map: `[M, width]`.
    pub(super) fn ask(&self, queries: &Tensor, keys: &Tensor, values: &Tensor) -> Result<Tensor> {
        let (m, width) = queries.dims2()?;
        let queries = self.split(&(queries * self.scale(width))?)?;
        let weights = ops::softmax_last_dim(&queries.matmul(keys)?)?;
        let mixed = weights.matmul(values)?;
        self.finish(&mixed.transpose(0, 1)?.reshape((m, width))?)
    }

    /// Attention inside rows of `length` tokens each, all of which see each other; queries, keys and
    /// values are `[rows * length, width]`.
    pub(super) fn within(&self, qkv: &[Tensor; 3], length: usize) -> Result<Tensor> {
        let (all, width) = qkv[0].dims2()?;
        let (rows, size) = (all / length, width / self.heads);
        let split = |x: &Tensor| {
            let x = x.reshape((rows, length, self.heads, size))?;
            x.transpose(1, 2)?.contiguous()
        };
        let [queries, keys, values] = qkv;
        let queries = split(&(queries * self.scale(width))?)?;
        let keys = split(keys)?.transpose(2, 3)?.contiguous()?;
        let weights = ops::softmax_last_dim(&queries.matmul(&keys)?)?;
        let mixed = weights.matmul(&split(values)?)?;
        self.finish(&mixed.transpose(1, 2)?.reshape((all, width))?)
    }

    /// The map after the heads.
    pub(super) fn finish(&self, mixed: &Tensor) -> Result<Tensor> {
        self.out.forward(mixed)
    }

    fn scale(&self, width: usize) -> f64 {
        ((width / self.heads) as f64).sqrt().recip()
    }
}

/// Two linear maps with the norm before them.
#[derive(Debug, Clone)]
struct Feed {
    norm: LayerNorm,
    up: Linear,
    down: Linear,
}

impl Feed {
    fn new(config: &Config, vb: &VarBuilder<'_>) -> Result<Self> {
        let (w, hidden) = (config.width, config.hidden);
        Ok(Self {
            norm: norm(w, vb.pp("hidden_norm"))?,
            up: linear(w, hidden, vb.pp("up"))?,
            down: linear(hidden, w, vb.pp("down"))?,
        })
    }

    fn forward(&self, x: &Tensor) -> Result<Tensor> {
        let hidden = self.up.forward(&self.norm.forward(x)?)?.relu()?;
        x + self.down.forward(&hidden)?
    }
}

/// A layer of the encoder.
#[derive(Debug, Clone)]
pub(super) struct EncoderLayer {
    attention: Attention,
    feed: Feed,
}

impl EncoderLayer {
    pub(super) fn new(config: &Config, vb: &VarBuilder<'_>) -> Result<Self> {
        Ok(Self {
            attention: Attention::new(config, "self", vb)?,
            feed: Feed::new(config, vb)?,
        })
    }

    /// `[N, width]` to the same; all tokens see each other.
    pub(super) fn forward(&self, x: &Tensor, position: &Tensor) -> Result<Tensor> {
        let qkv = self.attention.own(x, position)?;
        let seen = self.attention.within(&qkv, x.dim(0)?)?;
        self.feed.forward(&(x + seen)?)
    }
}

/// A layer of the decoder.
#[derive(Debug, Clone)]
pub(super) struct DecoderLayer {
    /// Among the tokens of a sequence.
    pub(super) own: Attention,
    /// From a sequence to the drawing.
    pub(super) cross: Attention,
    feed: Feed,
}

impl DecoderLayer {
    pub(super) fn new(config: &Config, vb: &VarBuilder<'_>) -> Result<Self> {
        Ok(Self {
            own: Attention::new(config, "self", vb)?,
            cross: Attention::new(config, "cross", vb)?,
            feed: Feed::new(config, vb)?,
        })
    }

    /// What follows the attention among the sequence's tokens: `x` is `[M, width]`, `seen` what that
    /// attention gave.
    pub(super) fn after(
        &self,
        x: &Tensor,
        seen: &Tensor,
        position: &Tensor,
        (keys, values): &(Tensor, Tensor),
    ) -> Result<Tensor> {
        let x = (x + seen)?;
        let queries = self.cross.queries(&x, position)?;
        let x = (&x + self.cross.ask(&queries, keys, values)?)?;
        self.feed.forward(&x)
    }
}
