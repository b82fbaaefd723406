//! From log-odds to probabilities that hold.
//!
//! The lines are logistic fits (Platt 1999) with a trained model's scores: for loops to 340 drawings of
//! real parts of six sources, for groupings to 1,147 drawings of the validation families and of random
//! solids. Those for vertices are the scores' own.

/// A line from a margin to the log-odds of being right.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Log-odds for a unit of margin: the inverse of a temperature.
    slope: f64,
    /// Log-odds at no margin.
    offset: f64,
}

/// For loops by the least margin of their choices.
pub(super) const LOOPS: Line = Line {
    slope: 0.063,
    offset: 1.15,
};

/// For orders at vertices by their margin.
pub(super) const VERTICES: Line = Line {
    slope: 1.0,
    offset: 0.0,
};

/// For faces by the log-odds that the search gives their grouping.
const GROUPS: Line = Line {
    slope: 0.20,
    offset: 1.11,
};

/// Margin beyond which more of it says no more, log-odds.
const SUREST: f64 = 60.0;

/// Probability of being right at a margin, log-odds; an endless margin, where there is no choice,
/// is certain.
pub(super) fn confidence(margin: f64, line: Line) -> f64 {
    if margin == f64::INFINITY {
        return 1.0;
    }
    let margin = margin.min(SUREST);
    1.0 / (1.0 + (-(line.slope * margin + line.offset)).exp())
}

/// Probability that a face's grouping is right, from the share of the search's likelihood.
pub(super) fn grouping(share: f64) -> f64 {
    let share = share.clamp(1e-9, 1.0 - 1e-9);
    confidence((share / (1.0 - share)).ln(), GROUPS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_margin_is_more_confidence() {
        for line in [LOOPS, VERTICES] {
            let [a, b, c] = [-1.0, 1.0, f64::INFINITY].map(|m| confidence(m, line));
            assert!(0.0 < a && a < b && b < c && c == 1.0);
        }
        assert!(grouping(0.3) < grouping(0.9) && grouping(1.0) <= 1.0);
    }
}
