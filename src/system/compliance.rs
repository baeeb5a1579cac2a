//! The flexibility of a body's surface, `F = (A⁻¹)_bb`, computed column by column when a node first touches something.

use crate::fe::model::Model;
use crate::linalg::cholesky::BlockCholesky;
use crate::math::Mat2;

/// Columns of `A⁻¹` restricted to the boundary nodes, in the body's frame (1/kg).
#[derive(Clone, Debug, Default)]
pub(super) struct Compliance {
    /// Index among the boundary nodes, `u32::MAX` elsewhere.
    slot: Vec<u32>,
    boundary: Vec<usize>,
    /// For each boundary node the 2×2 blocks towards all boundary nodes, once known.
    columns: Vec<Option<Box<[Mat2]>>>,
    scratch: Vec<f64>,
}

impl Compliance {
    pub fn new(model: &Model) -> Self {
        let boundary = model.mesh().boundary().nodes().to_vec();
        let mut slot = vec![u32::MAX; model.n_nodes()];
        for (index, &node) in boundary.iter().enumerate() {
            slot[node] = index as u32;
        }
        Self {
            slot,
            columns: vec![None; boundary.len()],
            boundary,
            scratch: vec![0.0; 4 * model.n_nodes()],
        }
    }

    /// Forgets every column: the factor has changed.
    pub fn clear(&mut self) {
        self.columns.iter_mut().for_each(|column| *column = None);
    }

    /// Computes the column of `node` if it is not known yet; returns whether it was new.
    pub fn prepare(&mut self, node: usize, is_fixed: &[bool], factor: &mut BlockCholesky) -> bool {
        let slot = self.slot[node] as usize;
        if self.columns[slot].is_some() {
            return false;
        }
        let n_dofs = self.scratch.len() / 2;
        self.scratch.fill(0.0);
        for axis in 0..2 {
            if !is_fixed[2 * node + axis] {
                self.scratch[axis * n_dofs + 2 * node + axis] = 1.0;
            }
        }
        factor.solve_many_in_place(&mut self.scratch, 2);
        let (x, y) = self.scratch.split_at(n_dofs);
        let column = self
            .boundary
            .iter()
            .map(|&at| Mat2::new(x[2 * at], y[2 * at], x[2 * at + 1], y[2 * at + 1]))
            .collect();
        self.columns[slot] = Some(column);
        true
    }

    /// Response at `at` to a force at `from`, whose column must be known.
    pub fn get(&self, at: usize, from: usize) -> Mat2 {
        let (at, from) = (self.slot[at] as usize, self.slot[from] as usize);
        match (&self.columns[from], &self.columns[at]) {
            (Some(column), _) => column[at],
            (None, Some(column)) => column[from].transpose(),
            (None, None) => Mat2::zeros(),
        }
    }
}
