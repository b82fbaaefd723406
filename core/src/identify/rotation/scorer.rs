//! The interface between scoring and decoding.

use super::Triples;
use crate::drawing::{Drawing, Graph};
use crate::{Progress, Result};

/// Says how likely every triple is to be part of a face.
///
/// Hand-made rules and trained models stand behind this one interface; decoding sees nothing but
/// the numbers.
pub trait TripleScorer: Send + Sync {
    /// Log-odds, one a triple in the order of `triples`: positive if the three edges more likely
    /// than not follow each other around a face. Finite.
    ///
    /// # Errors
    /// The scorer's own reasons, for instance a drawing beyond a model's limits;
    /// [`Error::Cancelled`](crate::Error::Cancelled) if `progress` asked to stop.
    fn score(
        &self,
        drawing: &Drawing,
        graph: &Graph,
        triples: &Triples,
        progress: Progress<'_>,
    ) -> Result<Vec<f64>>;
}
