//! Tables for training: the model's inputs with the truth, many drawings in one safetensors file.
//!
//! `faceformer features` writes them and `training/` reads them. Tables of all drawings follow
//! each other; `*_start` say where each drawing's begin, with the end of the last one added. With
//! N drawings, E edges, C corners, T triples and L loops in all:
//!
//! | tensor | shape | what |
//! |---|---|---|
//! | `edges` | f16 `[E, EDGE]` | [`Inputs::edges`] |
//! | `corners` | f16 `[C, CORNER]` | [`Inputs::corners`] |
//! | `corner_edges` | i32 `[C, 2]` | [`Inputs::corner_edges`], from 0 in each drawing |
//! | `triples` | f16 `[T, TRIPLE]` | [`Inputs::triples`] |
//! | `triple_corners` | i32 `[T, 2]` | [`Inputs::triple_corners`], from 0 in each drawing |
//! | `hand` | f32 `[T]` | [`Inputs::hand`] |
//! | `relations` | u16 `[sum of E^2]` | [`Inputs::relations`] |
//! | `follows` | u8 `[T]` | whether the triple is in a true face |
//! | `loop_steps`, `loop_start` | i32, `[L + 1]` | triples along each loop, from 0 in each drawing |
//! | `loop_kinds` | u8 `[L]` | surface kind, place in [`SurfaceKind::ALL`] |
//! | `orders4`, `orders5` | i32 `[V, (d-1)!, 2 d]` | triples of each order at a vertex of that degree, the true one first |
//! | `edge_start`, `corner_start`, `triple_start`, `loops_start`, `orders4_start`, `orders5_start` | i32 `[N + 1]` | where each drawing's rows begin |
//!
//! The metadata hold `ids` and `format`.

mod augment;
mod labels;

use std::collections::HashMap;
use std::path::Path;

use half::f16;
use safetensors::tensor::{Dtype, TensorView, serialize_to_file};

use super::Triples;
use super::inputs::{CORNER, EDGE, Inputs, TRIPLE};
use crate::drawing::{Drawing, Graph};
pub use augment::Augment;
use labels::Labels;

/// Version of the tables; a model is good for one.
pub const FORMAT: u32 = 1;

/// Tables of many drawings, in memory.
#[derive(Debug, Default)]
pub struct Shard {
    ids: Vec<String>,
    edges: Vec<f16>,
    corners: Vec<f16>,
    corner_edges: Vec<i32>,
    triples: Vec<f16>,
    triple_corners: Vec<i32>,
    hand: Vec<f32>,
    relations: Vec<u16>,
    follows: Vec<u8>,
    loop_steps: Vec<i32>,
    loop_start: Vec<i32>,
    loop_kinds: Vec<u8>,
    orders: [Vec<i32>; 2],
    /// Ends of each drawing's rows: edges, corners, triples, loops, orders of degree 4 and 5.
    ends: [Vec<i32>; 6],
}

impl Shard {
    /// Number of drawings.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Adds a drawing; says whether it could: not without a truth that tells what follows every
    /// co-edge.
    pub fn add(&mut self, drawing: &Drawing) -> bool {
        let graph = Graph::new(drawing);
        let triples = Triples::new(&graph);
        let truth = drawing.truth.as_ref();
        let Some(labels) = truth.and_then(|t| Labels::new(&graph, &triples, t)) else {
            return false;
        };
        let inputs = Inputs::new(drawing, &graph, &triples);
        self.ids.push(drawing.id.clone());
        let half = |x: &f32| f16::from_f32(*x);
        let pairs =
            |list: &[[u32; 2]]| list.iter().flatten().map(|&x| x as i32).collect::<Vec<_>>();
        self.edges.extend(inputs.edges.iter().map(half));
        self.corners.extend(inputs.corners.iter().map(half));
        self.corner_edges.extend(pairs(&inputs.corner_edges));
        self.triples.extend(inputs.triples.iter().map(half));
        self.triple_corners.extend(pairs(&inputs.triple_corners));
        self.hand.extend(&inputs.hand);
        self.relations.extend(&inputs.relations);
        self.follows.extend(&labels.follows);
        for steps in &labels.loops {
            self.loop_start.push(self.loop_steps.len() as i32);
            self.loop_steps.extend(steps.iter().map(|&t| t as i32));
        }
        self.loop_kinds.extend(&labels.kinds);
        for (all, new) in self.orders.iter_mut().zip(&labels.orders) {
            all.extend(new.iter().map(|&t| t as i32));
        }
        let [four, five] = [0, 1].map(|k| {
            let degree = k + 4;
            self.orders[k].len() / (2 * degree * (1..degree).product::<usize>())
        });
        let counts = [
            self.edges.len() / EDGE,
            self.corner_edges.len() / 2,
            self.hand.len(),
            self.loop_kinds.len(),
            four,
            five,
        ];
        for (ends, count) in self.ends.iter_mut().zip(counts) {
            ends.push(count as i32);
        }
        true
    }

    /// Writes the tables.
    ///
    /// # Errors
    /// What the file system says.
    pub fn write(&self, path: &Path) -> std::io::Result<()> {
        let mut tensors: Vec<(&str, Dtype, Vec<usize>, Vec<u8>)> = Vec::new();
        let halves = |x: &[f16]| x.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
        let ints = |x: &[i32]| x.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
        let floats = |x: &[f32]| x.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
        let mut add = |name, dtype, shape: &[usize], bytes| {
            tensors.push((name, dtype, shape.to_vec(), bytes));
        };
        let (f16, f32, i32, u8) = (Dtype::F16, Dtype::F32, Dtype::I32, Dtype::U8);
        let rows = |values: usize, width: usize| [values / width, width];
        add(
            "edges",
            f16,
            &rows(self.edges.len(), EDGE),
            halves(&self.edges),
        );
        add(
            "corners",
            f16,
            &rows(self.corners.len(), CORNER),
            halves(&self.corners),
        );
        let count = self.corner_edges.len();
        add(
            "corner_edges",
            i32,
            &rows(count, 2),
            ints(&self.corner_edges),
        );
        add(
            "triples",
            f16,
            &rows(self.triples.len(), TRIPLE),
            halves(&self.triples),
        );
        let count = self.triple_corners.len();
        add(
            "triple_corners",
            i32,
            &rows(count, 2),
            ints(&self.triple_corners),
        );
        add("hand", f32, &[self.hand.len()], floats(&self.hand));
        let bits = self.relations.iter().flat_map(|v| v.to_le_bytes());
        add(
            "relations",
            Dtype::U16,
            &[self.relations.len()],
            bits.collect(),
        );
        add("follows", u8, &[self.follows.len()], self.follows.clone());
        add(
            "loop_steps",
            i32,
            &[self.loop_steps.len()],
            ints(&self.loop_steps),
        );
        let mut start = self.loop_start.clone();
        start.push(self.loop_steps.len() as i32);
        add("loop_start", i32, &[start.len()], ints(&start));
        add(
            "loop_kinds",
            u8,
            &[self.loop_kinds.len()],
            self.loop_kinds.clone(),
        );
        for (k, name) in ["orders4", "orders5"].into_iter().enumerate() {
            let degree = k + 4;
            let (count, width) = ((1..degree).product::<usize>(), 2 * degree);
            let vertices = self.orders[k].len() / (count * width);
            add(name, i32, &[vertices, count, width], ints(&self.orders[k]));
        }
        let names = [
            "edge_start",
            "corner_start",
            "triple_start",
            "loops_start",
            "orders4_start",
            "orders5_start",
        ];
        for (name, ends) in names.into_iter().zip(&self.ends) {
            let start: Vec<i32> = std::iter::once(0).chain(ends.iter().copied()).collect();
            add(name, i32, &[start.len()], ints(&start));
        }
        let views = tensors.iter().map(|(name, dtype, shape, bytes)| {
            let view = TensorView::new(*dtype, shape.clone(), bytes);
            view.map(|v| (*name, v)).map_err(std::io::Error::other)
        });
        let views: Vec<_> = views.collect::<Result<_, _>>()?;
        let ids = serde_json::to_string(&self.ids).map_err(std::io::Error::other)?;
        let metadata = HashMap::from([
            ("format".to_owned(), FORMAT.to_string()),
            ("ids".to_owned(), ids),
        ]);
        serialize_to_file(views, Some(metadata), path).map_err(std::io::Error::other)
    }
}
