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

use super::delassus::assemble;
use super::impulses;
use super::island::{ActiveContact, Island, KktError, SolveSettings};
use super::partner::check_partners;
use super::summary::IslandSummary;
use super::work::{end_energy, kinetic_energy, start_energy};
use super::{gathered, momentum, velocity};
use crate::constraint::contact::Kinematics;
use crate::math::Vec2;
use crate::system::{Block, Response};

impl ActiveContact {
    /// Whether its multiplier is an impulse on masses at the forward increment.
    fn is_forward(&self) -> bool {
        !self.is_hard && !self.kinematics.is_quasi_static()
    }
}

/// Gives rigid bodies the velocities that go with the multipliers; flexible ones have theirs.
pub(super) fn solve_forward(
    island: &mut Island,
    settings: &SolveSettings,
    summary: &mut IslandSummary,
) -> Result<(), KktError> {
    if !settings.insists {
        check_partners(&mut island.blocks, &island.contacts, settings.dt)?;
    }
    gather_wrenches(island, |contact| contact.kinematics.is_quasi_static());
    gathered::set_soft_forces(island);
    gather_wrenches(island, ActiveContact::is_forward);
    for (block, wrench) in island.blocks.iter_mut().zip(&island.wrenches) {
        if let Block::Rigid(block) = block {
            block.add_impulse(wrench.map(|value| settings.dt * value));
        }
    }
    weigh_switches(island, settings);
    velocity::impact_rows(island, settings)?;
    momentum::balance_angular_momentum(island);
    summary.swing = island.blocks.iter().map(|block| block.swing()[1]).sum();
    summary.pending = pending_energy(island, settings)?;
    Ok(())
}

/// Weighs the forces of quasi-static contacts that open or close in this step.
///
/// While contacts stay what they are, a linear body keeps `H = T + V - dt²/8 a·M a` exactly (`a` smooth accelerations at full
/// steps), which swings about the energy. A contact that acts for a part of the step only breaks that: the trapezoid gives it
/// `dt/2 p` whenever it closed. What was given is taken back in the part, from none to all of it, that keeps `H`.
fn weigh_switches(island: &mut Island, settings: &SolveSettings) {
    let is_smooth = |contact: &ActiveContact| contact.kinematics.is_quasi_static();
    // Other members than central difference, β1 > 1/2, damp.
    let is_leapfrog = 2.0 * settings.b1 == settings.dt;
    let keeps_energy = is_leapfrog
        && island.blocks.iter().all(|block| match block {
            Block::Flex(block) => !block.is_damped(),
            Block::Rigid(_) => true,
        });
    if !keeps_energy
        || !island.joints.ties.is_empty()
        || !island.contacts.iter().all(is_smooth)
        || !gather_switches(island, settings)
    {
        return;
    }
    let gain = shadow_gain(island, settings);
    let now = kinetic_energy(&island.blocks);
    add_switches(island, -1.0);
    let without = kinetic_energy(&island.blocks);
    add_switches(island, 2.0);
    let twice = kinetic_energy(&island.blocks);
    let curvature = 0.5 * (without + twice) - now;
    let slope = 0.5 * (without - twice);
    let part = part_to_take([curvature, slope, gain]);
    add_switches(island, -1.0 - part);
    // What a contact that has closed really gave is its mean force over the step.
    for contact in &mut island.contacts {
        if contact.is_closed() && contact.remembered.normal <= 0.0 {
            contact.impulse = contact.multiplier.map(|force| -part * settings.b1 * force);
        }
    }
}

/// Gathers what contacts that have opened or closed gave to the velocities; returns whether there are any.
fn gather_switches(island: &mut Island, settings: &SolveSettings) -> bool {
    gathered::clear_wrenches(island);
    gathered::clear_impulses(island);
    let mut has_switched = false;
    for contact in &island.contacts {
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
        gathered::spread(
            &mut island.blocks,
            &contact.kinematics,
            force.map(|force| weight * force),
            Some(&mut island.wrenches),
            |block, node, impulse, lever| {
                block.gather_impulse(Response::Velocity, node, impulse, lever);
            },
        );
    }
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.respond_to_surface_impulse();
        }
    }
    has_switched
}

fn add_switches(island: &mut Island, scale: f64) {
    for (block, wrench) in island.blocks.iter_mut().zip(&island.wrenches) {
        match block {
            Block::Flex(block) => block.add_surface_response(scale),
            Block::Rigid(block) => block.add_impulse(wrench.map(|value| scale * value)),
        }
    }
}

/// Gain of `H` over the step beyond the work of loads, of prescribed bodies and of friction (J).
fn shadow_gain(island: &mut Island, settings: &SolveSettings) -> f64 {
    let mut gain = -island.actual_work(settings);
    for contact in &island.contacts {
        let drag = 0.5 * (contact.multiplier[1] + contact.remembered.tangent);
        gain -= drag * contact.slip;
    }
    for (end, start) in end_energy(&island.blocks)
        .iter()
        .zip(start_energy(&island.blocks))
    {
        gain += end - start;
    }
    for block in &island.blocks {
        let [start, end] = block.swing();
        gain -= end - start;
    }
    gain
}

fn gather_wrenches(island: &mut Island, counts: impl Fn(&ActiveContact) -> bool) {
    gathered::clear_wrenches(island);
    for contact in island.contacts.iter().filter(|contact| counts(contact)) {
        gathered::spread(
            &mut island.blocks,
            &contact.kinematics,
            contact.multiplier,
            Some(&mut island.wrenches),
            |_, _, _, _| {},
        );
    }
}

/// Kinetic energy that the half step of the forward contacts still to come will add at this very instant (J).
///
/// The velocity of a mass in contact lacks `dt/2 M⁻¹ Gᵀp` of the next multiplier, without which a resting mass would
/// seem to fall by `g dt/2`. That multiplier is the one that keeps the contact closed, foreseen without new loads.
fn pending_energy(island: &mut Island, settings: &SolveSettings) -> Result<f64, KktError> {
    let (dt, half) = (settings.dt, 0.5 * settings.dt);
    island.problem.clear_rows();
    for (index, contact) in island.contacts.iter().enumerate() {
        if !(contact.is_closed() && contact.is_forward()) {
            continue;
        }
        let kinematics = &contact.kinematics;
        let law = island.candidates[contact.candidate].law;
        let moved = foreseen(kinematics, &island.blocks, dt) - law.carried;
        let free = (moved + kinematics.gap * kinematics.normal) / (dt * dt);
        let friction = law.friction;
        let free = [kinematics.normal, kinematics.tangent()].map(|along| free.dot(&along));
        island.problem.push(index, kinematics, friction, free);
    }
    if island.problem.rows.is_empty() {
        return Ok(0.0);
    }
    let contacts = &island.contacts;
    let of = |index: usize| &contacts[index].kinematics;
    assemble(
        &island.blocks,
        &island.problem.rows,
        Response::Position,
        of,
        &mut island.problem.delassus,
    );
    island.problem.acted.clear();
    impulses::solve_rows(island)?;
    // T(v + dt/2 M⁻¹Gᵀp) - T(v) = dt/2 p·(G v + dt/4 W p).
    let (n, mut gain) = (island.problem.rows.len(), 0.0);
    for (row, direction) in island.problem.rows.iter().enumerate() {
        let kinematics = &island.contacts[direction.contact].kinematics;
        let velocity = kinematics.relative(&island.blocks, |block, grip| block.velocity(grip));
        let response: f64 = island.problem.delassus[row * n..(row + 1) * n]
            .iter()
            .zip(&island.problem.multipliers)
            .map(|(w, p)| w * p)
            .sum();
        let mean = velocity.dot(&direction.direction) + 0.5 * half * response;
        gain += half * island.problem.multipliers[row] * mean;
    }
    Ok(gain)
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
        dt * block.velocity(grip) + 0.5 * dt * dt * block.smooth_acceleration(grip, 1.0)
    })
}
