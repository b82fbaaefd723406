//! The network's larger operations for candle, each on the calling thread: candle's own norms hand
//! single rows to other threads, and see [`product`](super::product) for its products.

use candle_core::{
    CpuStorage, CustomOp1, CustomOp2, CustomOp3, Layout, Result, Shape, Tensor, bail,
};
use candle_nn::VarBuilder;

use super::product::{PANEL, Rows, padded, product};

/// Scores of the attention that are made at once: what a core keeps close.
const BLOCK: usize = 1 << 15;

/// A linear map.
#[derive(Debug, Clone)]
pub(super) struct Linear {
    /// Turned over, in panels, `[panels, in, PANEL]`, as products take it.
    weight: Tensor,
    bias: Tensor,
}

impl Linear {
    /// With weights `weight` `[out, in]` and `bias` `[out]`.
    pub(super) fn new(from: usize, out: usize, vb: &VarBuilder<'_>) -> Result<Self> {
        Ok(Self {
            bias: vb.get(out, "bias")?,
            ..Self::without_bias(from, out, vb)?
        })
    }

    /// With weights `weight` `[out, in]` only.
    pub(super) fn without_bias(from: usize, out: usize, vb: &VarBuilder<'_>) -> Result<Self> {
        let weight = vb.get((out, from), "weight")?;
        Ok(Self {
            bias: Tensor::zeros(out, weight.dtype(), weight.device())?,
            weight: weight
                .pad_with_zeros(0, 0, padded(out) - out)?
                .reshape((padded(out) / PANEL, PANEL, from))?
                .transpose(1, 2)?
                .contiguous()?,
        })
    }

    /// `[n, in]` to `[n, out]`.
    pub(super) fn forward(&self, x: &Tensor) -> Result<Tensor> {
        x.apply_op3_no_bwd(&self.weight, &self.bias, &Affine { relu: false })
    }

    /// The same, with what is negative cut off.
    pub(super) fn forward_relu(&self, x: &Tensor) -> Result<Tensor> {
        x.apply_op3_no_bwd(&self.weight, &self.bias, &Affine { relu: true })
    }
}

/// Rows of mean 0 and variance 1, scaled and shifted by column (Ba et al. 2016, "Layer
/// Normalization").
#[derive(Debug, Clone)]
pub(super) struct LayerNorm {
    weight: Tensor,
    bias: Tensor,
}

impl LayerNorm {
    pub(super) fn new(width: usize, vb: &VarBuilder<'_>) -> Result<Self> {
        Ok(Self {
            weight: vb.get(width, "weight")?,
            bias: vb.get(width, "bias")?,
        })
    }

    /// `[n, width]` to the same.
    pub(super) fn forward(&self, x: &Tensor) -> Result<Tensor> {
        x.apply_op3_no_bwd(&self.weight, &self.bias, &Norm)
    }
}

/// The numbers of a contiguous tensor.
fn floats<'a>(storage: &'a CpuStorage, layout: &Layout) -> Result<&'a [f32]> {
    match layout.contiguous_offsets() {
        Some((from, to)) => Ok(&storage.as_slice()?[from..to]),
        None => bail!("not contiguous"),
    }
}

struct Affine {
    relu: bool,
}

impl CustomOp3 for Affine {
    fn name(&self) -> &'static str {
        "affine"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        x_layout: &Layout,
        weight: &CpuStorage,
        weight_layout: &Layout,
        bias: &CpuStorage,
        bias_layout: &Layout,
    ) -> Result<(CpuStorage, Shape)> {
        let (rows, from) = x_layout.shape().dims2()?;
        let (panels, depth, _) = weight_layout.shape().dims3()?;
        let bias = floats(bias, bias_layout)?;
        let out = bias.len();
        if from != depth || padded(out) != panels * PANEL {
            bail!("{panels} panels of {depth} rows for {from} by {out}");
        }
        let left = Rows {
            values: floats(x, x_layout)?,
            stride: from,
        };
        let right = floats(weight, weight_layout)?;
        let mut y = vec![0.0f32; rows * out];
        product(left, right, depth, (&mut y, out), out);
        for row in y.chunks_exact_mut(out) {
            row.iter_mut().zip(bias).for_each(|(y, b)| *y += b);
            if self.relu {
                row.iter_mut().for_each(|y| *y = y.max(0.0));
            }
        }
        Ok((CpuStorage::F32(y), (rows, out).into()))
    }
}

/// Adds tensors of one shape.
pub(super) struct Sum;

impl CustomOp2 for Sum {
    fn name(&self) -> &'static str {
        "sum"
    }

    fn cpu_fwd(
        &self,
        a: &CpuStorage,
        a_layout: &Layout,
        b: &CpuStorage,
        b_layout: &Layout,
    ) -> Result<(CpuStorage, Shape)> {
        let shape = a_layout.shape();
        if shape != b_layout.shape() {
            bail!("{shape:?} and {:?}", b_layout.shape());
        }
        let pairs = floats(a, a_layout)?.iter().zip(floats(b, b_layout)?);
        let sums = pairs.map(|(a, b)| a + b).collect();
        Ok((CpuStorage::F32(sums), shape.clone()))
    }
}

/// Added to variances, as PyTorch does by default.
const EPSILON: f32 = 1e-5;

struct Norm;

impl CustomOp3 for Norm {
    fn name(&self) -> &'static str {
        "norm"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        x_layout: &Layout,
        weight: &CpuStorage,
        weight_layout: &Layout,
        bias: &CpuStorage,
        bias_layout: &Layout,
    ) -> Result<(CpuStorage, Shape)> {
        let (rows, width) = x_layout.shape().dims2()?;
        let weight = floats(weight, weight_layout)?;
        let bias = floats(bias, bias_layout)?;
        let mut y = Vec::with_capacity(rows * width);
        for row in floats(x, x_layout)?.chunks_exact(width) {
            let (mut sum, mut squares) = (0.0, 0.0);
            for x in row {
                sum += x;
                squares += x * x;
            }
            let mean = sum / width as f32;
            let variance = squares / width as f32 - mean * mean;
            let scale = (variance + EPSILON).sqrt().recip();
            let columns = row.iter().zip(weight).zip(bias);
            y.extend(columns.map(|((x, w), b)| (x - mean) * scale * w + b));
        }
        Ok((CpuStorage::F32(y), (rows, width).into()))
    }
}

/// Self-attention with log-weights for pairs, from queries, keys and values side by side,
/// `[E, 3 * width]`, to `[E, width]`.
pub(super) struct Attention<'a> {
    pub(super) heads: usize,
    /// Class of each pair, `[E, E]`.
    pub(super) classes: &'a [u16],
    /// Log-weights that each class of pairs gets, `[heads, classes]`.
    pub(super) log_weights: &'a [f32],
}

impl CustomOp1 for Attention<'_> {
    fn name(&self) -> &'static str {
        "attention"
    }

    fn cpu_fwd(&self, storage: &CpuStorage, layout: &Layout) -> Result<(CpuStorage, Shape)> {
        let (rows, triple) = layout.shape().dims2()?;
        let all = floats(storage, layout)?;
        let (width, size) = (triple / 3, triple / 3 / self.heads);
        if rows == 0 || self.classes.len() != rows * rows {
            bail!("{} pairs of {rows} edges", self.classes.len());
        }
        let scale = (size as f32).sqrt().recip();
        let mut y = vec![0.0f32; rows * width];
        let most = (BLOCK / rows).clamp(1, rows);
        let mut scores = vec![0.0f32; most * rows];
        let mut queries = vec![0.0f32; rows * size];
        let mut keys = vec![0.0f32; size * padded(rows)];
        let mut values = vec![0.0f32; rows * padded(size)];
        let by_head = self.log_weights.len() / self.heads;
        for (head, log_weights) in self.log_weights.chunks_exact(by_head).enumerate() {
            for (i, row) in all.chunks_exact(triple).enumerate() {
                let part = |which: usize| row[which * width + head * size..][..size].iter();
                let query = queries[i * size..].iter_mut();
                query.zip(part(0)).for_each(|(y, x)| *y = x * scale);
                let key = keys[i / PANEL * PANEL * size + i % PANEL..].iter_mut();
                let key = key.step_by(PANEL);
                key.zip(part(1)).for_each(|(y, x)| *y = *x);
                for (k, x) in part(2).enumerate() {
                    values[(k / PANEL * rows + i) * PANEL + k % PANEL] = *x;
                }
            }
            for first in (0..rows).step_by(most) {
                let count = most.min(rows - first);
                let scores = &mut scores[..count * rows];
                let queries = Rows {
                    values: &queries[first * size..],
                    stride: size,
                };
                product(queries, &keys, size, (scores, rows), rows);
                let classes = &self.classes[first * rows..];
                for (row, classes) in scores.chunks_exact_mut(rows).zip(classes.chunks(rows)) {
                    soften(row, classes, log_weights);
                }
                let scores = Rows {
                    values: scores,
                    stride: rows,
                };
                let end = (first + count - 1) * width + (head + 1) * size;
                let to = &mut y[first * width + head * size..end];
                product(scores, &values, rows, (to, width), size);
            }
        }
        Ok((CpuStorage::F32(y), (rows, width).into()))
    }
}

/// Softmax of scores and the log-weights of their classes.
fn soften(row: &mut [f32], classes: &[u16], log_weights: &[f32]) {
    // Largest and sums are kept for every eighth, so that they do not wait for each other.
    let mut largest = [f32::NEG_INFINITY; 8];
    for (row, classes) in row.chunks_mut(8).zip(classes.chunks(8)) {
        for ((x, &class), largest) in row.iter_mut().zip(classes).zip(&mut largest) {
            *x += log_weights[usize::from(class)];
            *largest = if *x > *largest { *x } else { *largest };
        }
    }
    let largest = largest.into_iter().fold(f32::NEG_INFINITY, f32::max);
    let mut sums = [0.0; 8];
    for row in row.chunks_mut(8) {
        for (x, sum) in row.iter_mut().zip(&mut sums) {
            *x = (*x - largest).exp();
            *sum += *x;
        }
    }
    let share = sums.iter().sum::<f32>().recip();
    row.iter_mut().for_each(|x| *x *= share);
}
