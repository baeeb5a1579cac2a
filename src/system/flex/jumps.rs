//! Loads and pins of a body of small strain that jump as a step begins.

use super::shared::Shared;
use crate::body::{Frame, KnownLoads};
use crate::math::{Vec2, cross, node_vec, rotation, set_node_vec};
use crate::system::pin_rates::RigidRates;

/// Lets loads that jump bring all their momentum, whatever the steps are long.
///
/// A step of length `h` brings `(1 - β1) h f` of the load `f` before it and `β1 h f'` of its own: of a jump `Δf` less than its time by
/// `(1 - β1) h Δf`, and more by as much when it is gone, if that step is as long. All jumps are to be late by the length `l` of the first one after
/// nothing was: the acceleration at the beginning of the step has jumped by `(1 - l/h) κ A⁻¹ Δf` for that, `κ = 1 + α b1`, by its part of
/// `M⁻¹ Δf` where the step resolves it, rigid motion above all, and by nothing where it does not, which would swing.
pub(super) fn take_up_load(shared: &mut Shared, known: &KnownLoads) {
    let (last, length) = (&known.last, shared.step.dt);
    if last.force.len() != shared.loads.own.force.len() || *last == shared.loads.own {
        return;
    }
    if *last == known.base {
        shared.loads.lag = length;
    }
    let late = shared.loads.lag / length;
    let share = 1.0 - late;
    let mean = (1.0 - shared.step.weights.b1 / length) * late;
    let turn = shared.start.frame.angle;
    let (back, centre) = (rotation(-turn), shared.start.frame.centre);
    let (mut force, mut torque) = (Vec2::zeros(), 0.0);
    shared.loads.late.resize(shared.loads.force.len(), 0.0);
    for (node, mass) in shared.shape.arms.node_mass.iter().enumerate() {
        let own = node_vec(&shared.loads.own.force, node) - node_vec(&last.force, node);
        let whole: Vec2 = own + *mass * (shared.loads.own.gravity - last.gravity);
        set_node_vec(&mut shared.loads.late, node, -mean * whole);
        let jump = share * whole;
        force += jump;
        torque += cross(node_vec(&shared.start.position, node) - centre, jump);
        set_node_vec(&mut shared.local, node, back * jump);
    }
    if share == 0.0 {
        return;
    }
    shared.shape.clear_fixed(&mut shared.local);
    shared.answer.solve(&mut shared.local);
    let kept = 1.0 + shared.shape.model.rayleigh().mass * shared.step.weights.b1;
    shared.local.iter_mut().for_each(|value| *value *= kept);
    shared.shape.spread_accelerations(&mut shared.local);
    shared
        .shape
        .arms
        .split(shared.shape.kind, &mut shared.local);
    for (start, jump) in shared.start.acceleration.iter_mut().zip(&shared.local) {
        *start += jump;
    }
    if shared.shape.kind == Frame::Free {
        shared.start.frame.acceleration += force / shared.shape.arms.mass;
    }
    if shared.shape.kind != Frame::Fixed {
        shared.start.torque += torque;
    }
}

/// Notes what the pins give for the jump `Δv` of the velocities in `local`, `A Δv/dt` at the held dofs, with all of `A`; elsewhere it is zero. Its sum is
/// `κ Σ m Δv/dt`.
fn note_push(shared: &mut Shared, kept: f64) {
    let (model, weights, dt) = (&shared.shape.model, shared.step.weights, shared.step.dt);
    let stiff = weights.b0 + model.rayleigh().stiffness * weights.b1;
    shared.pin_push.resize(shared.local.len(), 0.0);
    let push = &mut shared.pin_push;
    model.mass().multiply_add(kept / dt, &shared.local, push);
    model
        .stiffness()
        .multiply_add(stiff / dt, &shared.local, push);
}

/// Lets a pinned body of small strain begin the step with the velocities that its pins have in it.
///
/// Displacements that are given to the pins would be reached by accelerations of twice what they need, and a stiff body would swing about the
/// velocity of its pins from step to step.
pub(super) fn take_up_jump(shared: &mut Shared) {
    let dt = shared.step.dt;
    let (rest, start) = (
        shared.shape.model.placed_positions(),
        &shared.start.position,
    );
    let jump = |dof: usize| {
        (rest[dof] + shared.loads.prescribed[dof] - start[dof]) / dt - shared.start.velocity[dof]
    };
    let found = RigidRates::of_pins(&shared.shape.fixed_dofs, start, jump);
    shared.energy.jump_work = 0.0;
    let Some(jump) = found else {
        return;
    };
    let before = shared
        .shape
        .model
        .mass()
        .inner(&shared.start.velocity, &shared.start.velocity);
    let kept = 1.0 + shared.shape.model.rayleigh().mass * shared.step.weights.b1;
    jump.write_at(&shared.start.position, &mut shared.scratch);
    shared.answer_jump(kept);
    note_push(shared, kept);
    for (velocity, answer) in shared.start.velocity.iter_mut().zip(&shared.local) {
        *velocity += answer;
    }
    for &dof in &shared.shape.fixed_dofs {
        shared.start.acceleration[dof] = 0.0;
    }
    let after = shared
        .shape
        .model
        .mass()
        .inner(&shared.start.velocity, &shared.start.velocity);
    shared.energy.jump_work = 0.5 * (after - before);
}
