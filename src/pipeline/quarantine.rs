//! One sick body does not stop the world: the step is taken without it.

use super::error::StepError;
use super::flex_pipeline::FlexPipeline;
use crate::body::FlexBodySet;
use crate::coupling::{RapierSets, quarantine, quarantine_carriers};

impl FlexPipeline {
    /// Takes the step; a body that would end where no number is leaves the world, and the step is tried again without it.
    pub(super) fn step_without_the_sick(
        &mut self,
        sets: &mut RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
    ) -> Result<(), StepError> {
        self.sick.clear();
        quarantine_carriers(sets, flex_bodies, &mut self.sick);
        // What rapier disabled in a try is not disabled again in the next.
        let (mut bodies, mut colliders) = (Vec::new(), Vec::new());
        loop {
            match self.try_step(sets, flex_bodies) {
                Err(StepError::NotFinite(body)) if !self.sick.contains(&body) => {
                    let quarantine_of_rapier = sets.physics_pipeline.quarantine();
                    bodies.extend_from_slice(quarantine_of_rapier.bodies());
                    colliders.extend_from_slice(quarantine_of_rapier.colliders());
                    quarantine(body, sets, flex_bodies);
                    self.sick.push(body);
                }
                Err(error) => return Err(error),
                Ok(()) => break,
            }
        }
        let report = &mut self.report;
        report.quarantined_bodies.append(&mut bodies);
        report.quarantined_colliders.append(&mut colliders);
        report.quarantined_flex_bodies.extend_from_slice(&self.sick);
        Ok(())
    }
}
