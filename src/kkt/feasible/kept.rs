//! Copies of the base, to end a step at.

use super::{BlockBase, FeasiblePath};

/// A copy of the base.
#[derive(Debug, Default)]
pub(super) struct KeptBase {
    base: Vec<BlockBase>,
    nodes: Vec<f64>,
}

/// Which copy of the base.
#[derive(Clone, Copy, Debug)]
pub(in crate::kkt) enum Kept {
    /// Where a step was stopped first.
    Stop = 0,
    /// The best place that the whole of it reached.
    Arrival = 1,
}

impl FeasiblePath {
    /// Keeps a copy of the base.
    pub(in crate::kkt) fn keep_base(&mut self, which: Kept) {
        let kept = &mut self.kept[which as usize];
        kept.base.clone_from(&self.base);
        kept.nodes.clone_from(&self.nodes);
    }

    /// Goes back to the copy kept; surfaces stay where they are.
    pub(in crate::kkt) fn return_to_kept(&mut self, which: Kept) {
        let kept = &self.kept[which as usize];
        self.base.clone_from(&kept.base);
        self.nodes.clone_from(&kept.nodes);
    }
}
