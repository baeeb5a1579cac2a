//! What is done when Newton's iterations fail: first overlaps that were put there are left alone, then the step is taken
//! linearised, and if that throws a body about, the island stays where it is for a step.

use super::island::{Island, KktError, SolveSettings};
use super::position::PARTING_RATE;
use super::summary::IslandSummary;
use crate::constraint::contact::ContactMemory;
use crate::math::exp;
use crate::system::Block;

/// Solves for the working set of a linearised step.
const LINEAR_ROUNDS: usize = 3;

/// Motion within a step, beyond the body's own and relative to its size, that no contact explains.
const THROWN: f64 = 0.5;

/// Turn (rad) of a joined rigid body within a step, beyond its own, that no joint explains.
const TURNED: f64 = 0.5;

/// Multiple of the greatest speed before a collision that none gives: a light body between heavy ones gets twice, the
/// tip of a bar some times more.
const FLUNG: f64 = 10.0;

/// The same for a linearised step of joints, which begins with what the last one gave: it may be as fast, or cross the body, and no more.
const JERKED: f64 = 1.0;

/// Overlap, relative to the smallest flexible body, that no step in doubt leaves: someone has put it there.
const PUT_INTO: f64 = 1e-2;

impl Island {
    pub(super) fn fall_back(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        tolerance: f64,
        summary: &mut IslandSummary,
    ) {
        summary.is_doubtful = true;
        // Bodies that stick in each other may ask for what no position can give.
        self.ignores_overlaps = true;
        self.start_again(settings, tolerance, memory);
        if self.iterate(settings, memory, tolerance, summary) && !self.is_astray() {
            return;
        }
        let is_solved = self
            .linear_step(settings, memory, tolerance, summary)
            .is_ok()
            && !self.passes_through();
        let has_joints = !self.ties.is_empty();
        let is_thrown = self.blocks.iter().any(|block| match block {
            Block::Flex(block) => block.excess_motion() > THROWN,
            Block::Rigid(block) => has_joints && block.excess_turn() > TURNED,
        });
        if is_thrown || !is_solved {
            summary.is_held = self.end_together(summary);
        }
    }

    /// Puts the bodies and the working set back to where the iterations began.
    pub(super) fn start_again(
        &mut self,
        settings: &SolveSettings,
        tolerance: f64,
        memory: &ContactMemory,
    ) {
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.restart();
            }
        }
        self.open_working_set(settings, tolerance, memory);
    }

    /// Holds the island if contact, or a linearised step of joints, has flung a member away faster than any collision could,
    /// or if a step in doubt has fed it; see [`Island::is_fed`].
    ///
    /// Joints that iterations closed may well fling: what was stretched is let go. In a linearised step the rows of a body that
    /// turns point where it no longer is, and every step begins with more speed than the last.
    pub(super) fn hold_if_flung(
        &mut self,
        settings: &SolveSettings,
        supply: f64,
        summary: &mut IslandSummary,
    ) {
        let is_pulled = summary.is_linearized && !self.ties.is_empty();
        let greatest = match (is_pulled, self.contacts.is_empty()) {
            (true, _) => JERKED,
            (false, false) => FLUNG,
            (false, true) => return,
        };
        let is_fed = !self.contacts.is_empty() && self.is_fed(supply, summary);
        let dt = settings.dt;
        let (mut before, mut after) = (0.0f64, 0.0f64);
        for block in &self.blocks {
            if let Block::Flex(block) = block {
                let [start, end] = block.fastest();
                // Faster than across the body in a step, whatever it met.
                before = before.max(start).max(block.size() / dt);
                after = after.max(end);
            } else if let Block::Rigid(block) = block {
                let moved = (block.drift().centre - block.start().centre).norm();
                before = before.max(moved / dt);
            }
        }
        if is_fed || after > greatest * before {
            summary.is_held = self.end_together(summary);
            self.measure_ended(settings, summary);
        }
    }

    /// Whether a step in doubt has more than doubled the energy that there was, with what loads and springs have done (`supply`, J):
    /// such energy is stored in bodies that the iterations have wedged where no motion leads, and no velocity can give it back.
    fn is_fed(&self, supply: f64, summary: &IslandSummary) -> bool {
        let [before, after] = [summary.start_energy, summary.end_energy].map(|[k, e]| k + e);
        // Bodies that were put into each other are pressed apart, whatever energy that takes.
        let sizes = self.blocks.iter().filter_map(|block| match block {
            Block::Flex(block) => Some(block.size()),
            Block::Rigid(_) => None,
        });
        let deep = PUT_INTO * sizes.fold(f64::INFINITY, f64::min);
        let mut contacts = self.contacts.iter();
        let is_parting = contacts.any(|contact| contact.allowance < -deep);
        let gain = after - before - supply;
        summary.is_doubtful && !is_parting && gain > before + supply.max(0.0)
    }

    /// The step that is taken when Newton's iterations fail: every block linearised, three rounds for the working set.
    fn linear_step(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        tolerance: f64,
        summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        let kept = exp(-PARTING_RATE * settings.dt);
        summary.is_linearized = true;
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.linearize();
            }
        }
        self.open_working_set(settings, tolerance, memory);
        for round in 0..LINEAR_ROUNDS {
            self.correct();
            self.measure(round > 0);
            // There is no next iteration that a neighbour could take over in.
            for contact in &mut self.contacts {
                contact.is_lost = false;
            }
            self.add_violated(tolerance, kept, memory);
            if round == 0 {
                self.refresh_rows(false);
            }
            self.solve_multipliers(settings, round == 0, tolerance, summary)?;
        }
        self.correct();
        self.measure(false);
        Ok(())
    }
}
