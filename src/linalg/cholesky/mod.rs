//! Sparse Cholesky factorization of node-block matrices: `P A Pᵀ = L Lᵀ`.
//!
//! A solve of `A x = b` is then `x = Pᵀ L⁻ᵀ L⁻¹ P b`.
//!
//! | step | file | when |
//! |---|---|---|
//! | order the nodes | `ordering` | once per pattern |
//! | lay out the factor in panels | `panels` | once per pattern |
//! | compute `L`, or what of it has changed | `factor` | when values change |
//! | substitute | `solve` | every step |
//!
//! A panel holds up to four node columns with the same rows. Its diagonal block is kept as its
//! inverse; below, values are tiles of two nodes' rows by all columns, so that every kernel streams
//! through memory and works on four numbers at a time.
//!
//! Time of faer 0.24 (simplicial | supernodal) over the time of this module, one run on one core of
//! a Zen 5 machine, strips of triangles and at the end a square:
//!
//! | dofs | factorize | solve one | eight at once |
//! |---|---|---|---|
//! | 126 | 2.5, 2.1 | 2.2, 5.8 | 2.1, 2.8 |
//! | 1,458 | 2.6, 2.9 | 2.5, 6.2 | 2.8, 3.6 |
//! | 8,442 | 4.4, 2.8 | 2.7, 4.7 | 3.4, 3.4 |
//! | 100,352 | 8.7, 1.1 | 1.1, 1.8 | 2.2, 1.8 |
//!
//! So faer orders the nodes and brings the choice of instruction set, and its numeric kernels are
//! not used at any size.
//!
//! The kernels are compiled for several instruction sets, and the widest that the machine has is
//! chosen at run time. They add in an order fixed by the source and without fused multiply–add, so
//! that results are the same bits whichever is chosen; fusing the products of the factorization
//! gained 5 % at 100,352 dofs and nothing below.

mod aligned;
mod diagonal;
mod factor;
mod ordering;
mod panels;
mod solve;
#[cfg(test)]
mod tests;

use super::block_matrix::{BlockMatrix, Pattern};
use aligned::AlignedColumns;
use faer::traits::pulp::Arch;
use ordering::Ordering;
use panels::Panels;
use std::sync::Arc;

/// Why a matrix could not be factorized.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CholeskyError {
    /// A pivot was negative, or vanished beside its diagonal entry.
    #[error(
        "the matrix is not positive definite: node {node} was left with pivot {pivot:e} of a \
         diagonal of {diagonal:e}; hold the body's rigid motion or give it mass, and look for \
         turned-over cells near that node"
    )]
    NotPositiveDefinite {
        /// The node, in the numbering of the matrix.
        node: usize,
        /// What elimination left of the diagonal entry.
        pivot: f64,
        /// The diagonal entry itself.
        diagonal: f64,
    },
    /// A solution that is known is found too inexactly.
    #[error(
        "the matrix holds numbers so different in size that rounding leaves an error of {error:e} in a known solution"
    )]
    IllConditioned {
        /// The largest error, relative.
        error: f64,
    },
    /// The matrix does not store the blocks of the one that was analysed.
    #[error(
        "the matrix of {found} nodes does not have the pattern analysed, of {analysed} nodes: \
         analyse it, or build it from the same cells"
    )]
    PatternMismatch {
        /// The number of nodes of the matrix analysed.
        analysed: usize,
        /// The number of nodes of the matrix given.
        found: usize,
    },
}

/// The part of a factor that some unknowns depend on; see [`BlockCholesky::select`].
#[derive(Debug, Clone, Default)]
pub struct Selection {
    /// For each panel.
    is_wanted: Vec<bool>,
    /// For each node and position, while it is made.
    is_wanted_node: Vec<bool>,
    is_wanted_position: Vec<bool>,
}

/// The Cholesky factor of a [`BlockMatrix`], refilled as often as its values change.
///
/// Only [`analyze`](Self::analyze) allocates.
///
/// ```
/// use foil2d::linalg::block_matrix::BlockMatrix;
/// use foil2d::linalg::cholesky::BlockCholesky;
///
/// let spring = [2.0, 0.0, -1.0, 0.0, 0.0, 2.0, 0.0, -1.0, -1.0, 0.0, 2.0, 0.0, 0.0, -1.0, 0.0,
/// 2.0]; let mut a = BlockMatrix::from_cells(2, [[0, 1]].iter().map(|cell| &cell[..]));
/// a.add_cell(&[0, 1], &spring);
///
/// let mut cholesky = BlockCholesky::analyze(&a);
/// cholesky.factorize(&a)?;
/// let mut x = [3.0, 0.0, 0.0, 0.0];
/// cholesky.solve_in_place(&mut x);
/// assert!((x[0] - 2.0).abs() < 1e-15 && (x[2] - 1.0).abs() < 1e-15);
/// # Ok::<(), foil2d::linalg::cholesky::CholeskyError>(())
/// ```
#[derive(Debug, Clone)]
pub struct BlockCholesky {
    pattern: Arc<Pattern>,
    /// The node eliminated at each position.
    node_at: Vec<u32>,
    panels: Panels,
    sources: factor::Sources,
    values: AlignedColumns,
    /// One or two right-hand sides in elimination order, and a node for rows that fill up a pair.
    vector: Vec<[f64; 2]>,
    /// The panel being factorized, or eight right-hand sides, and two nodes for rows that stand for
    /// none.
    rows: Vec<[f64; 16]>,
    /// Whether `rows` is all zeros, as a factorization finds it and leaves it.
    rows_are_zero: bool,
    is_factorized: bool,
    n_factorizations: usize,
    /// The values that the factor was made of, if [`refactorize`](Self::refactorize) made it.
    made_of: Vec<[f64; 4]>,
    /// Positions, then panels, that others are asked of than before.
    is_changed: Vec<bool>,
    is_wanted: Vec<bool>,
    arch: Arch,
}

impl BlockCholesky {
    /// Orders the nodes of `matrix`, lays out its factor and reserves all memory; the values do not
    /// matter.
    pub fn analyze(matrix: &BlockMatrix) -> Self {
        let ordering = Ordering::new(matrix);
        let panels = Panels::new(matrix, &ordering);
        let n_nodes = matrix.n_nodes();
        Self {
            pattern: Arc::clone(matrix.pattern()),
            sources: factor::Sources::new(matrix, &ordering, &panels),
            values: AlignedColumns::zeros(panels.n_values),
            vector: vec![[0.0; 2]; 2 * (n_nodes + 1)],
            rows: vec![[0.0; 16]; n_nodes + 2],
            node_at: ordering.node_at,
            rows_are_zero: true,
            is_factorized: false,
            n_factorizations: 0,
            made_of: Vec::new(),
            is_changed: Vec::with_capacity(n_nodes),
            is_wanted: Vec::with_capacity(panels.panels.len()),
            panels,
            arch: Arch::new(),
        }
    }

    /// Computes `L` from the values of `matrix`. Allocates nothing.
    ///
    /// # Errors
    /// [`CholeskyError::NotPositiveDefinite`] if a pivot is not above 64 rounding errors of its
    /// diagonal entry, and [`CholeskyError::PatternMismatch`] if the matrix stores other blocks
    /// than the one analysed. After an error there is no factor to solve with until another call
    /// succeeds.
    pub fn factorize(&mut self, matrix: &BlockMatrix) -> Result<(), CholeskyError> {
        self.made_of.clear();
        self.is_wanted.clear();
        self.fill(matrix)
    }

    /// Computes the same `L` to the last bit, but only those parts of it that depend on values that have changed since the last call.
    /// Allocates nothing after the first call.
    ///
    /// A panel depends on its own columns of the matrix and on the panels below it in the tree of elimination.
    ///
    /// # Errors
    /// As of [`factorize`](Self::factorize).
    pub fn refactorize(&mut self, matrix: &BlockMatrix) -> Result<(), CholeskyError> {
        let blocks = matrix.blocks();
        self.is_wanted.clear();
        if self.is_factorized && self.made_of.len() == blocks.len() {
            self.sources
                .list_changed([&self.made_of, blocks], &mut self.is_changed);
            self.panels
                .close_upwards(&mut self.is_changed, &mut self.is_wanted);
        }
        self.made_of.clear();
        self.made_of.extend_from_slice(blocks);
        self.fill(matrix)
    }

    /// Computes the wanted panels, all if none are listed.
    fn fill(&mut self, matrix: &BlockMatrix) -> Result<(), CholeskyError> {
        self.is_factorized = false;
        if !Arc::ptr_eq(&self.pattern, matrix.pattern()) && self.pattern != *matrix.pattern() {
            return Err(CholeskyError::PatternMismatch {
                analysed: self.node_at.len(),
                found: matrix.n_nodes(),
            });
        }
        if !std::mem::replace(&mut self.rows_are_zero, false) {
            self.rows.fill([0.0; 16]);
        }
        let outcome = self.arch.dispatch(factor::Factorize {
            panels: &self.panels,
            sources: &self.sources,
            blocks: matrix.blocks(),
            values: self.values.get_mut(),
            rows: &mut self.rows,
            is_wanted: &self.is_wanted,
        });
        outcome.map_err(|failure| CholeskyError::NotPositiveDefinite {
            node: self.node_at[failure.position] as usize,
            pivot: failure.pivot,
            diagonal: failure.diagonal,
        })?;
        self.rows_are_zero = true;
        self.is_factorized = true;
        self.n_factorizations += 1;
        Ok(())
    }

    /// Replaces the right-hand side `x` by the solution of `A x = b`. Allocates nothing.
    ///
    /// # Panics
    /// If `x` does not have `n_dofs` entries, or if the last factorization failed or never was.
    pub fn solve_in_place(&mut self, x: &mut [f64]) {
        self.assert_ready(x.len(), 1);
        self.solve_few::<1>(x);
    }

    fn solve_few<const R: usize>(&mut self, columns: &mut [f64]) {
        self.arch.dispatch(solve::SolveFew::<R> {
            panels: &self.panels,
            values: self.values.get(),
            node_at: &self.node_at,
            work: self.vector.as_chunks_mut().0,
            columns,
        });
    }

    /// Solves for many right-hand sides, eight at a time. Allocates nothing.
    ///
    /// Forward substitution skips panels in which a whole block of right-hand sides is still zero:
    /// unit vectors cost a fifth to a third less if those of neighbouring nodes are kept together.
    ///
    /// - `columns`: right-hand sides, replaced by solutions, column-major, shape `(n_dofs,
    ///   n_columns)`.
    ///
    /// # Panics
    /// If `columns` has another length, or if the last factorization failed or never was.
    pub fn solve_many_in_place(&mut self, columns: &mut [f64], n_columns: usize) {
        self.solve_columns(columns, n_columns, &[]);
    }

    /// Solves for many right-hand sides where only the unknowns of `selection` are wanted; what is left at other nodes
    /// has no meaning. Allocates nothing.
    ///
    /// Backward substitution skips panels that no selected node depends on. Eight columns of unit vectors on the
    /// boundary of a square of 64 x 64 quads, wanted on the boundary, take three quarters of the time they take everywhere.
    ///
    /// # Panics
    /// Like [`solve_many_in_place`](Self::solve_many_in_place), and if the selection was made by another analysis.
    pub fn solve_many_for(&mut self, selection: &Selection, columns: &mut [f64], n_columns: usize) {
        self.assert_own(selection);
        self.solve_columns(columns, n_columns, &selection.is_wanted);
    }

    /// Finds out which part of the factor the unknowns of these nodes depend on; it is also the part that depends on their rows and columns of
    /// the matrix.
    ///
    /// # Panics
    /// If a node does not exist.
    pub fn select(&self, nodes: impl IntoIterator<Item = usize>) -> Selection {
        let mut selection = Selection::default();
        self.select_into(nodes, &mut selection);
        selection
    }

    /// Like [`select`](Self::select), in memory that is there already.
    ///
    /// # Panics
    /// If a node does not exist.
    pub fn select_into(&self, nodes: impl IntoIterator<Item = usize>, selection: &mut Selection) {
        let Selection {
            is_wanted,
            is_wanted_node,
            is_wanted_position,
        } = selection;
        is_wanted_node.clear();
        is_wanted_node.resize(self.node_at.len(), false);
        nodes
            .into_iter()
            .for_each(|node| is_wanted_node[node] = true);
        is_wanted_position.clear();
        is_wanted_position.extend(
            self.node_at
                .iter()
                .map(|&node| is_wanted_node[node as usize]),
        );
        self.panels.close_upwards(is_wanted_position, is_wanted);
    }

    /// Computes the same `L` to the last bit as [`factorize`](Self::factorize) does, if all values of the matrix that have changed since
    /// the last call lie in rows and columns of the nodes selected. Allocates nothing.
    ///
    /// # Errors
    /// As of [`factorize`](Self::factorize).
    ///
    /// # Panics
    /// If there is no factor yet, or the selection was made by another analysis.
    pub fn factorize_part(
        &mut self,
        selection: &Selection,
        matrix: &BlockMatrix,
    ) -> Result<(), CholeskyError> {
        self.assert_ready(self.n_dofs(), 1);
        self.assert_own(selection);
        self.made_of.clear();
        self.is_wanted.clone_from(&selection.is_wanted);
        self.fill(matrix)
    }

    fn assert_own(&self, selection: &Selection) {
        assert!(
            selection.is_wanted.len() == self.panels.panels.len(),
            "the selection was made by another analysis: select the nodes with this one"
        );
    }

    fn solve_columns(&mut self, columns: &mut [f64], n_columns: usize, is_wanted: &[bool]) {
        self.assert_ready(columns.len(), n_columns);
        let n_dofs = self.n_dofs();
        for block in columns.chunks_mut((8 * n_dofs).max(1)) {
            match block.len() / n_dofs {
                1 => {
                    self.solve_few::<1>(block);
                    continue;
                }
                2 => {
                    self.solve_few::<2>(block);
                    continue;
                }
                _ => {}
            }
            self.rows_are_zero = false;
            self.arch.dispatch(solve::SolveEight {
                panels: &self.panels,
                values: self.values.get(),
                node_at: &self.node_at,
                work: &mut self.rows,
                columns: block,
                is_wanted,
            });
        }
    }

    fn assert_ready(&self, n_entries: usize, n_columns: usize) {
        let n_dofs = self.n_dofs();
        assert!(
            n_entries == n_dofs * n_columns,
            "{n_columns} right-hand sides of {n_dofs} dofs do not have {n_entries} entries"
        );
        assert!(
            self.is_factorized,
            "factorize a matrix, and heed its error, before solving with it"
        );
    }

    /// The number of scalar rows, two per node.
    pub fn n_dofs(&self) -> usize {
        2 * self.node_at.len()
    }

    /// The number of entries kept of `L`, the zeros of joined columns among them.
    pub fn n_nonzeros(&self) -> usize {
        self.panels.n_nonzeros(self.node_at.len())
    }

    /// Floating-point operations of a factorization: the squares of the lengths of the columns kept of `L`, summed.
    pub fn n_operations(&self) -> f64 {
        self.panels.n_operations(self.node_at.len())
    }

    /// How many factorizations succeeded since the analysis: the work a step did, for reports and
    /// tests.
    pub fn n_factorizations(&self) -> usize {
        self.n_factorizations
    }
}
