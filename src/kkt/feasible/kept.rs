//! Places on the path that a step may come back to.

use super::{BlockBase, FeasiblePath};
use crate::system::Block;

/// A copy of the base.
#[derive(Debug, Default)]
pub(in crate::kkt) struct KeptBase {
    base: Vec<BlockBase>,
    nodes: Vec<f64>,
}

impl FeasiblePath {
    /// Copies the base.
    pub(in crate::kkt) fn keep_base(&self, kept: &mut KeptBase) {
        kept.base.clone_from(&self.base);
        kept.nodes.clone_from(&self.nodes);
    }

    /// Goes back to a copy; surfaces stay where they are.
    pub(in crate::kkt) fn return_to(&mut self, kept: &KeptBase) {
        self.base.clone_from(&kept.base);
        self.nodes.clone_from(&kept.nodes);
    }

    /// Leaves these rigid blocks at the base.
    pub(in crate::kkt) fn stop_rigid(&self, blocks: &mut [Block], which: &[bool]) {
        let stopped = which.iter().enumerate().filter(|(_, stops)| **stops);
        for (index, _) in stopped {
            if let Block::Rigid(body) = &mut blocks[index] {
                let base = &self.base[index];
                body.stop_at(base.centre, base.angle());
            }
        }
    }

    /// Leaves the blocks at the base, with what else the iterate found.
    pub(in crate::kkt) fn stop(&self, blocks: &mut [Block]) {
        for (base, block) in self.base.iter().zip(blocks) {
            match (block, base.nodes) {
                (Block::Flex(body), Some(first)) => {
                    let n = body.positions().len();
                    body.stop_at(&self.nodes[first..first + n]);
                }
                (Block::Rigid(body), _) => body.stop_at(base.centre, base.angle()),
                _ => {}
            }
        }
    }
}
