//! Whether confidences are what they say: bins of confidence and how often each was right.

use serde::{Deserialize, Serialize};

/// Number of bins of equal width.
pub const BINS: usize = 10;

/// Items whose confidence is in one range.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Bin {
    /// Number of items.
    pub count: usize,
    /// Those of them that are right.
    pub right: usize,
    /// Sum of their confidences, 0 to 1 each.
    pub confidence: f64,
}

/// Bins of confidence, bin `k` from `k / BINS` up to `(k + 1) / BINS`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Bins(pub [Bin; BINS]);

impl Bins {
    /// Adds an item of that confidence, 0 to 1.
    pub fn add(&mut self, confidence: f64, right: bool) {
        let bin = &mut self.0[((confidence * BINS as f64) as usize).min(BINS - 1)];
        bin.count += 1;
        bin.right += usize::from(right);
        bin.confidence += confidence;
    }

    /// Adds the items of other bins.
    pub fn extend(&mut self, other: &Self) {
        for (own, bin) in self.0.iter_mut().zip(&other.0) {
            own.count += bin.count;
            own.right += bin.right;
            own.confidence += bin.confidence;
        }
    }

    /// Expected calibration error, 0 to 1: the mean over all items of the distance between their
    /// bin's mean confidence and its share of right ones (Guo et al. 2017, equation 3); 0 for none.
    pub fn error(&self) -> f64 {
        let total: usize = self.0.iter().map(|b| b.count).sum();
        let gap = |b: &Bin| (b.confidence - b.right as f64).abs();
        self.0.iter().map(gap).sum::<f64>() / total.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn confidence_that_is_kept_has_no_error() {
        let mut bins = Bins::default();
        for k in 0..10 {
            bins.add(0.8, k < 8);
        }
        assert!(bins.error() < 1e-12);
        let mut sure = Bins::default();
        sure.add(1.0, false);
        sure.extend(&bins);
        assert!((sure.error() - 1.0 / 11.0).abs() < 1e-12);
        assert_eq!(sure.0[9].count, 1);
        assert_eq!(Bins::default().error(), 0.0);
    }
}
