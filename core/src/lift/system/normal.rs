//! Least squares through scaled normal equations and a sparse Cholesky factor.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{Argsort, Pair, SparseColMat, SymbolicSparseColMat};
use faer::{Mat, Side};

use super::{LiftError, NullSpace, Row, System};
use crate::sets::Sets;

/// Added to the diagonal of the scaled normal matrix, whose diagonal is 1. A direction in which the
/// rows say less than this (a singular value below 3e-6 of the largest) counts as left open: data
/// rounded to 1e-6 of the size would give it an error of about the size.
pub(super) const EPS: f64 = 1e-11;

/// Steps of iterative refinement; each shrinks the error that `EPS` brings by the factor
/// `EPS / (EPS + eigenvalue)`.
const REFINEMENTS: usize = 3;

/// Steps of inverse iteration; each shrinks what is not null space by the same factor.
const INVERSE_STEPS: usize = 3;

/// Columns of the first block of inverse iteration; doubled while the null space fills it.
const BLOCK: usize = 6;

/// Length below which a vector of the iterated block is no null vector.
const NULL_LENGTH: f64 = 1e-3;

/// Where the normal matrix of a system has coefficients, and in which order its unknowns are
/// eliminated: the same for all systems whose rows name the same unknowns.
#[derive(Debug, Clone)]
pub(crate) struct Pattern {
    places: SymbolicSparseColMat<usize>,
    order: Argsort<usize>,
    /// Number of coefficients before those of one place are summed.
    count: usize,
    llt: SymbolicLlt<usize>,
}

impl Pattern {
    pub(super) fn new<T>(system: &System<T>, active: &[bool]) -> Result<Self, LiftError> {
        let n = system.unknowns();
        let mut pairs: Vec<_> = (0..n).map(|i| Pair::new(i, i)).collect();
        for row in used(system, active) {
            for (k, &(i, _)) in row.terms.iter().enumerate() {
                pairs.extend(row.terms[..=k].iter().map(|&(j, _)| Pair::new(i, j)));
            }
        }
        let (places, order) = SymbolicSparseColMat::try_new_from_indices(n, n, &pairs)
            .map_err(|e| LiftError::Solver(format!("{e:?}")))?;
        let llt = SymbolicLlt::try_new(places.as_ref(), Side::Lower)
            .map_err(|e| LiftError::Solver(format!("{e:?}")))?;
        Ok(Self {
            places,
            order,
            count: pairs.len(),
            llt,
        })
    }
}

/// Least-squares solution over the rows that `active` marks.
pub(super) fn solve<T>(system: &System<T>, active: &[bool]) -> Result<Vec<f64>, LiftError> {
    solve_as(system, active, &Pattern::new(system, active)?)
}

/// The same for a pattern that is known.
pub(super) fn solve_as<T>(
    system: &System<T>,
    active: &[bool],
    pattern: &Pattern,
) -> Result<Vec<f64>, LiftError> {
    let factor = Factor::new(system, active, pattern, EPS, |row| row.weight)?;
    let n = system.unknowns();
    let mut x = vec![0.0; n];
    for _ in 0..=REFINEMENTS {
        // Gradient of the sum of squares, in scaled unknowns.
        let mut g = Mat::<f64>::zeros(n, 1);
        for row in used(system, active) {
            let r = row.residual(&x) * row.weight * row.weight;
            for &(i, c) in &row.terms {
                g[(i, 0)] -= r * c * factor.scale[i];
            }
        }
        let step = factor.llt.solve(&g);
        for i in 0..n {
            x[i] += step[(i, 0)] * factor.scale[i];
        }
    }
    if !x.iter().all(|v| v.is_finite()) {
        return Err(LiftError::Solver("the solution is not finite".into()));
    }
    Ok(x)
}

/// Null space of the rows that `active` marks. Rows count alike here, whatever their weight: a weak
/// row determines as much as a strong one.
pub(super) fn null_space<T>(system: &System<T>, active: &[bool]) -> Result<NullSpace, LiftError> {
    let unit = |row: &Row<T>| {
        let square: f64 = row.terms.iter().map(|t| t.1 * t.1).sum();
        if square > 0.0 {
            square.sqrt().recip()
        } else {
            0.0
        }
    };
    let pattern = Pattern::new(system, active)?;
    let factor = Factor::new(system, active, &pattern, system.open, unit)?;
    Ok(factor.null_space(&groups(system, active)))
}

/// Unknowns that rows tie to each other, each group sorted.
fn groups<T>(system: &System<T>, active: &[bool]) -> Vec<Vec<usize>> {
    let mut sets = Sets::new(system.unknowns());
    for row in used(system, active) {
        for pair in row.terms.windows(2) {
            sets.join(pair[0].0, pair[1].0);
        }
    }
    sets.groups()
}

fn used<'a, T>(system: &'a System<T>, active: &'a [bool]) -> impl Iterator<Item = &'a Row<T>> {
    let rows = system.rows().iter().zip(active);
    rows.filter(|(row, used)| **used && row.weight > 0.0)
        .map(|(row, _)| row)
}

/// Factor of the scaled normal matrix.
struct Factor {
    llt: Llt<usize, f64>,
    /// Reciprocal column lengths of the weighted matrix; 1 for empty columns.
    scale: Vec<f64>,
    /// What was added to the diagonal.
    eps: f64,
}

impl Factor {
    fn new<T>(
        system: &System<T>,
        active: &[bool],
        pattern: &Pattern,
        eps: f64,
        weight: impl Fn(&Row<T>) -> f64,
    ) -> Result<Self, LiftError> {
        let n = system.unknowns();
        let mut diagonal = vec![0.0; n];
        for row in used(system, active) {
            for &(i, c) in &row.terms {
                diagonal[i] += (weight(row) * c).powi(2);
            }
        }
        let scale: Vec<f64> = diagonal
            .iter()
            .map(|&d| if d > 0.0 { d.sqrt().recip() } else { 1.0 })
            .collect();
        let mut values = Vec::with_capacity(pattern.count);
        values.resize(n, eps);
        for row in used(system, active) {
            let w = weight(row).powi(2);
            for (k, &(i, a)) in row.terms.iter().enumerate() {
                let scaled = w * a * scale[i];
                let lower = row.terms[..=k].iter();
                values.extend(lower.map(|&(j, b)| scaled * b * scale[j]));
            }
        }
        if values.len() != pattern.count {
            return Err(LiftError::Solver("the rows have another pattern".into()));
        }
        let matrix =
            SparseColMat::new_from_argsort(pattern.places.clone(), &pattern.order, &values)
                .map_err(|e| LiftError::Solver(format!("{e:?}")))?;
        let llt = Llt::try_new_with_symbolic(pattern.llt.clone(), matrix.as_ref(), Side::Lower)
            .map_err(|e| LiftError::Solver(format!("factorisation: {e:?}")))?;
        Ok(Self { llt, scale, eps })
    }

    /// Inverse iteration on a block of pseudo-random vectors: what survives is null space. Groups of
    /// unknowns that share no row have null spaces of their own, which one block shows.
    fn null_space(&self, groups: &[Vec<usize>]) -> NullSpace {
        let n = self.scale.len();
        let mut width = BLOCK.min(n);
        let mut bases = vec![Vec::new(); groups.len()];
        let mut open: Vec<usize> = (0..groups.len()).collect();
        while !open.is_empty() {
            let mut block = Mat::from_fn(n, width, noise);
            for _ in 0..INVERSE_STEPS {
                block = self.llt.solve(&block);
                block *= faer::Scale(self.eps);
            }
            open.retain(|&g| {
                bases[g] = independent_columns(&block, &groups[g]);
                bases[g].len() == width && width < groups[g].len()
            });
            width = (2 * width).min(n);
        }
        NullSpace::new(groups, &bases, &self.scale)
    }
}

/// Repeatable noise in [-1, 1]: the null space must not depend on chance.
fn noise(row: usize, column: usize) -> f64 {
    let mut h = (row as u64)
        .wrapping_mul(0x9E37_79B9_7F4A_7C15)
        .wrapping_add((column as u64 + 1).wrapping_mul(0xD1B5_4A32_D192_ED03));
    h = (h ^ (h >> 32)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    h = (h ^ (h >> 32)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    (h >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Orthonormal basis of the columns in some of their rows, by Gram-Schmidt with pivoting, twice for
/// accuracy.
fn independent_columns(block: &Mat<f64>, rows: &[usize]) -> Vec<Vec<f64>> {
    let mut left = Columns::new(block, rows);
    let mut basis: Vec<Vec<f64>> = Vec::new();
    while let Some(mut v) = left.take_longest() {
        for b in &basis {
            remove(&mut v, b);
        }
        let length = dot(&v, &v).sqrt();
        if length < NULL_LENGTH {
            break;
        }
        v.iter_mut().for_each(|c| *c /= length);
        left.remove(&v);
        basis.push(v);
    }
    basis
}

/// Columns side by side, so that what is done to all of them is done at once.
struct Columns {
    values: Vec<f64>,
    stride: usize,
    /// Squared length of each column that is left.
    squares: Vec<f64>,
}

impl Columns {
    fn new(block: &Mat<f64>, rows: &[usize]) -> Self {
        let stride = block.ncols();
        let places = rows.iter().flat_map(|&i| (0..stride).map(move |k| (i, k)));
        let mut columns = Self {
            values: places.map(|place| block[place]).collect(),
            stride,
            squares: vec![0.0; stride],
        };
        for row in columns.values.chunks_exact(stride) {
            let squares = columns.squares.iter_mut().zip(row);
            squares.for_each(|(sum, x)| *sum += x * x);
        }
        columns
    }

    /// Takes the longest column out; `None` if there is none.
    fn take_longest(&mut self) -> Option<Vec<f64>> {
        let squares = self.squares.iter().enumerate();
        let (longest, _) = squares.max_by(|a, b| a.1.total_cmp(b.1))?;
        self.squares.swap_remove(longest);
        let last = self.squares.len();
        let rows = self.values.chunks_exact_mut(self.stride);
        let take = |row: &mut [f64]| {
            row.swap(longest, last);
            row[last]
        };
        Some(rows.map(take).collect())
    }

    /// Takes what is along a unit vector out of all.
    fn remove(&mut self, unit: &[f64]) {
        let count = self.squares.len();
        let mut shares = vec![0.0; count];
        for (row, u) in self.values.chunks_exact(self.stride).zip(unit) {
            let sums = shares.iter_mut().zip(&row[..count]);
            sums.for_each(|(sum, x)| *sum += x * u);
        }
        self.squares.fill(0.0);
        for (row, u) in self.values.chunks_exact_mut(self.stride).zip(unit) {
            let columns = row[..count].iter_mut().zip(&shares);
            for ((x, share), square) in columns.zip(&mut self.squares) {
                *x -= share * u;
                *square += *x * *x;
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn remove(v: &mut [f64], unit: &[f64]) {
    let d = dot(v, unit);
    v.iter_mut().zip(unit).for_each(|(c, u)| *c -= d * u);
}
