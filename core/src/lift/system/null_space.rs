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

    /// Share of the most that `sum(terms)` can change by, were its terms to change each by itself, that
    /// it does change by: 1 for a term that nothing ties to the others, and no more than the errors of
    /// the rows if they tie the terms to each other. Whichever basis the null space has, it is one.
    pub fn openness(&self, terms: &[(usize, f64)]) -> f64 {
        let length = |vector: &[f64]| vector.iter().map(|c| c * c).sum::<f64>().sqrt();
        let mut sum = vec![0.0; self.dimension];
        let mut most = 0.0;
        for &(i, c) in terms {
            let shares = &self.shares[i];
            sum.iter_mut().zip(shares).for_each(|(s, x)| *s += c * x);
            most += c.abs() * length(shares);
        }
        if most > 0.0 { length(&sum) / most } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_term_is_open_and_a_tie_with_its_error_is_not() {
        // Two unknowns that grow together but for an error, and a third by itself.
        let basis = [vec![0.8, 0.6, 0.0], vec![0.0, 0.0, 1.0]];
        let null_space = NullSpace::new(&basis, &[1.0; 3]);
        assert!((null_space.openness(&[(0, 2.0)]) - 1.0).abs() < 1e-12);
        let tie = [(0, 0.6), (1, -0.8 * (1.0 + 1e-5))];
        assert!(null_space.leaves_open(&tie));
        assert!(null_space.openness(&tie) < 1e-5);
        assert!(null_space.openness(&[(0, 1.0), (2, -1.0)]) > 0.5);
    }
}
