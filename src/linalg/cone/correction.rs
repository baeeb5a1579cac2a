//! A factor whose weights have changed in few rows: `H' = H + Gᵀ E G`, with `E` of low rank.
//!
//! ```text
//! H'⁻¹ b = y - Z (1 + E G Z)⁻¹ E G y,     y = H⁻¹ b,   Z = H⁻¹ Gᵀ
//! ```
//!
//! (Sherman, Morrison, Woodbury; Hager 1989). The columns of `Z` are kept as long as the factor is, so that a row that
//! changes sides to and fro costs two substitutions once.

use super::problem::{ConeEntry, motion};
use super::system::are_alike;
use crate::linalg::cholesky::BlockCholesky;

/// The rows that the factor was made of.
#[derive(Debug, Clone, Copy)]
pub(super) struct FactorRows<'a> {
    /// The entries of every row.
    pub spans: &'a [(u32, u32)],
    pub entries: &'a [ConeEntry],
}

impl<'a> FactorRows<'a> {
    fn entries_of(self, row: usize) -> &'a [ConeEntry] {
        let (start, end) = self.spans[row];
        &self.entries[start as usize..end as usize]
    }

    /// `G x` of one row.
    fn motion(self, row: usize, x: &[f64]) -> [f64; 2] {
        motion(self.entries_of(row), x)
    }
}

/// What a factor has been corrected for.
#[derive(Debug, Clone, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Corrected {
    /// The rows with columns in `answers`, two each.
    known: Vec<usize>,
    /// How many of them were known after each time that some were found together.
    found: Vec<usize>,
    /// Rows that have changed, and by how much, `[nn, nt, tt]`.
    changed: Vec<(usize, [f64; 3])>,
}

/// Rows whose weights have changed since the factor was made, and what is known of them.
#[derive(Debug, Clone, Default)]
pub(super) struct Correction {
    /// All that the rest follows from.
    of: Corrected,
    /// `Z`, column after column.
    answers: Vec<f64>,
    /// `G Z` of all known rows, two lines for each of them, as long as `stride`.
    compliance: Vec<f64>,
    stride: usize,
    changed_before: Vec<(usize, [f64; 3])>,
    /// Their places among the known ones.
    places: Vec<usize>,
    /// `1 + E G Z` beside `E G y`, line after line.
    dense: Vec<f64>,
    /// Substitutions for the problem at hand.
    pub n_substitutions: usize,
}

impl Correction {
    /// Forgets what belonged to another factor.
    pub fn forget(&mut self) {
        self.of.known.clear();
        self.of.found.clear();
        self.answers.clear();
        self.compliance.clear();
        self.stride = 0;
        self.of.changed.clear();
    }

    /// Notes which rows have changed, and by how much; whether others have than at the last time.
    pub fn list_changed(&mut self, changed: impl Iterator<Item = (usize, [f64; 3])>) -> bool {
        std::mem::swap(&mut self.of.changed, &mut self.changed_before);
        self.of.changed.clear();
        self.of.changed.extend(changed);
        let before = self.changed_before.iter().map(|(row, _)| row);
        !self.of.changed.iter().map(|(row, _)| row).eq(before)
            || (self.of.changed.iter().zip(&self.changed_before))
                .any(|((_, now), (_, before))| !are_alike(now, before))
    }

    /// Turns `y = H⁻¹ b` into `H'⁻¹ b`; false, with `y` as it was, if `H'` is singular as far as numbers tell.
    pub fn apply(
        &mut self,
        rows: FactorRows<'_>,
        factor: &mut BlockCholesky,
        y: &mut [f64],
    ) -> bool {
        self.answer_new(rows, factor, y.len());
        let n = 2 * self.of.changed.len();
        let width = n + 1;
        self.dense.clear();
        self.dense.resize(n * width, 0.0);
        for (i, &(row, [nn, nt, tt])) in self.of.changed.iter().enumerate() {
            let [upper, lower] = [0, 1].map(|c| (2 * i + c) * width);
            let weigh = |[a, b]: [f64; 2]| [nn * a + nt * b, nt * a + tt * b];
            for (j, &place) in self.places.iter().enumerate() {
                for d in 0..2 {
                    let at = 2 * self.places[i] * self.stride + 2 * place + d;
                    let [a, b] = weigh([self.compliance[at], self.compliance[at + self.stride]]);
                    self.dense[upper + 2 * j + d] = a;
                    self.dense[lower + 2 * j + d] = b;
                }
            }
            self.dense[upper + 2 * i] += 1.0;
            self.dense[lower + 2 * i + 1] += 1.0;
            let [a, b] = weigh(rows.motion(row, y));
            self.dense[upper + n] = a;
            self.dense[lower + n] = b;
        }
        if !eliminate(&mut self.dense, n) {
            return false;
        }
        let n_dofs = y.len();
        for (j, &place) in self.places.iter().enumerate() {
            for d in 0..2 {
                let share = self.dense[(2 * j + d) * width + n];
                let column = &self.answers[(2 * place + d) * n_dofs..][..n_dofs];
                y.iter_mut().zip(column).for_each(|(y, z)| *y -= share * z);
            }
        }
        true
    }

    /// Finds the columns of changed rows that are not known.
    fn answer_new(&mut self, rows: FactorRows<'_>, factor: &mut BlockCholesky, n_dofs: usize) {
        let n_known = self.of.known.len();
        self.places.clear();
        for &(row, _) in &self.of.changed {
            let place = self.of.known.iter().position(|&known| known == row);
            self.places.push(place.unwrap_or(self.of.known.len()));
            if place.is_none() {
                self.of.known.push(row);
            }
        }
        let n_new = self.of.known.len() - n_known;
        if n_new == 0 {
            return;
        }
        self.of.found.push(self.of.known.len());
        self.n_substitutions += 2 * n_new;
        let start = 2 * n_known * n_dofs;
        self.answers.resize(2 * self.of.known.len() * n_dofs, 0.0);
        let new = &mut self.answers[start..];
        new.fill(0.0);
        for (&row, columns) in self.of.known[n_known..]
            .iter()
            .zip(new.chunks_exact_mut(2 * n_dofs))
        {
            let (normal, tangent) = columns.split_at_mut(n_dofs);
            for entry in rows.entries_of(row) {
                let at = 2 * entry.node as usize;
                for k in 0..2 {
                    normal[at + k] += entry.normal[k];
                    tangent[at + k] += entry.tangent[k];
                }
            }
        }
        factor.solve_many_in_place(new, 2 * n_new);
        self.widen(2 * self.of.known.len());
        for (place, &row) in self.of.known.iter().enumerate() {
            let first = if place < n_known { n_known } else { 0 };
            for other in first..self.of.known.len() {
                for d in 0..2 {
                    let column = &self.answers[(2 * other + d) * n_dofs..][..n_dofs];
                    let [n, t] = rows.motion(row, column);
                    let at = 2 * place * self.stride + 2 * other + d;
                    self.compliance[at] = n;
                    self.compliance[at + self.stride] = t;
                }
            }
        }
    }

    /// Makes room for so many lines and columns.
    fn widen(&mut self, n: usize) {
        let stride = self.stride.max(n.next_power_of_two());
        let n_before = self.compliance.len().checked_div(self.stride).unwrap_or(0);
        self.compliance.resize(n.max(n_before) * stride, 0.0);
        if stride > self.stride {
            for line in (0..n_before).rev() {
                let begin = line * self.stride;
                self.compliance
                    .copy_within(begin..begin + self.stride, line * stride);
            }
            self.stride = stride;
        }
    }
}

/// What a snapshot writes of it.
#[cfg(feature = "serde-serialize")]
impl Correction {
    /// What the factor at hand has been corrected for.
    pub fn corrected(&self) -> &Corrected {
        &self.of
    }

    /// Finds the columns of these rows again, in the groups they were found in: the bits of a column depend on how many are solved for at once.
    pub fn correct_again(
        &mut self,
        of: &Corrected,
        rows: FactorRows<'_>,
        factor: &mut BlockCholesky,
        n_dofs: usize,
    ) {
        let mut begin = 0;
        for &end in &of.found {
            let group = of.known[begin..end].iter();
            self.of.changed.clear();
            self.of.changed.extend(group.map(|&row| (row, [0.0; 3])));
            self.answer_new(rows, factor, n_dofs);
            begin = end;
        }
        self.of.changed.clone_from(&of.changed);
    }
}

#[cfg(feature = "serde-serialize")]
impl Corrected {
    /// Whether its groups are groups, and its rows some of so many.
    pub fn is_sound(&self, n_rows: usize) -> bool {
        let changed = self.changed.iter().map(|(row, _)| row);
        self.found.is_sorted()
            && self.found.last().copied().unwrap_or(0) == self.known.len()
            && self.known.iter().chain(changed).all(|row| *row < n_rows)
    }
}

/// Pivots below this, beside ones, are rounding.
const SMALLEST: f64 = 64.0 * f64::EPSILON;

/// Solves `n` equations in place, by elimination with pivots; the right-hand side stands in the last column. False if a pivot vanishes.
fn eliminate(lines: &mut [f64], n: usize) -> bool {
    let width = n + 1;
    for column in 0..n {
        let size = |line: usize| lines[line * width + column].abs();
        let pivot = (column..n).fold(
            column,
            |best, line| {
                if size(line) > size(best) { line } else { best }
            },
        );
        let is_regular = size(pivot) > SMALLEST;
        if !is_regular {
            return false;
        }
        if pivot != column {
            let (upper, lower) = lines.split_at_mut(pivot * width);
            upper[column * width..][..width].swap_with_slice(&mut lower[..width]);
        }
        let (above, below) = lines.split_at_mut((column + 1) * width);
        let own = &above[column * width..];
        for line in below.chunks_exact_mut(width) {
            let factor = line[column] / own[column];
            if factor != 0.0 {
                for (value, own) in line[column..].iter_mut().zip(&own[column..]) {
                    *value -= factor * own;
                }
            }
        }
    }
    for column in (0..n).rev() {
        let (above, below) = lines.split_at_mut(column * width);
        let value = below[n] / below[column];
        below[n] = value;
        for line in above.chunks_exact_mut(width) {
            line[n] -= line[column] * value;
        }
    }
    true
}
