//! A flexible body as a block: `A = b2 M + b1 C + b0 K` in a co-rotating frame, one factor for ever.
//!
//! Beta-2 advances the coordinates of the split `x = c + R(θ)(X + u)`: centre, angle and displacement. Stiff vibrations
//! then turn with the body, where nodal world coordinates would tear them off their axes at every step.

use super::compliance::Compliance;
use super::explicit_block::Explicit;
use super::flex_impulse::Impulses;
use super::flex_path::clearance_of;
use super::flex_surface::FollowingSurface;
use super::large_block::Large;
use super::step::{FlexLoad, Step};
use super::step_loads::StepLoads;
use crate::body::{Arms, FlexState, Frame, FrameMotion};
use crate::fe::model::Model;
use crate::integrator::{Beta2, Weights};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};
use crate::math::{Mat2, Vec2, cross, node_vec, perp, set_node_vec};
use std::sync::Arc;

/// The rebuildable half of a flexible body: factor, compliance and the vectors of one step.
#[derive(Debug)]
pub struct FlexBlock {
    pub(super) model: Arc<Model>,
    pub(super) kind: Frame,
    pub(super) arms: Arms,
    pub(super) is_fixed: Vec<bool>,
    /// The pinned dofs, ascending.
    pub(super) fixed_dofs: Vec<usize>,
    /// The dofs of the massless nodes of a body with stiffness damping, ascending.
    pub(super) following_dofs: Vec<usize>,
    /// What they follow the others by, once factorized.
    pub(super) surface: Option<FollowingSurface>,
    /// Largest coordinate of the reference placement (m).
    pub(super) extent: f64,
    /// Largest side of the reference placement's box (m).
    pub(super) size: f64,
    /// Least distance of the surface from itself at rest (m).
    pub(super) clearance: f64,
    pub(super) effective: BlockMatrix,
    pub(super) factor: BlockCholesky,
    pub(super) factored_for: Option<Weights>,
    pub(super) compliance: Compliance,
    /// The factor of a consistent mass and what it answers, once a joint holds on to a node.
    pub(super) mass_factor: Option<(BlockCholesky, Compliance)>,
    pub(super) n_factorizations: u64,
    pub(super) n_solves: u64,
    pub(super) step: Step,
    /// World positions and velocities at the beginning of the step.
    pub(super) start_position: Vec<f64>,
    pub(super) start_velocity: Vec<f64>,
    pub(super) start_frame: FrameMotion,
    pub(super) start_torque: f64,
    pub(super) start_momentum: f64,
    /// Kinetic and elastic energy at the beginning (J).
    pub(super) loads: StepLoads,
    pub(super) start_energy: [f64; 2],
    /// Elastic energy at the end (J), and what plastic flow has dissipated in the step.
    pub(super) end_elastic: f64,
    pub(super) end_flow: f64,
    /// `ü` at the beginning.
    pub(super) start_acceleration: Vec<f64>,
    /// Applied nodal forces, gravity included (N).
    pub(super) force: Vec<f64>,
    /// Their resultant (N).
    pub(super) force_total: Vec2,
    /// Increment of the centre's acceleration, world axes (m/s²).
    pub(super) shift: Vec2,
    pub(super) prescribed: Vec<f64>,
    /// Work of the pins in the jumps of their motion (J).
    pub(super) jump_work: f64,
    /// Reactions of the pins at the beginning of the step (N).
    pub(super) start_reaction: Vec<f64>,
    /// Gravity and other forces per mass; `None` if forces act on single nodes (m/s²).
    pub(super) uniform: Option<Vec2>,
    /// `u_q`, `u̇_q`.
    pub(super) displacement_q: Vec<f64>,
    pub(super) rate_q: Vec<f64>,
    /// Frame before the increment, and at the iterate.
    pub(super) frame_q: FrameMotion,
    pub(super) frame: FrameMotion,
    /// Rotation matrix of the iterate's frame.
    pub(super) turn: Mat2,
    /// `δ` of the iterate.
    pub(super) increment: Vec<f64>,
    pub(super) contact_force: Vec<f64>,
    pub(super) has_contact_force: bool,
    /// The contact forces of the last solve, and the frame's angle in the last one from the beginning.
    pub(super) solved_force: Vec<f64>,
    pub(super) has_solved_force: bool,
    pub(super) solved_angle: Option<f64>,
    /// Resultant of the contact forces (N).
    pub(super) contact_total: Vec2,
    /// Moment of the contact forces about the centre, by the levers they were given with (N m).
    pub(super) contact_moment: f64,
    /// Impulses for the velocity and for the acceleration.
    pub(super) impulses: [Impulses; 2],
    /// Right-hand sides of both.
    pub(super) columns: Vec<f64>,
    pub(super) local: Vec<f64>,
    pub(super) scratch: Vec<f64>,
    /// `u`, `u̇` of the iterate.
    pub(super) displacement: Vec<f64>,
    pub(super) rate: Vec<f64>,
    pub(super) position: Vec<f64>,
    pub(super) velocity: Vec<f64>,
    pub(super) torque: f64,
    /// `I(u)` of the iterate (kg m²).
    pub(super) inertia: f64,
    pub(super) explicit: Explicit,
    pub(super) large: Option<Box<Large>>,
}

impl FlexBlock {
    /// Analyses the pattern of a model whose dofs in `is_fixed` are pinned.
    pub fn new(model: Arc<Model>, is_fixed: Vec<bool>, kind: Frame) -> Self {
        let effective = model.stiffness().clone();
        let factor = BlockCholesky::analyze(&effective);
        let matrix = (effective, factor, Compliance::new(&model));
        Self::with_matrix(model, is_fixed, kind, matrix, Explicit::default())
    }

    pub(super) fn with_matrix(
        model: Arc<Model>,
        is_fixed: Vec<bool>,
        kind: Frame,
        (effective, factor, compliance): (BlockMatrix, BlockCholesky, Compliance),
        explicit: Explicit,
    ) -> Self {
        let n = model.n_dofs();
        let zeros = || vec![0.0; n];
        let is_damped = model.rayleigh().stiffness > 0.0;
        let extent = model
            .rest_positions()
            .iter()
            .fold(0.0f64, |extent, x| extent.max(x.abs()));
        Self {
            arms: Arms::new(&model, kind),
            kind,
            fixed_dofs: (0..n).filter(|&dof| is_fixed[dof]).collect(),
            following_dofs: (0..n)
                .filter(|&dof| is_damped && model.is_massless(dof / 2))
                .collect(),
            surface: None,
            is_fixed,
            extent,
            size: size_of(model.rest_positions()),
            clearance: clearance_of(&model),
            factor,
            effective,
            factored_for: None,
            compliance,
            mass_factor: None,
            n_factorizations: 0,
            n_solves: 0,
            step: Step::default(),
            start_position: zeros(),
            start_velocity: zeros(),
            start_frame: FrameMotion::default(),
            start_torque: 0.0,
            start_momentum: 0.0,
            loads: StepLoads::default(),
            start_energy: [0.0; 2],
            end_elastic: 0.0,
            end_flow: 0.0,
            start_acceleration: zeros(),
            force: zeros(),
            force_total: Vec2::zeros(),
            shift: Vec2::zeros(),
            prescribed: zeros(),
            jump_work: 0.0,
            start_reaction: zeros(),
            uniform: None,
            displacement_q: zeros(),
            rate_q: zeros(),
            frame_q: FrameMotion::default(),
            frame: FrameMotion::default(),
            turn: Mat2::identity(),
            increment: zeros(),
            contact_force: zeros(),
            has_contact_force: false,
            solved_force: zeros(),
            has_solved_force: false,
            solved_angle: None,
            contact_total: Vec2::zeros(),
            contact_moment: 0.0,
            impulses: [Impulses::new(n), Impulses::new(n)],
            columns: vec![0.0; 2 * n],
            local: zeros(),
            scratch: zeros(),
            displacement: zeros(),
            rate: zeros(),
            position: zeros(),
            velocity: zeros(),
            torque: 0.0,
            inertia: 0.0,
            explicit,
            large: None,
            model,
        }
    }

    /// Size of the coordinates that round-off is relative to (m).
    pub fn extent(&self) -> f64 {
        self.extent.max(self.frame.centre.amax())
    }

    /// Largest side of the body at rest (m).
    pub fn size(&self) -> f64 {
        self.size
    }

    /// What the frame turns about, at the iterate (m).
    pub fn centre(&self) -> Vec2 {
        self.frame.centre
    }

    /// Centre of mass at the beginning of the step, if the body moves freely (m).
    pub fn start_centre(&self) -> Option<Vec2> {
        (self.kind == Frame::Free).then_some(self.start_frame.centre)
    }

    pub(super) fn n_dofs(&self) -> usize {
        self.local.len()
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
        self.take_over(step, state, load);
        if self.is_explicit() {
            return self.predict_explicitly(state);
        }
        if self.is_large() {
            return self.predict_large(state);
        }
        self.factorize(step.weights)?;
        self.take_up_load(&state.loads);
        if self.kind == Frame::Fixed {
            self.take_up_jump();
        }
        self.predict_operators(state);
        Ok(())
    }

    fn take_over(&mut self, step: Step, state: &FlexState, load: &FlexLoad<'_>) {
        self.step = step;
        self.start_position.copy_from_slice(&state.position);
        self.start_velocity.copy_from_slice(&state.velocity);
        self.start_acceleration.copy_from_slice(&state.acceleration);
        self.start_frame = state.frame;
        self.start_torque = state.torque;
        self.torque = state.torque;
        self.start_energy = [state.kinetic_energy, state.elastic_energy];
        for &dof in &self.fixed_dofs {
            self.prescribed[dof] = load.prescribed[dof];
            self.start_reaction[dof] = load.reaction[dof];
        }
        self.loads.begin(load, state.loads.lag);
        for (node, mass) in self.arms.node_mass.iter().enumerate() {
            for axis in 0..2 {
                let dof = 2 * node + axis;
                self.force[dof] = load.force[dof] + mass * load.gravity[axis];
            }
        }
        // Only the balances of a free body ask for these.
        if self.kind == Frame::Free {
            let is_uniform = load.force.iter().all(|force| *force == 0.0);
            self.uniform = is_uniform.then_some(load.gravity);
            self.force_total = sum_of(load.force) + self.arms.mass * load.gravity;
        }
    }

    fn predict_operators(&mut self, state: &FlexState) {
        // In a fixed frame, rates are velocities.
        let start = match self.kind {
            Frame::Fixed => [
                &state.displacement[..],
                &self.start_velocity,
                &self.start_acceleration,
            ],
            _ => [
                &state.displacement[..],
                &state.rate,
                &self.start_acceleration,
            ],
        };
        Beta2::predict(
            self.step.dt,
            start,
            &mut self.displacement_q,
            &mut self.rate_q,
        );
        self.predict_following(state);
        // The iterate starts from where the body is: the operators of unresolved modes are large and cancel in the solve.
        if self.kind != Frame::Fixed {
            self.displacement.copy_from_slice(&state.displacement);
            self.rate.copy_from_slice(&state.rate);
        }
        self.solved_angle = None;
        self.inertia = self.arms.polar;
        self.predict_frame();
        self.clear_contact_force();
        if self.kind != Frame::Fixed {
            self.start_momentum =
                self.angular_momentum_of(&self.start_frame, &state.displacement, &state.rate);
            self.place();
        } else {
            self.position.copy_from_slice(&state.position);
        }
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
        if self.is_explicit() {
            self.start_explicitly(state);
            return Ok(());
        }
        if self.is_large() {
            // Their steps need no acceleration to begin with.
            return Ok(());
        }
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
        state.loads.last.assign(load.force, load.gravity);
        state.loads.base.assign(load.force, load.gravity);
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
}

/// Largest side of the box around nodal positions (m).
fn size_of(dofs: &[f64]) -> f64 {
    let side = |axis: usize| {
        let along = dofs.iter().skip(axis).step_by(2);
        let ends = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(*x), high.max(*x)]
        });
        ends[1] - ends[0]
    };
    side(0).max(side(1))
}

/// Sum of nodal vectors.
fn sum_of(dofs: &[f64]) -> Vec2 {
    dofs.chunks_exact(2).map(|v| Vec2::new(v[0], v[1])).sum()
}
