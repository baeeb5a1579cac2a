//! What an explicit block knows from the step before that is in no committed state: a snapshot keeps it.

use super::explicit::Explicit;
use super::shared::Shared;
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

impl ExplicitRecord {
    /// What a block knows.
    pub(super) fn of(explicit: &Explicit, shared: &Shared) -> Self {
        Self {
            position: shared.now.position.clone(),
            elastic: explicit.elastic.clone(),
            internal: explicit.internal.clone(),
            late_start: explicit.late_start.clone(),
            kick: explicit.kick.clone(),
            is_known: explicit.is_known,
            is_new: explicit.is_new,
        }
    }

    /// Gives it to a new block; returns whether it fits.
    pub(super) fn recall(self, explicit: &mut Explicit, shared: &mut Shared) -> bool {
        let lists = [
            &self.position,
            &self.elastic,
            &self.internal,
            &self.late_start,
            &self.kick,
        ];
        let n_dofs = shared.shape.n_dofs();
        if lists.iter().any(|list| list.len() != n_dofs) {
            return false;
        }
        shared.now.position = self.position;
        explicit.elastic = self.elastic;
        explicit.internal = self.internal;
        explicit.late_start = self.late_start;
        explicit.kick = self.kick;
        explicit.is_known = self.is_known;
        explicit.is_new = self.is_new;
        true
    }
}
