//! Projection of velocities and accelerations: `M Δv = Gᵀπ` such that masses in contact neither part nor approach, and the same
//! for accelerations (Hughes, Taylor, Sackman, Curnier, Kanoknukulchai 1976; Laursen, Love 2002), with `A` in the place of `M`.

use super::Treatment;
use crate::kkt::island::{Island, KktError, SolveSettings};
use crate::kkt::summary::IslandSummary;
use crate::kkt::{hits, momentum, velocity};

/// See [`ImpactTreatment::Projected`](crate::kkt::ImpactTreatment::Projected).
#[derive(Debug)]
pub(super) struct Projected;

impl Treatment for Projected {
    fn finish(
        &self,
        island: &mut Island,
        settings: &SolveSettings,
        summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        velocity::solve_velocities(island, settings)?;
        if !summary.is_unsolved() {
            hits::carry_on(island);
        }
        momentum::balance_angular_momentum(island);
        Ok(())
    }
}
