//! Small dense systems.

/// Solution of a small symmetric system (Gaussian elimination with pivots); `None` if singular.
pub(super) fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let n = right.len();
    let trace: f64 = (0..n).map(|i| matrix[i][i].abs()).sum();
    for k in 0..n {
        let pivot = (k..n).max_by(|&a, &b| matrix[a][k].abs().total_cmp(&matrix[b][k].abs()))?;
        if matrix[pivot][k].abs() <= 1e-13 * trace {
            return None;
        }
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        for i in k + 1..n {
            let (above, below) = matrix.split_at_mut(i);
            let (own, row) = (&above[k], &mut below[0]);
            let share = row[k] / own[k];
            for (x, y) in row.iter_mut().zip(own).skip(k) {
                *x -= share * y;
            }
            right[i] -= share * right[k];
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let rest: f64 = (k + 1..n).map(|j| matrix[k][j] * x[j]).sum();
        x[k] = (right[k] - rest) / matrix[k][k];
    }
    Some(x)
}
