//! The network: a Transformer over edges, and two small heads.
//!
//! Encoder: pre-norm (Xiong et al. 2020, "On Layer Normalization in the Transformer Architecture"),
//! with a learned bias for each relation between two edges added to the attention (Shaw et al.
//! 2018, "Self-Attention with Relative Position Representations"; Ying et al. 2021, "Do
//! Transformers Really Perform Bad for Graph Representation?"). There are no positions: edges have
//! no order. `training/faceformer_training/rotation/model.py` is the same in PyTorch, and the names
//! of weights are the same in both.

use candle_core::{Device, Result, Tensor};
use candle_nn::VarBuilder;
use serde::{Deserialize, Serialize};

use super::ops::{Attention, LayerNorm, Linear, Sum};
use crate::drawing::SurfaceKind;
use crate::identify::rotation::inputs::{CORNER, EDGE, Inputs, RELATIONS, TRIPLE};
use crate::identify::rotation::shards::FORMAT;

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
            attention_norm: LayerNorm::new(w, &vb.pp("attention_norm"))?,
            qkv: Linear::new(w, 3 * w, &vb.pp("qkv"))?,
            out: Linear::new(w, w, &vb.pp("out"))?,
            hidden_norm: LayerNorm::new(w, &vb.pp("hidden_norm"))?,
            up: Linear::new(w, config.hidden, &vb.pp("up"))?,
            down: Linear::new(config.hidden, w, &vb.pp("down"))?,
        })
    }

    /// `x` is `[E, width]`.
    fn forward(&self, x: &Tensor, attention: &Attention<'_>) -> Result<Tensor> {
        let qkv = self.qkv.forward(&self.attention_norm.forward(x)?)?;
        let mixed = qkv.apply_op1_no_bwd(attention)?;
        let x = x.apply_op2_no_bwd(&self.out.forward(&mixed)?, &Sum)?;
        let hidden = self.up.forward_relu(&self.hidden_norm.forward(&x)?)?;
        x.apply_op2_no_bwd(&self.down.forward(&hidden)?, &Sum)
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
    hand: f32,
    loop_: Linear,
    kind: Linear,
}

/// A drawing as the encoder sees it.
#[derive(Debug, Clone)]
pub struct Encoded {
    /// Log-odds of the triples.
    pub scores: Vec<f32>,
    /// Edges in their context, `[E, width]`.
    edges: Vec<f32>,
    /// Triples, `[T, width]`.
    states: Vec<f32>,
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
            embed: Linear::new(config.edge, w, &vb.pp("embed"))?,
            embed_out: Linear::new(w, w, &vb.pp("embed_out"))?,
            relation: relation.t()?.to_vec2()?,
            layers: layers.collect::<Result<_>>()?,
            norm: LayerNorm::new(w, &vb.pp("norm"))?,
            outer: Linear::new(w, w, &vb.pp("outer"))?,
            middle: Linear::without_bias(w, w, &vb.pp("middle"))?,
            corner: Linear::without_bias(config.corner, w, &vb.pp("corner"))?,
            sum: Linear::new(w, w, &vb.pp("sum"))?,
            product: Linear::without_bias(w, w, &vb.pp("product"))?,
            triple: Linear::without_bias(config.triple, w, &vb.pp("triple"))?,
            score: Linear::new(w, 1, &vb.pp("score"))?,
            hand: vb.get(1, "hand")?.to_vec1::<f32>()?[0],
            loop_: Linear::new(2 * w + 1, w, &vb.pp("loop"))?,
            kind: Linear::new(w, config.kinds, &vb.pp("kind"))?,
        })
    }

    /// Encodes a drawing and scores its triples.
    ///
    /// # Errors
    /// candle's, if the tables do not fit each other.
    pub fn encode(&self, inputs: &Inputs) -> Result<Encoded> {
        let x = self
            .embed
            .forward_relu(&table(&inputs.edges, self.config.edge)?)?;
        let mut x = self.embed_out.forward(&x)?;
        let (classes, log_weights) = self.classes(inputs);
        let by_layer = log_weights.len() / self.config.layers;
        for (layer, log_weights) in self.layers.iter().zip(log_weights.chunks(by_layer.max(1))) {
            let attention = Attention {
                heads: self.config.heads,
                classes: &classes,
                log_weights,
            };
            x = layer.forward(&x, &attention)?;
        }
        let edges = self.norm.forward(&x)?;
        let corners = self.corners(inputs, &edges)?;
        let states = self.states(inputs, &corners)?;
        let own = numbers(&self.score.forward(&table(&states, self.config.width)?)?)?;
        let scores = inputs.hand.iter().zip(own).map(|(h, x)| h * self.hand + x);
        Ok(Encoded {
            scores: scores.collect(),
            edges: numbers(&edges)?,
            states,
        })
    }

    /// Corners, `[C, width]`.
    fn corners(&self, inputs: &Inputs, edges: &Tensor) -> Result<Vec<f32>> {
        let w = self.config.width;
        let outer = numbers(&self.outer.forward(edges)?)?;
        let middle = numbers(&self.middle.forward(edges)?)?;
        let own = table(&inputs.corners, self.config.corner)?;
        let mut corners = numbers(&self.corner.forward(&own)?)?;
        for (corner, pair) in corners.chunks_exact_mut(w).zip(&inputs.corner_edges) {
            let [outer, middle] = [row(&outer, pair[0], w), row(&middle, pair[1], w)];
            for (x, (a, b)) in corner.iter_mut().zip(outer.iter().zip(middle)) {
                *x = (a + b + *x).max(0.0);
            }
        }
        Ok(corners)
    }

    /// Triples, `[T, width]`.
    fn states(&self, inputs: &Inputs, corners: &[f32]) -> Result<Vec<f32>> {
        let w = self.config.width;
        let ends = |f: fn(f32, f32) -> f32| {
            let mut ends = Vec::with_capacity(inputs.triple_corners.len() * w);
            for &[a, b] in &inputs.triple_corners {
                let pairs = row(corners, a, w).iter().zip(row(corners, b, w));
                ends.extend(pairs.map(|(&a, &b)| f(a, b)));
            }
            table(&ends, w)
        };
        let mut states = numbers(&self.sum.forward(&ends(|a, b| a + b)?)?)?;
        let product = numbers(&self.product.forward(&ends(|a, b| a * b)?)?)?;
        let own = table(&inputs.triples, self.config.triple)?;
        let own = numbers(&self.triple.forward(&own)?)?;
        for (x, (a, b)) in states.iter_mut().zip(product.iter().zip(own)) {
            *x = (*x + a + b).max(0.0);
        }
        Ok(states)
    }

    /// The set of relations of each pair of edges, `[E, E]`, and what each set that occurs adds to the
    /// attention, `[layers, heads, sets]`.
    fn classes(&self, inputs: &Inputs) -> (Vec<u16>, Vec<f32>) {
        let mut place = vec![u16::MAX; 1 << RELATIONS];
        let mut sets: Vec<u16> = Vec::new();
        let class = |&bits: &u16| {
            let known = &mut place[usize::from(bits)];
            if *known == u16::MAX {
                *known = sets.len() as u16;
                sets.push(bits);
            }
            *known
        };
        let classes = inputs.relations.iter().map(class).collect();
        let rows = 0..self.config.layers * self.config.heads;
        let log_weights = rows.flat_map(|own| {
            let sum = move |bits: &u16| {
                let held = (0..RELATIONS).filter(|k| bits >> k & 1 == 1);
                held.fold(0.0, |sum, k| sum + self.relation[k][own])
            };
            sets.iter().map(sum)
        });
        (classes, log_weights.collect())
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
                let state = row(&encoded.states, triple as u32, w);
                let seen = state.iter().chain(row(&encoded.edges, edge as u32, w));
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
            .forward(&self.loop_.forward_relu(&pooled)?)?
            .to_vec2()
    }
}

/// A table of rows of that width.
fn table(values: &[f32], width: usize) -> Result<Tensor> {
    Tensor::from_slice(values, (values.len() / width, width), &Device::Cpu)
}

/// The numbers of a table, row by row.
fn numbers(table: &Tensor) -> Result<Vec<f32>> {
    table.flatten_all()?.to_vec1()
}

/// One row of a table.
fn row(values: &[f32], index: u32, width: usize) -> &[f32] {
    &values[index as usize * width..][..width]
}
