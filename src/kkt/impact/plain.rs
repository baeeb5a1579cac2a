//! (C.5) as printed: every multiplier acts on velocity and acceleration. The multiplier of an impact lingers in the stored
//! acceleration, and the energy of a bouncing bar grows without bound.

use super::Treatment;
use crate::kkt::island::{Island, KktError, SolveSettings};
use crate::kkt::summary::IslandSummary;
use crate::kkt::velocity;

/// No treatment.
#[derive(Debug)]
pub(super) struct Plain;

impl Treatment for Plain {
    fn finish(
        &self,
        island: &mut Island,
        settings: &SolveSettings,
        _summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        velocity::keep_plain_forces(island);
        if !island.joints.ties.is_empty() {
            // Joints hold their velocities all the same.
            for contact in &mut island.contacts {
                contact.is_settled = true;
            }
            velocity::finish_joints(island, settings)?;
        }
        Ok(())
    }
}
