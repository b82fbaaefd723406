//! The network: a Transformer over edges, and two small heads.
//!
//! Encoder: pre-norm (Xiong et al. 2020, "On Layer Normalization in the Transformer Architecture"),
//! with a learned bias for each relation between two edges added to the attention (Shaw et al.
//! 2018, "Self-Attention with Relative Position Representations"; Ying et al. 2021, "Do
//! Transformers Really Perform Bad for Graph Representation?"). There are no positions: edges have
//! no order. `training/faceformer_training/rotation/model.py` is the same in PyTorch, and the names
//! of weights are the same in both.

use candle_core::{D, Device, Result, Tensor};
use candle_nn::{LayerNorm, Linear, Module, VarBuilder, layer_norm, linear, linear_no_bias, ops};
use serde::{Deserialize, Serialize};

use crate::drawing::SurfaceKind;
use crate::identify::rotation::inputs::{CORNER, EDGE, Inputs, RELATIONS, TRIPLE};
use crate::identify::rotation::shards::FORMAT;

/// Added to variances, as PyTorch does by default.
const EPSILON: f64 = 1e-5;

/// Size of the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Numbers for each edge between layers.
    pub width: usize,
    /// Attention heads; they divide the width.
    pub heads: usize,
    /// Layers of the encoder.
    pub layers: usize,
    /// Numbers for each edge inside a layer.
    pub hidden: usize,
    /// Version of the tables of inputs, [`FORMAT`].
    pub format: u32,
    /// Numbers of an edge, [`EDGE`].
    pub edge: usize,
    /// Numbers of a corner, [`CORNER`].
    pub corner: usize,
    /// Numbers of a triple, [`TRIPLE`].
    pub triple: usize,
    /// Relations between edges, [`RELATIONS`].
    pub relations: usize,
    /// Kinds of surfaces, [`SurfaceKind::ALL`].
    pub kinds: usize,
}

impl Config {
    /// Whether the network takes the inputs that this version computes, and is of a sane size.
    pub fn is_supported(&self) -> bool {
        let inputs = [
            self.edge,
            self.corner,
            self.triple,
            self.relations,
            self.kinds,
        ];
        inputs == [EDGE, CORNER, TRIPLE, RELATIONS, SurfaceKind::ALL.len()]
            && self.format == FORMAT
            && (1..=1024).contains(&self.width)
            && (1..=4096).contains(&self.hidden)
            && (1..=24).contains(&self.layers)
            && (1..=64).contains(&self.heads)
            && self.width.is_multiple_of(self.heads)
    }

    /// Names and shapes of all weights.
    pub fn shapes(&self) -> Vec<(String, Vec<usize>)> {
        let w = self.width;
        let mut shapes = Vec::new();
        let mut add = |name: &str, out: usize, from: usize, bias: bool| {
            shapes.push((format!("{name}.weight"), vec![out, from]));
            if bias {
                shapes.push((format!("{name}.bias"), vec![out]));
            }
        };
        add("embed", w, self.edge, true);
        add("embed_out", w, w, true);
        add("relation", self.layers * self.heads, self.relations, false);
        for k in 0..self.layers {
            add(&format!("layers.{k}.qkv"), 3 * w, w, true);
            add(&format!("layers.{k}.out"), w, w, true);
            add(&format!("layers.{k}.up"), self.hidden, w, true);
            add(&format!("layers.{k}.down"), w, self.hidden, true);
        }
        add("outer", w, w, true);
        add("middle", w, w, false);
        add("corner", w, self.corner, false);
        add("sum", w, w, true);
        add("product", w, w, false);
        add("triple", w, self.triple, false);
        add("score", 1, w, true);
        add("loop", w, 2 * w + 1, true);
        add("kind", self.kinds, w, true);
        let mut norms = vec!["norm".to_owned()];
        for k in 0..self.layers {
            norms.push(format!("layers.{k}.attention_norm"));
            norms.push(format!("layers.{k}.hidden_norm"));
        }
        for name in norms {
            shapes.push((format!("{name}.weight"), vec![w]));
            shapes.push((format!("{name}.bias"), vec![w]));
        }
        shapes.push(("hand".to_owned(), vec![1]));
        shapes
    }
}

/// Self-attention and two linear maps, each added to what comes in.
#[derive(Debug, Clone)]
struct Layer {
    heads: usize,
    attention_norm: LayerNorm,
    qkv: Linear,
    out: Linear,
    hidden_norm: LayerNorm,
    up: Linear,
    down: Linear,
}

impl Layer {
    fn new(config: &Config, vb: &VarBuilder<'_>) -> Result<Self> {
        let w = config.width;
        Ok(Self {
            heads: config.heads,
            attention_norm: layer_norm(w, EPSILON, vb.pp("attention_norm"))?,
            qkv: linear(w, 3 * w, vb.pp("qkv"))?,
            out: linear(w, w, vb.pp("out"))?,
            hidden_norm: layer_norm(w, EPSILON, vb.pp("hidden_norm"))?,
            up: linear(w, config.hidden, vb.pp("up"))?,
            down: linear(config.hidden, w, vb.pp("down"))?,
        })
    }

    /// `x` is `[E, width]`, `bias` `[heads, E, E]`.
    fn forward(&self, x: &Tensor, bias: &Tensor) -> Result<Tensor> {
        let (edges, width) = x.dims2()?;
        let size = width / self.heads;
        let qkv = self.qkv.forward(&self.attention_norm.forward(x)?)?;
        // [E, 3, heads, size] -> three of [heads, E, size].
        let qkv = qkv
            .reshape((edges, 3, self.heads, size))?
            .permute((1, 2, 0, 3))?
            .contiguous()?;
        let (q, k, v) = (qkv.get(0)?, qkv.get(1)?, qkv.get(2)?);
        let q = (q * (1.0 / (size as f64).sqrt()))?;
        let weights = (q.matmul(&k.transpose(1, 2)?)? + bias)?;
        let mixed = ops::softmax_last_dim(&weights)?.matmul(&v)?;
        let mixed = mixed.transpose(0, 1)?.reshape((edges, width))?;
        let x = (x + self.out.forward(&mixed)?)?;
        let hidden = self.up.forward(&self.hidden_norm.forward(&x)?)?.relu()?;
        &x + self.down.forward(&hidden)?
    }
}

/// The network with its weights.
#[derive(Debug, Clone)]
pub struct Network {
    config: Config,
    embed: Linear,
    embed_out: Linear,
    /// `[relations][layers * heads]`, log-weights that a relation adds to the attention.
    relation: Vec<Vec<f32>>,
    layers: Vec<Layer>,
    norm: LayerNorm,
    outer: Linear,
    middle: Linear,
    corner: Linear,
    sum: Linear,
    product: Linear,
    triple: Linear,
    score: Linear,
    hand: f64,
    loop_: Linear,
    kind: Linear,
}

/// A drawing as the encoder sees it.
#[derive(Debug, Clone)]
pub struct Encoded {
    /// Log-odds of the triples.
    pub scores: Vec<f32>,
    /// Edges in their context, `[E][width]`.
    edges: Vec<Vec<f32>>,
    /// Triples, `[T][width]`.
    states: Vec<Vec<f32>>,
}

impl Network {
    /// Takes the weights by name.
    ///
    /// # Errors
    /// candle's, if a weight is missing or of another shape.
    pub fn new(config: Config, vb: &VarBuilder<'_>) -> Result<Self> {
        let w = config.width;
        let rows = config.layers * config.heads;
        let relation = vb.pp("relation").get((rows, config.relations), "weight")?;
        let layers = (0..config.layers).map(|k| Layer::new(&config, &vb.pp("layers").pp(k)));
        Ok(Self {
            config,
            embed: linear(config.edge, w, vb.pp("embed"))?,
            embed_out: linear(w, w, vb.pp("embed_out"))?,
            relation: relation.t()?.to_vec2()?,
            layers: layers.collect::<Result<_>>()?,
            norm: layer_norm(w, EPSILON, vb.pp("norm"))?,
            outer: linear(w, w, vb.pp("outer"))?,
            middle: linear_no_bias(w, w, vb.pp("middle"))?,
            corner: linear_no_bias(config.corner, w, vb.pp("corner"))?,
            sum: linear(w, w, vb.pp("sum"))?,
            product: linear_no_bias(w, w, vb.pp("product"))?,
            triple: linear_no_bias(config.triple, w, vb.pp("triple"))?,
            score: linear(w, 1, vb.pp("score"))?,
            hand: f64::from(vb.get(1, "hand")?.to_vec1::<f32>()?[0]),
            loop_: linear(2 * w + 1, w, vb.pp("loop"))?,
            kind: linear(w, config.kinds, vb.pp("kind"))?,
        })
    }

    /// Encodes a drawing and scores its triples.
    ///
    /// # Errors
    /// candle's, if the tables do not fit each other.
    pub fn encode(&self, inputs: &Inputs) -> Result<Encoded> {
        let cpu = &Device::Cpu;
        let table = |values: &[f32], width: usize| {
            Tensor::from_slice(values, (values.len() / width, width), cpu)
        };
        let x = self
            .embed
            .forward(&table(&inputs.edges, self.config.edge)?)?;
        let mut x = self.embed_out.forward(&x.relu()?)?;
        let mut biases = self.biases(inputs);
        for (layer, bias) in self.layers.iter().zip(&mut biases) {
            let edges = inputs.edge_count();
            let shape = (self.config.heads, edges, edges);
            x = layer.forward(&x, &Tensor::from_vec(std::mem::take(bias), shape, cpu)?)?;
        }
        let edges = self.norm.forward(&x)?;
        let column = |pairs: &[[u32; 2]], k: usize| {
            let list: Vec<u32> = pairs.iter().map(|p| p[k]).collect();
            Tensor::new(list, cpu)
        };
        let at = |k| column(&inputs.corner_edges, k);
        let outer = self.outer.forward(&edges)?.index_select(&at(0)?, 0)?;
        let middle = self.middle.forward(&edges)?.index_select(&at(1)?, 0)?;
        let own = self
            .corner
            .forward(&table(&inputs.corners, self.config.corner)?)?;
        let corners = ((outer + middle)? + own)?.relu()?;
        let end = |k| corners.index_select(&column(&inputs.triple_corners, k)?, 0);
        let (a, b) = (end(0)?, end(1)?);
        let states = (self.sum.forward(&(&a + &b)?)? + self.product.forward(&(a * b)?)?)?;
        let own = self
            .triple
            .forward(&table(&inputs.triples, self.config.triple)?)?;
        let states = (states + own)?.relu()?;
        let hand = (Tensor::from_slice(&inputs.hand, inputs.hand.len(), cpu)? * self.hand)?;
        let scores = (hand + self.score.forward(&states)?.squeeze(D::Minus1)?)?;
        Ok(Encoded {
            scores: scores.to_vec1()?,
            edges: edges.to_vec2()?,
            states: states.to_vec2()?,
        })
    }

    /// What the relations add to each layer's attention, `[heads, E, E]` flat.
    ///
    /// Few sets of relations occur: each one's sums are made once and then copied.
    fn biases(&self, inputs: &Inputs) -> Vec<Vec<f32>> {
        let pairs = inputs.relations.len();
        let (layers, heads) = (self.config.layers, self.config.heads);
        let mut place = vec![u32::MAX; 1 << RELATIONS];
        let mut sums: Vec<f32> = Vec::new();
        let rows = layers * heads;
        let which: Vec<u32> = inputs
            .relations
            .iter()
            .map(|&bits| {
                let known = &mut place[usize::from(bits)];
                if *known == u32::MAX {
                    *known = (sums.len() / rows) as u32;
                    let first = sums.len();
                    sums.resize(first + rows, 0.0);
                    for k in (0..RELATIONS).filter(|k| bits >> k & 1 == 1) {
                        for (sum, x) in sums[first..].iter_mut().zip(&self.relation[k]) {
                            *sum += x;
                        }
                    }
                }
                *known
            })
            .collect();
        (0..layers)
            .map(|layer| {
                let mut bias = Vec::with_capacity(heads * pairs);
                for head in 0..heads {
                    let own = layer * heads + head;
                    bias.extend(which.iter().map(|&p| sums[p as usize * rows + own]));
                }
                bias
            })
            .collect()
    }

    /// Logits of the kinds of loops, `[L][kinds]`. A loop is the list of its triples, each with the
    /// edge in its middle.
    ///
    /// # Errors
    /// candle's.
    pub fn kinds(&self, encoded: &Encoded, loops: &[Vec<(usize, usize)>]) -> Result<Vec<Vec<f32>>> {
        if loops.is_empty() {
            return Ok(Vec::new());
        }
        let w = self.config.width;
        let mut pooled = Vec::with_capacity(loops.len() * (2 * w + 1));
        for steps in loops {
            let mut mean = vec![0.0f32; 2 * w];
            for &(triple, edge) in steps {
                let seen = encoded.states[triple].iter().chain(&encoded.edges[edge]);
                for (sum, x) in mean.iter_mut().zip(seen) {
                    *sum += x;
                }
            }
            let count = steps.len().max(1) as f32;
            pooled.extend(mean.iter().map(|x| x / count));
            pooled.push(count.ln());
        }
        let pooled = Tensor::from_vec(pooled, (loops.len(), 2 * w + 1), &Device::Cpu)?;
        self.kind
            .forward(&self.loop_.forward(&pooled)?.relu()?)?
            .to_vec2()
    }
}
