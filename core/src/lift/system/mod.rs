//! Sparse weighted linear rows, solved as least squares or in the L1 norm.
//!
//! A row says `sum(coefficient * unknown) = rhs`, how much it weighs, and what it stands for (its
//! tag), so that a residual can be told in the words of the drawing. Least squares goes through the
//! normal equations: with columns of unit length `N = A^T W^2 A`, the matrix `N + eps I` is
//! factored once (sparse Cholesky), iterative refinement takes the effect of `eps` away, and
//! inverse iteration on a block of vectors gives the null space, so that a system that leaves
//! unknowns open is reported instead of guessed.

mod l1;
mod normal;
mod null_space;

pub(crate) use normal::Pattern;
pub use null_space::NullSpace;

use super::LiftError;

/// One equation: `sum(terms) = rhs`.
#[derive(Debug, Clone, PartialEq)]
pub struct Row<T> {
    /// Unknown and coefficient, sorted by unknown, each unknown once.
    pub terms: Vec<(usize, f64)>,
    /// Right-hand side.
    pub rhs: f64,
    /// Weight of the residual: the reciprocal of the error that is expected of it. Residuals are
    /// weighed in both norms, in least squares before they are squared.
    pub weight: f64,
    /// What the row stands for.
    pub tag: T,
}

impl<T> Row<T> {
    /// Left-hand side minus right-hand side at `x`, not weighted.
    pub fn residual(&self, x: &[f64]) -> f64 {
        self.terms.iter().map(|&(i, c)| c * x[i]).sum::<f64>() - self.rhs
    }
}

/// Squared singular value, as a share of the largest, that is never left open.
const MOST_OPEN: f64 = 2e-8;

/// A list of rows over a fixed number of unknowns.
///
/// ```
/// use faceformer::lift::system::System;
///
/// let mut system = System::new(3);
/// system.push([(0, 1.0), (1, -1.0)], 2.0, 1.0, "edge 1");
/// system.push([(1, 1.0)], 0.5, 1.0, "gauge");
/// let solution = system.least_squares()?;
/// assert!((solution.x[0] - 2.5).abs() < 1e-9);
/// assert!(solution.null_space.is_free(2) && !solution.null_space.is_free(0));
/// # Ok::<(), faceformer::lift::LiftError>(())
/// ```
#[derive(Debug, Clone)]
pub struct System<T> {
    unknowns: usize,
    rows: Vec<Row<T>>,
    /// Unknowns with their least values; the L1 norm alone heeds them.
    floors: Vec<(usize, f64)>,
    /// Unknowns with their sum; the L1 norm alone heeds it.
    total: Option<(Vec<usize>, f64)>,
    /// How much rows may say of a direction that counts as left open, see [`Self::blur`].
    open: f64,
}

/// What a solve gives.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Value of every unknown; unknowns that the rows leave free have a small arbitrary value.
    pub x: Vec<f64>,
    /// Residual of every row, not weighted.
    pub residuals: Vec<f64>,
    /// What the rows leave open.
    pub null_space: NullSpace,
}

impl Solution {
    /// Largest absolute weighted residual.
    pub fn worst<T>(&self, system: &System<T>) -> f64 {
        self.residuals
            .iter()
            .zip(system.rows())
            .map(|(r, row)| (r * row.weight).abs())
            .fold(0.0, f64::max)
    }
}

impl<T> System<T> {
    /// A system without rows.
    pub const fn new(unknowns: usize) -> Self {
        Self {
            unknowns,
            rows: Vec::new(),
            floors: Vec::new(),
            total: None,
            open: normal::EPS,
        }
    }

    /// Number of unknowns.
    pub const fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Adds an unknown and returns its index.
    pub const fn add_unknown(&mut self) -> usize {
        self.unknowns += 1;
        self.unknowns - 1
    }

    /// Takes all [`blur`](Self::blur) back.
    pub const fn sharpen(&mut self) {
        self.open = normal::EPS;
    }

    /// Makes what counts as left open 10 times more, in squared singular values, and says whether
    /// that is sensible still: rows without right-hand sides that disagree by their errors say of a
    /// loose part that all of it is zero.
    pub fn blur(&mut self) -> bool {
        self.open *= 10.0;
        self.open < MOST_OPEN
    }

    /// Keeps an unknown from falling below a value in the L1 norm; least squares does not heed it.
    pub fn bound_below(&mut self, unknown: usize, least: f64) {
        self.floors.push((unknown, least));
    }

    /// Fixes the sum of some unknowns in the L1 norm, where homogeneous rows would else be least at
    /// zero; least squares does not heed it.
    pub fn fix_sum(&mut self, unknowns: Vec<usize>, sum: f64) {
        self.total = Some((unknowns, sum));
    }

    /// The rows.
    pub fn rows(&self) -> &[Row<T>] {
        &self.rows
    }

    /// The rows, to change weights or right-hand sides.
    pub fn rows_mut(&mut self) -> &mut [Row<T>] {
        &mut self.rows
    }

    /// Adds a row; terms of the same unknown are summed. A row that names an unknown that is not
    /// there, or holds a number that is not finite, is refused by the solvers.
    pub fn push(
        &mut self,
        terms: impl IntoIterator<Item = (usize, f64)>,
        rhs: f64,
        weight: f64,
        tag: T,
    ) {
        let mut sorted: Vec<(usize, f64)> = terms.into_iter().collect();
        sorted.sort_unstable_by_key(|t| t.0);
        sorted.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        self.rows.push(Row {
            terms: sorted,
            rhs,
            weight,
            tag,
        });
    }

    /// Keeps the rows that `keep` accepts.
    pub fn retain(&mut self, keep: impl FnMut(&Row<T>) -> bool) {
        self.rows.retain(keep);
    }

    /// Least squares over all rows, with their null space.
    ///
    /// # Errors
    /// [`LiftError::Solver`] if a row is malformed or the factorisation breaks down.
    pub fn least_squares(&self) -> Result<Solution, LiftError> {
        let all = vec![true; self.rows.len()];
        let x = self.minimise(&all)?;
        Ok(self.solution(x, normal::null_space(self, &all)?))
    }

    /// Least-squares solution over the rows that `active` marks, one entry a row.
    ///
    /// # Errors
    /// As [`least_squares`](Self::least_squares).
    pub fn minimise(&self, active: &[bool]) -> Result<Vec<f64>, LiftError> {
        self.check()?;
        normal::solve(self, active)
    }

    /// The pattern of the rows that `active` marks, for [`minimise_as`](Self::minimise_as).
    ///
    /// # Errors
    /// [`LiftError::Solver`] if a row names an unknown that there is not.
    pub(crate) fn pattern(&self, active: &[bool]) -> Result<Pattern, LiftError> {
        self.check()?;
        Pattern::new(self, active)
    }

    /// As [`minimise`](Self::minimise), with the pattern of these rows or of a system whose rows
    /// name the same unknowns: much of the work is done then.
    ///
    /// # Errors
    /// As [`minimise`](Self::minimise), and [`LiftError::Solver`] for a pattern of other rows.
    pub(crate) fn minimise_as(
        &self,
        active: &[bool],
        pattern: &Pattern,
    ) -> Result<Vec<f64>, LiftError> {
        self.check()?;
        normal::solve_as(self, active, pattern)
    }

    /// The null space of all rows alone; weights play no part in it.
    ///
    /// # Errors
    /// As [`least_squares`](Self::least_squares).
    pub fn null_space(&self) -> Result<NullSpace, LiftError> {
        self.null_space_of(&vec![true; self.rows.len()])
    }

    /// The null space of the rows that `active` marks.
    ///
    /// # Errors
    /// As [`least_squares`](Self::least_squares).
    pub fn null_space_of(&self, active: &[bool]) -> Result<NullSpace, LiftError> {
        self.check()?;
        normal::null_space(self, active)
    }

    /// Least sum of weighted absolute residuals (paper, section 5.1), by Clarabel. Rows that are
    /// wrong end with a residual and leave the others alone, as long as the others outnumber them.
    ///
    /// # Errors
    /// [`LiftError::Solver`] if a row is malformed or the solver gives up.
    pub fn least_absolute(&self) -> Result<Solution, LiftError> {
        let null_space = self.null_space()?;
        let x = l1::solve(self)?;
        Ok(self.solution(x, null_space))
    }

    /// Residual of every row at `x`, not weighted.
    pub fn residuals(&self, x: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|r| r.residual(x)).collect()
    }

    fn solution(&self, x: Vec<f64>, null_space: NullSpace) -> Solution {
        Solution {
            residuals: self.residuals(&x),
            x,
            null_space,
        }
    }

    fn check(&self) -> Result<(), LiftError> {
        let bad = self.rows.iter().position(|row| {
            let sound = row.rhs.is_finite() && row.weight.is_finite() && row.weight >= 0.0;
            !sound
                || row
                    .terms
                    .iter()
                    .any(|&(i, c)| i >= self.unknowns || !c.is_finite())
        });
        bad.map_or(Ok(()), |row| {
            Err(LiftError::Solver(format!(
                "row {row} is malformed: a number is not finite or an unknown is not there"
            )))
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A chain of n unknowns with known steps: one free offset.
    fn chain(steps: &[f64]) -> System<usize> {
        let mut system = System::new(steps.len() + 1);
        for (i, &s) in steps.iter().enumerate() {
            system.push([(i + 1, 1.0), (i, -1.0)], s, 1.0, i);
        }
        system
    }

    #[test]
    fn chain_leaves_one_offset_free() {
        let system = chain(&vec![0.25; 400]);
        let solution = system.least_squares().unwrap();
        assert_eq!(solution.null_space.dimension(), 1);
        assert!(solution.null_space.is_free(17));
        assert!(solution.null_space.are_tied(0, 400));
        assert!((solution.x[400] - solution.x[0] - 100.0).abs() < 1e-6);
    }

    #[test]
    fn parts_that_share_no_row_are_not_tied() {
        let mut system = chain(&[1.0; 6]);
        system.retain(|row| row.tag != 3);
        let null = system.null_space().unwrap();
        assert_eq!(null.dimension(), 2);
        assert!(null.are_tied(0, 3) && null.are_tied(4, 6) && !null.are_tied(3, 4));
        assert!(!null.leaves_open(&[(5, 1.0), (6, -1.0)]));
        assert!(null.leaves_open(&[(2, 1.0), (6, -1.0)]));
    }

    #[test]
    fn an_unknown_without_rows_is_free() {
        let mut system = System::new(2);
        system.push([(0, 2.0)], 3.0, 1.0, ());
        let solution = system.least_squares().unwrap();
        assert!((solution.x[0] - 1.5).abs() < 1e-9);
        assert!(solution.null_space.is_free(1) && !solution.null_space.is_free(0));
        assert_eq!(System::<()>::new(0).null_space().unwrap().dimension(), 0);
    }

    #[test]
    fn small_features_are_not_taken_for_null_space() {
        // A plane through three points 1e-3 apart is determined, through three on a line is not.
        for (p, dimension) in [([1e-3, 1e-3], 0), ([2e-3, 0.0], 1)] {
            let mut system = System::new(3);
            for [x, y] in [[0.0, 0.0], [1e-3, 0.0], p] {
                system.push([(0, x), (1, y), (2, 1.0)], 0.3 * x + 0.7 * y, 1.0, ());
            }
            let solution = system.least_squares().unwrap();
            assert_eq!(solution.null_space.dimension(), dimension);
            assert!((solution.x[0] - 0.3).abs() < 1e-6);
        }
    }

    #[test]
    fn l1_isolates_a_wrong_row() {
        let mut system = chain(&[1.0; 5]);
        system.push([(0, 1.0)], 0.0, 1.0, 5);
        system.push([(5, 1.0)], 5.0, 1.0, 6);
        system.push([(2, 1.0), (0, -1.0)], 2.0, 1.0, 7);
        system.push([(3, 1.0)], 7.0, 1.0, 8);
        let solution = system.least_absolute().unwrap();
        for (row, r) in system.rows().iter().zip(&solution.residuals) {
            let expected = if row.tag == 8 { -4.0 } else { 0.0 };
            assert!((r - expected).abs() < 1e-6, "row {}: {r}", row.tag);
        }
    }

    #[test]
    fn malformed_rows_are_refused() {
        let mut system = System::new(1);
        system.push([(1, 1.0)], 0.0, 1.0, ());
        assert!(matches!(
            system.least_squares(),
            Err(LiftError::Solver(message)) if message.contains("row 0")
        ));
        let mut system = System::new(1);
        system.push([(0, f64::NAN)], 0.0, 1.0, ());
        assert!(system.least_absolute().is_err());
    }

    proptest! {
        /// Consistent rows of full rank give back the unknowns they were made from, in both norms.
        #[test]
        fn consistent_rows_give_back_their_source(
            x in prop::collection::vec(-3.0..3.0f64, 4..8),
            c in prop::collection::vec(-1.0..1.0f64, 3 * 40),
            at in prop::collection::vec(0..1000usize, 3 * 40),
        ) {
            let n = x.len();
            let mut system = System::new(n);
            for i in 0..n {
                system.push([(i, 1.0), ((i + 1) % n, 0.5)], x[i] + 0.5 * x[(i + 1) % n], 1.0, ());
            }
            for k in 0..40 {
                let terms: Vec<_> = (0..3).map(|j| (at[3 * k + j] % n, c[3 * k + j])).collect();
                let rhs = terms.iter().map(|&(i, c)| c * x[i]).sum();
                system.push(terms, rhs, 2.0, ());
            }
            for solution in [system.least_squares().unwrap(), system.least_absolute().unwrap()] {
                prop_assert_eq!(solution.null_space.dimension(), 0);
                for (a, b) in solution.x.iter().zip(&x) {
                    prop_assert!((a - b).abs() < 1e-6);
                }
            }
        }
    }
}
