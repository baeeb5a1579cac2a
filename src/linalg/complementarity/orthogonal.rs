//! Minimum-norm least squares by a complete orthogonal factorization, `A P = Q [T 0; 0 0] Z`.
//!
//! The answer `x = P Zᵀ [T⁻¹ (Qᵀ r); 0]` is the pseudo-inverse applied to `r`. It shares a load over
//! redundant contacts evenly, and noise that no multiplier can answer is projected out instead of being
//! divided by round-off. Householder reflections, columns pivoted (Golub and Van Loan, Matrix
//! Computations, 4th ed., §5.5.2).

use super::dense::{add_scaled, dot};

/// Scratch of the factorization.
#[derive(Debug, Clone, Default)]
pub(super) struct CompleteOrthogonal {
    order: Vec<usize>,
    column_norm: Vec<f64>,
    remaining: Vec<f64>,
    reflector: Vec<f64>,
    /// First entry and factor `2 / vᵀv` of each reflector of `Z`; the rest of it lies in the matrix.
    right: Vec<[f64; 2]>,
}

impl CompleteOrthogonal {
    /// Makes room for systems of up to `n` unknowns.
    pub fn reserve(&mut self, n: usize) {
        if self.order.len() < n {
            self.order.resize(n, 0);
            self.column_norm.resize(n, 0.0);
            self.remaining.resize(n, 0.0);
            self.reflector.resize(n, 0.0);
            self.right.resize(n, [0.0; 2]);
        }
    }

    /// Overwrites `x` with the minimum-norm least-squares solution; returns the rank.
    ///
    /// - `a`: the matrix, row-major, destroyed, shape `(n, n)`.
    /// - `x`: the right-hand side, then the solution, shape `(n)`.
    /// - `tolerance`: a column is dependent when less than this fraction of it is left.
    pub fn solve_in_place(&mut self, a: &mut [f64], x: &mut [f64], tolerance: f64) -> usize {
        let n = x.len();
        let rank = self.triangularize(a, x, tolerance);
        if rank < n {
            self.annihilate_right(a, n, rank);
        }
        for row in (0..rank).rev() {
            let line = &a[row * n..row * n + rank];
            x[row] = (x[row] - dot(&line[row + 1..], &x[row + 1..rank])) / line[row];
        }
        x[rank..].fill(0.0);
        if rank < n {
            for row in 0..rank {
                let tail = &a[row * n + rank..(row + 1) * n];
                let [head, factor] = self.right[row];
                let share = factor * (head * x[row] + dot(tail, &x[rank..]));
                x[row] -= share * head;
                add_scaled(&mut x[rank..], -share, tail);
            }
        }
        self.remaining[..n].copy_from_slice(x);
        for (position, &column) in self.order[..n].iter().enumerate() {
            x[column] = self.remaining[position];
        }
        rank
    }

    /// `Qᵀ A P` upper triangular in `a`, `Qᵀ r` in `x`; returns the rank.
    fn triangularize(&mut self, a: &mut [f64], x: &mut [f64], tolerance: f64) -> usize {
        let n = x.len();
        for (position, column) in self.order[..n].iter_mut().enumerate() {
            *column = position;
        }
        sum_squares(a, n, 0, &mut self.remaining[..n]);
        self.column_norm[..n].copy_from_slice(&self.remaining[..n]);
        for step in 0..n {
            if step > 0 {
                // summed afresh: downdated norms lose the digits that decide the rank
                sum_squares(a, n, step, &mut self.remaining[..n]);
            }
            let share = |column: usize| {
                let whole = self.column_norm[column];
                if whole > 0.0 {
                    self.remaining[column] / whole
                } else {
                    0.0
                }
            };
            let best = (step..n).fold(
                step,
                |best, c| if share(c) > share(best) { c } else { best },
            );
            let left = share(best);
            if left <= tolerance * tolerance || !left.is_finite() {
                return step;
            }
            if best != step {
                a.chunks_exact_mut(n).for_each(|line| line.swap(step, best));
                self.order.swap(step, best);
                self.column_norm.swap(step, best);
            }
            self.reflect_left(a, x, step);
        }
        n
    }

    /// Clears column `step` below the diagonal, with the same reflection of `x`.
    fn reflect_left(&mut self, a: &mut [f64], x: &mut [f64], step: usize) {
        let n = x.len();
        let reflector = &mut self.reflector[step..n];
        for (value, line) in reflector.iter_mut().zip(a[step * n..].chunks_exact(n)) {
            *value = line[step];
        }
        let norm = dot(reflector, reflector).sqrt();
        let diagonal = if reflector[0] > 0.0 { -norm } else { norm };
        reflector[0] -= diagonal;
        let factor = 2.0 / dot(reflector, reflector);
        let shares = &mut self.remaining[step..n];
        shares.fill(0.0);
        for (&value, line) in reflector.iter().zip(a[step * n..].chunks_exact(n)) {
            add_scaled(shares, factor * value, &line[step..]);
        }
        for (&value, line) in reflector.iter().zip(a[step * n..].chunks_exact_mut(n)) {
            add_scaled(&mut line[step..], -value, shares);
        }
        a[step * n + step] = diagonal;
        let share = factor * dot(reflector, &x[step..]);
        add_scaled(&mut x[step..], -share, reflector);
    }

    /// Clears the columns beyond the rank by reflections from the right, last row first.
    fn annihilate_right(&mut self, a: &mut [f64], n: usize, rank: usize) {
        for row in (0..rank).rev() {
            let (above, rest) = a.split_at_mut(row * n);
            let line = &mut rest[..n];
            let square = dot(&line[rank..], &line[rank..]);
            let norm = (line[row] * line[row] + square).sqrt();
            let diagonal = if line[row] > 0.0 { -norm } else { norm };
            let head = line[row] - diagonal;
            let length = head * head + square;
            let factor = if length > 0.0 { 2.0 / length } else { 0.0 };
            line[row] = diagonal;
            self.right[row] = [head, factor];
            let tail = &line[rank..];
            for other in above.chunks_exact_mut(n) {
                let share = factor * (head * other[row] + dot(tail, &other[rank..]));
                other[row] -= share * head;
                add_scaled(&mut other[rank..], -share, tail);
            }
        }
    }
}

/// The sums of squares of the columns `first..n`, over the rows `first..n`.
fn sum_squares(a: &[f64], n: usize, first: usize, sums: &mut [f64]) {
    sums[first..].fill(0.0);
    for line in a[first * n..].chunks_exact(n) {
        for (sum, value) in sums[first..].iter_mut().zip(&line[first..]) {
            *sum += value * value;
        }
    }
}
