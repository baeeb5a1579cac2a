//! Joints that hold masses of flexible bodies: their velocities and accelerations, in the metric of the masses.
//!
//! A node with mass that a joint holds has `G x' = d` from the position stage. With `G v' = ḋ` and `G a' = d̈` it is a node whose motion
//! is given, and Beta-2 advances the others as it advances a body that is pinned there: as stable as without joints. The projection that
//! leaves the others alone is that of the masses, `Δv = M⁻¹ Gᵀ P`, and it can only take energy. With `A⁻¹ = (M + b0 K + ..)⁻¹` in its place
//! the whole body would answer for what its node alone does too fast, and a vibration that the step does not resolve would grow by it.
//!
//! Hard contacts and joints take part with what they will do, but only these joints act here: the velocity stage finds the others
//! again, and nothing left to do for these. Nodes without mass follow what holds them as springs do, and need none of this.

use super::island::{Island, KktError, SolveSettings};
use super::joint_rows::ActiveJoint;
use crate::constraint::joint::unit_wrench;
use crate::math::Vec2;
use crate::system::{Block, Point, Response};

impl Island {
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
        self.velocity_rows(settings, |contact| contact.is_hard);
        let takes_part = |tie: &ActiveJoint| tie.is_hard || tie.holds_masses();
        self.list_joint_velocities(settings, takes_part);
        self.push_joined_masses(Response::Velocity, settings.dt)
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

    fn has_joined_masses(&self, settings: &SolveSettings) -> bool {
        !settings.is_explicit && self.ties.iter().any(ActiveJoint::holds_masses)
    }

    /// Solves the rows, and lets those of joined masses act.
    fn push_joined_masses(&mut self, of: Response, dt: f64) -> Result<(), KktError> {
        self.solve_impulses(Response::ByMass, dt)?;
        let first = self.rows.len();
        self.clear_impulses();
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
                    }
                    _ => {}
                }
            }
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
