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
//! No energy stage follows: an explicit step within its stability limit resolves every vibration, and a forward multiplier
//! stops the node that touches without adding energy.

use super::delassus::{RowDirection, assemble};
use super::island::{ActiveContact, Island, IslandSummary, KktError, SolveSettings};
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
        self.gather_wrenches(|contact| contact.kinematics.is_quasi_static());
        self.set_soft_forces();
        self.gather_wrenches(ActiveContact::is_forward);
        for (block, wrench) in self.blocks.iter_mut().zip(&self.wrenches) {
            if let Block::Rigid(block) = block {
                block.add_impulse(wrench.map(|value| settings.dt * value));
            }
        }
        self.impact_rows(settings)?;
        self.balance_angular_momentum();
        summary.pending = self.pending_energy(settings)?;
        Ok(())
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

/// Relative motion over the next step without multipliers (m).
fn foreseen(kinematics: &Kinematics, blocks: &[Block], dt: f64) -> Vec2 {
    kinematics.relative(blocks, |block, grip| {
        dt * block.velocity(grip) + 0.5 * dt * dt * block.smooth_acceleration(grip)
    })
}
