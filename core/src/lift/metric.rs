//! How far lifted depths are from the truth.

use super::Lift;
use crate::drawing::Truth;

/// Largest error of a vertex' depth, drawing units, after the best depth offset and for the better
/// of the two reversals; infinite if the truth has no depths or another number of vertices.
pub fn depth_error(lift: &Lift, truth: &Truth) -> f64 {
    if lift.depths.is_empty() || lift.depths.len() != truth.vertices3d.len() {
        return f64::INFINITY;
    }
    let spread = |sign: f64| {
        let pairs = lift.depths.iter().zip(&truth.vertices3d);
        let (low, high) = pairs
            .map(|(z, t)| sign * z - t.z)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), d| {
                (low.min(d), high.max(d))
            });
        // The best offset leaves half of the range on either side.
        (high - low) / 2.0
    };
    spread(1.0).min(spread(-1.0))
}
