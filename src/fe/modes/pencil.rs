//! `K` and `M` with held dofs taken out, and the operator `(K + s M)⁻¹ M`.

use crate::fe::mass_matrix::MassMatrix;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};

/// The matrices of one search.
pub(super) struct Pencil<'a> {
    /// With rows and columns of held dofs empty but for a one.
    stiffness: BlockMatrix,
    mass: &'a MassMatrix,
    pub(super) is_held: Vec<bool>,
    shifted: BlockMatrix,
    factor: BlockCholesky,
    pub(super) n_factorizations: usize,
    pub(super) n_solves: usize,
}

impl<'a> Pencil<'a> {
    /// # Panics
    /// If `is_held` is neither empty nor one flag per dof.
    pub(super) fn new(mut stiffness: BlockMatrix, mass: &'a MassMatrix, is_held: &[bool]) -> Self {
        let n_dofs = stiffness.n_dofs();
        assert!(
            is_held.is_empty() || is_held.len() == n_dofs,
            "{} flags were given for {n_dofs} dofs",
            is_held.len()
        );
        let is_held = match is_held {
            [] => vec![false; n_dofs],
            flags => flags.to_vec(),
        };
        stiffness.constrain(&is_held);
        Self {
            shifted: stiffness.clone(),
            factor: BlockCholesky::analyze(&stiffness),
            stiffness,
            mass,
            is_held,
            n_factorizations: 0,
            n_solves: 0,
        }
    }

    pub(super) fn n_dofs(&self) -> usize {
        self.stiffness.n_dofs()
    }

    pub(super) fn stiffness(&self) -> &BlockMatrix {
        &self.stiffness
    }

    /// Whether a dof is free and carries mass.
    pub(super) fn is_massive(&self, dof: usize) -> bool {
        !self.is_held[dof] && self.diagonal_mass(dof) > 0.0
    }

    fn diagonal_mass(&self, dof: usize) -> f64 {
        let node = dof / 2;
        match self.mass {
            MassMatrix::Lumped(mass) => mass[node],
            MassMatrix::Consistent(mass) => mass.block(node, node).map_or(0.0, |block| block[0]),
        }
    }

    /// The largest `K_ii/M_ii` (rad²/s²): a scale of the highest `ω²`.
    pub(super) fn largest_ratio(&self) -> f64 {
        let massive = (0..self.n_dofs()).filter(|&dof| self.is_massive(dof));
        let ratios = massive.map(|dof| {
            let node = dof / 2;
            let block = self.stiffness.block(node, node);
            block.map_or(0.0, |block| block[3 * (dof % 2)]).abs() / self.diagonal_mass(dof)
        });
        ratios.fold(0.0, f64::max)
    }

    /// `M x`, zero at held dofs.
    pub(super) fn mass_times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        self.mass.multiply_add(1.0, x, &mut y);
        for (y, &is_held) in y.iter_mut().zip(&self.is_held) {
            if is_held {
                *y = 0.0;
            }
        }
        y
    }

    /// `φ·K φ`, and the sum of the sizes of its terms, which bounds its rounding.
    pub(super) fn stiffness_of(&self, shape: &[f64]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (node, own) in shape.chunks_exact(2).enumerate() {
            let blocks = self.stiffness.row_blocks(node);
            for (&other, block) in self.stiffness.neighbours(node).iter().zip(blocks) {
                let other = &shape[2 * other as usize..][..2];
                for (k, entry) in block.iter().enumerate() {
                    let term = own[k / 2] * entry * other[k % 2];
                    sums[0] += term;
                    sums[1] += term.abs();
                }
            }
        }
        sums
    }

    /// Factorizes `K + s M`.
    pub(super) fn factorize(&mut self, shift: f64) -> Result<(), CholeskyError> {
        self.shifted.assign_scaled(1.0, &self.stiffness);
        self.mass.add_to(shift, &mut self.shifted);
        self.shifted.constrain(&self.is_held);
        self.n_factorizations += 1;
        self.factor.factorize(&self.shifted)
    }

    /// Replaces the columns of `M x` by `(K + s M)⁻¹ M x`.
    pub(super) fn solve(&mut self, columns: &mut [f64]) {
        let n_columns = columns.len() / self.n_dofs();
        self.n_solves += n_columns;
        self.factor.solve_many_in_place(columns, n_columns);
    }
}
