//! The numeric factorization: `L_jj L_jjᵀ = A_jj − Σ_k L_jk L_jkᵀ`.
//!
//! Below the diagonal, `L_ij = (A_ij − Σ_k L_ik L_jkᵀ) L_jj⁻ᵀ`.
//!
//! It looks left: each panel in turn gathers its columns of `A` into full-length rows, subtracts
//! what earlier panels contribute, factorizes its diagonal block and scales the rows below. The
//! rows are indexed by position, so no relative places are ever looked up.
//!
//! Throughout, `K` is the number of dof columns of a panel (2, 4, 6 or 8), and `N` the number of
//! places per dof row in which the columns of the target panel are kept (2, 4 or 8).

use super::diagonal::invert_factor;
use super::ordering::Ordering;
use super::panels::{Panel, Panels, View};
use crate::linalg::block_matrix::BlockMatrix;
use faer::traits::pulp::{Simd, WithSimd};

/// The two dof rows of one node, `N` places each, one after the other.
pub(super) type NodeRow = [f64; 16];

/// Where the entries of each column of the permuted matrix come from.
#[derive(Debug, Clone)]
pub(super) struct Sources {
    /// Where the blocks of each position begin in `blocks`.
    start: Vec<u32>,
    /// The place of block `(column, row)` among the blocks of the matrix, and the position of its
    /// row.
    blocks: Vec<[u32; 2]>,
}

impl Sources {
    pub fn new(matrix: &BlockMatrix, ordering: &Ordering, panels: &Panels) -> Self {
        let (mut start, mut blocks) = (vec![0], Vec::new());
        for panel in &panels.panels {
            for position in panel.first..panel.first + panel.width {
                let node = ordering.node_at[position as usize] as usize;
                let row_start = matrix.row_start(node);
                for (k, &other) in matrix.neighbours(node).iter().enumerate() {
                    // The diagonal block is wanted whole, because it is eliminated by rows.
                    let row = ordering.position_of[other as usize];
                    if row >= panel.first {
                        blocks.push([(row_start + k) as u32, row]);
                    }
                }
                start.push(blocks.len() as u32);
            }
        }
        Self { start, blocks }
    }

    /// Notes the positions whose columns hold a block that differs between two sets of values.
    pub fn list_changed(&self, [one, other]: [&[[f64; 4]]; 2], is_changed: &mut Vec<bool>) {
        is_changed.clear();
        is_changed.extend(self.start.windows(2).map(|range| {
            let mut own = self.blocks[range[0] as usize..range[1] as usize].iter();
            own.any(|&[place, _]| one[place as usize] != other[place as usize])
        }));
    }
}

/// A pivot that was not positive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Failure {
    pub position: usize,
    pub pivot: f64,
    pub diagonal: f64,
}

/// The whole factorization, as a task for one instruction set.
pub(super) struct Factorize<'a> {
    pub panels: &'a Panels,
    pub sources: &'a Sources,
    pub blocks: &'a [[f64; 4]],
    pub values: &'a mut [[f64; 4]],
    /// Zero at entry, and again at the end unless it fails. The last row takes what belongs to no
    /// row.
    pub rows: &'a mut [NodeRow],
    /// The panels to be made anew; all if empty. What others hold must be right already.
    pub is_wanted: &'a [bool],
}

impl WithSimd for Factorize<'_> {
    type Output = Result<(), Failure>;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> Self::Output {
        for (index, panel) in self.panels.panels.iter().enumerate() {
            if self.is_wanted.get(index) == Some(&false) {
                continue;
            }
            match panel.width {
                1 => self.eliminate::<2, 2>(panel),
                2 => self.eliminate::<4, 4>(panel),
                3 => self.eliminate::<6, 8>(panel),
                _ => self.eliminate::<8, 8>(panel),
            }?;
        }
        Ok(())
    }
}

impl Factorize<'_> {
    #[inline(always)]
    fn eliminate<const K: usize, const N: usize>(&mut self, panel: &Panel) -> Result<(), Failure> {
        self.load::<N>(panel);
        let first = panel.first as usize;
        let own = first..first + K / 2;
        let mut diagonal = [0.0; K];
        for ((c, entries), row) in diagonal
            .chunks_exact_mut(2)
            .enumerate()
            .zip(&self.rows[own.clone()])
        {
            entries.copy_from_slice(&[row[2 * c], row[N + 2 * c + 1]]);
        }
        self.subtract_earlier::<N>(panel);
        let mut block = [[0.0; N]; K];
        for (pair, row) in block.chunks_exact_mut(2).zip(&mut self.rows[own]) {
            pair[0].copy_from_slice(&row[..N]);
            pair[1].copy_from_slice(&row[N..2 * N]);
            row[..2 * N].fill(0.0);
        }
        let inverse = invert_factor(block, &diagonal).map_err(|(column, pivot)| Failure {
            position: first + column / 2,
            pivot,
            diagonal: diagonal[column],
        })?;
        self.store(panel, &inverse);
        Ok(())
    }

    /// Scatters the panel's columns of `A` over the rows.
    #[inline(always)]
    fn load<const N: usize>(&mut self, panel: &Panel) {
        let starts =
            &self.sources.start[panel.first as usize..=(panel.first + panel.width) as usize];
        for (column, range) in starts.windows(2).enumerate() {
            for &[place, row] in &self.sources.blocks[range[0] as usize..range[1] as usize] {
                // The block is (column, row): its transpose goes here.
                let [xx, xy, yx, yy] = self.blocks[place as usize];
                let row = &mut self.rows[row as usize];
                row[2 * column] = xx;
                row[2 * column + 1] = yx;
                row[N + 2 * column] = xy;
                row[N + 2 * column + 1] = yy;
            }
        }
    }

    /// Subtracts the products of all earlier panels that reach into this one.
    #[inline(always)]
    fn subtract_earlier<const N: usize>(&mut self, panel: &Panel) {
        let Self {
            panels,
            values,
            rows,
            ..
        } = self;
        for update in &panels.updates[panel.updates[0] as usize..panel.updates[1] as usize] {
            let source = &panels.panels[update.source as usize];
            let reach = update.rows.map(|row| (row - source.rows[0]) as usize);
            match source.width {
                1 => subtract_panel::<2, N>(
                    panels.view::<2>(source, values),
                    reach,
                    panel.first,
                    rows,
                ),
                2 => subtract_panel::<4, N>(
                    panels.view::<4>(source, values),
                    reach,
                    panel.first,
                    rows,
                ),
                3 => subtract_panel::<6, N>(
                    panels.view::<6>(source, values),
                    reach,
                    panel.first,
                    rows,
                ),
                _ => subtract_panel::<8, N>(
                    panels.view::<8>(source, values),
                    reach,
                    panel.first,
                    rows,
                ),
            }
        }
    }

    /// Writes the panel: the inverse of its diagonal factor, and the rows below times its
    /// transpose.
    #[inline(always)]
    fn store<const K: usize, const N: usize>(&mut self, panel: &Panel, inverse: &[[f64; N]; K]) {
        let indices = &self.panels.rows[panel.rows[0] as usize..panel.rows[1] as usize];
        let n_diagonal = K.div_ceil(4) * K;
        let values =
            &mut self.values[panel.values as usize..][..n_diagonal + indices.len() / 2 * K];
        let (diagonal, tiles) = values.split_at_mut(n_diagonal);
        for (t, tile) in diagonal.chunks_exact_mut(K).enumerate() {
            for (k, column) in tile.iter_mut().enumerate() {
                *column = std::array::from_fn(|q| inverse.get(4 * t + q).map_or(0.0, |row| row[k]));
            }
        }
        let mut transposed = [[0.0; N]; K];
        for j in 0..K {
            for k in 0..K {
                transposed[j][k] = inverse[k][j];
            }
        }
        scale_rows(&transposed, indices, self.rows, tiles);
    }
}

/// Takes the rows below a panel times the transposed inverse of its diagonal factor, and leaves
/// them zero.
#[inline(always)]
fn scale_rows<const K: usize, const N: usize>(
    transposed: &[[f64; N]; K],
    indices: &[u32],
    rows: &mut [NodeRow],
    tiles: &mut [[f64; 4]],
) {
    for (tile, pair) in tiles.chunks_exact_mut(K).zip(indices.chunks_exact(2)) {
        let mut out = [[0.0; N]; 4];
        for (half, &row) in pair.iter().enumerate() {
            let row = &mut rows[row as usize][..2 * N];
            for j in 0..K {
                // The transposed inverse is upper triangular: whole registers of zeros are passed
                // over.
                for l in j / 4 * 4..N {
                    out[2 * half][l] += row[j] * transposed[j][l];
                    out[2 * half + 1][l] += row[N + j] * transposed[j][l];
                }
            }
            row.fill(0.0);
        }
        for k in 0..K {
            tile[k] = [out[0][k], out[1][k], out[2][k], out[3][k]];
        }
    }
}

/// Subtracts `L_ik L_jkᵀ` of one earlier panel `k` from the rows of the panel `j` that begins at
/// position `first`.
///
/// - `reach`: which rows of the earlier panel are columns of the panel `j`; they and all below are
///   changed.
#[inline(always)]
fn subtract_panel<const K: usize, const N: usize>(
    source: View<'_>,
    reach: [usize; 2],
    first: u32,
    rows: &mut [NodeRow],
) {
    let mut factor = [[0.0; N]; K];
    for row in reach[0]..reach[1] {
        let column = (2 * (source.indices[row] - first) as usize).min(N - 2);
        let tile = &source.tiles[row / 2 * K..][..K];
        let half = row % 2 * 2;
        for k in 0..K {
            factor[k][column] = tile[k][half];
            factor[k][column + 1] = tile[k][half + 1];
        }
    }
    let start = reach[0] / 2;
    subtract_product(
        &source.tiles[start * K..],
        &source.indices[2 * start..],
        &factor,
        first,
        rows,
    );
}

/// Subtracts `tiles * factor` from the rows that the tiles stand for.
///
/// - `first`: what would change rows before this position goes to the last of `rows` instead.
#[inline(always)]
pub(super) fn subtract_product<const K: usize, const N: usize>(
    tiles: &[[f64; 4]],
    indices: &[u32],
    factor: &[[f64; N]; K],
    first: u32,
    rows: &mut [NodeRow],
) {
    let no_row = rows.len() - 1;
    for (tile, pair) in tiles.chunks_exact(K).zip(indices.chunks_exact(2)) {
        let upper = if pair[0] < first {
            no_row
        } else {
            pair[0] as usize
        };
        let lower = pair[1] as usize;
        let (mut a, mut b) = (rows[upper], rows[lower]);
        for (column, factor) in tile.iter().zip(factor) {
            for l in 0..N {
                a[l] -= column[0] * factor[l];
                a[N + l] -= column[1] * factor[l];
                b[l] -= column[2] * factor[l];
                b[N + l] -= column[3] * factor[l];
            }
        }
        rows[upper][..2 * N].copy_from_slice(&a[..2 * N]);
        rows[lower][..2 * N].copy_from_slice(&b[..2 * N]);
    }
}
