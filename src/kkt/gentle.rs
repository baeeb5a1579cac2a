//! The end of a step whose forces cannot be trusted: where the surfaces were first stopped, with velocities that no contact has added to.
//!
//! Positions stay on the feasible path. Velocities are those of the motion without contact, projected so that nothing that touches
//! approaches: a projection in the metric of the masses takes energy and never gives any, and its impulses come in pairs.

use super::island::{Island, KktError, SolveSettings};
use super::summary::IslandSummary;
use crate::constraint::contact::ContactMemory;
use crate::linalg::complementarity::Status;
use crate::system::Block;

/// Energy beyond what there was and what loads have done that tells of forces that are none (-): as much as the tests of energy allow.
pub const GAINED: f64 = 0.01;

/// Gap up to which bodies count as touching, relative to the margin (-).
const TOUCHING: f64 = 1.0;

impl Island {
    /// Whether a step along the path that is not solved has gained energy.
    ///
    /// Parts of a step that gain a little each are not to gain much together: each has its share. What contact has taken before is not theirs to
    /// give back.
    pub(super) fn has_gained(&self, settings: &SolveSettings, summary: &IslandSummary) -> bool {
        let [before, after] = [summary.start_energy, summary.end_energy].map(|[k, e]| k + e);
        let is_unsolved = (summary.is_cut || summary.is_stopped) && !self.path.is_empty();
        // Forces that no solution gave do no work to count on: neither of joints nor of driven bodies.
        let supply = self.applied_work().max(0.0);
        let gain = after - before - supply;
        let share = GAINED * settings.dt / settings.whole;
        is_unsolved && (gain.is_nan() || gain > share * (before + supply))
    }

    /// Ends the step where it was first stopped, or where it began, without forces of position.
    ///
    /// # Errors
    /// If a number is not finite.
    pub(super) fn end_gently(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        (summary.is_cut, summary.is_stopped) = (false, true);
        let tolerance = self.gap_tolerance(settings);
        if !self.return_to_first_stop() {
            self.return_to_start(settings, memory, tolerance);
        }
        let touching = TOUCHING * self.path.least_margin();
        for contact in &mut self.contacts {
            let is_near = contact.base.is_none_or(|base| base.gap <= touching);
            // Closed for the law of velocities, with no force of position to speak of.
            let pressed = if is_near { f64::MIN_POSITIVE } else { 0.0 };
            contact.multiplier = [pressed, 0.0];
            contact.impulse = [0.0; 2];
            contact.settled = [0.0; 2];
            contact.status = [Status::Open; 2];
            contact.is_massless = false;
        }
        for tie in &mut self.ties {
            tie.multiplier = 0.0;
            (tie.kick, tie.impulse) = (0.0, 0.0);
        }
        self.correct();
        self.path.stop(&mut self.blocks);
        for block in &mut self.blocks {
            match block {
                Block::Flex(block) => {
                    block.place_velocities();
                    block.measure_elastic_energy();
                }
                Block::Rigid(block) => block.forget_contact(),
            }
        }
        summary.gap_violation = self.gap_violation();
        settings.treatment().finish(self, settings, summary)?;
        summary.work = self.actual_work(settings) + self.joint_work(settings);
        summary.end_energy = self.end_energy();
        Ok(())
    }
}
