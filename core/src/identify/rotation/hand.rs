//! Scores without a trained model.

use super::features::{COUNT, features};
use super::{TripleScorer, Triples};
use crate::drawing::{Drawing, Graph};
use crate::{Progress, Result};

/// Scores triples by hand-made features in a weighted sum.
///
/// The weights come from a conditional logit over the choices at each edge, fitted to drawings of
/// real parts (block machining features, a parts library, electronic parts).
#[derive(Debug, Clone, PartialEq)]
pub struct HandScorer {
    weights: [f64; COUNT],
}

impl Default for HandScorer {
    fn default() -> Self {
        Self { weights: WEIGHTS }
    }
}

impl TripleScorer for HandScorer {
    fn score(
        &self,
        drawing: &Drawing,
        graph: &Graph,
        triples: &Triples,
        _: Progress<'_>,
    ) -> Result<Vec<f64>> {
        let rows = features(drawing, graph, triples);
        let sum = |row: &[f64; COUNT]| row.iter().zip(&self.weights).map(|(x, w)| x * w).sum();
        Ok(rows.iter().map(sum).collect())
    }
}

/// Weights, in the order of the features.
const WEIGHTS: [f64; COUNT] = [
    2.237, 3.125, 2.642, 2.505, 2.907, 0.763, 0.159, -1.282, -2.977, 4.112, 0.328, 0.150, 0.000,
    -0.218, 0.795, 0.921, 0.538, -0.380, -0.196, 0.260, -1.168, -0.336, -2.224, -0.059, 0.059,
    0.387, 0.742, 1.523, 0.348, 2.826, 0.000,
];
