//! One step of decoding for many sequences at once.
//!
//! The memory's keys and values are shared by all sequences. With the causal mask the keys and values
//! of earlier tokens never change, so they are kept: each step stores them for the sequences that
//! were alive then, and a sequence knows its place in every step. So sequences can end, or part in a
//! beam search, and nothing is copied.

use candle_core::{Device, Result, Tensor};
use candle_nn::Module;

use super::layers::DecoderLayer;
use super::{Memory, Network};

/// A sequence that is being decoded.
#[derive(Debug, Clone, PartialEq)]
pub struct Hypothesis {
    /// Tokens so far, the first one included.
    pub tokens: Vec<u32>,
    /// Log-probability of each token after the first.
    pub log_probabilities: Vec<f32>,
    /// Place of the sequence among those that were alive in each step so far.
    pub(super) places: Vec<u32>,
}

impl Hypothesis {
    /// A sequence of one token.
    pub fn new(start: u32) -> Self {
        Self {
            tokens: vec![start],
            log_probabilities: Vec::new(),
            places: Vec::new(),
        }
    }

    /// Log-probability of the whole sequence.
    pub fn log_probability(&self) -> f64 {
        self.log_probabilities.iter().copied().map(f64::from).sum()
    }
}

/// Keys and values of the tokens of one step in one layer, `[rows][width]` each.
#[derive(Debug)]
struct Kept {
    keys: Vec<f32>,
    values: Vec<f32>,
}

/// Decoding over one encoded drawing.
#[derive(Debug)]
pub struct Decoding<'a> {
    network: &'a Network,
    memory: &'a Memory,
    causal: bool,
    /// What is kept of each layer, step by step.
    kept: Vec<Vec<Kept>>,
}

impl<'a> Decoding<'a> {
    /// Decoding with the causal mask that the network was trained with, or without it, as the authors'
    /// released program decodes: there every token of a sequence sees all others, the later ones
    /// included, and the whole sequence is computed anew in every step.
    pub fn new(network: &'a Network, memory: &'a Memory, causal: bool) -> Self {
        Self {
            network,
            memory,
            causal,
            kept: network.decoder.iter().map(|_| Vec::new()).collect(),
        }
    }

    /// Logits of what follows each sequence, `[rows][TOKENS + tokens]`.
    ///
    /// All sequences are of the same length, at most [`Config::steps`](super::Config::steps); each
    /// one was in the step before, but for its last token, and gets its place in this one.
    ///
    /// # Errors
    /// candle's, if a token is none of the drawing's.
    pub fn step(&mut self, rows: &mut [Hypothesis]) -> Result<Vec<Vec<f32>>> {
        let Some(length) = rows.first().map(|row| row.tokens.len()) else {
            return Ok(Vec::new());
        };
        for (place, row) in rows.iter_mut().enumerate() {
            row.places.push(place as u32);
        }
        let last = if self.causal {
            self.next(rows, length)?
        } else {
            self.anew(rows, length)?
        };
        let last = self.network.decoder_norm.forward(&last)?;
        let pointers = self.network.pointer.forward(&last)?;
        pointers.matmul(&self.memory.columns)?.to_vec2()
    }

    /// Output of the last layer for the last tokens, `[rows, width]`, from what is kept.
    fn next(&mut self, rows: &[Hypothesis], length: usize) -> Result<Tensor> {
        let tokens = rows.iter().map(|row| row.tokens[length - 1]);
        let mut x = self.embed(tokens.collect())?;
        let position = self.network.step.narrow(0, length - 1, 1)?;
        let layers = self.network.decoder.iter().zip(&self.memory.layers);
        for ((layer, memory), kept) in layers.zip(&mut self.kept) {
            let [queries, keys, values] = layer.own.own(&x, &position)?;
            let flat = |x: &Tensor| x.flatten_all()?.to_vec1::<f32>();
            kept.push(Kept {
                keys: flat(&keys)?,
                values: flat(&values)?,
            });
            let mixed = look_back(
                &flat(&queries)?,
                rows,
                kept,
                self.network.config.width,
                self.network.config.heads,
            );
            let mixed = Tensor::from_vec(mixed, x.dims2()?, &Device::Cpu)?;
            let seen = layer.own.finish(&mixed)?;
            x = layer.after(&x, &seen, &position, memory)?;
        }
        Ok(x)
    }

    /// The same without the causal mask: whole sequences, computed anew.
    fn anew(&self, rows: &[Hypothesis], length: usize) -> Result<Tensor> {
        let count = rows.len();
        let tokens = rows.iter().flat_map(|row| row.tokens.iter().copied());
        let mut x = self.embed(tokens.collect())?;
        let width = self.network.config.width;
        let position = self.network.step.narrow(0, 0, length)?;
        let position = position.broadcast_as((count, length, width))?;
        let position = position.reshape((count * length, width))?;
        let layers = self.network.decoder.iter().zip(&self.memory.layers);
        for (layer, memory) in layers {
            x = whole(layer, &x, &position, length, memory)?;
        }
        let ends: Vec<u32> = (1..=count).map(|k| (k * length - 1) as u32).collect();
        x.index_select(&Tensor::new(ends, &Device::Cpu)?, 0)
    }

    /// Tokens in the drawing's context, `[M, width]`.
    fn embed(&self, tokens: Vec<u32>) -> Result<Tensor> {
        let tokens = Tensor::new(tokens, &Device::Cpu)?;
        self.memory.tokens.index_select(&tokens, 0)
    }
}

fn whole(
    layer: &DecoderLayer,
    x: &Tensor,
    position: &Tensor,
    length: usize,
    memory: &(Tensor, Tensor),
) -> Result<Tensor> {
    let qkv = layer.own.own(x, position)?;
    let seen = layer.own.within(&qkv, length)?;
    layer.after(x, &seen, position, memory)
}

/// What the last token of each row sees of the row, itself included: `[rows][width]`.
///
/// Rows are short, so plain loops are faster here than many tiny products of matrices.
fn look_back(
    queries: &[f32],
    rows: &[Hypothesis],
    kept: &[Kept],
    width: usize,
    heads: usize,
) -> Vec<f32> {
    let size = width / heads;
    let scale = (size as f32).sqrt().recip();
    let mut mixed = vec![0.0f32; rows.len() * width];
    let mut weights = vec![0.0f32; kept.len()];
    for (r, row) in rows.iter().enumerate() {
        for head in 0..heads {
            let part = r * width + head * size..r * width + (head + 1) * size;
            let query = &queries[part.clone()];
            let of = |place: u32| {
                let first = place as usize * width + head * size;
                first..first + size
            };
            let steps = || kept.iter().zip(&row.places);
            let mut largest = f32::NEG_INFINITY;
            for (weight, (step, &place)) in weights.iter_mut().zip(steps()) {
                *weight = scale * dot(query, &step.keys[of(place)]);
                largest = largest.max(*weight);
            }
            let mut sum = 0.0;
            for weight in &mut weights {
                *weight = (*weight - largest).exp();
                sum += *weight;
            }
            let out = &mut mixed[part];
            for (weight, (step, &place)) in weights.iter().zip(steps()) {
                let share = weight / sum;
                for (o, v) in out.iter_mut().zip(&step.values[of(place)]) {
                    *o += share * v;
                }
            }
        }
    }
    mixed
}

/// Scalar product, summed in eight lanes so that the compiler can use vector instructions.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut lanes = [0.0f32; 8];
    let (a8, b8) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f32 = a8
        .remainder()
        .iter()
        .zip(b8.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in a8.zip(b8) {
        for ((lane, x), y) in lanes.iter_mut().zip(x).zip(y) {
            *lane += x * y;
        }
    }
    rest + lanes.iter().sum::<f32>()
}
