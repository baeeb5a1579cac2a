//! What an explicit block knows from the step before that is in no committed state: a snapshot keeps it.

use super::flex_block::FlexBlock;
use serde::{Deserialize, Serialize};

/// The memory of an explicit block.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct ExplicitRecord {
    position: Vec<f64>,
    elastic: Vec<f64>,
    internal: Vec<f64>,
    late_start: Vec<f64>,
    kick: Vec<f64>,
    is_known: bool,
    is_new: bool,
}

impl FlexBlock {
    /// The memory of a block that steps by central difference.
    pub(crate) fn explicit_record(&self) -> Option<ExplicitRecord> {
        let explicit = &self.explicit;
        self.is_explicit().then(|| ExplicitRecord {
            position: self.position.clone(),
            elastic: explicit.elastic.clone(),
            internal: explicit.internal.clone(),
            late_start: explicit.late_start.clone(),
            kick: explicit.kick.clone(),
            is_known: explicit.is_known,
            is_new: explicit.is_new,
        })
    }

    /// Gives a new block the memory of another one; returns whether it fits.
    pub(crate) fn recall(&mut self, record: ExplicitRecord) -> bool {
        let lists = [
            &record.position,
            &record.elastic,
            &record.internal,
            &record.late_start,
            &record.kick,
        ];
        let n_dofs = self.n_dofs();
        if !self.is_explicit() || lists.iter().any(|list| list.len() != n_dofs) {
            return false;
        }
        self.position = record.position;
        let explicit = &mut self.explicit;
        explicit.elastic = record.elastic;
        explicit.internal = record.internal;
        explicit.late_start = record.late_start;
        explicit.kick = record.kick;
        explicit.is_known = record.is_known;
        explicit.is_new = record.is_new;
        true
    }
}
