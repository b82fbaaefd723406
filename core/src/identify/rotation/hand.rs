//! Scores without a trained model.

use super::features::{COUNT, Feature, Row, features};
use super::{Scores, TripleScorer, Triples};
use crate::drawing::{Drawing, Graph};
use crate::lift::directions::Directions;
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
        Self {
            weights: Feature::ALL.map(weight),
        }
    }
}

impl TripleScorer for HandScorer {
    fn score(
        &self,
        drawing: &Drawing,
        graph: &Graph,
        triples: &Triples,
        directions: Option<&Directions>,
        _: Progress<'_>,
    ) -> Result<Scores> {
        Ok(self
            .sums(&features(drawing, graph, triples, directions))
            .into())
    }
}

impl HandScorer {
    /// Log-odds of rows of features.
    pub(super) fn sums(&self, rows: &[Row]) -> Vec<f64> {
        let sum = |row: &Row| row.iter().zip(&self.weights).map(|(x, w)| x * w).sum();
        rows.iter().map(sum).collect()
    }
}

/// Weight of a feature, log-odds for one unit of it.
const fn weight(feature: Feature) -> f64 {
    match feature {
        Feature::ParallelSame => 1.09,
        Feature::ParallelOpposite => 2.23,
        Feature::NearlySame => 1.89,
        Feature::NearlyOpposite => 2.10,
        Feature::TangentsSame => 1.62,
        Feature::TangentsOpposite => -0.90,
        Feature::MixedSame => -0.58,
        Feature::MixedOpposite => -1.26,
        Feature::CongruentStraight => -2.31,
        Feature::CongruentCurved => 1.61,
        Feature::SideStraight => 0.13,
        Feature::SideCurved => -0.06,
        Feature::CycleOne => 0.00,
        Feature::CycleTwo => -1.00,
        Feature::CycleThree => 0.42,
        Feature::CycleFour => 0.88,
        Feature::CycleFive => 0.90,
        Feature::CycleSix => -0.07,
        Feature::CycleNone => 0.01,
        Feature::Longer => 0.55,
        Feature::LongerAtEnds => -0.74,
        Feature::LongerAtEnd => -1.27,
        Feature::Cross => -1.33,
        Feature::CrossingOpposite => -0.40,
        Feature::CrossingAdjacent => 0.40,
        Feature::SmoothOne => 0.03,
        Feature::SmoothBoth => 0.36,
        Feature::StraightOn => 0.75,
        Feature::SmoothOn => 0.01,
        Feature::FoldBack => 1.92,
        Feature::Plane => -0.41,
        Feature::Cylinder => 0.80,
        Feature::Neither => -2.77,
        Feature::RingMates => 2.24,
        Feature::RingSame => 1.14,
        Feature::RingOpposite => 0.58,
        Feature::RingParallel => 3.08,
        Feature::RingUnlike => 1.38,
        Feature::RingAll => 0.97,
    }
}
