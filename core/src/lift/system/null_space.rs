//! What a linear system leaves open.

/// Share of the largest component of a null vector below which a component is zero.
const ZERO: f64 = 1e-6;

/// The directions in which the unknowns can move without changing any left-hand side.
#[derive(Debug, Clone)]
pub struct NullSpace {
    /// One row an unknown: its share in each basis vector.
    shares: Vec<Vec<f64>>,
    dimension: usize,
    /// Components smaller than this are zero.
    zero: f64,
}

impl NullSpace {
    /// From an orthonormal basis in scaled unknowns.
    pub(super) fn new(basis: &[Vec<f64>], scale: &[f64]) -> Self {
        let shares: Vec<Vec<f64>> = scale
            .iter()
            .enumerate()
            .map(|(i, s)| basis.iter().map(|b| b[i] * s).collect())
            .collect();
        let largest = shares
            .iter()
            .flatten()
            .fold(0.0, |m: f64, c| m.max(c.abs()));
        Self {
            shares,
            dimension: basis.len(),
            zero: ZERO * largest,
        }
    }

    /// Number of independent ways to move; 0 if every unknown is determined.
    pub const fn dimension(&self) -> usize {
        self.dimension
    }

    /// Whether an unknown is not determined.
    pub fn is_free(&self, unknown: usize) -> bool {
        self.leaves_open(&[(unknown, 1.0)])
    }

    /// Whether the difference of two unknowns is determined, even if neither is.
    pub fn are_tied(&self, a: usize, b: usize) -> bool {
        a == b || !self.leaves_open(&[(a, 1.0), (b, -1.0)])
    }

    /// Whether the value of `sum(terms)` is not determined: a row with these terms would add to what
    /// is known.
    pub fn leaves_open(&self, terms: &[(usize, f64)]) -> bool {
        let size: f64 = terms.iter().map(|t| t.1.abs()).sum();
        (0..self.dimension).any(|k| {
            let moved: f64 = terms.iter().map(|&(i, c)| c * self.shares[i][k]).sum();
            moved.abs() > self.zero * size
        })
    }
}
