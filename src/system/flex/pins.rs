//! What the pins of a body of small strain give: their forces and their work.

use super::shared::Shared;
use crate::body::Frame;
use crate::fe::model::MassMatrix;
use crate::math::{Vec2, node_vec, set_node_vec};

/// The force that stiffness and damping tell of at a pinned node, at the end of the step (N); zero where nothing is held.
pub(super) fn reaction(shared: &Shared, node: usize) -> Vec2 {
    let is_fixed = [0, 1].map(|axis| shared.shape.is_fixed[2 * node + axis]);
    if is_fixed == [false; 2] {
        return Vec2::zeros();
    }
    let rayleigh = shared.shape.model.rayleigh();
    let stiffness = shared.shape.model.stiffness();
    let mut force = Vec2::zeros();
    for (&other, block) in stiffness
        .neighbours(node)
        .iter()
        .zip(stiffness.row_blocks(node))
    {
        let other = other as usize;
        let u = node_vec(&shared.now.displacement, other)
            + rayleigh.stiffness * node_vec(&shared.now.rate, other);
        force += Vec2::new(
            block[0] * u.x + block[1] * u.y,
            block[2] * u.x + block[3] * u.y,
        );
    }
    let mut reaction = shared.now.turn * force
        - node_vec(&shared.loads.force, node)
        - node_vec(&shared.contact.nodal, node);
    if let MassMatrix::Lumped(mass) = shared.shape.model.mass() {
        reaction += mass[node] * rayleigh.mass * node_vec(&shared.now.velocity, node);
    }
    if let Frame::Hinged(_) = shared.shape.kind {
        // What is at the pin moves with the frame.
        reaction += shared.shape.arms.node_mass[node] * shared.now.frame.acceleration;
    }
    for axis in 0..2 {
        if !is_fixed[axis] {
            reaction[axis] = 0.0;
        }
    }
    reaction
}

/// Work of the pins that move over the step, by the mean of their reactions, and of what speeds them up (J).
pub(super) fn work(shared: &Shared) -> f64 {
    let mut work = shared.energy.jump_work;
    for &dof in &shared.shape.fixed_dofs {
        let moved = shared.now.position[dof] - shared.start.position[dof];
        if moved != 0.0 {
            let end = reaction(shared, dof / 2)[dof % 2];
            work += 0.5 * (shared.start.reaction[dof] + end) * moved;
        }
    }
    work
}

/// Notes what the pin that a body turns about gives where it speeds up, beside the force that the stiffness tells of, which a stiff body has still to come
/// to: the rest of the change of momentum, where nothing touches the body.
pub(super) fn note_hinge_push(shared: &mut Shared) {
    let Frame::Hinged(pin) = shared.shape.kind else {
        return;
    };
    let [before, now] = [&shared.start.frame, &shared.now.frame].map(|frame| frame.velocity);
    if now == before || shared.contact.is_used {
        return;
    }
    let dt = shared.step.dt;
    let mut force = Vec2::zeros();
    for (node, mass) in shared.shape.arms.node_mass.iter().enumerate() {
        let [end, start] =
            [&shared.now.velocity, &shared.start.velocity].map(|values| node_vec(values, node));
        force += mass / dt * (end - start) - node_vec(&shared.loads.force, node);
    }
    let late = shared.loads.late.chunks_exact(2);
    force -= late.map(|late| Vec2::new(late[0], late[1])).sum::<Vec2>();
    let push = force - reaction(shared, pin);
    shared.energy.jump_work = 0.5 * dt * push.dot(&(before + now));
    // A part of a step may be taken again.
    shared.pin_push.clear();
    shared.pin_push.resize(shared.now.position.len(), 0.0);
    set_node_vec(&mut shared.pin_push, pin, push);
}
