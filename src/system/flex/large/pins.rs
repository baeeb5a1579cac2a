//! What pins give a body of large strain whose motion they change.

use super::LargeStrain;
use crate::body::Frame;
use crate::math::{Vec2, cross, node_vec, set_node_vec};
use crate::system::flex::shared::Shared;
use crate::system::pin_rates::{RigidRates, push_by_pins};

/// Takes out of the velocities what a jump of the pins has left there; returns the work of the pins in it (J).
///
/// Displacements that are given, `Δx = d`, end with `v' = 2 d/dt - v`: where the pins of a stiff body jump from rest to `ḋ`, it would end
/// with `2 ḋ`, and swing about `ḋ` from step to step. Velocities that had jumped as well, by what the body answers to that within a step,
/// would not.
pub(super) fn take_out_jump(shared: &mut Shared) -> f64 {
    if shared.shape.kind == Frame::Free {
        return 0.0;
    }
    let jump = |dof: usize| shared.now.velocity[dof] - shared.start.velocity[dof];
    let Some(jump) = RigidRates::of_pins(&shared.shape.fixed_dofs, &shared.now.position, jump)
    else {
        return 0.0;
    };
    let before = shared.kinetic_energy();
    let kept = 1.0 + shared.shape.model.rayleigh().mass * shared.step.weights.b0 / shared.step.dt;
    jump.write_at(&shared.now.position, &mut shared.scratch);
    shared.answer_jump(kept);
    shared.pin_push.clone_from(&shared.local);
    for dof in 0..shared.now.velocity.len() {
        shared.now.velocity[dof] -= if shared.shape.is_fixed[dof] {
            0.0
        } else {
            shared.local[dof]
        };
    }
    shared.kinetic_energy() - before
}

/// Notes by how much what the pins have given differs from the forces of the step, as [`take_out_jump`] takes `Δv` out of the velocities.
///
/// The impulse is `A Δv = dt²/2 ∂R/∂x' Δv`, of the forces `R` out of balance: what is left of them is those of the place `x' - dt/2 Δv`. `Δv` is the
/// answer of a factor that may be of another place; what that makes of the sum, which is known to be `Σ m Δv`, all pins share.
pub(super) fn note_push(large: &mut LargeStrain, shared: &mut Shared) {
    if shared.pin_push.is_empty() {
        return;
    }
    let (dt, about) = (shared.step.dt, shared.now.frame.centre);
    let position = &shared.now.position;
    let (mut force, mut moment) = (Vec2::zeros(), 0.0);
    for (node, mass) in shared.shape.arms.node_mass.iter().enumerate() {
        let jump = node_vec(&shared.pin_push, node);
        let x = node_vec(position, node);
        set_node_vec(&mut shared.local, node, x - 0.5 * dt * jump);
        force -= mass / dt * jump;
        moment -= mass / dt * cross(x - about, jump);
    }
    shared.pin_push.fill(0.0);
    let dofs = &shared.shape.fixed_dofs;
    let equation = (large.problem).equation(&shared.step, &shared.start, &shared.shape);
    let there = large.trial.evaluate(&equation, &shared.local);
    if there.is_ok_and(|there| there.norm.is_finite()) {
        for &dof in dofs {
            shared.pin_push[dof] = large.trial.reaction[dof];
        }
    } else {
        shared.pin_push.clear();
    }
    // A place that was looked at.
    let here = large.trial.evaluate(&equation, position);
    if here.is_err() || shared.pin_push.is_empty() {
        shared.pin_push.clear();
        large.ease_pins(shared);
        return;
    }
    for &dof in dofs {
        let mut changed = Vec2::zeros();
        changed[dof % 2] = shared.pin_push[dof] - large.trial.reaction[dof];
        force -= changed;
        moment -= cross(node_vec(position, dof / 2) - about, changed);
    }
    push_by_pins(dofs, position, (force, moment, about), &mut shared.pin_push);
    large.ease_pins(shared);
    for &dof in &shared.shape.fixed_dofs {
        shared.pin_push[dof] -= large.trial.reaction[dof];
    }
}

/// Damps what the step does not resolve. Its momentum is none of a free body; others have it from their pins, with its work.
pub(super) fn damp_and_push(large: &mut LargeStrain, shared: &mut Shared) {
    if shared.shape.kind == Frame::Free {
        large.damp_unresolved(shared);
        return;
    }
    let about = shared.now.frame.centre;
    let momentum = |shared: &Shared| {
        let mass = shared.shape.model.mass();
        let moment = mass.moment(about, &shared.now.position, &shared.now.velocity);
        let nodes = shared.shape.arms.node_mass.iter().enumerate();
        let linear = nodes.map(|(node, mass)| *mass * node_vec(&shared.now.velocity, node));
        (linear.sum::<Vec2>(), moment)
    };
    let before = momentum(shared);
    large.damp_unresolved(shared);
    let after = momentum(shared);
    let (linear, angular) = (after.0 - before.0, after.1 - before.1);
    let (dofs, velocity) = (&shared.shape.fixed_dofs, &shared.now.velocity);
    if let Some(pins) = RigidRates::of_pins(dofs, &shared.now.position, |dof| velocity[dof]) {
        shared.energy.jump_work += pins.at(about).dot(&linear) + pins.spin * angular;
    }
    let dt = shared.step.dt;
    shared.pin_push.resize(shared.now.position.len(), 0.0);
    let push = (linear / dt, angular / dt, about);
    push_by_pins(dofs, &shared.now.position, push, &mut shared.pin_push);
}
