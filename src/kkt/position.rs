//! The position stage: (C.5) with `g(x') >= 0`, `p >= 0` and Coulomb friction on the slip of the step.
//!
//! Divided by `b0` the second row of (C.5) reads `w = W p + b`, symmetric in `G`. Each Newton iteration solves the blocks
//! under the multipliers it has, beginning with those of the last step; measures gaps and slips there; and, unless they
//! hold, finds new multipliers from `b = g / b0 - W p`. A contact at rest so costs one solve.

mod measure;

use super::constraint_function::{ContactMethod, Trial};
use super::follow::Passed;
use super::island::{ActiveContact, Island, SolveSettings};
use super::summary::IslandSummary;
use crate::constraint::contact::{ContactMemory, Kinematics};
use crate::math::{Vec2, exp, judged::Judged, rounding};
use crate::system::{Block, Response};

/// Rate at which bodies that were put into each other part (1/s): a third of the overlap in a step of 1/60 s.
pub(super) const PARTING_RATE: Judged = Judged::new("kkt::PARTING_RATE", 24.0);

/// Round-off of gaps, relative to the extent of the scene.
pub(super) const ROUND_OFF: f64 = 2.0 * rounding::SUM;

/// Multiple of the tolerance from which an overlap counts as put there.
pub(super) const OVERLAPPED: Judged = Judged::new("kkt::OVERLAPPED", 1e7);

/// Times that a contact without a gap is let go within a step.
const LET_GO: u8 = 2;

/// How far frames have turned since the iterate before.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turned {
    /// Of the one that has turned farthest (rad).
    pub angle: f64,
    /// By how much that changes the places that were found, at most (m).
    pub way: f64,
}

impl Island {
    pub(super) fn solve_positions(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        summary: &mut IslandSummary,
    ) {
        let tolerance = self.gap_tolerance(settings);
        self.open_working_set(settings, tolerance, memory);
        self.find_margin(tolerance);
        let is_solved = match &settings.contact {
            ContactMethod::Lagrange => false,
            ContactMethod::ConstraintFunction(functions) => {
                let trial = Trial {
                    functions,
                    settings,
                    memory,
                    tolerance,
                };
                self.iterate_functions(&trial, summary)
            }
        };
        let mut passed = if is_solved {
            Passed::Solved
        } else {
            self.follow_path(settings, memory, tolerance, summary)
        };
        if self.path.is_empty() {
            // What is out of range ends its body's step, and is told by name.
            if self.is_in_range() && self.path.has_met_itself(&self.blocks) {
                self.start_again(settings, tolerance, memory);
                passed = self.follow_path(settings, memory, tolerance, summary);
            }
        }
        summary.is_cut = passed == Passed::Arrived;
        summary.is_stopped = passed == Passed::Stopped;
        if !self.path.is_empty() {
            if summary.is_unsolved() {
                self.path.stop(&mut self.blocks);
                self.measure_signed();
            }
            self.list_parted();
        } else if summary.is_stopped && !settings.may_be_cut {
            // No path tells how far the bodies may go.
            self.end_together(settings.dt, summary);
        }
        if !self.ties.is_empty() {
            self.prepare_joints();
            self.twists.relax(&mut self.blocks);
        }
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.place_velocities();
                block.measure_elastic_energy();
            }
        }
        // Blocks may answer by another factor from here on.
        self.prepare_joints();
        summary.gap_violation = self.gap_violation(summary.is_unsolved());
        summary.slip_violation = self.slip_violation();
        summary.joint_violation = self.joint_violation();
    }

    /// Puts the bodies and the working set back to where the step begins.
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

    /// Empties the working set but for what pressed in the last step.
    pub(super) fn open_working_set(
        &mut self,
        settings: &SolveSettings,
        tolerance: f64,
        memory: &ContactMemory,
    ) {
        let kept = exp(-PARTING_RATE * settings.dt);
        self.contacts.clear();
        self.is_working.clear();
        self.is_working.resize(self.candidates.len(), false);
        self.open_joints(settings);
        self.remember_contacts(OVERLAPPED * tolerance, kept, memory);
    }

    /// Round-off of a gap: positions of this size, and their predictions, are no better known.
    pub(super) fn gap_tolerance(&self, settings: &SolveSettings) -> f64 {
        ROUND_OFF * self.extent(settings)
    }

    /// How far positions are from the origin, and a unit of length (m): what rounding is a share of.
    pub(super) fn extent(&self, settings: &SolveSettings) -> f64 {
        let size = self.blocks.iter().fold(0.0f64, |size, block| match block {
            Block::Flex(block) => size.max(block.extent()),
            Block::Rigid(block) => size.max(block.start().centre.amax()),
        });
        settings.length_unit + size
    }

    /// Opens the working set with what pressed in the last step.
    fn remember_contacts(&mut self, slop: f64, kept: f64, memory: &ContactMemory) {
        self.pressed_before.clear();
        let scene = Self::scene(&self.blocks, &self.parts, &self.segments);
        for (index, candidate) in self.candidates.iter().enumerate() {
            // By another point too: what they stored of their forces still acts.
            if memory.has_pressed(candidate.key.owners()) {
                self.pressed_before.push(candidate.pair.blocks());
            }
            let remembered = memory.recall(&candidate.key);
            if remembered.normal <= 0.0 {
                continue;
            }
            if let Some(kinematics) = candidate.evaluate(&scene, &remembered) {
                let friction = candidate.law.friction;
                let blocks = &self.blocks;
                let mut contact =
                    ActiveContact::new(index, kinematics, remembered, friction, blocks);
                contact.allow_overlap(kept, slop, candidate, &scene);
                if self.is_held_by_joints(&kinematics) {
                    continue;
                }
                self.is_working[index] = true;
                self.contacts.push(contact);
            }
        }
    }

    /// Moves all blocks by the multipliers; returns how far the frames have turned.
    pub(super) fn correct(&mut self) -> Turned {
        self.wrenches.clear();
        self.wrenches.resize(self.blocks.len(), [0.0; 3]);
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.clear_contact_force();
            }
        }
        for contact in &self.contacts {
            let is_late = contact.kinematics.is_quasi_static();
            let wrenches = (!is_late).then_some(&mut self.wrenches[..]);
            Self::spread(
                &mut self.blocks,
                &contact.kinematics,
                contact.multiplier,
                wrenches,
                |block, node, force, lever| block.add_stage_force(node, force, lever, is_late),
            );
        }
        self.spread_joints();
        let mut turned = Turned::default();
        for (block, wrench) in self.blocks.iter_mut().zip(&self.wrenches) {
            match block {
                Block::Flex(block) => {
                    let angle = block.solve();
                    turned.angle = turned.angle.max(angle);
                    let way = angle * block.turning_share() * block.size();
                    turned.way = turned.way.max(way);
                }
                Block::Rigid(block) => block.set_position_increment(*wrench),
            }
        }
        self.add_across(Response::Position, 1.0);
        turned
    }

    /// Measures the working set where the blocks are now; returns how far the laws are from holding (m): overlaps, gaps
    /// of pressing contacts, slip of sticking ones, and slip that friction drives instead of opposing.
    ///
    /// The forces keep acting along the rows they have: gaps are true, and Newton's matrix is that of the rows. With
    /// `extrapolates` gaps follow the rows too, which always converges.
    pub(super) fn measure(&mut self, extrapolates: bool) -> f64 {
        let error = self.measure_joints();
        error.max(self.measure_contacts(extrapolates))
    }

    /// Measures the working set under the multipliers of the last step; returns how far the laws are from holding, extrapolated from the
    /// beginning of the step (m).
    pub(super) fn measure_guess(&mut self) -> f64 {
        let error = self.extrapolate_joints();
        error.max(self.measure_contacts(true))
    }

    /// Measures the signed contacts where the blocks are now; returns how far their laws are from holding there in truth (m).
    pub(super) fn measure_signed(&mut self) -> f64 {
        let scene = Self::scene(&self.blocks, &self.parts, &self.segments);
        let signed = self.contacts.iter_mut().filter(|one| one.base.is_none());
        let errors = signed
            .map(|contact| contact.measure(&self.candidates[contact.candidate], &scene, false));
        errors.fold(0.0, f64::max)
    }

    fn measure_contacts(&mut self, extrapolates: bool) -> f64 {
        let mut error = 0.0f64;
        let scene = Self::scene(&self.blocks, &self.parts, &self.segments);
        for contact in &mut self.contacts {
            let candidate = &self.candidates[contact.candidate];
            error = error.max(match contact.base {
                Some(base) => {
                    let onward = self.path.onward(&contact.kinematics, &self.blocks);
                    contact.measure_from(base, onward, candidate.law.friction)
                }
                None => contact.measure(candidate, &scene, extrapolates),
            });
        }
        error
    }

    /// Makes the measured geometry the rows that forces act along.
    pub(super) fn refresh_rows(&mut self) {
        for contact in &mut self.contacts {
            let gap = contact.kinematics.gap;
            contact.applied = contact.kinematics;
            contact.kinematics = contact.measured;
            contact.kinematics.gap = gap;
            contact.known = None;
        }
        self.refresh_joints();
    }

    /// Adds candidates that overlap now; returns whether there were any.
    pub(super) fn add_violated(
        &mut self,
        tolerance: f64,
        kept: f64,
        memory: &ContactMemory,
    ) -> bool {
        let before = self.contacts.len();
        let scene = Self::scene(&self.blocks, &self.parts, &self.segments);
        for (index, candidate) in self.candidates.iter().enumerate() {
            // Near pairs of the path come after the signed candidates.
            if self.is_working.get(index).is_none_or(|works| *works) {
                continue;
            }
            let remembered = memory.recall(&candidate.key);
            let found = candidate.evaluate(&scene, &remembered);
            let Some(kinematics) = found.filter(|found| found.gap < -tolerance) else {
                continue;
            };
            let friction = candidate.law.friction;
            let mut contact =
                ActiveContact::new(index, kinematics, remembered, friction, &self.blocks);
            let slop = OVERLAPPED * tolerance;
            contact.allow_overlap(kept, slop, candidate, &scene);
            let is_left_alone = self.is_held_by_joints(&kinematics);
            if !is_left_alone && contact.kinematics.gap < -tolerance {
                self.is_working[index] = true;
                self.contacts.push(contact);
            }
        }
        self.contacts.len() > before
    }

    /// What friction that is wedged against itself has given way by; see `follow::consistent` (m).
    fn slip_violation(&self) -> f64 {
        let slips = self
            .contacts
            .iter()
            .map(|contact| contact.yielding[1] * contact.multiplier[1].abs());
        slips.fold(0.0, f64::max)
    }

    /// Largest overlap that is left at a contact (m): where the blocks are, which is the base of the path where the step `is_stopped` there, and else
    /// what was found last.
    pub(super) fn gap_violation(&self, is_stopped: bool) -> f64 {
        self.contacts
            .iter()
            .filter(|contact| !contact.is_lost || contact.multiplier[0] > 0.0)
            .map(|contact| match contact.base {
                Some(base) if is_stopped => base.gap,
                _ => contact.gap(),
            })
            .fold(0.0, |worst, gap| worst.max(-gap))
    }
}

/// Tangential motion of the point against the target's material since the beginning of the step (m).
pub(super) fn slip(kinematics: &Kinematics, blocks: &[Block]) -> f64 {
    moved(kinematics, blocks).dot(&kinematics.tangent())
}

/// Motion of the point against the target since the beginning of the step, linear in the dofs of rigid blocks (m).
fn moved(kinematics: &Kinematics, blocks: &[Block]) -> Vec2 {
    kinematics.relative(blocks, |block, grip| block.displacement(grip))
}
