//! What a linear system leaves open.

/// Share of the largest component of a null vector below which a component is zero.
const ZERO: f64 = 1e-6;

/// The directions in which the unknowns can move without changing any left-hand side.
#[derive(Debug, Clone)]
pub struct NullSpace {
    /// One row an unknown: its share in each basis vector of its group.
    shares: Vec<Vec<f64>>,
    /// Group of each unknown; those of different ones move by themselves.
    group: Vec<usize>,
    dimension: usize,
    /// Components smaller than this are zero.
    zero: f64,
}

impl NullSpace {
    /// From an orthonormal basis, in scaled unknowns, of each group of unknowns that share no row
    /// with others.
    pub(super) fn new(groups: &[Vec<usize>], bases: &[Vec<Vec<f64>>], scale: &[f64]) -> Self {
        let mut shares = vec![Vec::new(); scale.len()];
        let mut group = vec![0; scale.len()];
        for (g, (unknowns, basis)) in groups.iter().zip(bases).enumerate() {
            for (k, &i) in unknowns.iter().enumerate() {
                shares[i] = basis.iter().map(|b| b[k] * scale[i]).collect();
                group[i] = g;
            }
        }
        let largest = shares
            .iter()
            .flatten()
            .fold(0.0, |m: f64, c| m.max(c.abs()));
        Self {
            shares,
            group,
            dimension: bases.iter().map(Vec::len).sum(),
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
        self.groups(terms).any(|(g, dimension)| {
            (0..dimension).any(|k| {
                let own = terms.iter().filter(|t| self.group[t.0] == g);
                let moved: f64 = own.map(|&(i, c)| c * self.shares[i][k]).sum();
                moved.abs() > self.zero * size
            })
        })
    }

    /// The groups of some terms, each once, with the dimension of its null space.
    fn groups<'a>(
        &'a self,
        terms: &'a [(usize, f64)],
    ) -> impl Iterator<Item = (usize, usize)> + 'a {
        terms.iter().enumerate().filter_map(|(t, &(i, _))| {
            let g = self.group[i];
            let new = terms[..t].iter().all(|t| self.group[t.0] != g);
            new.then(|| (g, self.shares[i].len()))
        })
    }

    /// Share of the most that `sum(terms)` can change by, were its terms to change each by itself, that
    /// it does change by: 1 for a term that nothing ties to the others, and no more than the errors of
    /// the rows if they tie the terms to each other. Whichever basis the null space has, it is one.
    pub fn openness(&self, terms: &[(usize, f64)]) -> f64 {
        let square = |vector: &[f64]| vector.iter().map(|c| c * c).sum::<f64>();
        let moved = self.groups(terms).map(|(g, dimension)| {
            let mut sum = vec![0.0; dimension];
            for &(i, c) in terms.iter().filter(|t| self.group[t.0] == g) {
                let shares = self.shares[i].iter();
                sum.iter_mut().zip(shares).for_each(|(s, x)| *s += c * x);
            }
            square(&sum)
        });
        let moved: f64 = moved.sum();
        let alone = |&(i, c): &(usize, f64)| c.abs() * square(&self.shares[i]).sqrt();
        let most: f64 = terms.iter().map(alone).sum();
        if most > 0.0 { moved.sqrt() / most } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_term_is_open_and_a_tie_with_its_error_is_not() {
        // Two unknowns that grow together but for an error, and a third by itself.
        let (groups, bases) = (
            [vec![0, 1], vec![2]],
            [vec![vec![0.8, 0.6]], vec![vec![1.0]]],
        );
        let null_space = NullSpace::new(&groups, &bases, &[1.0; 3]);
        assert!((null_space.openness(&[(0, 2.0)]) - 1.0).abs() < 1e-12);
        let tie = [(0, 0.6), (1, -0.8 * (1.0 + 1e-5))];
        assert!(null_space.leaves_open(&tie));
        assert!(null_space.openness(&tie) < 1e-5);
        assert!(null_space.openness(&[(0, 1.0), (2, -1.0)]) > 0.5);
    }
}
