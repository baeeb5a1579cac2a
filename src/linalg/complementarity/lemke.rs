//! The last fallback: Lemke's pivoting on `z >= 0`, `q + M z >= 0`, `zᵀ (q + M z) = 0`.
//!
//! Friction is put as a complementarity problem in the way of Stewart and Trinkle (1996): with
//! `p_t = f⁺ - f⁻` and a slip speed `s`, `w_t + s ⊥ f⁺`, `-w_t + s ⊥ f⁻`, `mu p_n - f⁺ - f⁻ ⊥ s`, which in
//! the plane is exact. For `W` positive semidefinite the matrix is copositive, and Lemke's method with
//! lexicographic ratios ends at a solution whenever `b` lies in the range of `W`, at any coefficient of
//! friction. Otherwise it may end on a ray, and nothing is offered. (Cottle, Pang and Stone, The Linear
//! Complementarity Problem, §4.4 and §4.9.)

use super::dense::add_scaled;
use super::problem::{Checked, RowKind};
use crate::math::rounding;
use faer::traits::pulp::{Arch, Simd, WithSimd};

/// Entries below this are no pivots; the tableau is scaled to unit diagonal.
const SMALLEST_PIVOT: f64 = rounding::SOLVED;
/// Ratios closer than this are equal.
const TIE: f64 = rounding::SUM;
/// Problems with more nonnegative unknowns than this are left to the other solvers.
const MAX_UNKNOWNS: usize = 480;

/// A nonnegative unknown.
#[derive(Debug, Clone, Copy)]
enum Unknown {
    /// Adds `sign * z` to the scaled multiplier of the row.
    Force { row: usize, sign: f64 },
    /// The slip speed of a friction row, or the speed beyond the upper bound of a box row.
    Speed { row: usize },
}

/// Scratch of the tableau.
#[derive(Debug, Clone, Default)]
pub(super) struct Lemke {
    unknowns: Vec<Unknown>,
    /// Rows `[B⁻¹ | z | z_0 | q]`, row-major, shape `(n, 2 n + 2)`.
    tableau: Vec<f64>,
    basis: Vec<usize>,
    pivot_row: Vec<f64>,
    ties: Vec<usize>,
    /// `p` where every `z` is zero.
    offset: Vec<f64>,
}

impl Lemke {
    /// Writes a solution into `multipliers`; false (and nothing written) if none came in sight.
    ///
    /// - `attempt`: another number takes another path, for when round-off has spoilt the last one.
    /// - `n_pivots`: counts the pivots of the tableau, each `O(n²)`.
    pub fn solve(
        &mut self,
        problem: Checked,
        attempt: usize,
        multipliers: &mut [f64],
        n_pivots: &mut usize,
    ) -> bool {
        self.list_unknowns(problem);
        let n = self.unknowns.len();
        if n == 0 || n > MAX_UNKNOWNS {
            return false;
        }
        let size = self.fill(problem, attempt);
        self.pivot_to_the_end(n, attempt, n_pivots);
        multipliers.copy_from_slice(&self.offset);
        let stride = 2 * n + 2;
        for (line, &basic) in self.tableau.chunks_exact(stride).zip(&self.basis) {
            if (n..2 * n).contains(&basic)
                && let Unknown::Force { row, sign } = self.unknowns[basic - n]
            {
                multipliers[row] += sign * size * line[stride - 1] / problem.diagonal(row).sqrt();
            }
        }
        multipliers.iter().all(|multiplier| multiplier.is_finite())
    }

    /// Lists the nonnegative unknowns of every row, and the multipliers at which they are all zero.
    fn list_unknowns(&mut self, problem: Checked) {
        self.unknowns.clear();
        self.offset.clear();
        for row in 0..problem.n_rows() {
            if !problem.is_movable(row) {
                self.offset.push(problem.idle_multiplier(row));
                continue;
            }
            self.offset.push(match problem.rows[row] {
                RowKind::Box { .. } => problem.idle_multiplier(row),
                _ => 0.0 - problem.acted(row),
            });
            let push = Unknown::Force { row, sign: 1.0 };
            let pull = Unknown::Force { row, sign: -1.0 };
            match problem.rows[row] {
                RowKind::Unilateral => self.unknowns.push(push),
                RowKind::Bilateral => self.unknowns.extend([push, pull]),
                RowKind::Friction { .. } if problem.friction(row).is_some() => {
                    self.unknowns.extend([push, pull, Unknown::Speed { row }]);
                }
                RowKind::Friction { .. } => {}
                RowKind::Box { low, high } => match (low.is_finite(), high.is_finite()) {
                    (true, true) => {
                        self.offset[row] = low;
                        self.unknowns.extend([push, Unknown::Speed { row }]);
                    }
                    (true, false) => {
                        self.offset[row] = low;
                        self.unknowns.push(push);
                    }
                    (false, true) => {
                        self.offset[row] = high;
                        self.unknowns.push(pull);
                    }
                    (false, false) => self.unknowns.extend([push, pull]),
                },
            }
        }
    }

    /// Fills the tableau `[I | -M | -d | q]`, scaled by `1 / sqrt(W_ii)`; returns the divisor of `q`.
    fn fill(&mut self, problem: Checked, attempt: usize) -> f64 {
        let n = self.unknowns.len();
        let stride = 2 * n + 2;
        self.tableau.clear();
        self.tableau.resize(n * stride, 0.0);
        self.basis.clear();
        self.basis.extend(0..n);
        let mut size = 0.0_f64;
        for (index, &unknown) in self.unknowns.iter().enumerate() {
            let line = &mut self.tableau[index * stride..(index + 1) * stride];
            line[index] = 1.0;
            line[2 * n] = -cover(attempt, index);
            line[2 * n + 1] = fill_row(
                problem,
                unknown,
                &self.unknowns,
                &self.offset,
                &mut line[n..2 * n],
            );
            size = size.max(line[2 * n + 1].abs());
        }
        let size = if size > 0.0 { size } else { 1.0 };
        for line in self.tableau.chunks_exact_mut(stride) {
            line[stride - 1] /= size;
        }
        size
    }

    /// Pivots until the artificial unknown leaves, a ray opens or the pivots run out.
    ///
    /// A ray also appears when round-off hides that the artificial unknown has just reached zero: what it
    /// ends with is for the residual to judge.
    fn pivot_to_the_end(&mut self, n: usize, attempt: usize, n_pivots: &mut usize) {
        let arch = Arch::new();
        let (stride, artificial) = (2 * n + 2, 2 * n);
        let load = |row: usize| self.tableau[row * stride + stride - 1] / cover(attempt, row);
        // the lexicographic minimum of [q, I] is the last of equal ones
        let mut leaving_row = (0..n).fold(
            0,
            |best, row| if load(row) <= load(best) { row } else { best },
        );
        if load(leaving_row) >= 0.0 {
            return;
        }
        let mut entering = artificial;
        for _ in 0..10 * n + 50 {
            let leaving = self.basis[leaving_row];
            self.pivot(arch, n, leaving_row, entering);
            *n_pivots += 1;
            if leaving == artificial {
                return;
            }
            entering = if leaving < n {
                leaving + n
            } else {
                leaving - n
            };
            match self.ratio_test(n, entering) {
                Some(row) => leaving_row = row,
                None => return,
            }
        }
    }

    /// The row of the lexicographically smallest ratio, the artificial unknown first among equals.
    fn ratio_test(&mut self, n: usize, entering: usize) -> Option<usize> {
        let (stride, artificial) = (2 * n + 2, 2 * n);
        self.ties.clear();
        let tableau = &self.tableau;
        let entry = |row: usize| tableau[row * stride + entering];
        let largest = (0..n).map(entry).fold(1.0, f64::max);
        self.ties
            .extend((0..n).filter(|&row| entry(row) > SMALLEST_PIVOT * largest));
        for column in std::iter::once(stride - 1).chain(0..n) {
            let ratio =
                |row: usize| tableau[row * stride + column] / tableau[row * stride + entering];
            let least = self
                .ties
                .iter()
                .map(|&row| ratio(row))
                .fold(f64::INFINITY, f64::min);
            self.ties
                .retain(|&row| ratio(row) <= least + TIE * least.abs().max(1.0));
            if let Some(&row) = self.ties.iter().find(|&&row| self.basis[row] == artificial) {
                return Some(row);
            }
            if self.ties.len() <= 1 {
                break;
            }
        }
        self.ties.first().copied()
    }

    /// Brings `entering` into the basis in place of the unknown of `leaving_row`.
    fn pivot(&mut self, arch: Arch, n: usize, leaving_row: usize, entering: usize) {
        let stride = 2 * n + 2;
        let line = &mut self.tableau[leaving_row * stride..(leaving_row + 1) * stride];
        let pivot = line[entering];
        line.iter_mut().for_each(|value| *value /= pivot);
        self.pivot_row.clear();
        self.pivot_row.extend_from_slice(line);
        arch.dispatch(Eliminate {
            tableau: &mut self.tableau,
            pivot_row: &self.pivot_row,
            leaving_row,
            entering,
        });
        self.basis[leaving_row] = entering;
    }
}

/// The elimination of the entering column from all other rows, as a task for one instruction set; all give the same bits.
struct Eliminate<'a> {
    tableau: &'a mut [f64],
    pivot_row: &'a [f64],
    leaving_row: usize,
    entering: usize,
}

impl WithSimd for Eliminate<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let lines = self.tableau.chunks_exact_mut(self.pivot_row.len());
        for (row, line) in lines.enumerate() {
            let factor = line[self.entering];
            if row != self.leaving_row && factor != 0.0 {
                add_scaled(line, -factor, self.pivot_row);
                line[self.entering] = 0.0;
            }
        }
    }
}

/// The share `d` of the artificial unknown in a row: one, or in later attempts spread over `[1, 2)`.
fn cover(attempt: usize, index: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    1.0 + (GOLDEN * (attempt * (index + 1)) as f64).fract()
}

/// Writes one row of `-M` and returns its `q`.
fn fill_row(
    problem: Checked,
    unknown: Unknown,
    unknowns: &[Unknown],
    offset: &[f64],
    line: &mut [f64],
) -> f64 {
    let weight = |row: usize| problem.diagonal(row).sqrt();
    match unknown {
        Unknown::Force { row, sign } => {
            for (value, &other) in line.iter_mut().zip(unknowns) {
                *value = match other {
                    Unknown::Force {
                        row: column,
                        sign: other_sign,
                    } => {
                        let entry = problem.row(row)[column];
                        -sign * other_sign * entry / (weight(row) * weight(column))
                    }
                    Unknown::Speed { row: column } if column == row => -1.0,
                    Unknown::Speed { .. } => 0.0,
                };
            }
            sign * problem.velocity(row, offset) / weight(row)
        }
        Unknown::Speed { row } => {
            let friction = problem.friction(row);
            for (value, &other) in line.iter_mut().zip(unknowns) {
                *value = match (other, friction) {
                    (Unknown::Force { row: column, .. }, _) if column == row => 1.0,
                    (Unknown::Force { row: column, .. }, Some((normal, coefficient)))
                        if column == normal =>
                    {
                        -coefficient * weight(row) / weight(normal)
                    }
                    _ => 0.0,
                };
            }
            match problem.rows[row] {
                RowKind::Box { low, high } => (high - low) * weight(row),
                _ => 0.0,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::problem::{Problem, RowKind};
    use super::*;

    #[test]
    fn a_path_counts_what_has_acted_already() {
        // W p + b = 0 for the normal row with p_t = -p_n / 4: p = (4, -1), of which (6, 2) has acted
        let rows = [
            RowKind::Unilateral,
            RowKind::Friction {
                normal: 0,
                coefficient: 0.25,
            },
        ];
        let problem = Problem {
            delassus: &[3.0, 1.0, 1.0, 2.0],
            free: &[-11.0 + 20.0, 20.0 + 10.0],
            rows: &rows,
            acted: &[6.0, 2.0],
        };
        let problem = problem.check().expect("the data is finite");
        let mut rest = [0.0; 2];
        let mut n_pivots = 0;
        let is_found = Lemke::default().solve(problem, 0, &mut rest, &mut n_pivots);
        assert!(is_found && n_pivots > 0);
        let off = (rest[0] + 2.0).abs().max((rest[1] + 3.0).abs());
        assert!(off <= 1e-12, "{rest:?}");
    }
}
