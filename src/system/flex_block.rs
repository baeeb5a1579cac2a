//! A flexible body as a block: `A = b2 M + b1 C + b0 K` in a co-rotating frame, one factor for ever.
//!
//! With `C = α M + β K`, `s = b0 + β b1` and the local predictor `u* = Rᵀ(q0 - c) - X + β(u̇ of q1)`, the first row of
//! (C.5) reads `A (Δa + u*/s) = Rᵀ(f - M q2 - α M q1) + (1 + α b1) M u*/s`: the stiffness never has to be multiplied.

use super::compliance::Compliance;
use crate::body::{Arms, FlexState, Frame};
use crate::fe::model::Model;
use crate::integrator::{Beta2, Weights};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};
use crate::math::{Mat2, Vec2, add_node_vec, cross, node_vec, perp, rotation};
use std::sync::Arc;

/// Everything about a step that is the same for all flexible bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Length (s).
    pub dt: f64,
    /// Beta-2 weights.
    pub weights: Weights,
}

/// The rebuildable half of a flexible body: factor, compliance and the vectors of one step.
#[derive(Debug)]
pub struct FlexBlock {
    pub(super) model: Arc<Model>,
    pub(super) frame: Frame,
    pub(super) arms: Arms,
    pub(super) is_fixed: Vec<bool>,
    effective: BlockMatrix,
    factor: BlockCholesky,
    factored_for: Option<Weights>,
    compliance: Compliance,
    n_factorizations: u64,
    pub(super) step: Step,
    pub(super) start: FlexState,
    /// Applied nodal forces, gravity included (N).
    pub(super) force: Vec<f64>,
    /// Prescribed displacement of the fixed dofs from the reference (m).
    pub(super) prescribed: Vec<f64>,
    pub(super) q0: Vec<f64>,
    pub(super) q1: Vec<f64>,
    /// Angle the local system is turned by, and the frame torque per inertia (rad/s²).
    pub(super) angle: f64,
    pub(super) frame_spin_rate: f64,
    inertia: f64,
    /// `-u*/s` plus the free solve, local.
    pub(super) free_increment: Vec<f64>,
    /// Increment of acceleration, global.
    pub(super) increment: Vec<f64>,
    pub(super) contact_force: Vec<f64>,
    pub(super) impulse: Vec<f64>,
    pub(super) local: Vec<f64>,
    pub(super) position: Vec<f64>,
    pub(super) velocity: Vec<f64>,
    n_solves: u64,
}

impl FlexBlock {
    /// Analyses the pattern of a model whose dofs in `is_fixed` are pinned.
    pub fn new(model: Arc<Model>, is_fixed: Vec<bool>, frame: Frame) -> Self {
        let arms = Arms::new(&model, frame);
        let n = model.n_dofs();
        let effective = model.stiffness().clone();
        let factor = BlockCholesky::analyze(&effective);
        let zeros = || vec![0.0; n];
        Self {
            compliance: Compliance::new(&model),
            arms,
            frame,
            is_fixed,
            effective,
            factor,
            factored_for: None,
            n_factorizations: 0,
            step: Step { dt: 0.0, weights: Weights::default() },
            start: FlexState { position: zeros(), velocity: zeros(), acceleration: zeros(), angle: 0.0 },
            force: zeros(),
            prescribed: zeros(),
            q0: zeros(),
            q1: zeros(),
            angle: 0.0,
            frame_spin_rate: 0.0,
            inertia: 1.0,
            free_increment: zeros(),
            increment: zeros(),
            contact_force: zeros(),
            impulse: zeros(),
            local: zeros(),
            position: zeros(),
            velocity: zeros(),
            n_solves: 0,
            model,
        }
    }

    /// The model the block was built for.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// Numeric factorizations so far.
    pub fn n_factorizations(&self) -> u64 {
        self.n_factorizations
    }

    /// Back-substitutions so far.
    pub fn n_solves(&self) -> u64 {
        self.n_solves
    }

    /// Begins a step: takes over the committed state and the loads, writes the operators and, if the weights are new,
    /// factorizes the effective matrix.
    ///
    /// - `force`: nodal forces without gravity (N), `gravity` (m/s²), `prescribed`: displacement of the pinned dofs (m).
    ///
    /// # Errors
    /// If the effective matrix is not positive definite.
    pub fn predict(
        &mut self,
        step: Step,
        state: &FlexState,
        force: &[f64],
        gravity: Vec2,
        prescribed: &[f64],
    ) -> Result<(), CholeskyError> {
        self.factorize(step.weights)?;
        self.step = step;
        self.start.position.copy_from_slice(&state.position);
        self.start.velocity.copy_from_slice(&state.velocity);
        self.start.acceleration.copy_from_slice(&state.acceleration);
        self.start.angle = state.angle;
        self.prescribed.copy_from_slice(prescribed);
        self.force.copy_from_slice(force);
        for (force, mass) in self.force.chunks_exact_mut(2).zip(&self.arms.node_mass) {
            force[0] += mass * gravity.x;
            force[1] += mass * gravity.y;
        }
        let start = [&state.position[..], &state.velocity, &state.acceleration];
        Beta2::predict(step.dt, start, &mut self.q0, &mut self.q1);
        self.position.copy_from_slice(&self.q0);
        self.velocity.copy_from_slice(&self.q1);
        self.frame_spin_rate = 0.0;
        self.angle = state.angle;
        if self.frame != Frame::Fixed {
            let centre = self.arms.centre(self.frame, &self.q0);
            (self.angle, self.inertia) = self.arms.angle(&self.q0, centre, state.angle);
        }
        Ok(())
    }

    /// Writes the acceleration that a new body's loads give it, `M a = f - C v` from an unstrained start.
    ///
    /// A consistent mass is lumped for this: the difference is a vibration of the order of the load's variation.
    pub fn start_acceleration(&mut self, state: &mut FlexState, force: &[f64], gravity: Vec2) {
        let rayleigh = self.model.rayleigh();
        self.local.copy_from_slice(force);
        self.model.stiffness().multiply_add(-rayleigh.stiffness, &state.velocity, &mut self.local);
        for (node, &mass) in self.arms.node_mass.iter().enumerate() {
            let mut acceleration = Vec2::zeros();
            if mass > 0.0 {
                acceleration = gravity + node_vec(&self.local, node) / mass
                    - rayleigh.mass * node_vec(&state.velocity, node);
            }
            for axis in 0..2 {
                let is_free = !self.is_fixed[2 * node + axis];
                state.acceleration[2 * node + axis] = if is_free { acceleration[axis] } else { 0.0 };
            }
        }
        spread_accelerations(&self.model, &self.is_fixed, &mut state.acceleration);
    }

    fn factorize(&mut self, weights: Weights) -> Result<(), CholeskyError> {
        if self.factored_for == Some(weights) {
            return Ok(());
        }
        let rayleigh = self.model.rayleigh();
        self.effective
            .assign_scaled(weights.b0 + rayleigh.stiffness * weights.b1, self.model.stiffness());
        self.model.mass().add_to(1.0 + rayleigh.mass * weights.b1, &mut self.effective);
        self.effective.constrain(&self.is_fixed);
        self.factored_for = None;
        self.factor.factorize(&self.effective)?;
        self.n_factorizations += 1;
        self.compliance.clear();
        self.factored_for = Some(weights);
        Ok(())
    }

    /// Solves for the motion without contact in the frame of the current angle.
    pub fn solve_free(&mut self) {
        let rayleigh = self.model.rayleigh();
        let Weights { b0, b1 } = self.step.weights;
        let s = b0 + rayleigh.stiffness * b1;
        let turn = rotation(-self.angle);
        let centre = self.arms.centre(self.frame, &self.q0);
        let drift = self.arms.centre(self.frame, &self.q1);
        let spin = self.spin_of_iterate(rayleigh.stiffness);
        for node in 0..self.model.n_nodes() {
            let reference = node_vec(&self.arms.reference, node);
            let mut star = turn * (node_vec(&self.q0, node) - centre) - reference;
            if rayleigh.stiffness > 0.0 {
                let strained = turn * (node_vec(&self.position, node) - centre) - reference;
                let rate = turn * (node_vec(&self.q1, node) - drift) - spin * perp(strained);
                star += rayleigh.stiffness * rate;
            }
            star /= s;
            self.free_increment[2 * node] = -star.x;
            self.free_increment[2 * node + 1] = -star.y;
        }
        self.load_right_hand_side(turn, rayleigh.mass, b1);
        self.add_prescribed(turn, s);
        self.factor.solve_in_place(&mut self.local);
        self.n_solves += 1;
        for (free, y) in self.free_increment.iter_mut().zip(&self.local) {
            *free += y;
        }
    }

    /// `Rᵀ(f - M q2 - α M q1) + (1 + α b1) M u*/s`, written over `local`.
    fn load_right_hand_side(&mut self, turn: Mat2, alpha: f64, b1: f64) {
        for node in 0..self.model.n_nodes() {
            let inertial = turn
                * (node_vec(&self.start.acceleration, node) + alpha * node_vec(&self.q1, node))
                + (1.0 + alpha * b1) * node_vec(&self.free_increment, node);
            self.increment[2 * node] = inertial.x;
            self.increment[2 * node + 1] = inertial.y;
            let applied = turn * node_vec(&self.force, node);
            self.local[2 * node] = applied.x;
            self.local[2 * node + 1] = applied.y;
        }
        self.model.mass().multiply_add(-1.0, &self.increment, &mut self.local);
    }

    /// Puts the known values of the pinned dofs into the right-hand side.
    fn add_prescribed(&mut self, turn: Mat2, s: f64) {
        let b0 = self.step.weights.b0;
        for node in 0..self.model.n_nodes() {
            if !(self.is_fixed[2 * node] || self.is_fixed[2 * node + 1]) {
                continue;
            }
            let target = node_vec(self.model.rest_positions(), node) + node_vec(&self.prescribed, node);
            let increment = turn * (target - node_vec(&self.q0, node)) / b0;
            let known = increment - node_vec(&self.free_increment, node);
            for axis in 0..2 {
                let dof = 2 * node + axis;
                if self.is_fixed[dof] {
                    self.local[dof] = known[axis];
                    if known[axis] != 0.0 {
                        self.move_to_right_hand_side(node, axis, s * known[axis]);
                    }
                }
            }
        }
    }

    /// Subtracts the stiffness column of one pinned dof from the rows of its free neighbours.
    fn move_to_right_hand_side(&mut self, node: usize, axis: usize, scaled: f64) {
        let stiffness = self.model.stiffness();
        for (&neighbour, block) in stiffness.neighbours(node).iter().zip(stiffness.row_blocks(node)) {
            for other in 0..2 {
                let dof = 2 * neighbour as usize + other;
                if !self.is_fixed[dof] {
                    // The matrix is symmetric: the column of the pinned dof is its row.
                    self.local[dof] -= block[2 * axis + other] * scaled;
                }
            }
        }
    }

    /// Angular velocity of the iterate, needed only where the damping must not feel a rigid spin.
    fn spin_of_iterate(&self, stiffness_damping: f64) -> f64 {
        if stiffness_damping == 0.0 || self.frame == Frame::Fixed {
            return 0.0;
        }
        let centre = self.arms.centre(self.frame, &self.position);
        let drift = self.arms.centre(self.frame, &self.velocity);
        let (mut momentum, mut inertia) = (0.0, 0.0);
        for (node, mass) in self.arms.node_mass.iter().enumerate() {
            let arm = node_vec(&self.position, node) - centre;
            momentum += mass * cross(arm, node_vec(&self.velocity, node) - drift);
            inertia += mass * arm.norm_squared();
        }
        momentum / inertia
    }

    /// Clears the contact forces of the iterate.
    pub fn clear_contact_force(&mut self) {
        self.contact_force.fill(0.0);
    }

    /// Adds a contact force at a node (N).
    pub fn add_contact_force(&mut self, node: usize, force: Vec2) {
        add_node_vec(&mut self.contact_force, node, force);
    }

    /// Contact forces of the iterate, interleaved (N).
    pub fn contact_force(&self) -> &[f64] {
        &self.contact_force
    }

    /// Computes the end of the step for the free solve and the contact forces given, and the angle it turns to.
    ///
    /// Returns how far the new angle is from the one solved with (rad), weighted by nothing: the residual of the frame.
    pub fn correct(&mut self, has_contact: bool) -> f64 {
        let turn = rotation(self.angle);
        if has_contact {
            self.respond_to_contact_force();
            for (sum, free) in self.local.iter_mut().zip(&self.free_increment) {
                *sum += free;
            }
        } else {
            self.local.copy_from_slice(&self.free_increment);
        }
        let spin_rate = self.frame_spin_rate;
        for node in 0..self.model.n_nodes() {
            let swing = spin_rate * perp(node_vec(&self.arms.reference, node));
            let increment = turn * (node_vec(&self.local, node) + swing);
            self.increment[2 * node] = increment.x;
            self.increment[2 * node + 1] = increment.y;
        }
        self.advance();
        self.update_frame()
    }

    /// `A⁻¹ Rᵀ f_contact`, written over `local`.
    fn respond_to_contact_force(&mut self) {
        let back = rotation(-self.angle);
        for (dofs, force) in self.local.chunks_exact_mut(2).zip(self.contact_force.chunks_exact(2)) {
            let force = back * Vec2::new(force[0], force[1]);
            dofs[0] = force.x;
            dofs[1] = force.y;
        }
        for (value, &is_fixed) in self.local.iter_mut().zip(&self.is_fixed) {
            if is_fixed {
                *value = 0.0;
            }
        }
        self.factor.solve_in_place(&mut self.local);
        self.n_solves += 1;
    }

    fn advance(&mut self) {
        let Weights { b0, b1 } = self.step.weights;
        for dof in 0..self.q0.len() {
            self.position[dof] = self.q0[dof] + b0 * self.increment[dof];
            self.velocity[dof] = self.q1[dof] + b1 * self.increment[dof];
        }
    }

    /// Torque that balances the internal forces and the angle of the new positions.
    fn update_frame(&mut self) -> f64 {
        if self.frame == Frame::Fixed {
            return 0.0;
        }
        let centre = self.arms.centre(self.frame, &self.position);
        let alpha = self.model.rayleigh().mass;
        // Torque of f + Gᵀλ - M (a' + α v') must vanish about the centre; `local` is free scratch here.
        for node in 0..self.model.n_nodes() {
            let inertial = node_vec(&self.start.acceleration, node)
                + node_vec(&self.increment, node)
                + alpha * node_vec(&self.velocity, node);
            self.local[2 * node] = inertial.x;
            self.local[2 * node + 1] = inertial.y;
        }
        let mut torque = 0.0;
        let inertial_torque = self.model.mass().moment(centre, &self.position, &self.local);
        for node in 0..self.model.n_nodes() {
            let force = node_vec(&self.force, node) + node_vec(&self.contact_force, node);
            torque += cross(node_vec(&self.position, node) - centre, force);
        }
        torque -= inertial_torque;
        let (angle, inertia) = self.arms.angle(&self.position, centre, self.angle);
        self.inertia = inertia;
        self.frame_spin_rate +=
            torque / (inertia * (1.0 + alpha * self.step.weights.b1));
        let change = angle - self.angle;
        self.angle = angle;
        change.abs()
    }

    /// Whether the frame turns, so that the step is non-linear.
    pub fn is_nonlinear(&self) -> bool {
        self.frame != Frame::Fixed
    }

    /// Makes [`super::Block::compliance`] known from `node`.
    pub fn prepare_compliance(&mut self, node: usize) {
        if self.compliance.prepare(node, &self.is_fixed, &mut self.factor) {
            self.n_solves += 2;
        }
    }

    /// See [`super::Block::compliance`].
    pub fn compliance(&self, at: usize, from: usize) -> Mat2 {
        let local = self.compliance.get(at, from);
        if self.frame == Frame::Fixed {
            return local;
        }
        let turn = rotation(self.angle);
        turn * local * turn.transpose()
    }

    /// Adds the response to the nodal impulses given since [`FlexBlock::clear_impulse`] to the end velocity (N s), or
    /// to the end acceleration (N).
    pub fn apply_impulse(&mut self, to: Response) {
        std::mem::swap(&mut self.contact_force, &mut self.impulse);
        self.respond_to_contact_force();
        std::mem::swap(&mut self.contact_force, &mut self.impulse);
        let turn = rotation(self.angle);
        let target = match to {
            Response::Velocity => &mut self.velocity,
            Response::Acceleration => &mut self.increment,
        };
        for (target, local) in target.chunks_exact_mut(2).zip(self.local.chunks_exact(2)) {
            let response = turn * Vec2::new(local[0], local[1]);
            target[0] += response.x;
            target[1] += response.y;
        }
    }
}

/// What a response is added to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Response {
    /// The end velocity.
    Velocity,
    /// The end acceleration.
    Acceleration,
}

/// Gives massless nodes the mean acceleration of the nodes that carry their mass: their own is a remainder without
/// inertia that the trapezoidal rule would amplify.
pub(super) fn spread_accelerations(model: &Model, is_fixed: &[bool], acceleration: &mut [f64]) {
    for (node, support) in model.massless_support() {
        if support.is_empty() {
            continue;
        }
        let sum: Vec2 = support.iter().map(|&massive| node_vec(acceleration, massive)).sum();
        for axis in 0..2 {
            if !is_fixed[2 * node + axis] {
                acceleration[2 * node + axis] = sum[axis] / support.len() as f64;
            }
        }
    }
}
