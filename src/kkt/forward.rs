//! Velocities of an explicit step, where multipliers act at the forward increment (Carpenter, Taylor, Katona 1991).
//!
//! There are three kinds of contact:
//!
//! - *quasi-static*, through nodes without mass: `p` is the force of a spring at the end of the step, and accelerates
//!   what it touches from then on;
//! - *forward*, of a flexible body's masses: `p` has acted over the whole step as the impulse `dt p`;
//! - of rigid bodies only: the position stage has moved positions, and velocities obey the impact law as in an implicit
//!   step.
//!
//! No energy stage follows: an explicit step within its stability limit resolves every vibration, a forward multiplier stops the
//! node that touches without adding energy, and the force of a quasi-static contact that opens or closes is weighed so that the
//! energy of the leapfrog stays what it is.

use super::delassus::{RowDirection, assemble};
use super::island::{ActiveContact, Island, KktError, SolveSettings};
use super::partner::check_partners;
use super::summary::IslandSummary;
use super::work::{end_energy, kinetic_energy, start_energy};
use crate::constraint::contact::Kinematics;
use crate::linalg::complementarity::RowKind;
use crate::math::Vec2;
use crate::system::{Block, Response};

impl ActiveContact {
    /// Whether its multiplier is an impulse on masses at the forward increment.
    fn is_forward(&self) -> bool {
        !self.is_hard && !self.kinematics.is_quasi_static()
    }
}

impl Island {
    /// Gives rigid bodies the velocities that go with the multipliers; flexible ones have theirs.
    pub(super) fn solve_forward(
        &mut self,
        settings: &SolveSettings,
        summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        if !settings.insists {
            check_partners(&mut self.blocks, &self.contacts, settings.dt)?;
        }
        self.gather_wrenches(|contact| contact.kinematics.is_quasi_static());
        self.set_soft_forces();
        self.gather_wrenches(ActiveContact::is_forward);
        for (block, wrench) in self.blocks.iter_mut().zip(&self.wrenches) {
            if let Block::Rigid(block) = block {
                block.add_impulse(wrench.map(|value| settings.dt * value));
            }
        }
        self.add_across(Response::Velocity, settings.dt);
        self.weigh_switches(settings);
        self.impact_rows(settings)?;
        self.balance_angular_momentum();
        summary.swing = self.blocks.iter().map(|block| block.swing()[1]).sum();
        summary.pending = self.pending_energy(settings)?;
        Ok(())
    }

    /// Weighs the forces of quasi-static contacts that open or close in this step.
    ///
    /// While contacts stay what they are, a linear body keeps `H = T + V - dt²/8 a·M a` exactly (`a` smooth accelerations at full
    /// steps), which swings about the energy. A contact that acts for a part of the step only breaks that: the trapezoid gives it
    /// `dt/2 p` whenever it closed. What was given is taken back in the part, from none to all of it, that keeps `H`.
    fn weigh_switches(&mut self, settings: &SolveSettings) {
        let is_smooth = |contact: &ActiveContact| contact.kinematics.is_quasi_static();
        // Other members than central difference, β1 > 1/2, damp.
        let is_leapfrog = 2.0 * settings.b1 == settings.dt;
        let keeps_energy = is_leapfrog
            && self.blocks.iter().all(|block| match block {
                Block::Flex(block) => !block.is_damped(),
                Block::Rigid(_) => true,
            });
        if !keeps_energy
            || !self.ties.is_empty()
            || !self.contacts.iter().all(is_smooth)
            || !self.gather_switches(settings)
        {
            return;
        }
        let gain = self.shadow_gain(settings);
        let now = kinetic_energy(&self.blocks);
        self.add_switches(-1.0);
        let without = kinetic_energy(&self.blocks);
        self.add_switches(2.0);
        let twice = kinetic_energy(&self.blocks);
        let curvature = 0.5 * (without + twice) - now;
        let slope = 0.5 * (without - twice);
        let part = part_to_take([curvature, slope, gain]);
        self.add_switches(-1.0 - part);
        // What a contact that has closed really gave is its mean force over the step.
        for contact in &mut self.contacts {
            if contact.is_closed() && contact.remembered.normal <= 0.0 {
                contact.impulse = contact.multiplier.map(|force| -part * settings.b1 * force);
            }
        }
    }

    /// Gathers what contacts that have opened or closed gave to the velocities; returns whether there are any.
    fn gather_switches(&mut self, settings: &SolveSettings) -> bool {
        self.wrenches.clear();
        self.wrenches.resize(self.blocks.len(), [0.0; 3]);
        self.clear_impulses();
        let mut has_switched = false;
        for contact in &self.contacts {
            let before = [contact.remembered.normal, contact.remembered.tangent];
            let is_closed = contact.is_closed();
            if is_closed == (before[0] > 0.0) {
                continue;
            }
            has_switched = true;
            let (weight, force) = if is_closed {
                (settings.b1, contact.multiplier)
            } else {
                (settings.dt - settings.b1, before)
            };
            Self::spread(
                &mut self.blocks,
                &contact.kinematics,
                force.map(|force| weight * force),
                Some(&mut self.wrenches),
                |block, node, impulse, lever| {
                    block.gather_impulse(Response::Velocity, node, impulse, lever);
                },
            );
        }
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.respond_to_surface_impulse();
            }
        }
        has_switched
    }

    fn add_switches(&mut self, scale: f64) {
        for (block, wrench) in self.blocks.iter_mut().zip(&self.wrenches) {
            match block {
                Block::Flex(block) => block.add_surface_response(scale),
                Block::Rigid(block) => block.add_impulse(wrench.map(|value| scale * value)),
            }
        }
        self.add_across(Response::Velocity, scale);
    }

    /// Gain of `H` over the step beyond the work of loads, of prescribed bodies and of friction (J).
    fn shadow_gain(&mut self, settings: &SolveSettings) -> f64 {
        let mut gain = -self.actual_work(settings);
        for contact in &self.contacts {
            let drag = 0.5 * (contact.multiplier[1] + contact.remembered.tangent);
            gain -= drag * contact.slip;
        }
        for (end, start) in end_energy(&self.blocks)
            .iter()
            .zip(start_energy(&self.blocks))
        {
            gain += end - start;
        }
        for block in &self.blocks {
            let [start, end] = block.swing();
            gain -= end - start;
        }
        gain
    }

    fn gather_wrenches(&mut self, counts: impl Fn(&ActiveContact) -> bool) {
        self.wrenches.clear();
        self.wrenches.resize(self.blocks.len(), [0.0; 3]);
        for contact in self.contacts.iter().filter(|contact| counts(contact)) {
            Self::spread(
                &mut self.blocks,
                &contact.kinematics,
                contact.multiplier,
                Some(&mut self.wrenches),
                |_, _, _, _| {},
            );
        }
    }

    /// Kinetic energy that the half step of the forward contacts still to come will add at this very instant (J).
    ///
    /// The velocity of a mass in contact lacks `dt/2 M⁻¹ Gᵀp` of the next multiplier, without which a resting mass would
    /// seem to fall by `g dt/2`. That multiplier is the one that keeps the contact closed, foreseen without new loads.
    fn pending_energy(&mut self, settings: &SolveSettings) -> Result<f64, KktError> {
        let (dt, half) = (settings.dt, 0.5 * settings.dt);
        self.rows.clear();
        self.kinds.clear();
        self.free.clear();
        for (index, contact) in self.contacts.iter().enumerate() {
            if !(contact.is_closed() && contact.is_forward()) {
                continue;
            }
            let kinematics = &contact.kinematics;
            let free = (foreseen(kinematics, &self.blocks, dt)
                + kinematics.gap * kinematics.normal)
                / (dt * dt);
            let normal = self.rows.len();
            let mut push = |direction: Vec2, kind| {
                self.rows.push(RowDirection {
                    contact: index,
                    direction,
                });
                self.free.push(free.dot(&direction));
                self.kinds.push(kind);
            };
            push(kinematics.normal, RowKind::Unilateral);
            let coefficient = self.candidates[contact.candidate].law.friction;
            if coefficient > 0.0 {
                let kind = RowKind::Friction {
                    normal,
                    coefficient,
                };
                push(kinematics.tangent(), kind);
            }
        }
        if self.rows.is_empty() {
            return Ok(0.0);
        }
        let contacts = &self.contacts;
        let of = |index: usize| &contacts[index].kinematics;
        assemble(
            &self.blocks,
            &self.rows,
            Response::Position,
            of,
            &mut self.delassus,
        );
        self.acted.clear();
        self.solve_rows()?;
        // T(v + dt/2 M⁻¹Gᵀp) - T(v) = dt/2 p·(G v + dt/4 W p).
        let (n, mut gain) = (self.rows.len(), 0.0);
        for (row, direction) in self.rows.iter().enumerate() {
            let kinematics = &self.contacts[direction.contact].kinematics;
            let velocity = kinematics.relative(&self.blocks, |block, grip| block.velocity(grip));
            let response: f64 = self.delassus[row * n..(row + 1) * n]
                .iter()
                .zip(&self.multipliers)
                .map(|(w, p)| w * p)
                .sum();
            let mean = velocity.dot(&direction.direction) + 0.5 * half * response;
            gain += half * self.multipliers[row] * mean;
        }
        Ok(gain)
    }
}

/// The `z` in [0, 1] that makes `curvature z² + slope z + gain` zero, or as small as can be.
fn part_to_take([curvature, slope, gain]: [f64; 3]) -> f64 {
    let value = |z: f64| ((curvature * z + slope) * z + gain).abs();
    let root = (slope * slope - 4.0 * curvature * gain).max(0.0).sqrt();
    let sum = -0.5 * (slope + root.copysign(slope));
    let candidates = [sum / curvature, gain / sum, 0.0, 1.0];
    let inside = candidates.into_iter().filter(|z| (0.0..=1.0).contains(z));
    inside.fold(0.0, |best, z| if value(z) < value(best) { z } else { best })
}

/// Relative motion over the next step without multipliers (m).
fn foreseen(kinematics: &Kinematics, blocks: &[Block], dt: f64) -> Vec2 {
    kinematics.relative(blocks, |block, grip| {
        dt * block.velocity(grip) + 0.5 * dt * dt * block.smooth_acceleration(grip)
    })
}
