//! Sparse LU `P A Q = L U` of node-block matrices that are neither definite nor, with what is added to them, symmetric.
//!
//! For equilibria past limit points alone: [`cholesky`](super::cholesky) is several times faster where a matrix is definite. Rows are
//! chosen by size as the elimination goes (faer), so that no pivot is small without need.

use super::block_matrix::BlockMatrix;
use faer::linalg::solvers::SolveCore;
use faer::prelude::Reborrow;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut};
use std::collections::BTreeSet;

/// Why a matrix has no factor.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(crate) enum LuError {
    /// A column has no pivot.
    #[error("the matrix is singular")]
    Singular,
    /// There is not enough memory.
    #[error("there is no memory for the factor of {n_dofs} dofs")]
    Memory {
        /// Rows of the matrix.
        n_dofs: usize,
    },
}

/// An entry beside the blocks of a matrix, added to what is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Entry {
    pub(crate) row: usize,
    pub(crate) column: usize,
    pub(crate) value: f64,
}

/// The factor of a [`BlockMatrix`] with some entries added, refilled as often as its values change.
#[derive(Debug, Clone)]
pub(crate) struct SparseLu {
    structure: SymbolicSparseColMat<usize>,
    values: Vec<f64>,
    symbolic: SymbolicLu<usize>,
    factor: Option<Lu<usize, f64>>,
}

impl SparseLu {
    /// Lays out the factor of matrices with the pattern of `matrix`, and entries at the places of `added`.
    pub(crate) fn analyze(matrix: &BlockMatrix, added: &[Entry]) -> Result<Self, LuError> {
        let n_dofs = matrix.n_dofs();
        // The pattern is symmetric, so that rows of blocks are columns.
        let mut columns: Vec<BTreeSet<usize>> = (0..n_dofs)
            .map(|dof| {
                let nodes = matrix.neighbours(dof / 2).iter();
                nodes
                    .flat_map(|&node| [2 * node as usize, 2 * node as usize + 1])
                    .collect()
            })
            .collect();
        for entry in added {
            columns[entry.column].insert(entry.row);
        }
        let mut starts = vec![0];
        let mut rows = Vec::new();
        for column in &columns {
            rows.extend(column);
            starts.push(rows.len());
        }
        let values = vec![0.0; rows.len()];
        let structure = SymbolicSparseColMat::new_checked(n_dofs, n_dofs, starts, None, rows);
        let memory = |_| LuError::Memory { n_dofs };
        Ok(Self {
            symbolic: SymbolicLu::try_new(structure.rb()).map_err(memory)?,
            structure,
            values,
            factor: None,
        })
    }

    /// Computes the factor; afterwards there is none if that is an error.
    pub(crate) fn factorize(
        &mut self,
        matrix: &BlockMatrix,
        added: &[Entry],
    ) -> Result<(), LuError> {
        let n_dofs = matrix.n_dofs();
        self.factor = None;
        let (starts, rows) = (self.structure.col_ptr(), self.structure.row_idx());
        for column in 0..n_dofs {
            let range = starts[column]..starts[column + 1];
            for place in range {
                let row = rows[place];
                let block = matrix.block(row / 2, column / 2);
                self.values[place] = block.map_or(0.0, |b| b[2 * (row % 2) + column % 2]);
            }
        }
        for entry in added {
            let range = starts[entry.column]..starts[entry.column + 1];
            if let Ok(at) = rows[range.clone()].binary_search(&entry.row) {
                self.values[range.start + at] += entry.value;
            }
        }
        let filled = SparseColMatRef::new(self.structure.rb(), &self.values);
        let factor = Lu::try_new_with_symbolic(self.symbolic.clone(), filled);
        self.factor = Some(factor.map_err(|_| LuError::Singular)?);
        Ok(())
    }

    /// Replaces a right-hand side by the solution; without a factor it becomes no number.
    pub(crate) fn solve_in_place(&self, x: &mut [f64]) {
        let Some(factor) = &self.factor else {
            x.fill(f64::NAN);
            return;
        };
        let n_dofs = x.len();
        let column = MatMut::from_column_major_slice_mut(x, n_dofs, 1);
        factor.solve_in_place_with_conj(Conj::No, column);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of nodes with springs that pull and push, and what couples its ends in one direction only.
    fn chain() -> (BlockMatrix, Vec<Entry>) {
        let cells: Vec<[usize; 2]> = (0..7).map(|k| [k, k + 1]).collect();
        let mut matrix = BlockMatrix::from_cells(8, cells.iter().map(|cell| &cell[..]));
        for (k, cell) in cells.iter().enumerate() {
            let mut spring = [0.0; 16];
            for i in 0..4 {
                for j in 0..4 {
                    let (low, high) = (i.min(j) as f64, i.max(j) as f64);
                    spring[4 * i + j] = (3.0 * low - 2.0 * high + k as f64).sin();
                }
            }
            matrix.add_cell(cell, &spring);
        }
        let entry = |row, column, value| Entry { row, column, value };
        let added = vec![entry(0, 15, 2.5), entry(3, 2, -0.7), entry(3, 2, 0.2)];
        (matrix, added)
    }

    fn multiply(matrix: &BlockMatrix, added: &[Entry], x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        matrix.multiply(x, &mut y);
        for entry in added {
            y[entry.row] += entry.value * x[entry.column];
        }
        y
    }

    #[test]
    fn indefinite_and_unsymmetric_matrices_are_solved() -> Result<(), LuError> {
        let (matrix, mut added) = chain();
        let mut lu = SparseLu::analyze(&matrix, &added)?;
        for scale in [1.0, -3.0] {
            added.iter_mut().for_each(|entry| entry.value *= scale);
            lu.factorize(&matrix, &added)?;
            let x: Vec<f64> = (0..16).map(|k| f64::from(k).cos()).collect();
            let mut found = multiply(&matrix, &added, &x);
            lu.solve_in_place(&mut found);
            for (found, x) in found.iter().zip(&x) {
                assert!((found - x).abs() < 1e-12, "{found} for {x}");
            }
        }
        Ok(())
    }

    #[test]
    fn what_is_singular_gives_no_numbers() -> Result<(), LuError> {
        let (mut matrix, _) = chain();
        let mut lu = SparseLu::analyze(&matrix, &[])?;
        matrix.fill_zero();
        let outcome = lu.factorize(&matrix, &[]);
        let mut x = vec![1.0; 16];
        lu.solve_in_place(&mut x);
        assert!(outcome == Err(LuError::Singular) || !x.iter().all(|x| x.is_finite()));
        Ok(())
    }
}
