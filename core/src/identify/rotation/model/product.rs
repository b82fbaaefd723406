//! Products of small matrices on the calling thread, by the processor's widest arithmetic.
//!
//! candle's own count the machine's cores anew for each product, which can take longer than it does,
//! and rearrange the weights each time.

use pulp::{Arch, Simd, WithSimd};

/// Rows of a tile, whose sums are kept in registers.
const ROWS: usize = 6;

/// Columns of a panel, which tiles of any processor divide.
pub(super) const PANEL: usize = 32;

/// Least multiple of [`PANEL`] that holds so many columns.
pub(super) const fn padded(columns: usize) -> usize {
    columns.next_multiple_of(PANEL)
}

/// Rows of numbers that follow each other at a distance.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    pub(super) values: &'a [f32],
    pub(super) stride: usize,
}

impl<'a> Rows<'a> {
    fn row(&self, index: usize) -> &'a [f32] {
        &self.values[index * self.stride..]
    }
}

/// Writes the product of `left` and `right` to rows of `columns` numbers at a distance: `to` are the
/// numbers and the distance. `right` comes in panels of [`PANEL`] columns, the last one filled up, and
/// has `depth` rows.
///
/// # Panics
/// If there are fewer numbers.
pub(super) fn product(
    left: Rows<'_>,
    right: &[f32],
    depth: usize,
    to: (&mut [f32], usize),
    columns: usize,
) {
    let (to, stride) = to;
    Arch::new().dispatch(Product {
        left,
        right,
        depth,
        to,
        stride,
        columns,
    });
}

struct Product<'a> {
    left: Rows<'a>,
    right: &'a [f32],
    depth: usize,
    to: &'a mut [f32],
    stride: usize,
    columns: usize,
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let width = 2 * S::F32_LANES;
        let rows = self.to.len().div_ceil(self.stride);
        let mut left = vec![0.0; ROWS * self.depth];
        for first in (0..rows).step_by(ROWS) {
            let count = ROWS.min(rows - first);
            for r in 0..count {
                let row = &self.left.row(first + r)[..self.depth];
                let places = left.iter_mut().skip(r).step_by(ROWS);
                places.zip(row).for_each(|(place, x)| *place = *x);
            }
            for column in (0..self.columns).step_by(width) {
                let panel = &self.right[column / PANEL * PANEL * self.depth..];
                let sums = tile(simd, &left, panel, column % PANEL);
                let within = width.min(self.columns - column);
                for (r, sums) in sums.iter().enumerate().take(count) {
                    let to = &mut self.to[(first + r) * self.stride + column..][..within];
                    if within == width {
                        S::as_mut_simd_f32s(to).0.copy_from_slice(sums);
                    } else {
                        let mut whole = [0.0; PANEL];
                        S::as_mut_simd_f32s(&mut whole[..width])
                            .0
                            .copy_from_slice(sums);
                        to.copy_from_slice(&whole[..within]);
                    }
                }
            }
        }
    }
}

/// Sums of a tile: `left` holds its rows' numbers column by column, and its columns are those of a
/// panel from `column`.
#[inline(always)]
fn tile<S: Simd>(simd: S, left: &[f32], panel: &[f32], column: usize) -> [[S::f32s; 2]; ROWS] {
    let width = 2 * S::F32_LANES;
    let mut sums = [[simd.splat_f32s(0.0); 2]; ROWS];
    for (left, right) in left.chunks_exact(ROWS).zip(panel.chunks_exact(PANEL)) {
        let (right, _) = S::as_simd_f32s(&right[column..column + width]);
        let (a, b) = (right[0], right[1]);
        for (sums, x) in sums.iter_mut().zip(left) {
            let x = simd.splat_f32s(*x);
            sums[0] = simd.mul_add_e_f32s(x, a, sums[0]);
            sums[1] = simd.mul_add_e_f32s(x, b, sums[1]);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_all_shapes_are_those_by_definition() {
        let value = |i: usize| ((i * 37 + 11) % 17) as f32 - 8.0;
        for (rows, depth, columns) in [(1, 1, 1), (5, 7, 31), (6, 3, 32), (13, 40, 70), (2, 9, 0)] {
            let (from, to) = (depth + 2, columns + 3);
            let left: Vec<f32> = (0..rows * from).map(value).collect();
            let right: Vec<f32> = (0..depth * padded(columns)).map(value).collect();
            let mut found = vec![-1.0; rows * to];
            let left_rows = Rows {
                values: &left,
                stride: from,
            };
            product(left_rows, &right, depth, (&mut found, to), columns);
            let right = |k: usize, j: usize| right[(j / PANEL * depth + k) * PANEL + j % PANEL];
            for i in 0..rows {
                for j in 0..to {
                    let sum = (0..depth).map(|k| left[i * from + k] * right(k, j));
                    let expected = if j < columns { sum.sum() } else { -1.0 };
                    assert_eq!(
                        found[i * to + j],
                        expected,
                        "{i} {j} of {rows} {depth} {columns}"
                    );
                }
            }
        }
    }
}
