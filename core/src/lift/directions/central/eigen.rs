//! Eigenvectors of small symmetric matrices.

use glam::{DMat3, DVec3};

/// Sweeps of rotations; each one about squares what is left off the diagonal.
const SWEEPS: usize = 8;

/// Eigenvalues, smallest first, with unit eigenvectors (Jacobi 1846: plane rotations).
pub(super) fn symmetric(m: DMat3) -> [(f64, DVec3); 3] {
    let mut a = m.to_cols_array_2d();
    let mut v = DMat3::IDENTITY.to_cols_array_2d();
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let ratio = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
            let t = if ratio == 0.0 { 1.0 } else { t };
            let c = t.hypot(1.0).recip();
            let s = t * c;
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
                (v[p][k], v[q][k]) = (c * v[p][k] - s * v[q][k], s * v[p][k] + c * v[q][k]);
            }
        }
    }
    let mut found = [0, 1, 2].map(|k| (a[k][k], DVec3::from_array(v[k])));
    found.sort_by(|x, y| x.0.total_cmp(&y.0));
    found
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn eigenvectors_are_found(
            values in prop::array::uniform3(-2.0..2.0f64),
            turn in prop::array::uniform3(-3.0..3.0f64),
        ) {
            let turn = DMat3::from_quat(DQuat::from_scaled_axis(DVec3::from_array(turn)));
            let m = turn * DMat3::from_diagonal(DVec3::from_array(values)) * turn.transpose();
            let found = symmetric(m);
            for (value, vector) in found {
                prop_assert!((m * vector).distance(vector * value) < 1e-12);
                prop_assert!((vector.length() - 1.0).abs() < 1e-12);
            }
            prop_assert!(found[0].0 <= found[1].0 && found[1].0 <= found[2].0);
        }
    }
}
