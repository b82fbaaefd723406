//! The small dense linear algebra of conic fitting.

use glam::DMat3;
use glam::DVec3;

/// Upper triangle of the QR decomposition of a tall matrix given by rows, by Householder
/// reflections: the rows' scalar products without squaring their condition number.
///
/// The rows are overwritten; there must be at least six.
pub(super) fn triangle(rows: &mut [[f64; 6]]) -> [[f64; 6]; 6] {
    for k in 0..6 {
        let norm = rows[k..].iter().map(|r| r[k] * r[k]).sum::<f64>().sqrt();
        let alpha = if rows[k][k] > 0.0 { -norm } else { norm };
        // The reflector v is column k below the diagonal, with its first entry v0 apart.
        let v0 = rows[k][k] - alpha;
        let vv = norm * norm - alpha * rows[k][k];
        if vv > 0.0 {
            let mut dots = [0.0; 6];
            for (i, row) in rows[k..].iter().enumerate() {
                let v = if i == 0 { v0 } else { row[k] };
                for j in k + 1..6 {
                    dots[j] += v * row[j];
                }
            }
            for (i, row) in rows[k..].iter_mut().enumerate() {
                let v = if i == 0 { v0 } else { row[k] };
                for j in k + 1..6 {
                    row[j] -= dots[j] / vv * v;
                }
            }
        }
        rows[k][k] = alpha;
    }
    let mut upper = [[0.0; 6]; 6];
    for (k, row) in upper.iter_mut().enumerate() {
        row[k..].copy_from_slice(&rows[k][k..]);
    }
    upper
}

/// Singular values (largest first) and right singular vectors (columns) by one-sided Jacobi
/// rotations (Hestenes 1958), accurate for small singular values too.
pub(super) fn singular(mut a: DMat3) -> (DVec3, DMat3) {
    let mut v = DMat3::IDENTITY;
    for _ in 0..30 {
        let mut turned = false;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let (x, y) = (a.col(p), a.col(q));
            let dot = x.dot(y);
            if dot.abs() <= 1e-15 * x.length() * y.length() {
                continue;
            }
            turned = true;
            let (c, s) = rotation(dot, x.length_squared(), y.length_squared());
            *a.col_mut(p) = x * c - y * s;
            *a.col_mut(q) = x * s + y * c;
            let (x, y) = (v.col(p), v.col(q));
            *v.col_mut(p) = x * c - y * s;
            *v.col_mut(q) = x * s + y * c;
        }
        if !turned {
            break;
        }
    }
    let mut order = [0, 1, 2];
    let norms = [0, 1, 2].map(|i| a.col(i).length());
    order.sort_by(|&i, &j| norms[j].total_cmp(&norms[i]));
    let [i, j, k] = order;
    (
        DVec3::new(norms[i], norms[j], norms[k]),
        DMat3::from_cols(v.col(i), v.col(j), v.col(k)),
    )
}

/// The eigenvector of the largest eigenvalue of a symmetric matrix, by Jacobi rotations.
pub(super) fn top_eigenvector(mut a: DMat3) -> DVec3 {
    let mut v = DMat3::IDENTITY;
    for _ in 0..30 {
        let scale = a.col(0).length() + a.col(1).length() + a.col(2).length();
        let mut turned = false;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = a.col(p)[q];
            if off.abs() <= 1e-16 * scale {
                continue;
            }
            turned = true;
            let (c, s) = rotation(off, a.col(p)[p], a.col(q)[q]);
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = c;
            turn.col_mut(q)[q] = c;
            turn.col_mut(q)[p] = s;
            turn.col_mut(p)[q] = -s;
            a = turn.transpose() * a * turn;
            v *= turn;
        }
        if !turned {
            break;
        }
    }
    let top = (0..3).fold(0, |b, i| if a.col(i)[i] > a.col(b)[b] { i } else { b });
    v.col(top)
}

/// Cosine and sine of the rotation that makes `[[pp, off], [off, qq]]` diagonal.
fn rotation(off: f64, pp: f64, qq: f64) -> (f64, f64) {
    let theta = (qq - pp) / (2.0 * off);
    let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    (c, c * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn matrix() -> impl Strategy<Value = DMat3> {
        prop::array::uniform9(-1.0..1.0f64).prop_map(|m| DMat3::from_cols_array(&m))
    }

    proptest! {
        #[test]
        fn singular_values_rebuild_the_matrix(m in matrix()) {
            let (s, v) = singular(m);
            prop_assert!(s.x >= s.y && s.y >= s.z && s.z >= 0.0);
            let gram = v * DMat3::from_diagonal(s * s) * v.transpose();
            prop_assert!(gram.abs_diff_eq(m.transpose() * m, 1e-12));
            prop_assert!((v.transpose() * v).abs_diff_eq(DMat3::IDENTITY, 1e-12));
        }

        #[test]
        fn top_eigenvector_maximises_the_form(m in matrix(), x in prop::array::uniform3(-1.0..1.0f64)) {
            let m = m + m.transpose();
            let v = top_eigenvector(m);
            let x = DVec3::from(x).normalize_or(DVec3::X);
            prop_assert!((v.length() - 1.0).abs() < 1e-12);
            prop_assert!(v.dot(m * v) >= x.dot(m * x) - 1e-12);
        }

        #[test]
        fn triangle_keeps_scalar_products(
            rows in prop::collection::vec(prop::array::uniform6(-1.0..1.0f64), 6..12)
        ) {
            let upper = triangle(&mut rows.clone());
            for i in 0..6 {
                for j in 0..6 {
                    let dot = |m: &[[f64; 6]]| m.iter().map(|r| r[i] * r[j]).sum::<f64>();
                    prop_assert!((dot(&rows) - dot(&upper)).abs() < 1e-12);
                }
            }
        }
    }
}
