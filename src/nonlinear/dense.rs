//! LU factors of a small dense matrix with row exchanges, `P A = L U`.

/// A row-major matrix and, once factorized, its factors in place.
#[derive(Clone, Debug, Default)]
pub(super) struct DenseLu {
    values: Vec<f64>,
    /// The row that was exchanged with each column's.
    exchanges: Vec<usize>,
    n_dofs: usize,
}

/// A pivot that vanished beside the largest entry of its column.
pub(super) struct Singular {
    pub(super) column: usize,
    pub(super) pivot: f64,
}

impl DenseLu {
    /// The zero matrix of `n_dofs` rows.
    pub(super) fn new(n_dofs: usize) -> Self {
        Self {
            values: vec![0.0; n_dofs * n_dofs],
            exchanges: vec![0; n_dofs],
            n_dofs,
        }
    }

    /// The entries, to be filled before [`factorize`](Self::factorize).
    pub(super) fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Replaces the entries by the factors. A pivot below `n` roundings of its column counts as zero.
    pub(super) fn factorize(&mut self) -> Result<(), Singular> {
        let n = self.n_dofs;
        for column in 0..n {
            let size = (0..n).map(|row| self.values[row * n + column].abs());
            let limit = n as f64 * f64::EPSILON * size.fold(0.0, f64::max);
            let modulus = |row: &usize| self.values[row * n + column].abs();
            let chosen = (column..n)
                .max_by(|a, b| modulus(a).total_cmp(&modulus(b)))
                .unwrap_or(column);
            let pivot = self.values[chosen * n + column];
            if pivot == 0.0 || pivot.abs() <= limit {
                return Err(Singular { column, pivot });
            }
            self.exchanges[column] = chosen;
            if chosen != column {
                for k in 0..n {
                    self.values.swap(chosen * n + k, column * n + k);
                }
            }
            for row in column + 1..n {
                let factor = self.values[row * n + column] / pivot;
                self.values[row * n + column] = factor;
                for k in column + 1..n {
                    self.values[row * n + k] -= factor * self.values[column * n + k];
                }
            }
        }
        Ok(())
    }

    /// Replaces the right-hand side by the solution.
    pub(super) fn solve_in_place(&self, x: &mut [f64]) {
        let n = self.n_dofs;
        for (column, &row) in self.exchanges.iter().enumerate() {
            x.swap(column, row);
        }
        for row in 0..n {
            let known: f64 = (0..row).map(|k| self.values[row * n + k] * x[k]).sum();
            x[row] -= known;
        }
        for row in (0..n).rev() {
            let known: f64 = (row + 1..n).map(|k| self.values[row * n + k] * x[k]).sum();
            x[row] = (x[row] - known) / self.values[row * n + row];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factorized(values: &[f64], n_dofs: usize) -> Result<DenseLu, Singular> {
        let mut lu = DenseLu::new(n_dofs);
        lu.values_mut().copy_from_slice(values);
        lu.factorize().map(|()| lu)
    }

    #[test]
    fn a_matrix_that_needs_exchanges_is_solved_to_rounding() {
        let a = [0.0, 2.0, 1.0, 1.0, 1e-20, 3.0, 4.0, 5.0, -6.0];
        let Ok(lu) = factorized(&a, 3) else {
            panic!("the matrix is regular");
        };
        let x = [1.0, -2.0, 3.0];
        let mut b = [0, 1, 2].map(|i| (0..3).map(|j| a[3 * i + j] * x[j]).sum::<f64>());
        lu.solve_in_place(&mut b);
        // Condition number below 10: a dozen roundings.
        assert!(b.iter().zip(x).all(|(b, x)| (b - x).abs() < 1e-14), "{b:?}");
    }

    #[test]
    fn a_matrix_without_inverse_names_its_column() {
        for (a, expected) in [
            ([1.0, 2.0, 2.0, 4.0], 1),
            ([0.0, 1.0, 0.0, 1.0], 0),
            // Singular but for the rounding of 1/3.
            ([1.0 / 3.0, 1.0, 0.1, 0.3], 1),
        ] {
            let Err(singular) = factorized(&a, 2) else {
                panic!("{a:?} has no inverse");
            };
            assert_eq!(singular.column, expected);
        }
    }
}
