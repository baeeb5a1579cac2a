//! Contact forces of the end of the step alone (Kane, Repetto, Ortiz, Marsden 1999).
//!
//! Internal forces follow Newmark, contact forces do not:
//!
//! ```text
//! x' = q0 + b0 Δa + dt²/2 M⁻¹ Gᵀp,    v' = q1 + b1 Δa + dt M⁻¹ Gᵀp,    a' = a + Δa = M⁻¹ (R - C v' - K x').
//! ```
//!
//! With `p = β0 p̃` the positions are those of (C.5) under the multipliers `p̃`, which the position stage has found. What is
//! left is to take `(b1 - β0 dt) M⁻¹ Gᵀp̃` from the velocity, nothing for the trapezoidal rule, and `M⁻¹ Gᵀp̃` from the
//! acceleration. A node that is held has `x' = x`, so `v' = -v` by the trapezoidal rule: what velocity it has left after the
//! impact changes sign with every step, and the force alternates by `2 m v / dt` for as long. Nodes without mass have no `M⁻¹`: contacts there are quasi-static, as (C.5) says.

use super::Treatment;
use crate::kkt::gathered;
use crate::kkt::island::{ActiveContact, Island, KktError, SolveSettings};
use crate::kkt::summary::IslandSummary;
use crate::kkt::{momentum, velocity};
use crate::system::{Block, Response};

/// See [`ImpactTreatment::ImplicitForces`](crate::kkt::ImpactTreatment::ImplicitForces).
#[derive(Debug)]
pub(super) struct ImplicitForces;

impl Treatment for ImplicitForces {
    fn finish(
        &self,
        island: &mut Island,
        settings: &SolveSettings,
        _summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        for contact in &mut island.contacts {
            contact.is_settled = !contact.is_hard;
        }
        velocity::take_out_hard_forces(island);
        // Between rigid bodies there is only the impact law.
        velocity::finish_joints(island, settings)?;
        take_from_acceleration(island, settings);
        momentum::balance_angular_momentum(island);
        Ok(())
    }
}

/// Whether a contact's force is one between masses of a flexible body and others.
fn is_implicit(contact: &ActiveContact) -> bool {
    contact.is_closed() && !contact.is_hard && !contact.is_massless
}

fn take_from_acceleration(island: &mut Island, settings: &SolveSettings) {
    let beta0 = 2.0 * settings.b0 / (settings.dt * settings.dt);
    gathered::clear_impulses(island);
    gathered::clear_wrenches(island);
    for contact in island
        .contacts
        .iter_mut()
        .filter(|contact| is_implicit(contact))
    {
        gathered::spread(
            &mut island.blocks,
            &contact.kinematics,
            contact.multiplier,
            Some(&mut island.wrenches),
            |block, node, force, lever| {
                block.gather_impulse(Response::Velocity, node, force, lever);
                block.gather_impulse(Response::Acceleration, node, force, lever);
            },
        );
        // The mean force over the step is `β0 p̃`.
        let part = (beta0 - 1.0) * settings.dt;
        contact.impulse = contact.multiplier.map(|force| part * force);
        contact.settled = contact.multiplier.map(|force| -force);
    }
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.respond_by_mass();
        }
    }
    let excess = settings.b1 - beta0 * settings.dt;
    for (of, scale) in [
        (Response::Velocity, -excess),
        (Response::Acceleration, -1.0),
    ] {
        gathered::add_to_rigid(island, of, scale);
        gathered::add_to_flexible(island, of, scale);
    }
}
