//! The end of a step of a body of large strain: velocities, accelerations, ways back to its beginning, and the state to commit.

use super::pins::{damp_and_push, note_push, take_out_jump};
use super::{LargeStrain, TOLERANCE};
use crate::body::{FlexState, Frame, FrameMotion};
use crate::large::Inertia;
use crate::math::{
    Vec2, add_node_vec, cross, node_vec, perp, rotation, rounding, set_node_vec, sum_over,
};
use crate::system::flex::answer::Answer;
use crate::system::flex::shape::Shape;
use crate::system::flex::shared::Shared;
use crate::system::pin_rates::RigidRates;
use crate::system::rigid_way::RigidWay;

/// Rounding of a sum of products (-).
const ROUNDING: f64 = rounding::SUM;

impl LargeStrain {
    /// Writes the velocities and the centre that go with the positions.
    pub fn follow_positions(&mut self, shared: &mut Shared) {
        let dt = shared.step.dt;
        for (dof, velocity) in shared.now.velocity.iter_mut().enumerate() {
            let moved = (shared.now.position[dof] - shared.start.position[dof]) / dt;
            *velocity = match shared.shape.is_fixed[dof] {
                true => moved,
                false => 2.0 * moved - shared.start.velocity[dof],
            };
        }
        self.resolved.copy_from_slice(&shared.now.velocity);
        shared.now.follow_centre(&shared.shape, &shared.start.frame);
    }

    /// Writes the velocities that the step resolves and their mean acceleration, and damps the others.
    pub fn place_velocities(&mut self, shared: &mut Shared) {
        shared.energy.jump_work = take_out_jump(shared);
        note_push(self, shared);
        self.resolve_end(shared);
        if is_magnified(shared, &self.resolved) {
            self.answer_as_at_the_end(shared);
            self.resolve_end(shared);
        }
        damp_and_push(self, shared);
        let pairs = self.resolved.iter().zip(&self.start_resolved);
        for (acceleration, (now, before)) in self.acceleration.iter_mut().zip(pairs) {
            *acceleration = (now - before) / shared.step.dt;
        }
    }

    /// The resolved part of the velocities at hand.
    fn resolve_end(&mut self, shared: &mut Shared) {
        let motion = [&shared.now.position[..], &shared.now.velocity];
        resolve(
            &shared.shape,
            &shared.start.frame,
            &mut shared.answer,
            motion,
            &mut self.resolved,
        );
    }

    /// Takes the share `min(χ, 1)` of the velocities that the step does not resolve, `(1 - A⁻¹ M)² v`, and of neither momentum.
    ///
    /// Of the two amplifications of a mode that the step does not resolve, the decay `χ` of the stress damps one; the other goes to -1. What
    /// is taken of a mode of frequency ω is `χ (1 - r)²` of its velocity, `r = 1/(1 + ω² dt²/4)`: energy, always, and nothing where `χ` is zero.
    /// What the step resolves loses a share of the fourth order of `ω dt` to it, besides the damping that it is said to have.
    pub(super) fn damp_unresolved(&mut self, shared: &mut Shared) {
        let share = self.problem.decay(&shared.step).min(1.0);
        if share == 0.0 {
            return;
        }
        let fast = &mut shared.local;
        let pairs = shared.now.velocity.iter().zip(&self.resolved);
        for (fast, (whole, resolved)) in fast.iter_mut().zip(pairs) {
            *fast = whole - resolved;
        }
        let motion = [&shared.now.position[..], fast];
        resolve(
            &shared.shape,
            &shared.start.frame,
            &mut shared.answer,
            motion,
            &mut self.trial.residual,
        );
        let unresolved = fast.iter().zip(&self.trial.residual);
        for (velocity, (fast, resolved)) in shared.now.velocity.iter_mut().zip(unresolved) {
            *velocity -= share * (fast - resolved);
        }
    }

    /// Measures the elastic energy of the iterate.
    pub fn measure_elastic_energy(&self, shared: &mut Shared) {
        let flowed = self.trial.deformation.flowed();
        let energy = self
            .problem
            .model
            .energy_after(&shared.now.position, flowed);
        (shared.energy.elastic, shared.energy.flow) = (energy.stored, energy.dissipated);
    }

    /// Elastic energy that rounding of the positions may make and take (J).
    pub fn rounding_energy(&self, shared: &Shared) -> f64 {
        let rounding = f64::EPSILON * shared.extent();
        0.5 * shared.shape.n_dofs() as f64 * self.trial.row_sum * rounding * rounding
    }

    /// Goes back to where the step began.
    pub fn restart(&mut self, shared: &mut Shared) {
        shared.now.position.copy_from_slice(&shared.start.position);
        shared.now.velocity.copy_from_slice(&shared.start.velocity);
        self.resolved.copy_from_slice(&self.start_resolved);
        self.led.is_led = false;
        shared.energy.jump_work = 0.0;
        shared.contact.clear();
        shared.now.follow_centre(&shared.shape, &shared.start.frame);
    }

    /// Ends the step where it began, moving as a rigid body with this velocity of its centre (m/s) and spin (rad/s).
    pub fn move_on(&mut self, shared: &mut Shared, velocity: Vec2, spin: f64) {
        self.restart(shared);
        let centre = shared.now.frame.centre;
        for node in 0..shared.shape.model.n_nodes() {
            let arm = node_vec(&shared.now.position, node) - centre;
            let rigid = velocity + spin * perp(arm);
            for axis in 0..2 {
                let dof = 2 * node + axis;
                shared.now.velocity[dof] = if shared.shape.is_fixed[dof] {
                    0.0
                } else {
                    rigid[axis]
                };
            }
        }
        self.acceleration.fill(0.0);
        self.resolved.copy_from_slice(&shared.now.velocity);
        shared.now.follow_centre(&shared.shape, &shared.start.frame);
    }

    /// Ends the step as a rigid motion leads it.
    pub fn carry_on(&mut self, shared: &mut Shared, way: &RigidWay) {
        self.restart(shared);
        for node in 0..shared.shape.model.n_nodes() {
            let end = way.end(node_vec(&shared.now.position, node));
            set_node_vec(&mut shared.now.position, node, end);
            set_node_vec(&mut shared.now.velocity, node, way.velocity_at(end));
        }
        self.acceleration.fill(0.0);
        self.resolved.copy_from_slice(&shared.now.velocity);
        shared.now.follow_centre(&shared.shape, &shared.start.frame);
    }

    /// Work of the pins that move, by their mean force over the step and, of what is at the pins, its mean velocity (J).
    pub fn pin_work(&self, shared: &Shared) -> f64 {
        let arrays = [
            self.reaction(),
            &shared.now.position,
            &shared.start.position,
        ];
        let work = sum_over(arrays, |[force, end, start]| force * (end - start));
        let jumps = shared.shape.fixed_dofs.iter().map(|&dof| {
            let jump = shared.now.velocity[dof] - shared.start.velocity[dof];
            0.5 * shared.shape.arms.node_mass[dof / 2] * jump * jump
        });
        work - jumps.sum::<f64>() + shared.energy.jump_work
    }

    /// Writes the end of the step over the committed state.
    pub fn commit(&self, shared: &Shared, state: &mut FlexState) {
        state.kinetic_energy = shared.kinetic_energy();
        state.elastic_energy = shared.energy.elastic;
        state.position.copy_from_slice(&shared.now.position);
        state.velocity.copy_from_slice(&shared.now.velocity);
        let (factor, dt) = (&shared.answer.factor, shared.step.dt);
        self.reference.tell(factor, dt, &mut state.linearized);
        // From where the part of the step began that has been solved: the state may be that of the whole step.
        let flowed = &mut state.flowed;
        flowed.copy_from_slice(self.trial.deformation.flowed());
        let flow = self.problem.model.commit_flow(&shared.now.position, flowed);
        state.flow_energy = self.flow_energy + flow;
        state.torque = 0.0;
        state.pin_push.clone_from(&shared.pin_push);
        state.loads.last.force.clear();
        state.frame = shared.now.frame;
        state.frame.acceleration = Vec2::zeros();
        state.frame.spin_rate = 0.0;
        if shared.shape.kind == Frame::Fixed {
            let pairs = shared
                .now
                .position
                .iter()
                .zip(shared.shape.model.placed_positions());
            for (u, (x, rest)) in state.displacement.iter_mut().zip(pairs) {
                *u = x - rest;
            }
        }
        state.split_position(&shared.shape.arms, shared.shape.kind);
        if shared.shape.kind != Frame::Fixed {
            let (centre, inertia) = (shared.now.frame.centre, shared.now.inertia);
            let mass = shared.shape.model.mass();
            state.frame.spin =
                mass.moment(centre, &shared.now.position, &shared.now.velocity) / inertia;
        }
        let (frame, back) = (state.frame, rotation(-state.frame.angle));
        for node in 0..shared.shape.model.n_nodes() {
            // No mean turn of the shape is needed for this, which a folded body may not have.
            let arm = node_vec(&shared.now.position, node) - frame.centre;
            let own =
                node_vec(&shared.now.velocity, node) - frame.velocity - frame.spin * perp(arm);
            set_node_vec(&mut state.rate, node, back * own);
            let mean = (node_vec(&self.resolved, node) - node_vec(&self.start_resolved, node))
                / shared.step.dt;
            set_node_vec(&mut state.acceleration, node, back * mean);
        }
        for &dof in &shared.shape.fixed_dofs {
            state.acceleration[dof] = 0.0;
        }
    }

    /// `2/dt² + α/dt` (1/s²).
    fn momentum_factor(&self, shared: &Shared) -> f64 {
        let Inertia { acceleration, drag } = self.problem.inertia(&shared.step);
        acceleration + drag
    }

    /// Load less inertia force of a node at `x` (N): all that inner forces would have to be.
    fn lacking_force(&self, shared: &Shared, node: usize, x: Vec2) -> Vec2 {
        let Inertia { acceleration, drag } = self.problem.inertia(&shared.step);
        let coast = node_vec(&self.problem.coast, node);
        let start = node_vec(&shared.start.position, node);
        // About where the iterate is, so that no digits are lost far from the origin.
        let mass = shared.shape.arms.node_mass[node];
        node_vec(&self.problem.load, node)
            - mass * (acceleration * (x - coast) + drag * (x - start))
    }

    /// How far the centre of a free body is from where the forces bring it (m).
    pub(super) fn lacking_shift(&self, shared: &Shared) -> Vec2 {
        let nodes = 0..shared.shape.arms.node_mass.len();
        let lacking = nodes
            .map(|node| self.lacking_force(shared, node, node_vec(&shared.now.position, node)));
        lacking.sum::<Vec2>() / (shared.shape.arms.mass * self.momentum_factor(shared))
    }

    /// Shifts and turns a free body so that its centre of mass is where the forces bring it, and its angular momentum what their couple makes
    /// it, beyond the tolerance of the iterations.
    ///
    /// Inner forces have neither a resultant nor, about the middles `(x + x')/2`, a couple. Those of a led body have none about its end, which is where
    /// contacts hold it: about the middles, what presses it with many times its weight would have one by any turn that it has come back from.
    pub(super) fn balance_momentum(&self, shared: &mut Shared) {
        let factor = self.momentum_factor(shared);
        let shift = self.lacking_shift(shared);
        let masses = || shared.shape.arms.node_mass.iter().enumerate();
        let (mut first, mut moment) = (Vec2::zeros(), Vec2::zeros());
        for (node, &mass) in masses() {
            first += mass * (node_vec(&shared.now.position, node) - shared.start.frame.centre);
            moment += mass * (node_vec(&shared.start.position, node) - shared.start.frame.centre);
        }
        let [centre, started] =
            [first, moment].map(|sum| shared.start.frame.centre + sum / shared.shape.arms.mass);
        let is_held = self.problem.takes_end && shared.contact.presses();
        let (mut couple, mut polar) = (0.0, 0.0);
        for (node, &mass) in masses() {
            let x = node_vec(&shared.now.position, node);
            let (arm, before) = (x - centre, node_vec(&shared.start.position, node) - started);
            let middle = if is_held { arm } else { 0.5 * (arm + before) };
            couple += cross(middle, self.lacking_force(shared, node, x + shift));
            polar += mass * factor * middle.dot(&arm);
        }
        // A body that turns by half a circle within the step has no such middles.
        // Half of the digits that the tolerance gives: what is more is no remainder of the iterations.
        let most = TOLERANCE.sqrt();
        let rest = Some(couple / polar).filter(|turn| turn.abs() <= most);
        let turn = rest.unwrap_or(0.0);
        for node in 0..shared.shape.arms.node_mass.len() {
            let arm = node_vec(&shared.now.position, node) - centre;
            add_node_vec(&mut shared.now.position, node, shift + turn * perp(arm));
        }
    }
}

/// Writes the part of velocities that the step resolves, `A⁻¹ M v`: what a body of large strain tells a contact.
///
/// Rigid motion, which of a pinned body is that of its pins, and what turns about a single one, is all in it, of a vibration of frequency ω the share `1/(1 + ω² dt²/4)`. Vibrations that the step does not resolve change the
/// sign of their velocities in every step, and impulses that stopped those by what the whole body answers would throw it away. Impulses
/// `P` that bring `G v` so measured to rest change the kinetic energy by at most `-½ v·GᵀW⁻¹G v`, `W = G A⁻¹ Gᵀ`, as `A⁻¹ M A⁻¹ <= A⁻¹`.
///
/// - `near`: motion of the frame at the beginning of the step.
/// - `motion`: positions (m) and velocities (m/s).
pub(super) fn resolve(
    shape: &Shape,
    near: &FrameMotion,
    answer: &mut Answer,
    [position, velocity]: [&[f64]; 2],
    resolved: &mut [f64],
) {
    resolved.copy_from_slice(velocity);
    let rigid = take_out_rigid(shape, near, position, resolved);
    for (dof, value) in resolved.iter_mut().enumerate() {
        let mass = shape.arms.node_mass[dof / 2];
        *value *= if shape.is_fixed[dof] { 0.0 } else { mass };
    }
    answer.solve(resolved);
    take_out_rigid(shape, near, position, resolved);
    if let Some(rigid) = rigid {
        for node in 0..shape.arms.node_mass.len() {
            add_node_vec(resolved, node, rigid.at(node_vec(position, node)));
        }
    }
    for &dof in &shape.fixed_dofs {
        resolved[dof] = velocity[dof];
    }
}

/// Takes a rigid motion out of nodal velocities: of a free body the one that its masses see, of one that turns about a pin that of the pin with
/// the turn that its masses see, of others the one that their pins give. Returns it, if there is one.
///
/// A stiffness does not know a turn for a rigid motion where there is stress: as its own motion it would count as unresolved by the square of the turn in
/// a step.
fn take_out_rigid(
    shape: &Shape,
    near: &FrameMotion,
    position: &[f64],
    velocity: &mut [f64],
) -> Option<RigidRates> {
    let rigid = match shape.kind {
        Frame::Free | Frame::Hinged(_) => mean_rates(shape, near, position, velocity),
        Frame::Fixed => RigidRates::of_pins(&shape.fixed_dofs, position, |dof| velocity[dof])?,
    };
    for node in 0..shape.arms.node_mass.len() {
        add_node_vec(velocity, node, -rigid.at(node_vec(position, node)));
    }
    Some(rigid)
}

/// The rigid motion that the masses of a body see: of all of a free one, about the pin of one that turns there.
fn mean_rates(shape: &Shape, near: &FrameMotion, position: &[f64], velocity: &[f64]) -> RigidRates {
    let centre = shape.arms.centre(shape.kind, position, near.centre);
    let drift = shape.arms.centre(shape.kind, velocity, Vec2::zeros());
    let (mut moment, mut inertia) = (0.0, 0.0);
    for (node, mass) in shape.arms.node_mass.iter().enumerate() {
        let arm = node_vec(position, node) - centre;
        moment += mass * cross(arm, node_vec(velocity, node) - drift);
        inertia += mass * arm.norm_squared();
    }
    RigidRates {
        about: centre,
        velocity: drift,
        spin: moment / inertia,
    }
}

/// Whether the part of the velocities that is called resolved has more of their kinetic energy than all of it, `v·M A⁻¹ M v > v·M v`: then `A >= M`
/// does not hold. What is compressed and held by others has an indefinite stiffness, and neither damping what is not resolved nor impulses
/// would take energy.
fn is_magnified(shared: &Shared, resolved: &[f64]) -> bool {
    let mass = |dof: usize| shared.shape.arms.node_mass[dof / 2];
    // Relative to the motion of the pins, in which nothing is at work.
    let velocity = |dof: usize| shared.now.velocity[dof];
    let given = match shared.shape.kind {
        Frame::Free => None,
        _ => RigidRates::of_pins(&shared.shape.fixed_dofs, &shared.now.position, velocity),
    };
    let given = |dof: usize| {
        given.map_or(0.0, |rigid| {
            rigid.at(node_vec(&shared.now.position, dof / 2))[dof % 2]
        })
    };
    let own = |other: &[f64]| {
        let products = other.iter().enumerate().map(|(dof, other)| {
            let given = given(dof);
            mass(dof) * (velocity(dof) - given) * (other - given)
        });
        products.sum::<f64>()
    };
    own(resolved) > own(&shared.now.velocity) * (1.0 + ROUNDING)
}
