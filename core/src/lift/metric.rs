//! How far lifted depths are from the truth.

use super::{Camera, Lift};
use crate::drawing::Truth;

/// Largest error of a vertex' depth, drawing units; infinite if the truth has no depths or another
/// number of vertices.
///
/// What a drawing does not tell is taken at its best: the depth offset and the reversal in a
/// parallel projection, the scale in a central one.
pub fn depth_error(lift: &Lift, truth: &Truth) -> f64 {
    if lift.depths.is_empty() || lift.depths.len() != truth.vertices3d.len() {
        return f64::INFINITY;
    }
    let pairs = || {
        lift.depths
            .iter()
            .copied()
            .zip(truth.vertices3d.iter().map(|t| t.z))
    };
    match lift.camera {
        Camera::Parallel => spread(pairs()).min(spread(pairs().map(|(z, t)| (-z, t)))),
        Camera::Central { .. } => scaled(&pairs().collect::<Vec<_>>()),
    }
}

/// Largest difference after the best offset, which leaves half of the range on either side.
fn spread(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (low, high) = pairs
        .map(|(z, t)| z - t)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), d| {
            (low.min(d), high.max(d))
        });
    (high - low) / 2.0
}

/// Largest difference after the best factor. It is a convex function of the factor, so golden
/// sections find it.
fn scaled(pairs: &[(f64, f64)]) -> f64 {
    let worst = |s: f64| {
        let off = pairs.iter().map(|(z, t)| (s * z - t).abs());
        off.fold(0.0, f64::max)
    };
    let ratios = pairs.iter().map(|(z, t)| t / z).filter(|r| r.is_finite());
    let (mut low, mut high) = ratios.fold((f64::INFINITY, 0.0), |(low, high), r| {
        (f64::min(low, r), f64::max(high, r))
    });
    const SECTIONS: usize = 90;
    let golden = (5f64.sqrt() - 1.0) / 2.0;
    for _ in 0..SECTIONS {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        if worst(a) < worst(b) {
            high = b;
        } else {
            low = a;
        }
    }
    let found = worst(f64::midpoint(low, high));
    if found.is_finite() {
        found
    } else {
        f64::INFINITY
    }
}
