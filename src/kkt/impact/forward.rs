//! Multipliers at the forward increment, for `β0 = 0`; see `kkt/forward.rs`.

use super::Treatment;
use crate::kkt::forward;
use crate::kkt::island::{Island, KktError, SolveSettings};
use crate::kkt::summary::IslandSummary;

/// The treatment of explicit steps.
#[derive(Debug)]
pub(super) struct Forward;

impl Treatment for Forward {
    fn finish(
        &self,
        island: &mut Island,
        settings: &SolveSettings,
        summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        forward::solve_forward(island, settings, summary)
    }
}
