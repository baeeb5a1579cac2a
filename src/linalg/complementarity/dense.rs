//! Direct solves of small dense systems `A x = r`: Cholesky if `A` is symmetric, LU with pivoting if not.
//!
//! Matrices are row-major and are overwritten. Both factorizations stop, and say so, when a pivot has
//! lost all but a fraction `tolerance` of its own size: the matrix is then singular in working precision.

use faer::traits::pulp::{Arch, Simd, WithSimd};

/// The scalar product, summed in eight lanes so that it runs at the speed of memory.
#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 8];
    let (a_blocks, b_blocks) = (a.chunks_exact(8), b.chunks_exact(8));
    let tail: f64 = a_blocks
        .remainder()
        .iter()
        .zip(b_blocks.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in a_blocks.zip(b_blocks) {
        for lane in 0..8 {
            lanes[lane] += x[lane] * y[lane];
        }
    }
    lanes.iter().sum::<f64>() + tail
}

/// Adds `factor * x` to `y`.
#[inline(always)]
pub(super) fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// Overwrites the lower triangle of `a` with `L`, `A = L Lᵀ`; false if `A` is singular or indefinite.
pub(crate) fn factorize_cholesky(a: &mut [f64], n: usize, tolerance: f64) -> bool {
    Arch::new().dispatch(Factorize { a, n, tolerance })
}

/// Rows that are factorized side by side: their chains of additions and divisions do not wait for each other.
const ROWS: usize = 4;

/// The factorization, as a task for one instruction set; all give the same bits.
struct Factorize<'a> {
    a: &'a mut [f64],
    n: usize,
    tolerance: f64,
}

impl WithSimd for Factorize<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        let Self { a, n, tolerance } = self;
        for first in (0..n).step_by(ROWS) {
            let (above, rest) = a.split_at_mut(first * n);
            let own = &mut rest[..ROWS.min(n - first) * n];
            for column in 0..first {
                let other = &above[column * n..=column * n + column];
                for line in own.chunks_exact_mut(n) {
                    let sum = line[column] - dot(&line[..column], &other[..column]);
                    line[column] = sum / other[column];
                }
            }
            if !factorize_rows(own, n, first, tolerance) {
                return false;
            }
        }
        true
    }
}

/// Finishes some rows whose entries before column `first` are those of `L`.
#[inline(always)]
fn factorize_rows(own: &mut [f64], n: usize, first: usize, tolerance: f64) -> bool {
    for index in 0..own.len() / n {
        let row = first + index;
        let (before, rest) = own.split_at_mut(index * n);
        let current = &mut rest[..n];
        for (column, other) in (first..row).zip(before.chunks_exact(n)) {
            let sum = current[column] - dot(&current[..column], &other[..column]);
            current[column] = sum / other[column];
        }
        let pivot = current[row] - dot(&current[..row], &current[..row]);
        if pivot <= tolerance * current[row] || !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        current[row] = pivot.sqrt();
    }
    true
}

/// Overwrites the right-hand side `x` with the solution, from the factor of [`factorize_cholesky`].
pub(crate) fn solve_cholesky_in_place(a: &[f64], n: usize, x: &mut [f64]) {
    for row in 0..n {
        let line = &a[row * n..row * n + row + 1];
        x[row] = (x[row] - dot(&line[..row], &x[..row])) / line[row];
    }
    for row in (0..n).rev() {
        let line = &a[row * n..row * n + row + 1];
        let (before, current) = x.split_at_mut(row);
        current[0] /= line[row];
        add_scaled(before, -current[0], &line[..row]);
    }
}

/// Overwrites `a` with its LU factors and `x` with the solution; false if `A` is singular.
///
/// Rows are first divided by their largest entry, because contacts mix grams with tonnes.
///
/// - `column_size`: scratch, shape `(n)`.
pub(crate) fn solve_lu_in_place(
    a: &mut [f64],
    x: &mut [f64],
    column_size: &mut [f64],
    tolerance: f64,
) -> bool {
    let n = x.len();
    if !equilibrate_rows(a, x, column_size) {
        return false;
    }
    for step in 0..n {
        let size = |row: usize| a[row * n + step].abs();
        let pivot_row = (step..n).fold(
            step,
            |best, row| if size(row) > size(best) { row } else { best },
        );
        let pivot_size = size(pivot_row);
        if pivot_size <= tolerance * column_size[step] || !pivot_size.is_finite() {
            return false;
        }
        if pivot_row != step {
            let (upper, lower) = a.split_at_mut(pivot_row * n);
            upper[step * n..(step + 1) * n].swap_with_slice(&mut lower[..n]);
            x.swap(step, pivot_row);
        }
        let (done, below) = a.split_at_mut((step + 1) * n);
        let pivot = &done[step * n..];
        for (offset, line) in below.chunks_exact_mut(n).enumerate() {
            let factor = line[step] / pivot[step];
            if factor != 0.0 {
                add_scaled(&mut line[step + 1..], -factor, &pivot[step + 1..]);
                x[step + 1 + offset] -= factor * x[step];
            }
        }
    }
    for row in (0..n).rev() {
        let line = &a[row * n..(row + 1) * n];
        x[row] = (x[row] - dot(&line[row + 1..], &x[row + 1..])) / line[row];
    }
    true
}

/// Divides each row by its largest entry and measures the columns; false if a row is zero.
fn equilibrate_rows(a: &mut [f64], x: &mut [f64], column_size: &mut [f64]) -> bool {
    let n = x.len();
    column_size[..n].fill(0.0);
    for (line, x) in a.chunks_exact_mut(n).zip(x) {
        let largest = line
            .iter()
            .fold(0.0_f64, |largest, value| largest.max(value.abs()));
        if largest == 0.0 {
            return false;
        }
        *x /= largest;
        for (value, size) in line.iter_mut().zip(column_size.iter_mut()) {
            *value /= largest;
            *size = size.max(value.abs());
        }
    }
    true
}
