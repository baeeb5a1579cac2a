//! A flexible body as a block: `A = b2 M + b1 C + b0 K` in a co-rotating frame, one factor for ever.
//!
//! Beta-2 advances the coordinates of the split `x = c + R(θ)(X + u)`: centre, angle and displacement. Stiff vibrations
//! then turn with the body, where nodal world coordinates would tear them off their axes at every step. The increments
//! are one local vector `δ = δ_t + δ_θ J X + δ_u`, for which (C.5) reads, with `C = α M + β K` and `s = b0 + β b1`,
//!
//! ```text
//! A (δ + w) = Rᵀ(f + Gᵀp) - M (a_q + h + α v_q) + (1 + α b1) M w,      w = (u_q + β u̇_q) / s,
//! ```
//!
//! `a_q` the accelerations before the increment, `h` the centripetal and Coriolis terms: the stiffness need never be
//! multiplied. The angle obeys the balance of angular momentum instead of its row, which is exact for finite strains too.

use super::compliance::Compliance;
use crate::body::{Arms, FlexState, Frame, FrameMotion};
use crate::fe::model::Model;
use crate::integrator::{Beta2, Weights};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};
use crate::math::{Mat2, Vec2, add_node_vec, cross, node_vec, perp, rotation, set_node_vec};
use std::sync::Arc;

/// Everything about a step that is the same for all flexible bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Length (s).
    pub dt: f64,
    /// Beta-2 weights.
    pub weights: Weights,
}

/// What a response is added to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Response {
    /// The end velocity.
    Velocity,
    /// The end acceleration.
    Acceleration,
}

/// Applied loads of one step.
#[derive(Clone, Copy, Debug)]
pub struct FlexLoad<'a> {
    /// Nodal forces without gravity, interleaved (N).
    pub force: &'a [f64],
    /// Gravity and other forces per mass (m/s²).
    pub gravity: Vec2,
    /// Displacement of the pinned dofs, interleaved (m).
    pub prescribed: &'a [f64],
}

/// The rebuildable half of a flexible body: factor, compliance and the vectors of one step.
#[derive(Debug)]
pub struct FlexBlock {
    pub(super) model: Arc<Model>,
    pub(super) kind: Frame,
    pub(super) arms: Arms,
    pub(super) is_fixed: Vec<bool>,
    effective: BlockMatrix,
    factor: BlockCholesky,
    factored_for: Option<Weights>,
    compliance: Compliance,
    n_factorizations: u64,
    n_solves: u64,
    pub(super) step: Step,
    /// World positions and velocities at the beginning of the step.
    pub(super) start_position: Vec<f64>,
    pub(super) start_velocity: Vec<f64>,
    pub(super) start_frame: FrameMotion,
    start_torque: f64,
    start_momentum: f64,
    pub(super) start_elastic: f64,
    pub(super) end_elastic: f64,
    /// `u`, `ü` at the beginning.
    pub(super) start_displacement: Vec<f64>,
    pub(super) start_acceleration: Vec<f64>,
    /// Applied nodal forces, gravity included (N).
    pub(super) force: Vec<f64>,
    prescribed: Vec<f64>,
    /// `u_q`, `u̇_q`.
    displacement_q: Vec<f64>,
    rate_q: Vec<f64>,
    /// Frame before the increment, and at the iterate.
    frame_q: FrameMotion,
    pub(super) frame: FrameMotion,
    /// What the balance of angular momentum adds to `δ_θ`.
    pub(super) spin_correction: f64,
    /// The part of it that the iterate's placement holds.
    pub(super) placed_correction: f64,
    /// `δ_θ` of the last free solve.
    free_turn: Option<f64>,
    /// `δ` without contact.
    pub(super) free_increment: Vec<f64>,
    /// `δ` of the iterate.
    pub(super) increment: Vec<f64>,
    pub(super) contact_force: Vec<f64>,
    impulse: Vec<f64>,
    pub(super) local: Vec<f64>,
    scratch: Vec<f64>,
    /// `u`, `u̇` of the iterate.
    pub(super) displacement: Vec<f64>,
    pub(super) rate: Vec<f64>,
    pub(super) position: Vec<f64>,
    pub(super) velocity: Vec<f64>,
    pub(super) torque: f64,
}

impl FlexBlock {
    /// Analyses the pattern of a model whose dofs in `is_fixed` are pinned.
    pub fn new(model: Arc<Model>, is_fixed: Vec<bool>, kind: Frame) -> Self {
        let effective = model.stiffness().clone();
        let n = model.n_dofs();
        let zeros = || vec![0.0; n];
        Self {
            arms: Arms::new(&model, kind),
            kind,
            is_fixed,
            factor: BlockCholesky::analyze(&effective),
            effective,
            factored_for: None,
            compliance: Compliance::new(&model),
            n_factorizations: 0,
            n_solves: 0,
            step: Step {
                dt: 0.0,
                weights: Weights::default(),
            },
            start_position: zeros(),
            start_velocity: zeros(),
            start_frame: FrameMotion::default(),
            start_torque: 0.0,
            start_momentum: 0.0,
            start_elastic: 0.0,
            end_elastic: 0.0,
            start_displacement: zeros(),
            start_acceleration: zeros(),
            force: zeros(),
            prescribed: zeros(),
            displacement_q: zeros(),
            rate_q: zeros(),
            frame_q: FrameMotion::default(),
            frame: FrameMotion::default(),
            spin_correction: 0.0,
            placed_correction: 0.0,
            free_turn: None,
            free_increment: zeros(),
            increment: zeros(),
            contact_force: zeros(),
            impulse: zeros(),
            local: zeros(),
            scratch: zeros(),
            displacement: zeros(),
            rate: zeros(),
            position: zeros(),
            velocity: zeros(),
            torque: 0.0,
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
    /// # Errors
    /// If the effective matrix is not positive definite.
    pub fn predict(
        &mut self,
        step: Step,
        state: &FlexState,
        load: &FlexLoad<'_>,
    ) -> Result<(), CholeskyError> {
        self.factorize(step.weights)?;
        self.step = step;
        self.start_position.copy_from_slice(&state.position);
        self.start_velocity.copy_from_slice(&state.velocity);
        self.start_displacement.copy_from_slice(&state.displacement);
        self.start_acceleration.copy_from_slice(&state.acceleration);
        self.start_frame = state.frame;
        self.start_torque = state.torque;
        self.start_elastic = state.elastic_energy;
        self.prescribed.copy_from_slice(load.prescribed);
        self.force.copy_from_slice(load.force);
        for (force, mass) in self.force.chunks_exact_mut(2).zip(&self.arms.node_mass) {
            force[0] += mass * load.gravity.x;
            force[1] += mass * load.gravity.y;
        }
        let start = [&state.displacement[..], &state.rate, &state.acceleration];
        Beta2::predict(step.dt, start, &mut self.displacement_q, &mut self.rate_q);
        // The iterate starts from where the body is: the operators of unresolved modes are large and cancel in the solve.
        self.displacement.copy_from_slice(&state.displacement);
        self.rate.copy_from_slice(&state.rate);
        self.predict_frame();
        let inertia = self.inertia_of(&state.displacement);
        self.spin_correction =
            (step.dt - step.weights.b1) / step.weights.b1 * state.torque / inertia;
        self.placed_correction = self.spin_correction;
        self.free_turn = None;
        self.increment.fill(0.0);
        self.contact_force.fill(0.0);
        if self.kind != Frame::Fixed {
            self.start_momentum =
                self.angular_momentum_of(&self.start_frame, &state.displacement, &state.rate);
        }
        self.place();
        Ok(())
    }

    /// Writes the accelerations that a new body's loads and spin give it from an unstrained start.
    ///
    /// They solve `A ü = f - C v + centripetal terms` instead of `M ü = ...`: the same to second order in the step for
    /// frequencies the step resolves, and nothing for those it does not, which would ring for ever.
    ///
    /// # Errors
    /// If the effective matrix is not positive definite.
    pub fn start(
        &mut self,
        step: Step,
        state: &mut FlexState,
        load: &FlexLoad<'_>,
    ) -> Result<(), CholeskyError> {
        self.factorize(step.weights)?;
        let rayleigh = self.model.rayleigh();
        for node in 0..self.model.n_nodes() {
            let reference = node_vec(&self.arms.reference, node);
            let rate = node_vec(&state.rate, node);
            let mut inertial = load.gravity - rayleigh.mass * node_vec(&state.velocity, node);
            if self.kind != Frame::Fixed {
                let spin = state.frame.spin;
                inertial += spin * spin * reference - 2.0 * spin * perp(rate);
            }
            set_node_vec(&mut self.scratch, node, inertial);
        }
        self.local.copy_from_slice(load.force);
        self.model
            .stiffness()
            .multiply_add(-rayleigh.stiffness, &state.rate, &mut self.local);
        self.model
            .mass()
            .multiply_add(1.0, &self.scratch, &mut self.local);
        for (value, &is_fixed) in self.local.iter_mut().zip(&self.is_fixed) {
            if is_fixed {
                *value = 0.0;
            }
        }
        self.factor.solve_in_place(&mut self.local);
        let (shift, turn) = self.arms.split(self.kind, &mut self.local);
        state.frame.acceleration = shift;
        state.frame.spin_rate = turn;
        state.acceleration.copy_from_slice(&self.local);
        state.torque = 0.0;
        for (node, mass) in self.arms.node_mass.iter().enumerate() {
            let applied = node_vec(load.force, node) + *mass * load.gravity;
            state.torque += cross(
                node_vec(&state.position, node) - state.frame.centre,
                applied,
            );
        }
        Ok(())
    }

    fn predict_frame(&mut self) {
        let (dt, start) = (self.step.dt, self.start_frame);
        let half = 0.5 * dt * dt;
        let mut frame = FrameMotion {
            centre: start.centre + dt * start.velocity + half * start.acceleration,
            velocity: start.velocity + dt * start.acceleration,
            acceleration: start.acceleration,
            // The spin follows angular momentum and the angle the mean spin: no stored rate can ring.
            angle: start.angle + dt * start.spin,
            spin: start.spin,
            spin_rate: 0.0,
        };
        match self.kind {
            Frame::Fixed => frame = start,
            Frame::Hinged(node) => {
                // The hinge goes where it is told.
                frame.centre = self.arms.origin + node_vec(&self.prescribed, node);
                frame.velocity = (frame.centre - start.centre) / dt;
                frame.acceleration = (frame.velocity - start.velocity) / dt;
            }
            Frame::Free => {}
        }
        self.frame_q = frame;
        self.frame = frame;
    }

    fn factorize(&mut self, weights: Weights) -> Result<(), CholeskyError> {
        if self.factored_for == Some(weights) {
            return Ok(());
        }
        let rayleigh = self.model.rayleigh();
        self.effective.assign_scaled(
            weights.b0 + rayleigh.stiffness * weights.b1,
            self.model.stiffness(),
        );
        self.model
            .mass()
            .add_to(1.0 + rayleigh.mass * weights.b1, &mut self.effective);
        self.effective.constrain(&self.is_fixed);
        self.factored_for = None;
        self.factor.factorize(&self.effective)?;
        self.n_factorizations += 1;
        self.compliance.clear();
        self.factored_for = Some(weights);
        Ok(())
    }

    /// Solves for the increment without contact, in the frame and with the inertial terms of the current iterate.
    pub fn solve_free(&mut self) {
        let rayleigh = self.model.rayleigh();
        let Weights { b0, b1 } = self.step.weights;
        let (s, alpha) = (b0 + rayleigh.stiffness * b1, rayleigh.mass);
        let kept = 1.0 + alpha * b1;
        for dof in 0..self.local.len() {
            let star = (self.displacement_q[dof] + rayleigh.stiffness * self.rate_q[dof]) / s;
            self.free_increment[dof] = -star;
            // Accelerations before the increment, less what the stiffness would give back.
            self.scratch[dof] =
                self.start_acceleration[dof] + alpha * self.rate_q[dof] - kept * star;
        }
        if self.kind == Frame::Fixed {
            self.local.copy_from_slice(&self.force);
        } else {
            self.add_frame_inertia(alpha);
        }
        self.model
            .mass()
            .multiply_add(-1.0, &self.scratch, &mut self.local);
        self.add_prescribed(s);
        self.factor.solve_in_place(&mut self.local);
        self.n_solves += 1;
        for (free, solved) in self.free_increment.iter_mut().zip(&self.local) {
            *free += solved;
        }
        if self.kind != Frame::Fixed {
            // What the balance of angular momentum has added is now partly in the row: count it once.
            let turn = self.arms.turn_of(&self.free_increment);
            if let Some(before) = self.free_turn.replace(turn) {
                self.spin_correction -= turn - before;
            }
        }
    }

    /// Turns the forces into the frame and adds its accelerations, `h` included, to the scratch vector.
    fn add_frame_inertia(&mut self, alpha: f64) {
        let back = rotation(-self.frame.angle);
        let frame = &self.frame;
        let shift = back * (self.frame_q.acceleration + alpha * self.frame_q.velocity);
        let turn = alpha * self.frame_q.spin;
        // α J u, with the mean turn of the iterate, beyond what δ_θ J X holds.
        let swing = frame.spin_rate + alpha * frame.spin;
        let squared = frame.spin * frame.spin;
        for node in 0..self.model.n_nodes() {
            let reference = node_vec(&self.arms.reference, node);
            let u = node_vec(&self.displacement, node);
            let inertial = shift + turn * perp(reference) + swing * perp(u)
                - squared * (reference + u)
                + 2.0 * frame.spin * perp(node_vec(&self.rate, node));
            add_node_vec(&mut self.scratch, node, inertial);
            set_node_vec(&mut self.local, node, back * node_vec(&self.force, node));
        }
    }

    /// Puts the known values of the pinned dofs into the right-hand side.
    fn add_prescribed(&mut self, s: f64) {
        let b0 = self.step.weights.b0;
        for dof in 0..self.local.len() {
            if !self.is_fixed[dof] {
                continue;
            }
            // A hinge is the centre of its frame: its displacement there is zero.
            let target = if self.kind == Frame::Fixed {
                self.prescribed[dof]
            } else {
                0.0
            };
            let increment = (target - self.displacement_q[dof]) / b0;
            let known = increment - self.free_increment[dof];
            self.local[dof] = known;
            if known != 0.0 {
                self.move_to_right_hand_side(dof, s * known);
            }
        }
    }

    /// Subtracts the stiffness column of one pinned dof from the rows of its free neighbours.
    fn move_to_right_hand_side(&mut self, dof: usize, scaled: f64) {
        let stiffness = self.model.stiffness();
        let (node, axis) = (dof / 2, dof % 2);
        for (&neighbour, block) in stiffness
            .neighbours(node)
            .iter()
            .zip(stiffness.row_blocks(node))
        {
            for other in 0..2 {
                let row = 2 * neighbour as usize + other;
                if !self.is_fixed[row] {
                    // The matrix is symmetric: the column of the pinned dof is its row.
                    self.local[row] -= block[2 * axis + other] * scaled;
                }
            }
        }
    }

    /// Clears the contact forces of the iterate.
    pub fn clear_contact_force(&mut self) {
        self.contact_force.fill(0.0);
    }

    /// Adds a contact force at a node (N).
    pub fn add_contact_force(&mut self, node: usize, force: Vec2) {
        add_node_vec(&mut self.contact_force, node, force);
    }

    /// Computes the end of the step from the free solve and the contact forces given.
    ///
    /// Returns how far the frame's angle moved (rad).
    pub fn correct(&mut self, has_contact: bool) -> f64 {
        if has_contact {
            self.respond(false);
            for (sum, free) in self.local.iter_mut().zip(&self.free_increment) {
                *sum += free;
            }
        } else {
            self.local.copy_from_slice(&self.free_increment);
        }
        self.increment.copy_from_slice(&self.local);
        if self.kind == Frame::Fixed {
            self.advance(Vec2::zeros(), 0.0);
            return 0.0;
        }
        let (shift, turn) = self.arms.split(self.kind, &mut self.local);
        let angle = self.frame.angle;
        self.advance(shift, turn + self.spin_correction);
        self.balance_angular_momentum();
        (self.frame.angle - angle).abs()
    }

    /// `A⁻¹ Rᵀ f` for the contact forces, or for the impulses, written over `local`.
    fn respond(&mut self, to_impulse: bool) {
        let source = if to_impulse {
            &self.impulse
        } else {
            &self.contact_force
        };
        if self.kind == Frame::Fixed {
            self.local.copy_from_slice(source);
        } else {
            let back = rotation(-self.frame.angle);
            for node in 0..self.model.n_nodes() {
                set_node_vec(&mut self.local, node, back * node_vec(source, node));
            }
        }
        for (value, &is_fixed) in self.local.iter_mut().zip(&self.is_fixed) {
            if is_fixed {
                *value = 0.0;
            }
        }
        self.factor.solve_in_place(&mut self.local);
        self.n_solves += 1;
    }

    /// Applies the increments; `local` holds `δ_u`.
    fn advance(&mut self, shift: Vec2, turn: f64) {
        let Weights { b0, b1 } = self.step.weights;
        for dof in 0..self.local.len() {
            self.displacement[dof] = self.displacement_q[dof] + b0 * self.local[dof];
            self.rate[dof] = self.rate_q[dof] + b1 * self.local[dof];
        }
        if self.kind != Frame::Fixed {
            let shift = rotation(self.frame.angle) * shift;
            let before = &self.frame_q;
            self.frame.centre = before.centre + b0 * shift;
            self.frame.velocity = before.velocity + b1 * shift;
            self.frame.acceleration = before.acceleration + shift;
            self.frame.angle = before.angle + 0.5 * self.step.dt * b1 * turn;
            self.frame.spin = before.spin + b1 * turn;
            self.frame.spin_rate = b1 * turn / self.step.dt;
        }
        self.place();
    }

    /// World positions and velocities of the iterate.
    fn place(&mut self) {
        if self.kind == Frame::Fixed {
            for ((x, rest), u) in self
                .position
                .iter_mut()
                .zip(self.model.rest_positions())
                .zip(&self.displacement)
            {
                *x = rest + u;
            }
            self.velocity.copy_from_slice(&self.rate);
            return;
        }
        let frame = &self.frame;
        let turn = rotation(frame.angle);
        for node in 0..self.model.n_nodes() {
            let arm = node_vec(&self.arms.reference, node) + node_vec(&self.displacement, node);
            let own = node_vec(&self.rate, node) + frame.spin * perp(arm);
            set_node_vec(&mut self.position, node, frame.centre + turn * arm);
            set_node_vec(&mut self.velocity, node, frame.velocity + turn * own);
        }
    }

    /// `I(u) ω + Σ m u × u̇` (N m s).
    fn angular_momentum_of(&self, frame: &FrameMotion, u: &[f64], rate: &[f64]) -> f64 {
        self.inertia_of(u) * frame.spin + self.model.mass().moment(Vec2::zeros(), u, rate)
    }

    /// `I(u) = Σ m (X + u)²` (kg m²).
    fn inertia_of(&self, u: &[f64]) -> f64 {
        let linear: f64 = self
            .arms
            .mass_moment
            .iter()
            .zip(u)
            .map(|(moment, u)| moment * u)
            .sum();
        self.arms.polar + 2.0 * linear + self.model.mass().inner(u, u)
    }

    /// Corrects the turn so that angular momentum grows by the impulse of the torques.
    fn balance_angular_momentum(&mut self) {
        let mut torque = 0.0;
        for node in 0..self.model.n_nodes() {
            let force = node_vec(&self.force, node) + node_vec(&self.contact_force, node);
            torque += cross(node_vec(&self.position, node) - self.frame.centre, force);
        }
        let momentum = self.angular_momentum_of(&self.frame, &self.displacement, &self.rate);
        torque -= self.model.rayleigh().mass * momentum;
        if let Frame::Hinged(_) = self.kind {
            torque -= self.hinge_inertia();
        }
        self.torque = torque;
        let Weights { b1, .. } = self.step.weights;
        let impulse = (self.step.dt - b1) * self.start_torque + b1 * torque;
        let missing = self.start_momentum + impulse - momentum;
        let damped = 1.0 + self.model.rayleigh().mass * b1;
        let change = missing / (self.inertia_of(&self.displacement) * damped);
        self.spin_correction += change / b1;
        self.placed_correction = self.spin_correction;
        self.frame.spin += change;
        self.frame.angle += 0.5 * self.step.dt * change;
        self.frame.spin_rate += change / self.step.dt;
        self.place();
    }

    /// Torque of the frame's own acceleration when the hinge is moved.
    fn hinge_inertia(&self) -> f64 {
        let acceleration = self.frame.acceleration;
        let masses = self.arms.node_mass.iter().enumerate();
        masses
            .map(|(node, mass)| {
                mass * cross(
                    node_vec(&self.position, node) - self.frame.centre,
                    acceleration,
                )
            })
            .sum()
    }

    /// Whether the frame turns, so that the step is non-linear.
    pub fn is_nonlinear(&self) -> bool {
        self.kind != Frame::Fixed
    }

    /// Makes [`super::Block::compliance`] known from `node`.
    pub fn prepare_compliance(&mut self, node: usize) {
        if self
            .compliance
            .prepare(node, &self.is_fixed, &mut self.factor)
        {
            self.n_solves += 2;
        }
    }

    /// See [`super::Block::compliance`].
    pub fn compliance(&self, at: usize, from: usize) -> Mat2 {
        let local = self.compliance.get(at, from);
        if self.kind == Frame::Fixed {
            return local;
        }
        let turn = rotation(self.frame.angle);
        turn * local * turn.transpose()
    }

    /// Clears the impulses gathered for [`FlexBlock::apply_impulse`].
    pub fn clear_impulse(&mut self) {
        self.impulse.fill(0.0);
    }

    /// Gathers an impulse at a node (N s).
    pub fn gather_impulse(&mut self, node: usize, impulse: Vec2) {
        add_node_vec(&mut self.impulse, node, impulse);
    }

    /// Adds the response to the gathered impulses to the end velocity (N s), or to the end acceleration (N).
    pub fn apply_impulse(&mut self, to: Response) {
        self.respond(true);
        if to == Response::Acceleration {
            self.torque += self.arms.polar * self.arms.turn_of(&self.local);
            for (sum, response) in self.increment.iter_mut().zip(&self.local) {
                *sum += response;
            }
            return;
        }
        let turn = rotation(self.frame.angle);
        for node in 0..self.model.n_nodes() {
            let response = turn * node_vec(&self.local, node);
            add_node_vec(&mut self.velocity, node, response);
        }
        if self.kind != Frame::Fixed {
            self.balance_impulse();
        }
    }

    /// Turns the velocities so that the impulses' moment about the deformed centre is what angular momentum gained.
    fn balance_impulse(&mut self) {
        let centre = self.frame.centre;
        let wanted: f64 = (0..self.model.n_nodes())
            .map(|node| {
                cross(
                    node_vec(&self.position, node) - centre,
                    node_vec(&self.impulse, node),
                )
            })
            .sum();
        let turn = rotation(self.frame.angle);
        for node in 0..self.model.n_nodes() {
            let response = turn * node_vec(&self.local, node);
            set_node_vec(&mut self.scratch, node, response);
        }
        let gained = self
            .model
            .mass()
            .moment(centre, &self.position, &self.scratch);
        let spin = (wanted - gained) / self.inertia_of(&self.displacement);
        for node in 0..self.model.n_nodes() {
            let swing = spin * perp(node_vec(&self.position, node) - centre);
            add_node_vec(&mut self.velocity, node, swing);
        }
    }
}
