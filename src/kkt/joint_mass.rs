//! Joints that hold masses of flexible bodies: their velocities and accelerations, in the metric of the masses.
//!
//! A node with mass that a joint holds has `G x' = d` from the position stage. With `G v' = ḋ` and `G a' = d̈` it is a node whose motion
//! is given, and Beta-2 advances the others as it advances a body that is pinned there: as stable as without joints. The projection that
//! leaves the others alone is that of the masses, `Δv = M⁻¹ Gᵀ P`, and it can only take energy. With `A⁻¹ = (M + b0 K + ..)⁻¹` in its place
//! the whole body would answer for what its node alone does too fast, and a vibration that the step does not resolve would grow by it.
//!
//! What is shorter than the step is answered by all of the body, `A⁻¹`: jumps of the motion that drives a joint, joints that take hold of masses of
//! another velocity, and impacts of rigid bodies. A node that stops alone leaves the rest of a stiff body as fast as it was, the other way round, and
//! damping `β K Δv` that its stored accelerations do not know of. Held so for ever, a clamped beam would be damped four times as fast as one on pins.
//!
//! Hard contacts and joints take part with what they will do, but only these joints act here: the velocity stage finds the others
//! again, and nothing left to do for these. Nodes without mass follow what holds them as springs do, and need none of this.

use super::island::{Island, KktError, SolveSettings};
use super::joints::ActiveJoint;
use super::joints::Finish;
use super::{gathered, impulses};
use crate::constraint::joint::unit_wrench;
use crate::linalg::complementarity::RowKind;
use crate::math::Vec2;
use crate::system::{Block, Point, Response};

/// Gives masses of flexible bodies the velocities of what they are joined to.
///
/// # Errors
/// If a number is not finite.
pub(super) fn settle_joined_velocities(
    island: &mut Island,
    settings: &SolveSettings,
) -> Result<(), KktError> {
    if !has_joined_masses(island, settings) {
        return Ok(());
    }
    take_jumps(island, settings)?;
    if is_struck(island) {
        return Ok(());
    }
    impulses::velocity_rows(island, settings, |contact| contact.is_hard);
    let takes_part = |tie: &ActiveJoint| tie.is_hard || tie.holds_masses();
    island
        .joints
        .list_velocities(&mut island.problem, (&island.blocks, settings), takes_part);
    push_joined_masses(island, Response::Velocity, settings)
}

/// Takes out of the velocities what a jump of the motion that drives a joint has left there, or of one that has taken hold.
///
/// Displacements that are given, `Δx = d`, end with `v' = 2 d/dt - v`: where what drives a stiff body jumps from rest to `ḋ`, the body would end
/// with `2 ḋ`, and swing about `ḋ` from step to step. Velocities that had jumped as well, by what the body answers to that within a step,
/// `A⁻¹ Gᵀ W⁻¹ J`, would not.
fn take_jumps(island: &mut Island, settings: &SolveSettings) -> Result<(), KktError> {
    island.problem.clear_rows();
    island.joints.list(&mut island.problem, |_, tie| {
        let is_held = matches!(tie.finish, Finish::Hold { .. }) && tie.is_movable && !tie.is_left;
        let law = || {
            let last = tie.row.remembered;
            let before = last.map_or(tie.began, |last| last.driven);
            (tie.driven - before, RowKind::Bilateral, 0.0)
        };
        (is_held && tie.holds_masses()).then(law)
    });
    if island.problem.free.iter().all(|jump| *jump == 0.0) {
        return Ok(());
    }
    island.problem.acted.clear();
    impulses::solve_impulses(island, Response::Velocity, settings.dt)?;
    island.joints.take_impulses(&island.problem);
    gathered::clear_impulses(island);
    gathered::gather_rows(island, Response::Velocity);
    gathered::add_to_rigid(island, Response::Velocity, 1.0);
    gathered::respond(island);
    gathered::add_to_flexible(island, Response::Velocity, 1.0);
    gathered::clear_impulses(island);
    Ok(())
}

/// Gives masses of flexible bodies the accelerations of what they are joined to.
///
/// # Errors
/// If a number is not finite.
pub(super) fn settle_joined_accelerations(
    island: &mut Island,
    settings: &SolveSettings,
) -> Result<(), KktError> {
    if !has_joined_masses(island, settings) || is_struck(island) {
        return Ok(());
    }
    // Impulses gathered for velocities act first: there is one place for what blocks answer.
    gathered::respond(island);
    gathered::add_to_flexible(island, Response::Velocity, 1.0);
    impulses::acceleration_rows(island, settings, |contact| contact.is_hard);
    let takes_part = |tie: &ActiveJoint| tie.is_hard || tie.holds_masses();
    island.joints.list_accelerations(
        &mut island.problem,
        (&island.blocks, &island.wrenches),
        takes_part,
    );
    push_joined_masses(island, Response::Acceleration, settings)
}

/// Whether rigid bodies have met in this step that did not press in the last, or a joint has taken hold of masses.
fn is_struck(island: &Island) -> bool {
    let mut contacts = island.contacts.iter();
    let mut ties = island.joints.ties.iter();
    contacts
        .any(|contact| contact.is_hard && contact.is_closed() && contact.remembered.normal == 0.0)
        || ties.any(|tie| tie.holds_masses() && tie.row.remembered.is_none())
}

fn has_joined_masses(island: &Island, settings: &SolveSettings) -> bool {
    !settings.is_explicit && island.joints.ties.iter().any(ActiveJoint::holds_masses)
}

/// Solves the rows, and lets those of joined masses act.
fn push_joined_masses(
    island: &mut Island,
    of: Response,
    settings: &SolveSettings,
) -> Result<(), KktError> {
    impulses::solve_impulses(island, Response::ByMass, settings.dt)?;
    let first = island.problem.rows.len();
    gathered::clear_impulses(island);
    for slot in 0..island.joints.listed.len() {
        let value = island.problem.multipliers[first + slot];
        let tie = island.joints.ties[island.joints.listed[slot]];
        if !tie.holds_masses() || value == 0.0 {
            continue;
        }
        let acting = &mut island.joints.ties[island.joints.listed[slot]];
        match of {
            Response::Velocity => acting.impulse += value,
            _ => acting.settle(value, settings.dt - settings.b1),
        }
        for grip in &island.joints.end_grips[tie.row.grips.0..tie.row.grips.1] {
            let force: Vec2 = value * grip.weight * tie.end;
            match (&mut island.blocks[grip.block], grip.point) {
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
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.respond_by_mass();
        }
    }
    gathered::add_to_flexible(island, of, 1.0);
    gathered::clear_impulses(island);
    Ok(())
}
