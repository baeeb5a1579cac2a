//! The end of a step of a body of large strain: velocities, accelerations, ways back to its beginning, and the state to commit.

use super::flex_block::FlexBlock;
use super::large_block::Large;
use super::large_equation::{equation_of, factorize, total_decay};
use super::large_reference::is_near;
use super::pin_rates::RigidRates;
use super::rigid_way::RigidWay;
use crate::body::{FlexState, Frame, Linearized};
use crate::linalg::cholesky::CholeskyError;
use crate::math::{Vec2, add_node_vec, cross, node_vec, perp, rotation, set_node_vec, sum_over};

/// Rounding of a sum of products (-).
const ROUNDING: f64 = 1e-12;

impl FlexBlock {
    /// Factorizes where the step begins, or where it was last done if that is near: contacts ask how the body answers before it has moved.
    pub(super) fn factorize_large(
        &mut self,
        large: &mut Large,
        state: &FlexState,
    ) -> Result<(), CholeskyError> {
        large.is_ambiguous = false;
        let Linearized { position, dt } = &state.linearized;
        let may_serve = *dt == self.step.dt && position.len() == self.position.len();
        if may_serve && self.serves_again(large, position, &state.position)? {
            return Ok(());
        }
        self.factorize_at(large, &state.position)
    }

    /// Takes the factor of the tangent at these positions, if the step begins near enough to them; returns whether it does.
    fn serves_again(
        &mut self,
        large: &mut Large,
        at: &[f64],
        start: &[f64],
    ) -> Result<bool, CholeskyError> {
        let equation = equation_of(
            &large.model,
            &self.step,
            large.led.takes_end,
            [&large.load, &self.start_position, &large.coast],
            &self.is_fixed,
        );
        let key = (&large.model, &equation);
        if large.reference.is_of(key, at, &self.factor) {
            return Ok(is_near(large.reference.gradients(), &large.deformation));
        }
        // A run that was restored.
        large.model.begin(at, &mut large.deformation);
        let gradients = large.deformation.start_gradients().to_vec();
        large.model.begin(start, &mut large.deformation);
        if large.model.flows() || !is_near(&gradients, &large.deformation) {
            return Ok(false);
        }
        large.model.begin(at, &mut large.deformation);
        self.factorize_at(large, at)?;
        large.model.begin(start, &mut large.deformation);
        Ok(!large.is_ambiguous)
    }

    /// Factorizes where the deformation begins, at these positions.
    fn factorize_at(&mut self, large: &mut Large, at: &[f64]) -> Result<(), CholeskyError> {
        let equation = equation_of(
            &large.model,
            &self.step,
            large.led.takes_end,
            [&large.load, &self.start_position, &large.coast],
            &self.is_fixed,
        );
        let scale = self.step.weights.b0;
        let matrices = (&mut large.tangent, &mut self.effective);
        let deformation = &large.deformation;
        self.n_factorizations += 1;
        let found = factorize(&equation, scale, deformation, matrices, &mut self.factor)?;
        large.row_sum = found.row_sum;
        large.is_ambiguous = !found.is_definite;
        let (key, place) = ((&large.model, &equation), (at, deformation));
        large
            .reference
            .note(key, place, &self.factor, found.is_definite);
        self.compliance.clear();
        Ok(())
    }

    /// Writes the velocities and the centre that go with the positions.
    pub(super) fn follow_positions(&mut self) {
        let dt = self.step.dt;
        for (dof, velocity) in self.velocity.iter_mut().enumerate() {
            let moved = (self.position[dof] - self.start_position[dof]) / dt;
            *velocity = match self.is_fixed[dof] {
                true => moved,
                false => 2.0 * moved - self.start_velocity[dof],
            };
        }
        if let Some(large) = &mut self.large {
            large.resolved.copy_from_slice(&self.velocity);
        }
        self.follow_centre();
    }

    /// Writes the part of velocities that the step resolves, `A⁻¹ M v`: what a body of large strain tells a contact.
    ///
    /// Rigid motion, which of a pinned body is that of its pins, is all in it, of a vibration of frequency ω the share `1/(1 + ω² dt²/4)`. Vibrations that the step does not resolve change the
    /// sign of their velocities in every step, and impulses that stopped those by what the whole body answers would throw it away. Impulses
    /// `P` that bring `G v` so measured to rest change the kinetic energy by at most `-½ v·GᵀW⁻¹G v`, `W = G A⁻¹ Gᵀ`, as `A⁻¹ M A⁻¹ <= A⁻¹`.
    pub(super) fn resolve(&mut self, position: &[f64], velocity: &[f64], resolved: &mut [f64]) {
        resolved.copy_from_slice(velocity);
        let rigid = self.take_out_rigid(position, resolved);
        for (dof, value) in resolved.iter_mut().enumerate() {
            let mass = self.arms.node_mass[dof / 2];
            *value *= if self.is_fixed[dof] { 0.0 } else { mass };
        }
        self.factor.solve_in_place(resolved);
        self.n_solves += 1;
        self.take_out_rigid(position, resolved);
        if let Some(rigid) = rigid {
            for node in 0..self.arms.node_mass.len() {
                add_node_vec(resolved, node, rigid.at(node_vec(position, node)));
            }
        }
        for &dof in &self.fixed_dofs {
            resolved[dof] = velocity[dof];
        }
    }

    /// Takes a rigid motion out of nodal velocities: of a free body the one that its masses see, of others the one that their pins give. Returns it, if
    /// there is one.
    fn take_out_rigid(&self, position: &[f64], velocity: &mut [f64]) -> Option<RigidRates> {
        let rigid = match self.kind {
            Frame::Free => self.mean_rates(position, velocity),
            _ => RigidRates::of_pins(&self.fixed_dofs, position, |dof| velocity[dof])?,
        };
        for node in 0..self.arms.node_mass.len() {
            add_node_vec(velocity, node, -rigid.at(node_vec(position, node)));
        }
        Some(rigid)
    }

    /// The rigid motion that the masses of a free body see.
    fn mean_rates(&self, position: &[f64], velocity: &[f64]) -> RigidRates {
        let near = self.start_frame;
        let centre = self.arms.centre(self.kind, position, near.centre);
        let drift = self.arms.centre(self.kind, velocity, Vec2::zeros());
        let (mut moment, mut inertia) = (0.0, 0.0);
        for (node, mass) in self.arms.node_mass.iter().enumerate() {
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

    /// Centre, its velocity and the inertia about it, of the positions and velocities at hand.
    pub(super) fn follow_centre(&mut self) {
        if self.kind == Frame::Fixed {
            return;
        }
        let near = self.start_frame;
        self.frame.centre = self.arms.centre(self.kind, &self.position, near.centre);
        self.frame.velocity = self.arms.centre(self.kind, &self.velocity, near.velocity);
        self.inertia = self.polar_inertia(self.frame.centre);
        let moment = self
            .model
            .mass()
            .moment(self.frame.centre, &self.position, &self.velocity);
        self.frame.spin = moment / self.inertia;
    }

    /// Writes the velocities that the step resolves and their mean acceleration, and damps the others.
    pub(super) fn place_large_acceleration(&mut self) {
        let Some(mut large) = self.large.take() else {
            return;
        };
        self.jump_work = self.take_out_jump();
        self.resolve_end(&mut large.resolved);
        if self.is_magnified(&large.resolved) {
            self.answer_as_at_the_end(&mut large);
            self.resolve_end(&mut large.resolved);
        }
        self.damp_unresolved(&mut large);
        let pairs = large.resolved.iter().zip(&large.start_resolved);
        for (acceleration, (now, before)) in large.acceleration.iter_mut().zip(pairs) {
            *acceleration = (now - before) / self.step.dt;
        }
        self.large = Some(large);
    }

    /// Takes out of the velocities what a jump of the pins has left there; returns the work of the pins in it (J).
    ///
    /// Displacements that are given, `Δx = d`, end with `v' = 2 d/dt - v`: where the pins of a stiff body jump from rest to `ḋ`, it would end
    /// with `2 ḋ`, and swing about `ḋ` from step to step. Velocities that had jumped as well, by what the body answers to that within a step,
    /// would not.
    fn take_out_jump(&mut self) -> f64 {
        if self.kind == Frame::Free {
            return 0.0;
        }
        let jump = |dof: usize| self.velocity[dof] - self.start_velocity[dof];
        let Some(jump) = RigidRates::of_pins(&self.fixed_dofs, &self.position, jump) else {
            return 0.0;
        };
        let before = self.kinetic_energy();
        let position = std::mem::take(&mut self.position);
        let kept = 1.0 + self.model.rayleigh().mass * self.step.weights.b0 / self.step.dt;
        self.answer_jump(&jump, &position, kept);
        self.position = position;
        for dof in 0..self.velocity.len() {
            self.velocity[dof] -= if self.is_fixed[dof] {
                0.0
            } else {
                self.local[dof]
            };
        }
        self.kinetic_energy() - before
    }

    /// The resolved part of the velocities at hand.
    fn resolve_end(&mut self, resolved: &mut [f64]) {
        let [position, velocity] = [&mut self.position, &mut self.velocity].map(std::mem::take);
        self.resolve(&position, &velocity, resolved);
        (self.position, self.velocity) = (position, velocity);
    }

    /// Whether the part of the velocities that is called resolved has more of their kinetic energy than all of it, `v·M A⁻¹ M v > v·M v`: then `A >= M`
    /// does not hold. What is compressed and held by others has an indefinite stiffness, and neither damping what is not resolved nor impulses
    /// would take energy.
    fn is_magnified(&self, resolved: &[f64]) -> bool {
        let mass = |dof: usize| self.arms.node_mass[dof / 2];
        // Relative to the motion of the pins, in which nothing is at work.
        let velocity = |dof: usize| self.velocity[dof];
        let given = match self.kind {
            Frame::Free => None,
            _ => RigidRates::of_pins(&self.fixed_dofs, &self.position, velocity),
        };
        let given = |dof: usize| {
            given.map_or(0.0, |rigid| {
                rigid.at(node_vec(&self.position, dof / 2))[dof % 2]
            })
        };
        let own = |other: &[f64]| {
            let products = other.iter().enumerate().map(|(dof, other)| {
                let given = given(dof);
                mass(dof) * (velocity(dof) - given) * (other - given)
            });
            products.sum::<f64>()
        };
        own(resolved) > own(&self.velocity) * (1.0 + ROUNDING)
    }

    /// Takes the share `min(χ, 1)` of the velocities that the step does not resolve, `(1 - A⁻¹ M)² v`, and of neither momentum.
    ///
    /// Of the two amplifications of a mode that the step does not resolve, the decay `χ` of the stress damps one; the other goes to -1. What
    /// is taken of a mode of frequency ω is `χ (1 - r)²` of its velocity, `r = 1/(1 + ω² dt²/4)`: energy, always, and nothing where `χ` is zero.
    /// What the step resolves loses a share of the fourth order of `ω dt` to it, besides the damping that it is said to have.
    fn damp_unresolved(&mut self, large: &mut Large) {
        let share = total_decay(&self.step, large.model.damping()).min(1.0);
        if share == 0.0 {
            return;
        }
        let [position, mut fast] = [&mut self.position, &mut self.local].map(std::mem::take);
        for (dof, fast) in fast.iter_mut().enumerate() {
            *fast = self.velocity[dof] - large.resolved[dof];
        }
        self.resolve(&position, &fast, &mut large.residual);
        for (dof, velocity) in self.velocity.iter_mut().enumerate() {
            *velocity -= share * (fast[dof] - large.residual[dof]);
        }
        (self.position, self.local) = (position, fast);
    }

    /// Elastic energy that rounding of the positions may make and take (J): nothing for bodies of small strain, whose displacements are known.
    pub fn rounding_energy(&self) -> f64 {
        self.large.as_ref().map_or(0.0, |large| {
            let rounding = f64::EPSILON * self.extent();
            0.5 * self.n_dofs() as f64 * large.row_sum * rounding * rounding
        })
    }

    /// Goes back to where the step began.
    pub(super) fn restart_large(&mut self) {
        self.position.copy_from_slice(&self.start_position);
        self.velocity.copy_from_slice(&self.start_velocity);
        if let Some(large) = &mut self.large {
            large.resolved.copy_from_slice(&large.start_resolved);
            large.led.is_led = false;
        }
        self.jump_work = 0.0;
        self.clear_contact_force();
        self.follow_centre();
    }

    /// Ends the step where it began, moving as a rigid body with this velocity of its centre (m/s) and spin (rad/s).
    pub(super) fn move_large_on(&mut self, velocity: Vec2, spin: f64) {
        self.restart_large();
        let centre = self.frame.centre;
        for node in 0..self.model.n_nodes() {
            let arm = node_vec(&self.position, node) - centre;
            let rigid = velocity + spin * perp(arm);
            for axis in 0..2 {
                let dof = 2 * node + axis;
                self.velocity[dof] = if self.is_fixed[dof] { 0.0 } else { rigid[axis] };
            }
        }
        if let Some(large) = &mut self.large {
            large.acceleration.fill(0.0);
            large.resolved.copy_from_slice(&self.velocity);
        }
        self.follow_centre();
    }

    /// Ends the step as a rigid motion leads it.
    pub(super) fn carry_large_on(&mut self, way: &RigidWay) {
        self.restart_large();
        for node in 0..self.model.n_nodes() {
            let end = way.end(node_vec(&self.position, node));
            set_node_vec(&mut self.position, node, end);
            set_node_vec(&mut self.velocity, node, way.velocity_at(end));
        }
        if let Some(large) = &mut self.large {
            large.acceleration.fill(0.0);
            large.resolved.copy_from_slice(&self.velocity);
        }
        self.follow_centre();
    }

    /// Work of the pins that move, by their mean force over the step and, of what is at the pins, its mean velocity (J).
    pub(super) fn large_pin_work(&self, large: &Large) -> f64 {
        let arrays = [&large.reaction[..], &self.position, &self.start_position];
        let work = sum_over(arrays, |[force, end, start]| force * (end - start));
        let jumps = self.fixed_dofs.iter().map(|&dof| {
            let jump = self.velocity[dof] - self.start_velocity[dof];
            0.5 * self.arms.node_mass[dof / 2] * jump * jump
        });
        work - jumps.sum::<f64>() + self.jump_work
    }

    /// Writes the end of the step over the committed state.
    pub(super) fn commit_large(&self, large: &Large, state: &mut FlexState) {
        state.kinetic_energy = self.kinetic_energy();
        state.elastic_energy = self.end_elastic;
        state.position.copy_from_slice(&self.position);
        state.velocity.copy_from_slice(&self.velocity);
        let dt = self.step.dt;
        large
            .reference
            .tell(&self.factor, dt, &mut state.linearized);
        let flowed = &mut state.flowed;
        state.flow_energy += large.model.commit_flow(&self.position, flowed);
        state.torque = 0.0;
        state.loads.last.force.clear();
        state.frame = self.frame;
        state.frame.acceleration = Vec2::zeros();
        state.frame.spin_rate = 0.0;
        if self.kind == Frame::Fixed {
            let pairs = self.position.iter().zip(self.model.rest_positions());
            for (u, (x, rest)) in state.displacement.iter_mut().zip(pairs) {
                *u = x - rest;
            }
        }
        state.split_position(&self.arms, self.kind);
        if self.kind != Frame::Fixed {
            let (centre, inertia) = (self.frame.centre, self.inertia);
            let mass = self.model.mass();
            state.frame.spin = mass.moment(centre, &self.position, &self.velocity) / inertia;
        }
        let (frame, back) = (state.frame, rotation(-state.frame.angle));
        for node in 0..self.model.n_nodes() {
            // No mean turn of the shape is needed for this, which a folded body may not have.
            let arm = node_vec(&self.position, node) - frame.centre;
            let own = node_vec(&self.velocity, node) - frame.velocity - frame.spin * perp(arm);
            set_node_vec(&mut state.rate, node, back * own);
            let mean = (node_vec(&large.resolved, node) - node_vec(&large.start_resolved, node))
                / self.step.dt;
            set_node_vec(&mut state.acceleration, node, back * mean);
        }
        for &dof in &self.fixed_dofs {
            state.acceleration[dof] = 0.0;
        }
    }
}
