//! The position stage: (C.5) with `g(x') >= 0`, `p >= 0` and Coulomb friction on the slip of the step.
//!
//! Divided by `b0` the second row of (C.5) reads `w = W p + g_free / b0`, symmetric in `G`.

use super::delassus::{RowDirection, assemble};
use super::island::{ActiveContact, Island, IslandSummary, KktError, SolveSettings};
use crate::constraint::contact::{ContactMemory, Kinematics};
use crate::linalg::complementarity::{Problem, RowKind, Status};
use crate::system::{Block, Grip};

/// Turning below this angle (rad) changes no position by more than round-off.
const ANGLE_TOLERANCE: f64 = 1e-12;

/// Rounds of adding newly violated candidates within one Newton iteration.
const MAX_ROUNDS: usize = 12;

impl Island {
    pub(super) fn solve_positions(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        let tolerance = self.gap_tolerance();
        self.contacts.clear();
        self.is_working.clear();
        self.is_working.resize(self.candidates.len(), false);
        self.free_motion();
        self.remember_contacts(memory);
        for iteration in 0..settings.max_newton {
            summary.n_newton = iteration + 1;
            if iteration > 0 {
                self.turn_frames();
            }
            let mut turned = 0.0f64;
            for _ in 0..MAX_ROUNDS {
                self.solve_multipliers(settings, summary)?;
                turned = self.correct();
                if !self.add_violated(tolerance, memory) {
                    break;
                }
            }
            let moved = self.refresh_kinematics();
            if turned <= ANGLE_TOLERANCE && moved <= tolerance {
                break;
            }
        }
        summary.gap_violation = self.gap_violation();
        Ok(())
    }

    /// Round-off of a gap: positions of this size, and their predictions, are no better known.
    fn gap_tolerance(&self) -> f64 {
        let mut size = 0.0f64;
        for block in &self.blocks {
            match block {
                Block::Flex(block) => {
                    size = block
                        .positions()
                        .iter()
                        .fold(size, |size, x| size.max(x.abs()));
                }
                Block::Rigid(block) => size = size.max(block.start().centre.amax()),
            }
        }
        1e-12 * (1.0 + size)
    }

    fn free_motion(&mut self) {
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.clear_contact_force();
                block.solve_free();
                block.correct(false);
            }
        }
    }

    /// Solves the free motion again in frames that have turned.
    fn turn_frames(&mut self) {
        for block in &mut self.blocks {
            if let Block::Flex(block) = block
                && block.is_nonlinear()
            {
                block.solve_free();
            }
        }
    }

    /// Opens the working set with what overlaps in the free motion or pressed in the last step.
    fn remember_contacts(&mut self, memory: &ContactMemory) {
        let scene = Self::scene(&self.blocks, &self.parts, &self.segments);
        for (index, candidate) in self.candidates.iter().enumerate() {
            let remembered = memory.recall(&candidate.key);
            let Some(kinematics) = candidate.evaluate(&scene, &remembered) else {
                continue;
            };
            if kinematics.gap < 0.0 || remembered.normal > 0.0 {
                self.is_working[index] = true;
                self.contacts.push(ActiveContact::new(
                    index,
                    kinematics,
                    remembered,
                    &self.blocks,
                ));
            }
        }
    }

    /// One complementarity problem on the working set.
    fn solve_multipliers(
        &mut self,
        settings: &SolveSettings,
        summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        if self.contacts.is_empty() {
            return Ok(());
        }
        for contact in &self.contacts {
            prepare(&mut self.blocks, &contact.kinematics);
        }
        self.rows.clear();
        self.kinds.clear();
        self.free.clear();
        self.multipliers.clear();
        self.statuses.clear();
        for (index, contact) in self.contacts.iter().enumerate() {
            let kinematics = &contact.kinematics;
            let free = kinematics.relative(&self.blocks, |block, grip| block.free_offset(grip));
            let normal_row = self.rows.len();
            self.rows.push(RowDirection {
                contact: index,
                direction: kinematics.normal,
            });
            self.kinds.push(RowKind::Unilateral);
            self.free
                .push((kinematics.gap + free.dot(&kinematics.normal)) / settings.b0);
            self.multipliers.push(contact.multiplier[0]);
            self.statuses.push(contact.status[0]);
            let coefficient = self.candidates[contact.candidate].law.friction;
            if coefficient > 0.0 {
                let moved = kinematics.relative(&self.blocks, |block, grip| {
                    block.position(grip) - block.start_position(grip)
                });
                self.rows.push(RowDirection {
                    contact: index,
                    direction: kinematics.tangent(),
                });
                self.kinds.push(RowKind::Friction {
                    normal: normal_row,
                    coefficient,
                });
                self.free
                    .push((moved + free).dot(&kinematics.tangent()) / settings.b0);
                self.multipliers.push(contact.multiplier[1]);
                self.statuses.push(contact.status[1]);
            }
        }
        let contacts = &self.contacts;
        assemble(
            &self.blocks,
            &self.rows,
            |index| &contacts[index].kinematics,
            &mut self.delassus,
        );
        let problem = Problem {
            delassus: &self.delassus,
            free: &self.free,
            rows: &self.kinds,
        };
        let outcome = self
            .solver
            .solve(&problem, &mut self.multipliers, &mut self.statuses)?;
        summary.n_pivots += outcome.n_pivots;
        summary.residual = outcome.residual;
        self.scatter_multipliers();
        Ok(())
    }

    fn scatter_multipliers(&mut self) {
        for (row, direction) in self.rows.iter().enumerate() {
            let contact = &mut self.contacts[direction.contact];
            let which = usize::from(matches!(self.kinds[row], RowKind::Friction { .. }));
            contact.multiplier[which] = self.multipliers[row];
            contact.status[which] = self.statuses[row];
        }
    }

    /// Moves all blocks by the multipliers; returns the largest turn of a frame (rad).
    fn correct(&mut self) -> f64 {
        self.wrenches.clear();
        self.wrenches.resize(self.blocks.len(), [0.0; 3]);
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.clear_contact_force();
            }
        }
        for contact in &self.contacts {
            Self::spread(
                &mut self.blocks,
                &contact.kinematics,
                contact.multiplier,
                Some(&mut self.wrenches),
                |block, node, force| block.add_contact_force(node, force),
            );
        }
        let has_contact = !self.contacts.is_empty();
        let mut turned = 0.0f64;
        for (block, wrench) in self.blocks.iter_mut().zip(&self.wrenches) {
            match block {
                Block::Flex(block) => turned = turned.max(block.correct(has_contact)),
                Block::Rigid(block) if !block.is_prescribed() => {
                    block.set_position_increment(*wrench)
                }
                Block::Rigid(_) => {}
            }
        }
        turned
    }

    /// Adds candidates that overlap now; returns whether there were any.
    fn add_violated(&mut self, tolerance: f64, memory: &ContactMemory) -> bool {
        let before = self.contacts.len();
        let scene = Self::scene(&self.blocks, &self.parts, &self.segments);
        for (index, candidate) in self.candidates.iter().enumerate() {
            if self.is_working[index] {
                continue;
            }
            let remembered = memory.recall(&candidate.key);
            if let Some(kinematics) = candidate.evaluate(&scene, &remembered)
                && kinematics.gap < -tolerance
            {
                self.is_working[index] = true;
                self.contacts.push(ActiveContact::new(
                    index,
                    kinematics,
                    remembered,
                    &self.blocks,
                ));
            }
        }
        self.contacts.len() > before
    }

    /// Measures the working set again where the blocks are now; returns how far the constraints are from holding (m):
    /// overlaps, gaps of pressing contacts, and slip of sticking ones.
    fn refresh_kinematics(&mut self) -> f64 {
        let scene = Self::scene(&self.blocks, &self.parts, &self.segments);
        let mut error = 0.0f64;
        for contact in &mut self.contacts {
            let candidate = &self.candidates[contact.candidate];
            let Some(kinematics) = candidate.evaluate(&scene, &contact.remembered) else {
                continue;
            };
            error = error.max(-kinematics.gap);
            if contact.multiplier[0] > 0.0 {
                error = error.max(kinematics.gap.abs());
            }
            if contact.status[1] == Status::Stick {
                let moved = kinematics.relative(&self.blocks, |block, grip| {
                    block.position(grip) - block.start_position(grip)
                });
                error = error.max(moved.dot(&kinematics.tangent()).abs());
            }
            contact.kinematics = kinematics;
        }
        error
    }

    fn gap_violation(&self) -> f64 {
        self.contacts
            .iter()
            .fold(0.0, |worst, contact| worst.max(-contact.kinematics.gap))
    }
}

/// Makes the compliances of a contact's nodes known.
fn prepare(blocks: &mut [Block], kinematics: &Kinematics) {
    for attachment in kinematics.attachments() {
        if let (Block::Flex(block), Grip::Node(node)) =
            (&mut blocks[attachment.block], attachment.grip)
        {
            block.prepare_compliance(node);
        }
    }
}

impl ActiveContact {
    fn new(
        candidate: usize,
        kinematics: Kinematics,
        remembered: crate::constraint::contact::Remembered,
        blocks: &[Block],
    ) -> Self {
        let pressed = remembered.normal > 0.0;
        let approach = kinematics
            .relative(blocks, |block, grip| block.start_velocity(grip))
            .dot(&kinematics.normal);
        Self {
            candidate,
            is_hard: !kinematics.is_soft(blocks),
            kinematics,
            multiplier: [remembered.normal, remembered.tangent],
            impulse: [0.0; 2],
            status: if pressed {
                [Status::Stick, Status::Stick]
            } else {
                [Status::Open; 2]
            },
            unresolved: 0.0,
            approach,
            remembered,
        }
    }
}
