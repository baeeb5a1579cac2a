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

use super::impulses;
use super::island::{Island, KktError, SolveSettings};
use super::multipliers::prepare;
use super::unresolved::unresolved_shares;
use super::{answers, closing, gathered, hits, joint_mass, midway, restitution};
use crate::system::Response;

pub(super) fn solve_velocities(
    island: &mut Island,
    settings: &SolveSettings,
) -> Result<(), KktError> {
    take_out_hard_forces(island);
    midway::act_midway(island, settings);
    for index in 0..island.contacts.len() {
        if island.contacts[index].is_closed() {
            // Newton's iterations may have ended without asking for a compliance.
            prepare(&mut island.blocks, &island.contacts[index].kinematics);
            let shares =
                unresolved_shares(&island.blocks, &island.contacts[index].kinematics, settings);
            let contact = &mut island.contacts[index];
            [contact.unresolved, contact.rigid] = shares;
        }
    }
    if !impact_rows(island, settings)? {
        return Ok(());
    }
    // The accelerations do not depend on these impulses: one substitution answers both. Where forces act wholly within the step, none
    // goes on.
    if !settings.is_within {
        settle_accelerations(island, settings)?;
    }
    gathered::respond(island);
    gathered::add_to_flexible(island, Response::Velocity, 1.0);
    gathered::add_to_flexible(island, Response::Acceleration, 1.0);
    Ok(())
}

/// Solves the impact law at the contacts that hold velocities, and gathers its impulses, which rigid bodies take at once;
/// returns whether there are any.
pub(super) fn impact_rows(island: &mut Island, settings: &SolveSettings) -> Result<bool, KktError> {
    answers::find_answers(island, settings)?;
    closing::take_out_closings(island, settings)?;
    island.joints.kick(&mut island.blocks, settings);
    joint_mass::settle_joined_velocities(island, settings)?;
    hits::meet(island, settings);
    let has_rows = solve_velocity_rows(island, settings);
    hits::end_rows(island);
    has_rows
}

fn solve_velocity_rows(island: &mut Island, settings: &SolveSettings) -> Result<bool, KktError> {
    impulses::velocity_rows(island, settings, |_| true);
    island
        .joints
        .list_velocities(&mut island.problem, (&island.blocks, settings), |_| true);
    if island.problem.kinds.is_empty() {
        return Ok(false);
    }
    impulses::solve_impulses(island, Response::Velocity, settings.dt)?;
    restitution::keep_energy(island, settings)?;
    island.joints.take_impulses(&island.problem);
    impulses::read_impulses(island);
    gathered::clear_impulses(island);
    gathered::gather_rows(island, Response::Velocity);
    gathered::add_to_rigid(island, Response::Velocity, 1.0);
    Ok(true)
}

/// Velocities and accelerations feel soft multipliers as (C.5) says, hard ones not at all.
pub(super) fn take_out_hard_forces(island: &mut Island) {
    gathered::clear_wrenches(island);
    for contact in &island.contacts {
        let (blocks, kinematics) = (&mut island.blocks, &contact.kinematics);
        let force = contact.multiplier;
        if !contact.is_hard {
            let wrenches = Some(&mut island.wrenches[..]);
            gathered::spread(blocks, kinematics, force, wrenches, |_, _, _, _| {});
        }
    }
    island
        .joints
        .add_soft_forces(&island.blocks, &mut island.wrenches);
    gathered::set_soft_forces(island);
}

/// (C.5) as printed: every multiplier acts on velocity and acceleration.
pub(super) fn keep_plain_forces(island: &mut Island) {
    gathered::clear_wrenches(island);
    for contact in &mut island.contacts {
        contact.is_hard = false;
        gathered::spread(
            &mut island.blocks,
            &contact.kinematics,
            contact.multiplier,
            Some(&mut island.wrenches),
            |_, _, _, _| {},
        );
    }
    island
        .joints
        .add_soft_forces(&island.blocks, &mut island.wrenches);
    gathered::set_soft_forces(island);
}

/// Contacts that hold velocities and stay closed keep no relative acceleration either.
///
/// Between surfaces with mass, multipliers would alternate otherwise. Rigid bodies that press each other would start the next step with
/// accelerations that no pose allows, and its multipliers, at the levers of its end, would turn them back too far: a tower on a
/// soft block rocks itself up by `p h dt / I` a second.
fn settle_accelerations(island: &mut Island, settings: &SolveSettings) -> Result<(), KktError> {
    gathered::clear_wrenches(island);
    island
        .joints
        .add_spring_forces(&mut island.wrenches, settings.dt);
    joint_mass::settle_joined_accelerations(island, settings)?;
    impulses::acceleration_rows(island, settings, |_| true);
    if island.problem.rows.is_empty() && !island.joints.has_soft() {
        return Ok(());
    }
    island.joints.list_accelerations(
        &mut island.problem,
        (&island.blocks, &island.wrenches),
        |_| true,
    );
    impulses::solve_impulses(island, Response::Acceleration, settings.dt)?;
    // What the stored acceleration loses will not act in the next step.
    let late = settings.dt - settings.b1;
    for (row, direction) in island.problem.rows.iter().enumerate() {
        let contact = &mut island.contacts[direction.contact];
        let force = island.problem.multipliers[row];
        contact.impulse[direction.axis] += late * force;
        contact.settled[direction.axis] = force;
    }
    island.joints.take_accelerations(&island.problem, late);
    gathered::gather_rows(island, Response::Acceleration);
    gathered::add_to_rigid(island, Response::Acceleration, 1.0);
    Ok(())
}

/// Solves the impact law and the joints' velocities where flexible blocks take part in joints only.
pub(super) fn finish_joints(island: &mut Island, settings: &SolveSettings) -> Result<(), KktError> {
    if impact_rows(island, settings)? {
        gathered::respond(island);
        gathered::add_to_flexible(island, Response::Velocity, 1.0);
    }
    Ok(())
}
