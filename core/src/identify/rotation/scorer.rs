//! The interface between scoring and decoding.

use super::Triples;
use crate::drawing::{CoEdge, Drawing, Graph, SurfaceKind};
use crate::lift::directions::Directions;
use crate::{Progress, Result};

/// Says how likely every triple is to be part of a face.
///
/// Hand-made rules and trained models stand behind this one interface; decoding sees nothing but
/// the numbers.
pub trait TripleScorer: Send + Sync {
    /// Scores every triple of a drawing with these dominant directions, if it has any.
    ///
    /// # Errors
    /// The scorer's own reasons, for instance a drawing beyond a model's limits;
    /// [`Error::Cancelled`](crate::Error::Cancelled) if `progress` asked to stop.
    fn score(
        &self,
        drawing: &Drawing,
        graph: &Graph,
        triples: &Triples,
        directions: Option<&Directions>,
        progress: Progress<'_>,
    ) -> Result<Scores>;
}

/// What a scorer finds.
pub struct Scores {
    /// Log-odds, one a triple in the order of [`Triples`]: positive if the three edges more likely
    /// than not follow each other around a face. Finite.
    pub log_odds: Vec<f64>,
    /// Tells the kinds of surfaces, if the scorer can.
    pub kinds: Option<Box<dyn LoopKinds>>,
    /// What the user should know.
    pub notices: Vec<String>,
}

impl From<Vec<f64>> for Scores {
    fn from(log_odds: Vec<f64>) -> Self {
        Self {
            log_odds,
            kinds: None,
            notices: Vec::new(),
        }
    }
}

/// Tells which kind of surface a loop bounds.
pub trait LoopKinds {
    /// The probability of each of the kinds for each loop, a closed walk.
    fn kinds(
        &self,
        graph: &Graph,
        triples: &Triples,
        loops: &[Vec<CoEdge>],
    ) -> Vec<[f64; SurfaceKind::ALL.len()]>;
}
