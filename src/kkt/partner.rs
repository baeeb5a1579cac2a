//! Light partners of explicit bodies: the only limit of the step that the mesh alone does not know.
//!
//! A mass that presses on nodes without mass sits on their springs. Alone on fixed ground it would be stable while
//! `dt² Σ k_i n·M⁻¹n <= 4`, `k_i` the stiffness of contact i.

use super::active_contact::ActiveContact;
use super::delassus::compliance;
use super::multipliers::prepare;
use super::settings::KktError;
use crate::system::{Block, Response};

/// `(ω dt)²` at which central difference becomes unstable.
const LIMIT: f64 = 4.0;

/// Refuses a step in which some mass is too light for the springs it has met.
pub(super) fn check_partners(
    blocks: &mut [Block],
    contacts: &[ActiveContact],
    dt: f64,
) -> Result<(), KktError> {
    for contact in contacts {
        if contact.is_closed() && contact.kinematics.is_quasi_static() {
            // Newton's iterations may have ended without asking for a compliance.
            prepare(blocks, &contact.kinematics);
        }
    }
    for block in 0..blocks.len() {
        let squared = sampling_of(blocks, contacts, block);
        if squared > LIMIT {
            return Err(KktError::LightPartner {
                block,
                dt,
                critical: dt * (LIMIT / squared).sqrt(),
            });
        }
    }
    Ok(())
}

/// `dt² Σ k_i n·M⁻¹n` of a rigid body on the springs it presses (-).
fn sampling_of(blocks: &[Block], contacts: &[ActiveContact], block: usize) -> f64 {
    let Block::Rigid(rigid) = &blocks[block] else {
        return 0.0;
    };
    if rigid.is_prescribed() {
        return 0.0;
    }
    let mut sum = 0.0;
    for contact in contacts {
        let kinematics = &contact.kinematics;
        if !contact.is_closed() || !kinematics.is_quasi_static() {
            continue;
        }
        let normal = kinematics.normal;
        let own = kinematics.attachments().iter();
        let mobility: f64 = own
            .filter(|a| a.block == block)
            .map(|a| a.weight * a.weight * rigid.rigid_mobility(a.grip.lever, normal))
            .sum();
        if mobility > 0.0 {
            // Over dt² already, as everything a multiplier moves.
            let flexibility = compliance(blocks, kinematics, kinematics, Response::Position);
            let along = flexibility.map_or(0.0, |value| normal.dot(&(value * normal)));
            sum += mobility / along;
        }
    }
    sum
}
