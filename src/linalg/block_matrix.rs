//! Symmetric sparse matrices of 2×2 node blocks: `A = Σ_c B_cᵀ A_c B_c`, summed cell by cell.

pub(super) use super::pattern::Pattern;
use crate::math::{Number, Wide};
use faer::traits::pulp::{Arch, Simd, WithSimd};
use std::sync::Arc;

/// `y = A x`, by the widest instructions that the machine has.
struct Multiply<'a> {
    matrix: &'a BlockMatrix,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for Multiply<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (node, out) in self.y.chunks_exact_mut(2).enumerate() {
            out.copy_from_slice(&self.matrix.multiply_node(node, self.x));
        }
    }
}

/// A symmetric matrix over interleaved dofs `[x0, y0, x1, y1, ...]`, stored as rows of 2×2 node
/// blocks.
///
/// Block `(i, j)` is row-major, `[xx, xy, yx, yy]`. Both triangles are stored, every diagonal block
/// is present, and columns ascend within a row. Clones share the pattern, so that the matrices of
/// one mesh (mass, stiffness, effective) hold it once and recognize each other at no cost.
///
/// ```
/// use foil2d::linalg::block_matrix::BlockMatrix;
///
/// let cells = [[0, 1], [1, 2]];
/// let mut a = BlockMatrix::from_cells(3, cells.iter().map(|cell| &cell[..]));
/// a.add_diagonal(1, [2.0, 3.0]);
/// let mut y = [0.0; 6];
/// a.multiply(&[1.0; 6], &mut y);
/// assert_eq!(y, [0.0, 0.0, 2.0, 3.0, 0.0, 0.0]);
/// ```
#[derive(Debug, Clone)]
pub struct BlockMatrix {
    pattern: Arc<Pattern>,
    values: Vec<[f64; 4]>,
}

impl BlockMatrix {
    /// Builds the zero matrix that couples the nodes of every cell with each other.
    ///
    /// - `cells`: the nodes of each cell, in any order.
    ///
    /// # Panics
    /// If a cell names a node that is not below `n_nodes`, or if `n_nodes` does not fit in 32 bits.
    pub fn from_cells<'a>(
        n_nodes: usize,
        cells: impl Iterator<Item = &'a [usize]> + Clone,
    ) -> Self {
        let pattern = Pattern::from_cells(n_nodes, cells);
        Self {
            values: vec![[0.0; 4]; pattern.columns.len()],
            pattern: Arc::new(pattern),
        }
    }

    /// The number of nodes, that is of block rows.
    pub fn n_nodes(&self) -> usize {
        self.pattern.row_start.len() - 1
    }

    /// The number of scalar rows, two per node.
    pub fn n_dofs(&self) -> usize {
        2 * self.n_nodes()
    }

    /// The nodes coupled with `node`, itself among them, ascending.
    pub fn neighbours(&self, node: usize) -> &[u32] {
        &self.pattern.columns[self.pattern.row(node)]
    }

    /// Whether both matrices store the same blocks.
    pub fn has_pattern_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.pattern, &other.pattern) || self.pattern == other.pattern
    }

    /// The stored blocks of one row beside [`neighbours`](Self::neighbours), in the same order.
    pub fn row_blocks(&self, node: usize) -> &[[f64; 4]] {
        &self.values[self.pattern.row(node)]
    }

    /// All stored blocks, row after row.
    pub(super) fn blocks(&self) -> &[[f64; 4]] {
        &self.values
    }

    /// All stored blocks, row after row, to be changed: the caller keeps the matrix symmetric.
    pub(super) fn blocks_mut(&mut self) -> &mut [[f64; 4]] {
        &mut self.values
    }

    /// The place in [`blocks`](Self::blocks) where the row of `node` begins.
    pub(super) fn row_start(&self, node: usize) -> usize {
        self.pattern.row_start[node]
    }

    /// A number that tells patterns apart, the same on every machine.
    pub(crate) fn fingerprint(&self) -> u64 {
        self.pattern.fingerprint
    }

    pub(super) fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// The block that couples row node `i` with column node `j`, if the pattern has it.
    pub fn block(&self, i: usize, j: usize) -> Option<&[f64; 4]> {
        self.slot(i, j).map(|slot| &self.values[slot])
    }

    /// The block that couples row node `i` with column node `j`, to be changed.
    ///
    /// The caller keeps the matrix symmetric: `(j, i)` must receive the transpose.
    pub fn block_mut(&mut self, i: usize, j: usize) -> Option<&mut [f64; 4]> {
        self.slot(i, j).map(|slot| &mut self.values[slot])
    }

    /// The place of the block that couples row node `i` with column node `j`, for [`add_block_at`](Self::add_block_at).
    ///
    /// Matrices of one pattern have the same places.
    pub fn place(&self, i: usize, j: usize) -> Option<usize> {
        self.slot(i, j)
    }

    /// Adds to the block at a place known beforehand: a third of the time of [`add_cell`](Self::add_cell), which searches.
    ///
    /// The caller keeps the matrix symmetric.
    ///
    /// # Panics
    /// If there is no such place.
    #[inline]
    pub fn add_block_at(&mut self, place: usize, block: [f64; 4]) {
        for (value, added) in self.values[place].iter_mut().zip(block) {
            *value += added;
        }
    }

    fn slot(&self, i: usize, j: usize) -> Option<usize> {
        let row = self.pattern.row(i);
        let columns = &self.pattern.columns[row.clone()];
        columns
            .binary_search(&u32::try_from(j).ok()?)
            .ok()
            .map(|k| row.start + k)
    }

    /// Sets every block to zero and keeps the pattern.
    pub fn fill_zero(&mut self) {
        self.values.fill([0.0; 4]);
    }

    /// Adds a cell's matrix to the blocks of its nodes.
    ///
    /// - `nodes`: the `m` nodes of the cell.
    /// - `cell_matrix`: symmetric, row-major over the cell's interleaved dofs, shape `(2 m, 2 m)`.
    ///
    /// # Panics
    /// If the lengths disagree, or if two of the nodes are not coupled in the pattern.
    pub fn add_cell(&mut self, nodes: &[usize], cell_matrix: &[f64]) {
        let width = 2 * nodes.len();
        assert!(
            cell_matrix.len() == width * width,
            "a cell of {} nodes takes a matrix of {} numbers, not {}",
            nodes.len(),
            width * width,
            cell_matrix.len()
        );
        for (&i, rows) in nodes
            .iter()
            .zip(cell_matrix.chunks_exact((2 * width).max(1)))
        {
            let (upper, lower) = rows.split_at(width);
            let row = self.pattern.row(i);
            let columns = &self.pattern.columns[row.clone()];
            let values = &mut self.values[row];
            for (&j, (top, bottom)) in nodes
                .iter()
                .zip(upper.chunks_exact(2).zip(lower.chunks_exact(2)))
            {
                let place = columns.partition_point(|&column| (column as usize) < j);
                assert!(
                    columns
                        .get(place)
                        .is_some_and(|&column| column as usize == j),
                    "nodes {i} and {j} share no cell of the pattern: build it from the cells that are added"
                );
                let block = &mut values[place];
                block[0] += top[0];
                block[1] += top[1];
                block[2] += bottom[0];
                block[3] += bottom[1];
            }
        }
    }

    /// Adds a lumped term, `[m_x, m_y]`, to the diagonal of one node.
    pub fn add_diagonal(&mut self, node: usize, [mass_x, mass_y]: [f64; 2]) {
        if let Some(block) = self.block_mut(node, node) {
            block[0] += mass_x;
            block[3] += mass_y;
        }
    }

    /// Copies the rows of a smaller matrix over those from `first` on.
    ///
    /// # Panics
    /// If a row stores another number of blocks.
    pub fn assign_part(&mut self, first: usize, part: &Self) {
        for node in 0..part.n_nodes() {
            let row = self.pattern.row(first + node);
            self.values[row].copy_from_slice(part.row_blocks(node));
        }
    }

    /// Sets the diagonal of one node.
    pub fn assign_diagonal(&mut self, node: usize, [x, y]: [f64; 2]) {
        if let Some(block) = self.block_mut(node, node) {
            *block = [x, 0.0, 0.0, y];
        }
    }

    /// Sets `A = scale * other`.
    ///
    /// # Panics
    /// If the patterns differ.
    pub fn assign_scaled(&mut self, scale: f64, other: &Self) {
        self.assert_same_pattern(other);
        for (block, from) in self.values.iter_mut().zip(&other.values) {
            *block = from.map(|value| scale * value);
        }
    }

    /// Adds `scale * other` to `A`.
    ///
    /// # Panics
    /// If the patterns differ.
    pub fn add_scaled(&mut self, scale: f64, other: &Self) {
        self.assert_same_pattern(other);
        for (block, from) in self.values.iter_mut().zip(&other.values) {
            for (value, from) in block.iter_mut().zip(from) {
                *value += scale * from;
            }
        }
    }

    fn assert_same_pattern(&self, other: &Self) {
        assert!(
            self.has_pattern_of(other),
            "matrices can only be summed block by block if they were built from the same cells"
        );
    }

    /// Takes fixed dofs out of the matrix: their rows and columns become zero and their diagonal
    /// one.
    ///
    /// - `is_fixed`: one flag per dof, length `n_dofs`.
    ///
    /// # Panics
    /// If `is_fixed` has another length.
    pub fn constrain(&mut self, is_fixed: &[bool]) {
        assert!(
            is_fixed.len() == self.n_dofs(),
            "{} flags were given for {} dofs",
            is_fixed.len(),
            self.n_dofs()
        );
        for node in 0..self.n_nodes() {
            let row = self.pattern.row(node);
            let fixed_row = [is_fixed[2 * node], is_fixed[2 * node + 1]];
            for (&other, block) in self.pattern.columns[row.clone()]
                .iter()
                .zip(&mut self.values[row])
            {
                let other = other as usize;
                let fixed_column = [is_fixed[2 * other], is_fixed[2 * other + 1]];
                if fixed_row == [false; 2] && fixed_column == [false; 2] {
                    continue;
                }
                for (k, value) in block.iter_mut().enumerate() {
                    if fixed_row[k / 2] || fixed_column[k % 2] {
                        *value = if other == node && k / 2 == k % 2 {
                            1.0
                        } else {
                            0.0
                        };
                    }
                }
            }
        }
    }

    /// Writes `y = A x`.
    ///
    /// # Panics
    /// If `x` or `y` does not have `n_dofs` entries.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        self.assert_vectors(x, y);
        Arch::new().dispatch(Multiply { matrix: self, x, y });
    }

    /// Adds `alpha A x` to `y`.
    ///
    /// # Panics
    /// If `x` or `y` does not have `n_dofs` entries.
    pub fn multiply_add(&self, alpha: f64, x: &[f64], y: &mut [f64]) {
        self.assert_vectors(x, y);
        for (node, out) in y.chunks_exact_mut(2).enumerate() {
            let [sum_x, sum_y] = self.multiply_node(node, x);
            out[0] += alpha * sum_x;
            out[1] += alpha * sum_y;
        }
    }

    /// The two entries of `A x` that belong to `node`.
    ///
    /// # Panics
    /// If `x` has fewer than `n_dofs` entries.
    #[inline(always)]
    pub fn multiply_node(&self, node: usize, x: &[f64]) -> [f64; 2] {
        let row = self.pattern.row(node);
        let places = x.as_chunks::<2>().0;
        // Four sums, so that the products of a block go side by side.
        let mut sums = Wide::ZERO;
        for (&other, block) in self.pattern.columns[row.clone()]
            .iter()
            .zip(&self.values[row])
        {
            let [x, y] = places[other as usize];
            sums += Wide(*block) * Wide([x, y, x, y]);
        }
        let Wide(sums) = sums;
        [sums[0] + sums[1], sums[2] + sums[3]]
    }

    fn assert_vectors(&self, x: &[f64], y: &[f64]) {
        let n_dofs = self.n_dofs();
        assert!(
            x.len() == n_dofs && y.len() == n_dofs,
            "a matrix of {n_dofs} dofs was given vectors of {} and {}",
            x.len(),
            y.len()
        );
    }
}
