//! The flexibility of a body's surface, `F = (A⁻¹)_bb`, computed a few nodes at a time when the first of them touches something.

use crate::fe::model::Model;
use crate::linalg::cholesky::{BlockCholesky, Selection};
use crate::math::Mat2;

/// Nodes whose columns are computed together: eight right-hand sides take hardly longer than three, and what touches at
/// one node soon touches at the next ones.
const BATCH: usize = 4;

/// The column of one node. Its room is kept when the factor changes.
#[derive(Clone, Debug, Default)]
struct Column {
    is_known: bool,
    blocks: Vec<Mat2>,
}

/// Columns of `A⁻¹` restricted to the boundary nodes, in the body's frame (1/kg).
#[derive(Clone, Debug, Default)]
pub(super) struct Compliance {
    /// Index among the boundary nodes, `u32::MAX` elsewhere.
    slot: Vec<u32>,
    boundary: Vec<usize>,
    /// For each boundary node the 2×2 blocks towards all boundary nodes, if they are known.
    columns: Vec<Column>,
    /// The part of the factor that the boundary depends on, once known.
    selection: Option<Selection>,
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
            columns: vec![Column::default(); boundary.len()],
            boundary,
            selection: None,
            scratch: vec![0.0; 4 * BATCH * model.n_nodes()],
        }
    }

    /// Forgets every column: the factor has changed.
    pub fn clear(&mut self) {
        let columns = self.columns.iter_mut();
        columns.for_each(|column| column.is_known = false);
    }

    /// Computes the columns of `node` and of those of its group along the boundary, if they are not known yet; returns whether
    /// they were new.
    pub fn prepare(&mut self, node: usize, is_fixed: &[bool], factor: &mut BlockCholesky) -> bool {
        let own = self.slot[node] as usize;
        if self.columns[own].is_known {
            return false;
        }
        // Groups that do not depend on who was asked for before: a column is the same bits whenever it is computed.
        let first = own - own % BATCH;
        let batch = first..self.boundary.len().min(first + BATCH);
        let n_new = batch.len();
        let n_dofs = self.scratch.len() / (2 * BATCH);
        let responses = &mut self.scratch[..2 * n_new * n_dofs];
        responses.fill(0.0);
        for (pair, slot) in responses.chunks_exact_mut(2 * n_dofs).zip(batch.clone()) {
            for axis in 0..2 {
                let dof = 2 * self.boundary[slot] + axis;
                if !is_fixed[dof] {
                    pair[axis * n_dofs + dof] = 1.0;
                }
            }
        }
        let boundary = &self.boundary;
        let selection = self
            .selection
            .get_or_insert_with(|| factor.select(boundary.iter().copied()));
        factor.solve_many_for(selection, responses, 2 * n_new);
        for (pair, slot) in responses.chunks_exact(2 * n_dofs).zip(batch) {
            let (x, y) = pair.split_at(n_dofs);
            let block = |&at: &usize| Mat2::new(x[2 * at], y[2 * at], x[2 * at + 1], y[2 * at + 1]);
            let column = &mut self.columns[slot];
            column.is_known = true;
            column.blocks.clear();
            column.blocks.extend(boundary.iter().map(block));
        }
        true
    }

    /// Response at `at` to a force at `from`, whose column must be known.
    pub fn get(&self, at: usize, from: usize) -> Mat2 {
        let (at, from) = (self.slot[at] as usize, self.slot[from] as usize);
        let (forth, back) = (&self.columns[from], &self.columns[at]);
        if forth.is_known {
            forth.blocks[at]
        } else if back.is_known {
            back.blocks[from].transpose()
        } else {
            Mat2::zeros()
        }
    }
}
