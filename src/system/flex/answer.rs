//! What a flexible body answers to forces: the matrix of its step, its factor, and columns of their inverses as they are asked for.

use super::compliance::Compliance;
use super::shape::Shape;
use crate::fe::model::MassMatrix;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::BlockCholesky;
use crate::math::Mat2;

/// `A` and its factor; of an explicit body the stiffness of its massless nodes.
#[derive(Debug)]
pub(super) struct Answer {
    pub effective: BlockMatrix,
    pub factor: BlockCholesky,
    pub compliance: Compliance,
    /// The factor of a consistent mass and what it answers, once a joint holds on to a node.
    masses: Option<(BlockCholesky, Compliance)>,
    pub n_factorizations: u64,
    pub n_solves: u64,
}

impl Answer {
    pub fn new(effective: BlockMatrix, factor: BlockCholesky, compliance: Compliance) -> Self {
        Self {
            effective,
            factor,
            compliance,
            masses: None,
            n_factorizations: 0,
            n_solves: 0,
        }
    }

    /// Another factor is about to be made: what the last one has answered counts no more.
    pub fn expect_factor(&mut self) {
        self.n_factorizations += 1;
        self.compliance.clear();
    }

    /// Replaces forces by what they move.
    pub fn solve(&mut self, dofs: &mut [f64]) {
        self.factor.solve_in_place(dofs);
        self.n_solves += 1;
    }

    /// Makes the column of a boundary node known.
    pub fn prepare(&mut self, node: usize, is_fixed: &[bool]) {
        if self.compliance.prepare(node, is_fixed, &mut self.factor) {
            self.n_solves += 2;
        }
    }

    /// Operations of one factorization, roughly.
    pub fn factor_operations(&self, n_dofs: usize) -> f64 {
        let stored = self.factor.n_nonzeros() as f64;
        stored * stored / n_dofs as f64
    }

    /// Makes the answer of the masses alone known from a node: nothing to do for nodal masses, one factorization for ever for a
    /// consistent mass.
    pub fn prepare_masses(&mut self, shape: &Shape, node: usize) {
        let model = &shape.model;
        if self.masses.is_none()
            && let MassMatrix::Consistent(mass) = model.mass()
        {
            let mut mass = mass.clone();
            let massless = |dof: usize| model.is_massless(dof / 2);
            let idle: Vec<bool> = (0..shape.n_dofs())
                .map(|dof| shape.is_fixed[dof] || massless(dof))
                .collect();
            mass.constrain(&idle);
            let mut factor = BlockCholesky::analyze(&mass);
            if factor.factorize(&mass).is_err() {
                return;
            }
            self.n_factorizations += 1;
            self.masses = Some((factor, Compliance::new(model)));
        }
        if let Some((factor, compliance)) = &mut self.masses
            && compliance.prepare(node, &shape.is_fixed, factor)
        {
            self.n_solves += 2;
        }
    }

    /// Whether a factor of the masses answers for them all; elsewhere each node answers for itself.
    pub fn knows_masses(&self) -> bool {
        self.masses.is_some()
    }

    /// Replaces impulses by what the masses alone answer to them; only where they are [known](Self::knows_masses).
    pub fn solve_masses(&mut self, dofs: &mut [f64]) {
        if let Some((factor, _)) = &mut self.masses {
            factor.solve_in_place(dofs);
            self.n_solves += 1;
        }
    }

    /// Velocity at one node per impulse at another if nothing but their masses resisted (1/kg), in axes turned by `turn`.
    pub fn of_masses(&self, shape: &Shape, turn: Mat2, at: usize, from: usize) -> Mat2 {
        if let Some((_, compliance)) = &self.masses {
            let local = compliance.get(at, from);
            return turn * local * turn.transpose();
        }
        if at == from {
            shape.inverse_mass(at)
        } else {
            Mat2::zeros()
        }
    }
}
