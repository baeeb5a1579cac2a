//! The velocity stage: impulses at contacts of rigid bodies, at surfaces with mass, and at massless ones where the step is
//! longer than the impact.
//!
//! The position stage leaves a multiplier `p` per contact. On a flexible body it acts as (C.5) says, and a surface with mass
//! holds its relative velocity besides. Between rigid bodies it only moved the positions; the velocity obeys
//! `0 <= P ⊥ n·v' + e n·v >= 0`.
//! Behind a massless surface that is stiff on the scale of the step the masses meet what they meet, and the same condition, weighted by
//! their share of the contact's mobility, replaces the vibration that the step cannot resolve; see `kkt/unresolved.rs`.
//!
//! Impulses `P` and the forces `A` that change the stored accelerations come on top of what the multipliers have done. The laws,
//! Coulomb's among them, hold for the whole: `b1 p + P` in velocities, `p + A` in accelerations. A contact that slides or parts
//! at the end of the step does so in the next: its row there is the acceleration that would end this motion within a step.

use super::delassus::{RowDirection, assemble};
use super::island::{ActiveContact, Island, KktError, SolveSettings};
use super::jammed::are_jammed;
use super::joint_system::Rows;
use super::multipliers::prepare;
use super::sparse::Asked;
use super::unresolved::unresolved_shares;
use crate::linalg::complementarity::{INDEPENDENT, Problem, RowKind, Status, give};
use crate::math::{Vec2, perp, rounding};
use crate::system::Response;

impl Island {
    pub(super) fn solve_velocities(&mut self, settings: &SolveSettings) -> Result<(), KktError> {
        self.take_out_hard_forces();
        for index in 0..self.contacts.len() {
            if self.contacts[index].is_closed() {
                // Newton's iterations may have ended without asking for a compliance.
                prepare(&mut self.blocks, &self.contacts[index].kinematics);
                let shares =
                    unresolved_shares(&self.blocks, &self.contacts[index].kinematics, settings);
                let contact = &mut self.contacts[index];
                [contact.unresolved, contact.rigid] = shares;
            }
        }
        if !self.impact_rows(settings)? {
            return Ok(());
        }
        // The accelerations do not depend on these impulses: one substitution answers both. Where forces act wholly within the step, none
        // goes on.
        if !settings.is_within {
            self.settle_accelerations(settings)?;
        }
        self.respond();
        self.add_to_flexible(Response::Velocity, 1.0);
        self.add_to_flexible(Response::Acceleration, 1.0);
        Ok(())
    }

    /// Solves the impact law at the contacts that hold velocities, and gathers its impulses, which rigid bodies take at once;
    /// returns whether there are any.
    pub(super) fn impact_rows(&mut self, settings: &SolveSettings) -> Result<bool, KktError> {
        self.take_out_closings(settings)?;
        self.kick_joints(settings);
        self.settle_joined_velocities(settings)?;
        self.velocity_rows(settings, |_| true);
        self.list_joint_velocities(settings, |_| true);
        if self.kinds.is_empty() {
            return Ok(false);
        }
        self.solve_impulses(Response::Velocity, settings.dt)?;
        self.take_joint_impulses();
        self.read_impulses();
        self.clear_impulses();
        self.gather_rows(Response::Velocity);
        self.add_to_rigid(Response::Velocity, 1.0);
        Ok(true)
    }

    /// Velocities and accelerations feel soft multipliers as (C.5) says, hard ones not at all.
    pub(super) fn take_out_hard_forces(&mut self) {
        self.wrenches.clear();
        self.wrenches.resize(self.blocks.len(), [0.0; 3]);
        for contact in &self.contacts {
            let (blocks, kinematics) = (&mut self.blocks, &contact.kinematics);
            let force = contact.multiplier;
            if !contact.is_hard {
                let wrenches = Some(&mut self.wrenches[..]);
                Self::spread(blocks, kinematics, force, wrenches, |_, _, _, _| {});
            }
        }
        self.add_soft_joints();
        self.set_soft_forces();
    }

    /// (C.5) as printed: every multiplier acts on velocity and acceleration.
    pub(super) fn keep_plain_forces(&mut self) {
        self.wrenches.clear();
        self.wrenches.resize(self.blocks.len(), [0.0; 3]);
        for contact in &mut self.contacts {
            contact.is_hard = false;
            Self::spread(
                &mut self.blocks,
                &contact.kinematics,
                contact.multiplier,
                Some(&mut self.wrenches),
                |_, _, _, _| {},
            );
        }
        self.add_soft_joints();
        self.set_soft_forces();
    }

    /// States the impact law at the contacts that count and hold velocities, as velocities or masses respond.
    pub(super) fn velocity_rows(
        &mut self,
        settings: &SolveSettings,
        counts: impl Fn(&ActiveContact) -> bool,
    ) {
        self.rows.clear();
        self.kinds.clear();
        self.free.clear();
        for index in 0..self.contacts.len() {
            let contact = self.contacts[index];
            if !contact.is_closed() || contact.holds_velocity() == 0.0 || !counts(&contact) {
                continue;
            }
            let law = self.candidates[contact.candidate].law;
            let kinematics = contact.kinematics;
            let velocity = kinematics.relative(&self.blocks, |block, grip| block.velocity(grip));
            let rebound = law.rebound(contact.approach, settings.restitution_threshold);
            // A resolved impact rebounds by its elasticity.
            let rebound = if contact.is_hard {
                rebound
            } else {
                contact.rigid * rebound
            };
            let normal = self.rows.len();
            self.contacts[index].parting = [rebound, 0.0];
            self.push_row(
                index,
                kinematics.normal,
                velocity.dot(&kinematics.normal) - rebound,
                RowKind::Unilateral,
            );
            if law.friction > 0.0 {
                let tangent = kinematics.tangent();
                let kind = RowKind::Friction {
                    normal,
                    coefficient: law.friction,
                };
                self.push_row(index, tangent, velocity.dot(&tangent), kind);
            }
        }
        self.list_acted(settings.b1);
    }

    /// Begins with the forces of the position stage at contacts of rigid bodies, on which they have not acted; how long they would have to
    /// act for impulses is left to the solver.
    fn guess_impulses(&mut self) {
        self.multipliers.clear();
        self.multipliers.resize(self.kinds.len(), 0.0);
        for (row, direction) in self.rows.iter().enumerate() {
            let contact = &self.contacts[direction.contact];
            if contact.is_hard && self.impulse_give == 0.0 {
                let which = usize::from(direction.direction != contact.kinematics.normal);
                self.multipliers[row] = contact.multiplier[which];
            }
        }
    }

    /// Solves the rows listed, those of the contacts and those of the joints after them, for impulses (or forces, of accelerations). All rows give
    /// way a little where impulses [jam](super::jammed).
    pub(super) fn solve_impulses(&mut self, of: Response, dt: f64) -> Result<(), KktError> {
        self.acted.resize(self.kinds.len(), 0.0);
        if of != Response::Acceleration {
            self.impulse_give = 0.0;
        }
        self.solve_impulses_once(of, dt)?;
        if of == Response::Velocity
            && are_jammed(
                &self.blocks,
                &self.contacts,
                (&self.rows, &self.free),
                &self.multipliers,
            )
        {
            self.impulse_give = give(INDEPENDENT);
            self.solve_impulses_once(of, dt)?;
        }
        Ok(())
    }

    fn solve_impulses_once(&mut self, of: Response, dt: f64) -> Result<(), KktError> {
        let n = self.kinds.len();
        if of != Response::ByMass && self.is_sparse(n) {
            self.guess_impulses();
            let asked = Asked {
                of,
                which: Rows::End,
                unit: dt,
                give: self.impulse_give,
            };
            self.solve_sparse(asked)?;
            return Ok(());
        }
        match of {
            Response::Velocity => self.hold_wedged(dt),
            Response::Acceleration => self.hold_wedged(1.0),
            _ => {}
        }
        let contacts = &self.contacts;
        assemble(
            &self.blocks,
            &self.rows,
            of,
            |index| &contacts[index].kinematics,
            &mut self.delassus,
        );
        self.soften();
        self.expand_joints(of);
        for row in 0..n {
            self.delassus[row * (n + 1)] *= 1.0 + self.impulse_give;
        }
        self.solve_rows()?;
        self.responses.clear();
        self.diagonals.clear();
        for row in 0..n {
            let line = &self.delassus[row * n..(row + 1) * n];
            let moved = line.iter().zip(&self.multipliers).map(|(w, p)| w * p);
            self.responses.push(moved.sum());
            self.diagonals.push(line[row]);
        }
        Ok(())
    }

    /// Lets the friction of rigid bodies that began in each other, and stuck, hold with what its position stage had: forces that press overlaps apart
    /// wedge bodies with each other, and velocities know nothing of these. Such bodies would fall while they stand.
    ///
    /// - `unit`: what forces act for (s), or 1 if forces are asked for.
    fn hold_wedged(&mut self, unit: f64) {
        for (row, direction) in self.rows.iter().enumerate() {
            let contact = &self.contacts[direction.contact];
            let is_wedged = contact.is_parting() && contact.status[1] == Status::Stick;
            if let (RowKind::Friction { coefficient, .. }, true) = (self.kinds[row], is_wedged) {
                let most = (coefficient * contact.multiplier[0] * unit).max(0.0);
                self.kinds[row] = RowKind::Box {
                    low: -most,
                    high: most,
                };
            }
        }
    }

    fn push_row(&mut self, contact: usize, direction: Vec2, free: f64, kind: RowKind) {
        self.rows.push(RowDirection { contact, direction });
        self.free.push(free);
        self.kinds.push(kind);
    }

    /// Lists what has acted already of the soft rows' multipliers: `scale` times those of the position stage.
    pub(super) fn list_acted(&mut self, scale: f64) {
        self.acted.clear();
        for direction in &self.rows {
            let contact = &self.contacts[direction.contact];
            let which = usize::from(direction.direction != contact.kinematics.normal);
            let acted = if contact.is_hard {
                0.0
            } else {
                scale * contact.multiplier[which]
            };
            self.acted.push(acted);
        }
    }

    /// Leaves impulses and the velocities of rows after them on the contacts.
    fn read_impulses(&mut self) {
        for (row, direction) in self.rows.iter().enumerate() {
            let softened = self.free[row] + self.responses[row];
            let contact = &mut self.contacts[direction.contact];
            let which = usize::from(direction.direction != contact.kinematics.normal);
            let impulse = self.multipliers[row];
            let share = if contact.is_hard {
                1.0
            } else {
                contact.holds_velocity().max(rounding::SUM)
            };
            contact.parting[which] += softened - (1.0 - share) * self.diagonals[row] * impulse;
            contact.impulse[which] = impulse;
        }
    }

    /// Weights soft rows: `W_ii (1 - φ)/φ` on the diagonal lets a resolved contact keep its velocity.
    fn soften(&mut self) {
        let n = self.rows.len();
        for row in 0..n {
            let contact = &self.contacts[self.rows[row].contact];
            if !contact.is_hard {
                let share = contact.holds_velocity().max(rounding::SUM);
                self.delassus[row * n + row] *= 1.0 + (1.0 - share) / share;
            }
        }
    }

    pub(super) fn solve_rows(&mut self) -> Result<(), KktError> {
        self.multipliers.clear();
        self.multipliers.resize(self.kinds.len(), 0.0);
        self.statuses.clear();
        self.statuses.resize(self.kinds.len(), Status::Stick);
        self.solver.set_redundancy_tolerance(1e-6);
        let has_joints = self.kinds.len() > self.rows.len();
        self.tell_independence();
        if !self.acted.is_empty() {
            // Rows of joints follow those of contacts.
            self.acted.resize(self.kinds.len(), 0.0);
        }
        let problem = Problem {
            delassus: &self.delassus,
            free: &self.free,
            rows: &self.kinds,
            acted: &self.acted,
        };
        let outcome = (if has_joints {
            self.solver
                .solve_condensed(&problem, &mut self.multipliers, &mut self.statuses)
        } else {
            self.solver
                .solve(&problem, &mut self.multipliers, &mut self.statuses)
        })?;
        self.n_pivots += outcome.n_pivots;
        Ok(())
    }

    /// Contacts that hold velocities and stay closed keep no relative acceleration either.
    ///
    /// Between surfaces with mass, multipliers would alternate otherwise. Rigid bodies that press each other would start the next step with
    /// accelerations that no pose allows, and its multipliers, at the levers of its end, would turn them back too far: a tower on a
    /// soft block rocks itself up by `p h dt / I` a second.
    fn settle_accelerations(&mut self, settings: &SolveSettings) -> Result<(), KktError> {
        self.wrenches.clear();
        self.wrenches.resize(self.blocks.len(), [0.0; 3]);
        self.add_spring_forces(settings.dt);
        self.settle_joined_accelerations(settings)?;
        self.acceleration_rows(settings, |_| true);
        if self.rows.is_empty() && !self.has_soft_joints() {
            return Ok(());
        }
        self.list_joint_accelerations(|_| true);
        self.solve_impulses(Response::Acceleration, settings.dt)?;
        // What the stored acceleration loses will not act in the next step.
        let late = settings.dt - settings.b1;
        for (row, direction) in self.rows.iter().enumerate() {
            let contact = &mut self.contacts[direction.contact];
            let which = usize::from(direction.direction != contact.kinematics.normal);
            contact.impulse[which] += late * self.multipliers[row];
            contact.settled[which] = self.multipliers[row];
        }
        self.gather_rows(Response::Acceleration);
        self.add_to_rigid(Response::Acceleration, 1.0);
        Ok(())
    }

    /// States the law of accelerations at the contacts that count and hold velocities.
    pub(super) fn acceleration_rows(
        &mut self,
        settings: &SolveSettings,
        counts: impl Fn(&ActiveContact) -> bool,
    ) {
        self.rows.clear();
        self.kinds.clear();
        self.free.clear();
        for index in 0..self.contacts.len() {
            let contact = self.contacts[index];
            if !contact.is_closed() || contact.holds_velocity() == 0.0 || !counts(&contact) {
                continue;
            }
            let kinematics = contact.kinematics;
            let mut acceleration =
                kinematics.relative(&self.blocks, |block, grip| block.smooth_acceleration(grip));
            for a in kinematics.attachments() {
                let answer = self.blocks[a.block].acceleration_under(&self.wrenches, a.block);
                acceleration += a.weight * (answer.0 + answer.1 * perp(a.grip.lever));
            }
            let normal = self.rows.len();
            let along = acceleration.dot(&kinematics.normal) + contact.parting[0] / settings.dt;
            self.push_row(index, kinematics.normal, along, RowKind::Unilateral);
            let coefficient = self.candidates[contact.candidate].law.friction;
            if coefficient > 0.0 {
                let tangent = kinematics.tangent();
                let kind = RowKind::Friction {
                    normal,
                    coefficient,
                };
                let along = acceleration.dot(&tangent) + contact.parting[1] / settings.dt;
                self.push_row(index, tangent, along, kind);
            }
        }
        self.list_acted(1.0);
    }
}
