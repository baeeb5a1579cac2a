//! Joints that hold masses of flexible bodies: their velocities and accelerations, in the metric of the masses.
//!
//! A node with mass that a joint holds has `G x' = d` from the position stage. With `G v' = ḋ` and `G a' = d̈` it is a node whose motion
//! is given, and Beta-2 advances the others as it advances a body that is pinned there: as stable as without joints. The projection that
//! leaves the others alone is that of the masses, `Δv = M⁻¹ Gᵀ P`, and it can only take energy. With `A⁻¹ = (M + b0 K + ..)⁻¹` in its place
//! the whole body would answer for what its node alone does too fast, and a vibration that the step does not resolve would grow by it.
//!
//! Two things are shorter than the step, and are answered by all of the body, `A⁻¹`: jumps of the motion that drives a joint, and impacts of rigid bodies in
//! islands where forces act wholly within the step. There impulses bring what the step resolves, `A⁻¹ M v`, to rest, which takes energy from whatever
//! moves; held so for ever, a clamped beam would be damped four times as fast as one on pins.
//!
//! Hard contacts and joints take part with what they will do, but only these joints act here: the velocity stage finds the others
//! again, and nothing left to do for these. Nodes without mass follow what holds them as springs do, and need none of this.

use super::island::{Island, KktError, SolveSettings};
use super::joint_law::Finish;
use super::joint_rows::ActiveJoint;
use crate::constraint::joint::unit_wrench;
use crate::linalg::complementarity::RowKind;
use crate::math::Vec2;
use crate::system::{Block, Point, Response};

impl Island {
    /// Solves the impact law and the joints' velocities where flexible blocks take part in joints only.
    pub(super) fn finish_joints(&mut self, settings: &SolveSettings) -> Result<(), KktError> {
        if self.impact_rows(settings)? {
            self.respond();
            self.add_to_flexible(Response::Velocity, 1.0);
        }
        Ok(())
    }

    /// Gives masses of flexible bodies the velocities of what they are joined to.
    ///
    /// # Errors
    /// If a number is not finite.
    pub(super) fn settle_joined_velocities(
        &mut self,
        settings: &SolveSettings,
    ) -> Result<(), KktError> {
        if !self.has_joined_masses(settings) {
            return Ok(());
        }
        self.take_jumps(settings)?;
        if settings.is_within && self.is_struck() {
            return Ok(());
        }
        self.velocity_rows(settings, |contact| contact.is_hard);
        let takes_part = |tie: &ActiveJoint| tie.is_hard || tie.holds_masses();
        self.list_joint_velocities(settings, takes_part);
        self.push_joined_masses(Response::Velocity, settings.dt)
    }

    /// Part of `G'v'` of a row that is driven from outside (m/s or rad/s).
    pub(super) fn driven_rate(&self, tie: &ActiveJoint) -> f64 {
        self.along(tie, |block, _| match block {
            Block::Rigid(block) if block.is_prescribed() => block.rates(),
            _ => [0.0; 3],
        })
    }

    /// Takes out of the velocities what a jump of the motion that drives a joint has left there.
    ///
    /// Displacements that are given, `Δx = d`, end with `v' = 2 d/dt - v`: where what drives a stiff body jumps from rest to `ḋ`, the body would end
    /// with `2 ḋ`, and swing about `ḋ` from step to step. Velocities that had jumped as well, by what the body answers to that within a step,
    /// `A⁻¹ Gᵀ W⁻¹ J`, would not.
    fn take_jumps(&mut self, settings: &SolveSettings) -> Result<(), KktError> {
        self.rows.clear();
        self.kinds.clear();
        self.free.clear();
        self.joint_rows.clear();
        self.joint_gives.clear();
        let mut jumps = false;
        for (index, tie) in self.ties.iter().enumerate() {
            let is_held =
                matches!(tie.finish, Finish::Hold { .. }) && tie.is_movable && !tie.is_left;
            if !is_held || !tie.holds_masses() {
                continue;
            }
            let last = tie.row.remembered;
            let jump = last.map_or(0.0, |last| tie.driven - last.driven);
            jumps |= jump != 0.0;
            self.joint_rows.push(index);
            self.joint_gives.push(0.0);
            self.free.push(jump);
            self.kinds.push(RowKind::Bilateral);
        }
        if !jumps {
            return Ok(());
        }
        self.acted.clear();
        self.solve_impulses(Response::Velocity, settings.dt)?;
        self.take_joint_impulses();
        self.clear_impulses();
        self.gather_rows(Response::Velocity);
        self.add_to_rigid(Response::Velocity, 1.0);
        self.respond();
        self.add_to_flexible(Response::Velocity, 1.0);
        self.clear_impulses();
        Ok(())
    }

    /// Gives masses of flexible bodies the accelerations of what they are joined to.
    ///
    /// # Errors
    /// If a number is not finite.
    pub(super) fn settle_joined_accelerations(
        &mut self,
        settings: &SolveSettings,
    ) -> Result<(), KktError> {
        if !self.has_joined_masses(settings) {
            return Ok(());
        }
        // Impulses gathered for velocities act first: there is one place for what blocks answer.
        self.respond();
        self.add_to_flexible(Response::Velocity, 1.0);
        self.acceleration_rows(settings, |contact| contact.is_hard);
        let takes_part = |tie: &ActiveJoint| tie.is_hard || tie.holds_masses();
        self.list_joint_accelerations(takes_part);
        self.push_joined_masses(Response::Acceleration, settings.dt)
    }

    /// Whether rigid bodies have met in this step that did not press in the last.
    fn is_struck(&self) -> bool {
        self.contacts.iter().any(|contact| {
            contact.is_hard && contact.is_closed() && contact.remembered.normal == 0.0
        })
    }

    fn has_joined_masses(&self, settings: &SolveSettings) -> bool {
        !settings.is_explicit && self.ties.iter().any(ActiveJoint::holds_masses)
    }

    /// Solves the rows, and lets those of joined masses act.
    fn push_joined_masses(&mut self, of: Response, dt: f64) -> Result<(), KktError> {
        self.solve_impulses(Response::ByMass, dt)?;
        let first = self.rows.len();
        self.clear_impulses();
        // Without links it stays empty, and takes no memory.
        let mut across = Vec::new();
        for slot in 0..self.joint_rows.len() {
            let value = self.multipliers[first + slot];
            let tie = self.ties[self.joint_rows[slot]];
            if !tie.holds_masses() || value == 0.0 {
                continue;
            }
            if of == Response::Velocity {
                self.ties[self.joint_rows[slot]].impulse += value;
            }
            for grip in &self.end_grips[tie.row.grips.0..tie.row.grips.1] {
                let force: Vec2 = value * grip.weight * tie.end;
                match (&mut self.blocks[grip.block], grip.point) {
                    (Block::Flex(block), Point::Node(node)) => {
                        block.gather_impulse(of, node, force, grip.lever);
                    }
                    (Block::Rigid(block), _) => {
                        let wrench = unit_wrench(grip, tie.end, tie.row.measure.is_turn());
                        let wrench = wrench.map(|part| value * part);
                        match of {
                            Response::Acceleration => block.add_smooth_acceleration(wrench),
                            _ => block.add_impulse(wrench),
                        }
                        if block.link_response().is_some() {
                            across.push((grip.block, wrench));
                        }
                    }
                    _ => {}
                }
            }
        }
        for (block, wrench) in across {
            self.push_across(of, block, wrench);
        }
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.respond_by_mass();
            }
        }
        self.add_to_flexible(of, 1.0);
        self.clear_impulses();
        Ok(())
    }
}

impl ActiveJoint {
    /// Whether the row holds nodes of flexible bodies that all have mass.
    pub(super) fn holds_masses(&self) -> bool {
        !self.is_hard && self.has_mass
    }
}
