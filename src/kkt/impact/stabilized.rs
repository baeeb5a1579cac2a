//! Projection, and an energy stage after it: the default.

use super::Treatment;
use super::projected::Projected;
use crate::kkt::island::{Island, KktError, SolveSettings};
use crate::kkt::summary::IslandSummary;

/// See [`ImpactTreatment::Stabilized`](crate::kkt::ImpactTreatment::Stabilized).
#[derive(Debug)]
pub(super) struct Stabilized;

impl Treatment for Stabilized {
    fn finish(
        &self,
        island: &mut Island,
        settings: &SolveSettings,
        summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        Projected.finish(island, settings, summary)
    }

    fn limits_energy(&self) -> bool {
        true
    }
}
