//! The L1 norm through Clarabel: minimise `sum(t)` with `-t <= W (A x - b) <= t` and what
//! is fixed of the unknowns.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};

use super::{LiftError, System};

/// Quadratic pull of the unknowns towards zero, so that free unknowns stay bounded; far below the
/// slope 1 of the absolute values.
const PULL: f64 = 1e-9;

pub(super) fn solve<T>(system: &System<T>) -> Result<Vec<f64>, LiftError> {
    let n = system.unknowns();
    let rows: Vec<_> = system.rows().iter().filter(|r| r.weight > 0.0).collect();
    if n == 0 || rows.is_empty() {
        return Ok(vec![0.0; n]);
    }
    // Weights are reciprocal errors and may be large; their common factor changes nothing.
    let top = rows.iter().map(|r| r.weight).fold(0.0, f64::max);
    let m = rows.len();
    let (mut at_row, mut at_column, mut values) = (Vec::new(), Vec::new(), Vec::new());
    let mut entry = |row: usize, column: usize, value: f64| {
        at_row.push(row);
        at_column.push(column);
        values.push(value);
    };
    let mut rhs = vec![0.0; 2 * m];
    for (k, row) in rows.iter().enumerate() {
        let w = row.weight / top;
        for &(i, c) in &row.terms {
            entry(k, i, w * c);
            entry(m + k, i, -w * c);
        }
        entry(k, n + k, -1.0);
        entry(m + k, n + k, -1.0);
        rhs[k] = w * row.rhs;
        rhs[m + k] = -w * row.rhs;
    }
    let floors = system.floors.len();
    for (k, &(i, least)) in system.floors.iter().enumerate() {
        entry(2 * m + k, i, -1.0);
        rhs.push(-least);
    }
    let mut count = 2 * m + floors;
    let mut cones = vec![NonnegativeConeT(count)];
    if let Some((unknowns, sum)) = &system.total {
        unknowns.iter().for_each(|&i| entry(count, i, 1.0));
        rhs.push(*sum);
        cones.push(ZeroConeT(1));
        count += 1;
    }
    let constraints = CscMatrix::new_from_triplets(count, n + m, at_row, at_column, values);
    let quadratic = CscMatrix::new_from_triplets(
        n + m,
        n + m,
        (0..n).collect(),
        (0..n).collect(),
        vec![PULL; n],
    );
    let mut cost = vec![0.0; n + m];
    cost[n..].fill(1.0);
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .build()
        .map_err(|e| LiftError::Solver(e.to_string()))?;
    let mut solver = DefaultSolver::new(&quadratic, &cost, &constraints, &rhs, &cones, settings)
        .map_err(|e| LiftError::Solver(e.to_string()))?;
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => Ok(solver.solution.x[..n].to_vec()),
        status => Err(LiftError::Solver(format!("Clarabel ended with {status}"))),
    }
}
