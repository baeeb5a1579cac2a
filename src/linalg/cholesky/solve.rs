//! Substitution: `L y = P b`, then `Lᵀ P x = y`, one right-hand side or eight at a time.
//!
//! Forwards, a panel solves for its own dofs and subtracts from the rows below; backwards, it
//! gathers the rows below and then solves. Its diagonal block is kept as an inverse, so solving is
//! multiplying, without divisions in line. `K` is the number of dof columns of a panel.

use super::factor::{NodeRow, subtract_product};
use super::panels::{Panel, Panels};
use faer::traits::pulp::{Simd, WithSimd};

/// The solve for one right-hand side, as a task for one instruction set.
pub(super) struct SolveOne<'a> {
    pub panels: &'a Panels,
    pub values: &'a [[f64; 4]],
    pub node_at: &'a [u32],
    /// In elimination order. The last node stands for rows that fill up a pair and stays zero.
    pub work: &'a mut [[f64; 2]],
    pub x: &'a mut [f64],
}

impl WithSimd for SolveOne<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        for (y, &node) in self.work.iter_mut().zip(self.node_at) {
            y.copy_from_slice(&self.x[2 * node as usize..][..2]);
        }
        for panel in &self.panels.panels {
            match panel.width {
                1 => self.forward::<2>(panel),
                2 => self.forward::<4>(panel),
                3 => self.forward::<6>(panel),
                _ => self.forward::<8>(panel),
            }
        }
        for panel in self.panels.panels.iter().rev() {
            match panel.width {
                1 => self.backward::<2>(panel),
                2 => self.backward::<4>(panel),
                3 => self.backward::<6>(panel),
                _ => self.backward::<8>(panel),
            }
        }
        for (y, &node) in self.work.iter().zip(self.node_at) {
            self.x[2 * node as usize..][..2].copy_from_slice(y);
        }
    }
}

impl SolveOne<'_> {
    #[inline(always)]
    fn forward<const K: usize>(&mut self, panel: &Panel) {
        let view = self.panels.view::<K>(panel, self.values);
        let own = self.work[panel.first as usize..][..K / 2].as_flattened_mut();
        let mut y = [0.0; K];
        y.copy_from_slice(own);
        let mut solved = [0.0; 8];
        for (tile, out) in view
            .diagonal
            .chunks_exact(K)
            .zip(solved.chunks_exact_mut(4))
        {
            out.copy_from_slice(&multiply_tile(tile, &y));
        }
        y.copy_from_slice(&solved[..K]);
        own.copy_from_slice(&y);
        for (tile, pair) in view.tiles.chunks_exact(K).zip(view.indices.chunks_exact(2)) {
            let product = multiply_tile(tile, &y);
            let upper = &mut self.work[pair[0] as usize];
            upper[0] -= product[0];
            upper[1] -= product[1];
            let lower = &mut self.work[pair[1] as usize];
            lower[0] -= product[2];
            lower[1] -= product[3];
        }
    }

    #[inline(always)]
    fn backward<const K: usize>(&mut self, panel: &Panel) {
        let view = self.panels.view::<K>(panel, self.values);
        let mut sums = [[0.0; 4]; K];
        for (tile, pair) in view.tiles.chunks_exact(K).zip(view.indices.chunks_exact(2)) {
            let [x0, x1] = self.work[pair[0] as usize];
            let [x2, x3] = self.work[pair[1] as usize];
            add_transposed(tile, &[x0, x1, x2, x3], &mut sums);
        }
        let own = self.work[panel.first as usize..][..K / 2].as_flattened_mut();
        let mut y = [0.0; 8];
        for ((y, own), sum) in y.iter_mut().zip(own.iter()).zip(&sums) {
            *y = own - add_up(sum);
        }
        let mut sums = [[0.0; 4]; K];
        for (tile, y) in view.diagonal.chunks_exact(K).zip(y.chunks_exact(4)) {
            add_transposed(tile, &[y[0], y[1], y[2], y[3]], &mut sums);
        }
        for (own, sum) in own.iter_mut().zip(&sums) {
            *own = add_up(sum);
        }
    }
}

/// `tile * y`, even and odd columns apart so that two chains of additions run side by side.
#[inline(always)]
fn multiply_tile<const K: usize>(tile: &[[f64; 4]], y: &[f64; K]) -> [f64; 4] {
    let (mut even, mut odd) = ([0.0; 4], [0.0; 4]);
    for (columns, y) in tile.chunks_exact(2).zip(y.chunks_exact(2)) {
        for q in 0..4 {
            even[q] += columns[0][q] * y[0];
            odd[q] += columns[1][q] * y[1];
        }
    }
    std::array::from_fn(|q| even[q] + odd[q])
}

/// Adds to each column's sums the products of its entries with `x`.
#[inline(always)]
fn add_transposed<const K: usize>(tile: &[[f64; 4]], x: &[f64; 4], sums: &mut [[f64; 4]; K]) {
    for (sum, column) in sums.iter_mut().zip(tile) {
        for q in 0..4 {
            sum[q] += column[q] * x[q];
        }
    }
}

#[inline(always)]
fn add_up(sum: &[f64; 4]) -> f64 {
    (sum[0] + sum[2]) + (sum[1] + sum[3])
}

/// The solve for up to eight right-hand sides, as a task for one instruction set.
pub(super) struct SolveEight<'a> {
    pub panels: &'a Panels,
    pub values: &'a [[f64; 4]],
    pub node_at: &'a [u32],
    /// In elimination order: eight numbers of a node's x, then eight of its y.
    pub work: &'a mut [NodeRow],
    /// Column-major, at most eight columns.
    pub columns: &'a mut [f64],
}

impl WithSimd for SolveEight<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        let n_nodes = self.node_at.len();
        self.work.fill([0.0; 16]);
        for (k, column) in self.columns.chunks_exact(2 * n_nodes).enumerate() {
            for (row, &node) in self.work.iter_mut().zip(self.node_at) {
                let entries = &column[2 * node as usize..][..2];
                row[k] = entries[0];
                row[8 + k] = entries[1];
            }
        }
        for panel in &self.panels.panels {
            match panel.width {
                1 => self.forward::<2>(panel),
                2 => self.forward::<4>(panel),
                3 => self.forward::<6>(panel),
                _ => self.forward::<8>(panel),
            }
        }
        for panel in self.panels.panels.iter().rev() {
            match panel.width {
                1 => self.backward::<2>(panel),
                2 => self.backward::<4>(panel),
                3 => self.backward::<6>(panel),
                _ => self.backward::<8>(panel),
            }
        }
        for (k, column) in self.columns.chunks_exact_mut(2 * n_nodes).enumerate() {
            for (row, &node) in self.work.iter().zip(self.node_at) {
                column[2 * node as usize..][..2].copy_from_slice(&[row[k], row[8 + k]]);
            }
        }
    }
}

impl SolveEight<'_> {
    #[inline(always)]
    fn forward<const K: usize>(&mut self, panel: &Panel) {
        let own = &mut self.work[panel.first as usize..][..K / 2];
        if own.iter().all(|row| *row == [0.0; 16]) {
            return;
        }
        let view = self.panels.view::<K>(panel, self.values);
        let y = gather::<K>(own);
        let mut solved = [[0.0; 8]; 8];
        for (tile, solved) in view
            .diagonal
            .chunks_exact(K)
            .zip(solved.chunks_exact_mut(4))
        {
            let mut sums = [[0.0; 8]; 4];
            for (column, y) in tile.iter().zip(&y) {
                for l in 0..8 {
                    sums[0][l] += column[0] * y[l];
                    sums[1][l] += column[1] * y[l];
                    sums[2][l] += column[2] * y[l];
                    sums[3][l] += column[3] * y[l];
                }
            }
            solved.copy_from_slice(&sums);
        }
        let mut y = [[0.0; 8]; K];
        y.copy_from_slice(&solved[..K]);
        scatter(&y, own);
        subtract_product(view.tiles, view.indices, &y, 0, self.work);
    }

    #[inline(always)]
    fn backward<const K: usize>(&mut self, panel: &Panel) {
        let view = self.panels.view::<K>(panel, self.values);
        let mut y = gather::<K>(&self.work[panel.first as usize..][..K / 2]);
        // Two columns at a time: their sums stay in registers while the rows pass by.
        for (k, y) in y.chunks_exact_mut(2).enumerate() {
            let [mut a, mut b] = [y[0], y[1]];
            for (tile, pair) in view.tiles.chunks_exact(K).zip(view.indices.chunks_exact(2)) {
                let (upper, lower) = (&self.work[pair[0] as usize], &self.work[pair[1] as usize]);
                let columns = &tile[2 * k..2 * k + 2];
                for l in 0..8 {
                    a[l] -= columns[0][0] * upper[l];
                    a[l] -= columns[0][1] * upper[8 + l];
                    a[l] -= columns[0][2] * lower[l];
                    a[l] -= columns[0][3] * lower[8 + l];
                    b[l] -= columns[1][0] * upper[l];
                    b[l] -= columns[1][1] * upper[8 + l];
                    b[l] -= columns[1][2] * lower[l];
                    b[l] -= columns[1][3] * lower[8 + l];
                }
            }
            [y[0], y[1]] = [a, b];
        }
        let mut x = [[0.0; 8]; K];
        for (k, x) in x.iter_mut().enumerate() {
            let mut sum = [0.0; 8];
            for (tile, y) in view.diagonal.chunks_exact(K).zip(y.chunks(4)) {
                for (factor, y) in tile[k].iter().zip(y) {
                    for l in 0..8 {
                        sum[l] += factor * y[l];
                    }
                }
            }
            *x = sum;
        }
        scatter(&x, &mut self.work[panel.first as usize..][..K / 2]);
    }
}

/// Splits the rows of nodes into rows of dofs.
#[inline(always)]
fn gather<const K: usize>(rows: &[NodeRow]) -> [[f64; 8]; K] {
    let mut dofs = [[0.0; 8]; K];
    dofs.as_flattened_mut().copy_from_slice(rows.as_flattened());
    dofs
}

/// Joins rows of dofs to rows of nodes.
#[inline(always)]
fn scatter<const K: usize>(dofs: &[[f64; 8]; K], rows: &mut [NodeRow]) {
    rows.as_flattened_mut().copy_from_slice(dofs.as_flattened());
}
