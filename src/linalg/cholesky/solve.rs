//! Substitution: `L y = P b`, then `Lᵀ P x = y`, one, two or eight right-hand sides at a time.
//!
//! Forwards, a panel solves for its own dofs and subtracts from the rows below; backwards, it
//! gathers the rows below and then solves. Its diagonal block is kept as an inverse, so solving is
//! multiplying, without divisions in line. `K` is the number of dof columns of a panel.

use super::factor::{NodeRow, subtract_product};
use super::panels::{Panel, Panels, View};
use faer::traits::pulp::{Scalar, Simd, WithSimd};

/// The solve for `R` right-hand sides, one or two, as a task for one instruction set.
///
/// A second right-hand side costs less than the first, because a panel comes from far memory once
/// for both.
pub(super) struct SolveFew<'a, const R: usize> {
    pub panels: &'a Panels,
    pub values: &'a [[f64; 4]],
    pub node_at: &'a [u32],
    /// In elimination order. The last node stands for rows that fill up a pair.
    pub work: &'a mut [[[f64; 2]; R]],
    /// Column-major.
    pub columns: &'a mut [f64],
}

impl<const R: usize> WithSimd for SolveFew<'_, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // A tile has four rows: wider registers than that are left to the compiler.
        if S::F64_LANES > 4 {
            self.run(Scalar::new());
        } else {
            self.run(simd);
        }
    }
}

impl<const R: usize> SolveFew<'_, R> {
    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) {
        let n_nodes = self.node_at.len();
        for (r, column) in self.columns.chunks_exact((2 * n_nodes).max(1)).enumerate() {
            for (y, &node) in self.work.iter_mut().zip(self.node_at) {
                y[r].copy_from_slice(&column[2 * node as usize..][..2]);
            }
        }
        self.work[n_nodes] = [[0.0; 2]; R];
        for panel in &self.panels.panels {
            match panel.width {
                1 => self.forward::<S, 2>(simd, panel),
                2 => self.forward::<S, 4>(simd, panel),
                3 => self.forward::<S, 6>(simd, panel),
                _ => self.forward::<S, 8>(simd, panel),
            }
        }
        for panel in self.panels.panels.iter().rev() {
            match panel.width {
                1 => self.backward::<S, 2>(simd, panel),
                2 => self.backward::<S, 4>(simd, panel),
                3 => self.backward::<S, 6>(simd, panel),
                _ => self.backward::<S, 8>(simd, panel),
            }
        }
        for (r, column) in self
            .columns
            .chunks_exact_mut((2 * n_nodes).max(1))
            .enumerate()
        {
            for (y, &node) in self.work.iter().zip(self.node_at) {
                column[2 * node as usize..][..2].copy_from_slice(&y[r]);
            }
        }
    }

    /// Solves for the dofs of a panel and subtracts from the rows below; nothing while they are
    /// zero, as most are under a load on a few nodes.
    #[inline(always)]
    fn forward<S: Simd, const K: usize>(&mut self, simd: S, panel: &Panel) {
        let first = panel.first as usize;
        let own = first..first + K / 2;
        let view = self.panels.view::<K>(panel, self.values);
        for r in 0..R {
            let mut y = [0.0; 8];
            for (y, node) in y.chunks_exact_mut(2).zip(&self.work[own.clone()]) {
                y.copy_from_slice(&node[r]);
            }
            if y == [0.0; 8] {
                continue;
            }
            let factors = y.map(|y| simd.splat_f64s(y));
            for (t, tile) in view.diagonal.as_chunks::<K>().0.iter().enumerate() {
                // The inverse is lower triangular: a tile ends with its last row.
                let solved = match t {
                    0 if K > 4 => multiply::<S, 4>(simd, &tile[..4], &factors),
                    _ => multiply::<S, K>(simd, tile, &factors),
                };
                y[4 * t..4 * t + 4].copy_from_slice(&solved);
            }
            for (y, node) in y.chunks_exact(2).zip(&mut self.work[own.clone()]) {
                node[r].copy_from_slice(y);
            }
            let factors = y.map(|y| simd.splat_f64s(y));
            for (tile, pair) in tiles_of::<K>(&view) {
                let product = multiply::<S, K>(simd, tile, &factors);
                let upper = &mut self.work[pair[0] as usize][r];
                upper[0] -= product[0];
                upper[1] -= product[1];
                let lower = &mut self.work[pair[1] as usize][r];
                lower[0] -= product[2];
                lower[1] -= product[3];
            }
        }
    }

    /// Gathers the rows below a panel, last row first so that memory is read in one direction, and
    /// solves for its dofs.
    #[inline(always)]
    fn backward<S: Simd, const K: usize>(&mut self, simd: S, panel: &Panel) {
        let first = panel.first as usize;
        let own = first..first + K / 2;
        let view = self.panels.view::<K>(panel, self.values);
        for r in 0..R {
            let mut sums = Sums::<S, K>::new(simd);
            for (tile, pair) in tiles_of::<K>(&view).rev() {
                let [x0, x1] = self.work[pair[0] as usize][r];
                let [x2, x3] = self.work[pair[1] as usize][r];
                sums.add(simd, tile, &[x0, x1, x2, x3]);
            }
            let mut y = [0.0; 8];
            for (y, node) in y.chunks_exact_mut(2).zip(&self.work[own.clone()]) {
                y.copy_from_slice(&node[r]);
            }
            for (y, sum) in y.iter_mut().zip(sums.totals()) {
                *y -= sum;
            }
            let mut sums = Sums::<S, K>::new(simd);
            for (tile, y) in view.diagonal.as_chunks::<K>().0.iter().zip(y.as_chunks().0) {
                sums.add(simd, tile, y);
            }
            let totals = sums.totals();
            for (x, node) in totals.chunks_exact(2).zip(&mut self.work[own.clone()]) {
                node[r].copy_from_slice(x);
            }
        }
    }
}

/// The tiles below a panel, each with the two nodes whose rows it holds.
#[inline(always)]
fn tiles_of<'a, const K: usize>(
    view: &View<'a>,
) -> impl DoubleEndedIterator<Item = (&'a [[f64; 4]; K], &'a [u32; 2])> {
    let (tiles, pairs) = (view.tiles.as_chunks::<K>().0, view.indices.as_chunks().0);
    tiles.iter().zip(pairs)
}

/// The first `K` columns of a tile times as many numbers, each spread over a register.
///
/// Even and odd columns are summed apart so that two chains of additions run side by side. Written
/// with explicit registers: left alone, the compiler halves and transposes them.
#[inline(always)]
fn multiply<S: Simd, const K: usize>(
    simd: S,
    tile: &[[f64; 4]],
    factors: &[S::f64s; 8],
) -> [f64; 4] {
    let mut product = [0.0; 4];
    for (part, out) in S::as_mut_simd_f64s(&mut product).0.iter_mut().enumerate() {
        let term = |k: usize| simd.mul_f64s(S::as_simd_f64s(&tile[k]).0[part], factors[k]);
        let (mut even, mut odd) = (term(0), term(1));
        for k in (2..K).step_by(2) {
            even = simd.add_f64s(even, term(k));
            odd = simd.add_f64s(odd, term(k + 1));
        }
        *out = simd.add_f64s(even, odd);
    }
    product
}

/// The products of each column of some tiles with numbers for their rows, not yet added up.
struct Sums<S: Simd, const K: usize> {
    /// Four numbers a column: the first `4 / F64_LANES` registers.
    columns: [[S::f64s; 4]; K],
}

impl<S: Simd, const K: usize> Sums<S, K> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let columns = [[simd.splat_f64s(0.0); 4]; K];
        Self { columns }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, tile: &[[f64; 4]; K], x: &[f64; 4]) {
        let x = S::as_simd_f64s(x).0;
        for (sums, column) in self.columns.iter_mut().zip(tile) {
            let column = S::as_simd_f64s(column).0;
            for ((sum, column), x) in sums.iter_mut().zip(column).zip(x) {
                *sum = simd.add_f64s(*sum, simd.mul_f64s(*column, *x));
            }
        }
    }

    #[inline(always)]
    fn totals(&self) -> [f64; K] {
        std::array::from_fn(|k| {
            let mut entries = [0.0; 4];
            let parts = S::as_mut_simd_f64s(&mut entries).0;
            for (part, sum) in parts.iter_mut().zip(&self.columns[k]) {
                *part = *sum;
            }
            (entries[0] + entries[2]) + (entries[1] + entries[3])
        })
    }
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
    /// For each panel whether its unknowns are wanted; empty if all are.
    pub is_wanted: &'a [bool],
}

impl WithSimd for SolveEight<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        let n_nodes = self.node_at.len();
        self.work.fill([0.0; 16]);
        for (k, column) in self.columns.chunks_exact((2 * n_nodes).max(1)).enumerate() {
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
        for (index, panel) in self.panels.panels.iter().enumerate().rev() {
            if self.is_wanted.get(index) == Some(&false) {
                continue;
            }
            match panel.width {
                1 => self.backward::<2>(panel),
                2 => self.backward::<4>(panel),
                3 => self.backward::<6>(panel),
                _ => self.backward::<8>(panel),
            }
        }
        for (k, column) in self
            .columns
            .chunks_exact_mut((2 * n_nodes).max(1))
            .enumerate()
        {
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
