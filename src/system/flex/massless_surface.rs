//! Nodes without mass in an explicit step: they follow the others quasi-statically,
//! `K_ss u_s = f_s + Gᵀp - K_sm u_m`.
//!
//! Only the block `K_ss` of the stiffness is factorized, once: it holds the nodes whose mass has moved inwards, a strip along
//! the contact boundary, and never the mesh.

use crate::fe::model::Model;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::BlockCholesky;
use crate::math::Mat2;

/// The massless nodes of a body by their own numbering, and what is known of `K_ss⁻¹`.
#[derive(Clone, Debug, Default)]
pub(super) struct MasslessSurface {
    /// The massless nodes, ascending.
    pub nodes: Vec<usize>,
    /// Index among them, `u32::MAX` elsewhere.
    slot: Vec<u32>,
    /// For each massless node the 2×2 blocks of `K_ss⁻¹` towards all of them, once known (m/N).
    columns: Vec<Option<Box<[Mat2]>>>,
    /// Right-hand side and solution of the local solve, interleaved.
    pub local: Vec<f64>,
}

impl MasslessSurface {
    /// Finds the massless nodes and copies `K_ss`, in which pinned dofs are taken out.
    pub fn new(model: &Model, is_fixed: &[bool]) -> (Self, BlockMatrix) {
        let nodes: Vec<usize> = model.massless_support().map(|(node, _)| node).collect();
        let mut slot = vec![u32::MAX; model.n_nodes()];
        for (index, &node) in nodes.iter().enumerate() {
            slot[node] = index as u32;
        }
        let pairs: Vec<[usize; 2]> = nodes
            .iter()
            .enumerate()
            .flat_map(|(row, &node)| {
                let slots = model.stiffness().neighbours(node).iter();
                let slots = slots.map(|&other| slot[other as usize]);
                slots
                    .filter(|&other| other != u32::MAX)
                    .map(move |column| [row, column as usize])
            })
            .collect();
        let mut block = BlockMatrix::from_cells(nodes.len(), pairs.iter().map(|pair| &pair[..]));
        for &[row, column] in &pairs {
            let source = model.stiffness().block(nodes[row], nodes[column]);
            if let (Some(source), Some(copy)) = (source, block.block_mut(row, column)) {
                *copy = *source;
            }
        }
        let fixed: Vec<bool> = nodes
            .iter()
            .flat_map(|&node| [is_fixed[2 * node], is_fixed[2 * node + 1]])
            .collect();
        block.constrain(&fixed);
        let surface = Self {
            columns: vec![None; nodes.len()],
            local: vec![0.0; 2 * nodes.len()],
            nodes,
            slot,
        };
        (surface, block)
    }

    /// Makes the column of `K_ss⁻¹` of a massless node known; returns whether it was new.
    pub fn prepare(&mut self, node: usize, is_fixed: &[bool], factor: &mut BlockCholesky) -> bool {
        let slot = self.slot[node] as usize;
        if self.columns.get(slot).is_none_or(Option::is_some) {
            return false;
        }
        let mut columns = [vec![0.0; self.local.len()], vec![0.0; self.local.len()]];
        for (axis, column) in columns.iter_mut().enumerate() {
            if !is_fixed[2 * node + axis] {
                column[2 * slot + axis] = 1.0;
                factor.solve_in_place(column);
            }
        }
        let [x, y] = columns;
        let block = |at: usize| Mat2::new(x[2 * at], y[2 * at], x[2 * at + 1], y[2 * at + 1]);
        self.columns[slot] = Some((0..self.nodes.len()).map(block).collect());
        true
    }

    /// Displacement at one massless node per force at another (m/N), the column of one of which must be known; zero
    /// between other nodes.
    pub fn flexibility(&self, at: usize, from: usize) -> Mat2 {
        let (at, from) = (self.slot[at] as usize, self.slot[from] as usize);
        match (self.columns.get(from), self.columns.get(at)) {
            (Some(Some(column)), Some(_)) => column[at],
            (Some(None), Some(Some(column))) => column[from].transpose(),
            _ => Mat2::zeros(),
        }
    }
}
