//! Scores of many drawings in one row.

use serde::{Deserialize, Serialize};

use super::calibration::Bins;
use super::score::{DrawingScore, share};

/// The identification part of what `faceformer eval --json` prints; shares are 0 to 100.
///
/// ```
/// use faceformer::identify::metrics::{DrawingScore, Summary};
///
/// let score = DrawingScore { faces: 4, predicted: 2, matched: 2, ..Default::default() };
/// let summary: Summary = [score].iter().collect();
/// assert_eq!((summary.precision, summary.recall), (100.0, 50.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Summary {
    /// Number of drawings, refused ones included.
    pub drawings: usize,
    /// Number of true faces.
    pub faces: usize,
    /// Mean over drawings of the share of predicted faces that are true.
    pub precision: f64,
    /// Mean over drawings of the share of true faces that were found.
    pub recall: f64,
    /// Share of all matched faces with the right one of the paper's three classes.
    pub type_rate: f64,
    /// Share of all matched faces with the right one of the six surface kinds.
    pub surface_rate: f64,
    /// Share of drawings with every face right.
    pub exact: f64,
    /// Share of drawings with every face right in one of the first three sets of faces.
    pub exact_top3: f64,
    /// Mean over drawings of the share of predicted loops that are true.
    pub loop_precision: f64,
    /// Mean over drawings of the share of true loops that were found.
    pub loop_recall: f64,
    /// Share of drawings with every loop right.
    pub loops_exact: f64,
    /// Number of drawings that the engine refused; they count as zero in the shares.
    pub refused: usize,
    /// Median time of the drawings that were not refused, in milliseconds.
    pub ms_median: f64,
    /// 99th percentile (nearest rank) of the same times.
    pub ms_p99: f64,
    /// Expected calibration error of faces' confidences, 0 to 1; see [`Bins::error`].
    pub calibration_error: f64,
    /// The same of loops' confidences.
    pub loop_calibration_error: f64,
    /// Confidences of all predicted faces.
    pub face_bins: Bins,
    /// Confidences of all predicted loops that have one.
    pub loop_bins: Bins,
}

impl Summary {
    /// The summary of the drawings' scores.
    pub fn of(scores: &[DrawingScore]) -> Self {
        let sum = |count: fn(&DrawingScore) -> usize| scores.iter().map(count).sum::<usize>();
        let mean = |value: fn(&DrawingScore) -> f64| {
            100.0 * scores.iter().map(value).sum::<f64>() / scores.len().max(1) as f64
        };
        let matched = sum(|s| s.matched);
        let mut times: Vec<f64> = scores.iter().filter(|s| !s.refused).map(|s| s.ms).collect();
        times.sort_unstable_by(f64::total_cmp);
        let (mut face_bins, mut loop_bins) = (Bins::default(), Bins::default());
        for score in scores {
            face_bins.extend(&score.face_bins);
            loop_bins.extend(&score.loop_bins);
        }
        Self {
            drawings: scores.len(),
            faces: sum(|s| s.faces),
            precision: mean(DrawingScore::precision),
            recall: mean(DrawingScore::recall),
            type_rate: 100.0 * share(sum(|s| s.typed), matched),
            surface_rate: 100.0 * share(sum(|s| s.surfaced), matched),
            exact: mean(|s| f64::from(s.exact())),
            exact_top3: mean(|s| f64::from(s.exact_top3)),
            loop_precision: mean(DrawingScore::loop_precision),
            loop_recall: mean(DrawingScore::loop_recall),
            loops_exact: mean(|s| f64::from(s.loops_exact())),
            refused: sum(|s| usize::from(s.refused)),
            ms_median: median(&times),
            ms_p99: nearest_rank(&times, 0.99),
            calibration_error: face_bins.error(),
            loop_calibration_error: loop_bins.error(),
            face_bins,
            loop_bins,
        }
    }
}

impl<'a> FromIterator<&'a DrawingScore> for Summary {
    fn from_iter<I: IntoIterator<Item = &'a DrawingScore>>(scores: I) -> Self {
        Self::of(&scores.into_iter().copied().collect::<Vec<_>>())
    }
}

/// Median of sorted numbers, the mean of the middle two for an even count, 0 for none.
pub fn median(sorted: &[f64]) -> f64 {
    let n = sorted.len();
    match (n, n % 2) {
        (0, _) => 0.0,
        (_, 1) => sorted[n / 2],
        _ => (sorted[n / 2 - 1] + sorted[n / 2]) / 2.0,
    }
}

/// Smallest of the sorted numbers that at least the given share of them does not exceed.
fn nearest_rank(sorted: &[f64], share: f64) -> f64 {
    let rank = (share * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.max(1) - 1).copied().unwrap_or(0.0)
}
