//! Joints whose ends were put apart: they close over several steps, and what closes them leaves no velocity.
//!
//! A position stage that moves a row by `c` because its ends do not meet yet does so with a multiplier `W⁻¹ c / b0` beyond what
//! the law of motion asks for. That part acts on positions only, as the pseudo-velocities do with which rigid-body engines correct theirs: ends that are
//! `d` apart would fly at each other with `d/dt` otherwise, and a chain of such joints at its far end with the sum of all. What joints answer to
//! contacts that part bodies is taken out in the same way: these are not felt by velocities either. The next step begins without both.

use super::active_contact::ActiveContact;
use super::island::{Island, KktError, SolveSettings};
use super::joint_law::Finish;
use super::joint_rows::{ActiveJoint, add_wrench};
use super::joint_system::Rows;
use super::sparse::Asked;
use super::summary::IslandSummary;
use crate::constraint::joint::unit_wrench;
use crate::linalg::complementarity::RowKind;
use crate::system::{Block, Point, Response};

impl Island {
    /// Takes what closes joints out of velocities and accelerations.
    ///
    /// # Errors
    /// If a number is not finite.
    pub(super) fn take_out_closings(&mut self, settings: &SolveSettings) -> Result<(), KktError> {
        if settings.is_explicit || !(self.closes() || self.parts_joined()) {
            return Ok(());
        }
        self.gather_partings();
        self.rows.clear();
        self.kinds.clear();
        self.free.clear();
        self.acted.clear();
        self.joint_rows.clear();
        self.joint_gives.clear();
        for (index, tie) in self.ties.iter().enumerate() {
            if tie.holds() {
                self.joint_rows.push(index);
                self.joint_gives.push(0.0);
                let achieved = if tie.closing == 0.0 {
                    0.0
                } else {
                    tie.closing + tie.gap
                };
                let parted = self.parted(tie);
                self.free.push(parted - achieved / settings.b0);
                self.kinds.push(RowKind::Bilateral);
            }
        }
        self.solve_closings(settings)?;
        for slot in 0..self.joint_rows.len() {
            self.ties[self.joint_rows[slot]].closer = self.multipliers[slot];
        }
        self.clear_impulses();
        self.wrenches.clear();
        self.wrenches.resize(self.blocks.len(), [0.0; 3]);
        for at in 0..self.ties.len() {
            let tie = self.ties[at];
            if !tie.is_hard && tie.closer != 0.0 {
                self.gather_closer(&tie, settings.b1);
            }
        }
        self.add_to_rigid(Response::Velocity, settings.b1);
        self.respond();
        self.add_to_flexible(Response::Velocity, 1.0);
        if !settings.is_within {
            self.add_to_rigid(Response::Acceleration, 1.0);
            self.add_to_flexible(Response::Acceleration, 1.0);
        }
        self.clear_impulses();
        Ok(())
    }

    /// Whether bodies that joints hold too are parted by contacts: these multipliers are no forces, nor is what joints answer to them.
    fn parts_joined(&self) -> bool {
        let parts = |contact: &ActiveContact| contact.is_parting() && contact.is_closed();
        !self.ties.is_empty() && self.contacts.iter().any(parts)
    }

    /// Gathers the wrenches of the contacts that part rigid bodies.
    fn gather_partings(&mut self) {
        self.wrenches.clear();
        self.wrenches.resize(self.blocks.len(), [0.0; 3]);
        for contact in self.contacts.iter().filter(|contact| contact.is_parting()) {
            let wrenches = Some(&mut self.wrenches[..]);
            let (rows, forces) = (&contact.kinematics, contact.multiplier);
            Self::spread(&mut self.blocks, rows, forces, wrenches, |_, _, _, _| {});
        }
    }

    /// How contacts that part move a joint row, over `b0` (N/kg, or N m/(kg m²) of what keeps an angle).
    fn parted(&self, tie: &ActiveJoint) -> f64 {
        let is_turn = tie.row.measure.is_turn();
        let grips = self.joint_grips[tie.row.grips.0..tie.row.grips.1].iter();
        let moved = grips.map(|grip| match &self.blocks[grip.block] {
            Block::Rigid(block) => {
                let wrench = unit_wrench(grip, tie.direction, is_turn);
                block.mobility_between(wrench, self.wrenches[grip.block], Response::Velocity)
            }
            Block::Flex(_) => 0.0,
        });
        moved.sum()
    }

    /// Whether ends that were put apart come nearer in this step.
    pub(super) fn closes(&self) -> bool {
        self.ties.iter().any(|tie| tie.closing != 0.0)
    }

    /// Elastic energy that closing has stored: who has put ends apart has brought it (J).
    pub(super) fn stretched_by_closing(&self, summary: &IslandSummary) -> f64 {
        match self.closes() {
            true => (summary.end_energy[1] - summary.start_energy[1]).max(0.0),
            false => 0.0,
        }
    }

    fn solve_closings(&mut self, settings: &SolveSettings) -> Result<(), KktError> {
        let n = self.kinds.len();
        self.acted.resize(n, 0.0);
        if self.is_sparse(n) {
            self.multipliers.clear();
            self.multipliers.resize(n, 0.0);
            let asked = Asked {
                of: Response::Velocity,
                which: Rows::Kept,
                unit: settings.dt,
                give: 0.0,
            };
            self.solve_sparse(asked)?;
            return Ok(());
        }
        self.delassus.clear();
        self.expand_delassus(Response::Velocity, Rows::Kept);
        self.solve_rows()
    }

    /// Takes the force that closes a row back.
    fn gather_closer(&mut self, tie: &ActiveJoint, b1: f64) {
        let is_turn = tie.row.measure.is_turn();
        for grip in &self.joint_grips[tie.row.grips.0..tie.row.grips.1] {
            match (&mut self.blocks[grip.block], grip.point) {
                (Block::Flex(block), Point::Node(node)) => {
                    let force = -tie.closer * grip.weight * tie.direction;
                    block.gather_impulse(Response::Velocity, node, b1 * force, grip.lever);
                    block.gather_impulse(Response::Acceleration, node, force, grip.lever);
                }
                _ => add_wrench(
                    &mut self.wrenches[grip.block],
                    -tie.closer,
                    unit_wrench(grip, tie.direction, is_turn),
                ),
            }
        }
    }
}

impl ActiveJoint {
    /// Whether the row has held what it measures in this step.
    fn holds(&self) -> bool {
        let is_law = matches!(self.finish, Finish::Hold { .. } | Finish::Limit);
        is_law && self.is_movable && !self.is_left && self.is_closed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraint::contact::{Kinematics, Remembered};
    use crate::kkt::calm::tests::join;
    use crate::kkt::together::tests::rigid;
    use crate::linalg::complementarity::Method;
    use crate::math::Vec2;
    use crate::path::samples::Random;
    use crate::system::Point;

    const SETTINGS: SolveSettings = SolveSettings {
        dt: 1e-2,
        whole: 1e-2,
        b0: 5e-5,
        b1: 1e-2,
        is_within: false,
        is_explicit: false,
        insists: false,
        impact: crate::kkt::ImpactTreatment::Stabilized,
        contact: crate::kkt::ContactMethod::Lagrange,
        solver: Method::ActiveSet,
        restitution_threshold: 0.0,
        max_newton: 10,
        may_be_cut: false,
        length_unit: 1.0,
    };

    /// A joint holds two bodies along `x`, and a contact pushes them apart along a line by `force`: all the joint's force answers to that.
    #[test]
    fn what_answers_to_contacts_that_part_is_no_force() {
        for (slant, asked) in [(0.0, -0.01), (0.5, -0.01), (0.5, 0.0)] {
            let mut random = Random::new(3);
            let mut island = Island::default();
            for x in [0.0, 1.0] {
                island.blocks.push(rigid(&mut random, Vec2::new(x, 0.0)).0);
            }
            join(&mut island, [0, 1]);
            island.ties[0].is_hard = true;
            island.list_holders();
            let (force, normal) = (7.0, Vec2::new(1.0, slant).normalize());
            let grips = [(0, 1.0), (1, -1.0)]
                .map(|(block, weight)| (block, Point::Arm(Vec2::zeros()), weight, Vec2::zeros()));
            let row = Kinematics::with_levers(0.0, normal, Vec2::zeros(), &grips);
            let mut contact =
                ActiveContact::new(0, row, Remembered::default(), 0.0, &island.blocks);
            (contact.asked, contact.multiplier) = (asked, [force, 0.0]);
            island.contacts.push(contact);
            assert!(island.take_out_closings(&SETTINGS).is_ok());
            let expected = if asked < 0.0 { -force * normal.x } else { 0.0 };
            let found = island.ties[0].closer;
            assert!((found - expected).abs() < 1e-12, "{slant}: {found}");
        }
    }
}
