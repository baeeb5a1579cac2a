//! A body of small strain that steps implicitly: `A = b2 M + b1 C + b0 K` in a co-rotating frame, one factor for ever.
//!
//! Beta-2 advances the coordinates of the split `x = c + R(θ)(X + u)`: centre, angle and displacement. Stiff vibrations
//! then turn with the body, where nodal world coordinates would tear them off their axes at every step.

mod end;
mod solve;

use super::following::Following;
use super::jumps::{take_up_jump, take_up_load};
use super::shape::Shape;
use super::shared::Shared;
use crate::body::{FlexState, Frame, FrameMotion};
use crate::integrator::{Beta2, Weights};
use crate::linalg::cholesky::CholeskyError;
use crate::math::{
    Vec2, add_node_vec, cross,
    judged::{Judged, NEGLIGIBLE},
    node_vec, perp, rotation, set_node_vec,
};
use crate::system::step::{FlexLoad, Step};

/// Error of a rigid motion that rounding may leave: with more, contact iterations no longer converge.
const MOST_HIDDEN: Judged = NEGLIGIBLE;

/// What a step by Beta-2 needs beside what all blocks have.
#[derive(Debug)]
pub(super) struct SmallStrain {
    following: Following,
    factored_for: Option<Weights>,
    /// `u_q`, `u̇_q`.
    displacement_q: Vec<f64>,
    rate_q: Vec<f64>,
    /// Frame before the increment.
    frame_q: FrameMotion,
    /// `δ` of the iterate.
    increment: Vec<f64>,
    /// Increment of the centre's acceleration, world axes (m/s²).
    shift: Vec2,
    /// Torque of the forces of the iterate about the centre (N m).
    torque: f64,
    /// The contact forces of the last solve, and the frame's angle in the last one from the beginning.
    solved_force: Vec<f64>,
    has_solved_force: bool,
    solved_angle: Option<f64>,
}

impl SmallStrain {
    pub fn new(shape: &Shape) -> Self {
        let zeros = || vec![0.0; shape.n_dofs()];
        Self {
            following: Following::new(shape),
            factored_for: None,
            displacement_q: zeros(),
            rate_q: zeros(),
            frame_q: FrameMotion::default(),
            increment: zeros(),
            shift: Vec2::zeros(),
            torque: 0.0,
            solved_force: zeros(),
            has_solved_force: false,
            solved_angle: None,
        }
    }

    /// Writes the operators of a step that has begun and, if the weights are new, factorizes the effective matrix.
    ///
    /// # Errors
    /// If the effective matrix is not positive definite.
    pub fn predict(&mut self, shared: &mut Shared, state: &FlexState) -> Result<(), CholeskyError> {
        self.torque = state.torque;
        self.factorize(shared, shared.step.weights)?;
        take_up_load(shared, &state.loads);
        if shared.shape.kind == Frame::Fixed {
            take_up_jump(shared);
        }
        self.predict_operators(shared, state);
        Ok(())
    }

    fn predict_operators(&mut self, shared: &mut Shared, state: &FlexState) {
        // In a fixed frame, rates are velocities.
        let start = match shared.shape.kind {
            Frame::Fixed => [
                &state.displacement[..],
                &shared.start.velocity,
                &shared.start.acceleration,
            ],
            _ => [
                &state.displacement[..],
                &state.rate,
                &shared.start.acceleration,
            ],
        };
        Beta2::predict(
            shared.step.dt,
            start,
            &mut self.displacement_q,
            &mut self.rate_q,
        );
        let operators: [&mut [f64]; 2] = [&mut self.displacement_q, &mut self.rate_q];
        self.following.begin(
            &shared.shape,
            &state.displacement,
            shared.step.dt,
            operators,
        );
        // The iterate starts from where the body is: the operators of unresolved modes are large and cancel in the solve.
        if shared.shape.kind != Frame::Fixed {
            shared.now.displacement.copy_from_slice(&state.displacement);
            shared.now.rate.copy_from_slice(&state.rate);
        }
        self.solved_angle = None;
        shared.now.inertia = shared.shape.arms.polar;
        self.predict_frame(shared);
        shared.contact.clear();
        if shared.shape.kind != Frame::Fixed {
            shared.start.momentum = shared.shape.angular_momentum_of(
                &shared.start.frame,
                &state.displacement,
                &state.rate,
            );
            shared.now.place(&shared.shape);
        } else {
            shared.now.position.copy_from_slice(&state.position);
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
        shared: &mut Shared,
        step: Step,
        state: &mut FlexState,
        load: &FlexLoad<'_>,
    ) -> Result<(), CholeskyError> {
        self.factorize(shared, step.weights)?;
        let rayleigh = shared.shape.model.rayleigh();
        for node in 0..shared.shape.model.n_nodes() {
            let reference = node_vec(&shared.shape.arms.reference, node);
            let rate = node_vec(&state.rate, node);
            let mut inertial = load.gravity - rayleigh.mass * node_vec(&state.velocity, node);
            if shared.shape.kind != Frame::Fixed {
                let spin = state.frame.spin;
                inertial += spin * spin * reference - 2.0 * spin * perp(rate);
            }
            set_node_vec(&mut shared.scratch, node, inertial);
        }
        shared.local.copy_from_slice(load.force);
        shared.shape.model.stiffness().multiply_add(
            -rayleigh.stiffness,
            &state.rate,
            &mut shared.local,
        );
        shared
            .shape
            .model
            .mass()
            .multiply_add(1.0, &shared.scratch, &mut shared.local);
        let whole = take_out_common(shared, 1.0 + rayleigh.mass * step.weights.b1);
        shared.shape.clear_fixed(&mut shared.local);
        shared.answer.factor.solve_in_place(&mut shared.local);
        let (shift, turn) = shared
            .shape
            .arms
            .split(shared.shape.kind, &mut shared.local);
        state.frame.acceleration = whole + shift;
        state.frame.spin_rate = turn;
        state.acceleration.copy_from_slice(&shared.local);
        state.torque = 0.0;
        state.loads.last.assign(load.force, load.gravity);
        state.loads.base.assign(load.force, load.gravity);
        for (node, mass) in shared.shape.arms.node_mass.iter().enumerate() {
            let applied = node_vec(load.force, node) + *mass * load.gravity;
            state.torque += cross(
                node_vec(&state.position, node) - state.frame.centre,
                applied,
            );
        }
        Ok(())
    }

    /// Lets the masses of a body whose surface has lost its own feel the springs of the surface in balance, as they will in the steps
    /// to come: `M ü = ... - K̃ u`. What the surface still is from there would else do work in the first of them that nothing gives.
    ///
    /// - `force`: on the nodes, interleaved (N).
    ///
    /// # Errors
    /// If the effective matrix is not positive definite.
    pub fn lose_surface_mass(
        &mut self,
        shared: &mut Shared,
        step: Step,
        state: &mut FlexState,
        force: &[f64],
    ) -> Result<(), CholeskyError> {
        self.factorize(shared, step.weights)?;
        let (shape, damping) = (&shared.shape, shared.shape.model.rayleigh().stiffness);
        for ((sum, u), rate) in shared
            .scratch
            .iter_mut()
            .zip(&state.displacement)
            .zip(&state.rate)
        {
            *sum = u + damping * rate;
        }
        let back = rotation(-state.frame.angle);
        let own = |node: usize| back * node_vec(force, node);
        self.following
            .write_imbalance(shape, &shared.scratch, own, &mut shared.local);
        for node in 0..shape.model.n_nodes() {
            let push = shape.model.stiffness().multiply_node(node, &shared.local);
            let change = shape.inverse_mass(node) * Vec2::from(push);
            add_node_vec(&mut state.acceleration, node, -change);
        }
        shape.spread_accelerations(&mut state.acceleration);
        shape.arms.split(shape.kind, &mut state.acceleration);
        Ok(())
    }

    fn predict_frame(&mut self, shared: &mut Shared) {
        let (dt, start) = (shared.step.dt, shared.start.frame);
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
        match shared.shape.kind {
            Frame::Fixed => frame = start,
            Frame::Hinged(node) => {
                // The hinge goes where it is told.
                frame.centre = shared.shape.arms.origin + node_vec(&shared.loads.prescribed, node);
                frame.velocity = (frame.centre - start.centre) / dt;
                frame.acceleration = (frame.velocity - start.velocity) / dt;
            }
            Frame::Free => {}
        }
        self.frame_q = frame;
        shared.now.frame = frame;
    }

    /// Factorizes the effective matrix, if the weights are new.
    ///
    /// # Errors
    /// If it is not positive definite, or rounding hides the mass in it.
    fn factorize(&mut self, shared: &mut Shared, weights: Weights) -> Result<(), CholeskyError> {
        if self.factored_for == Some(weights) {
            return Ok(());
        }
        let rayleigh = shared.shape.model.rayleigh();
        shared.answer.effective.assign_scaled(
            weights.b0 + rayleigh.stiffness * weights.b1,
            shared.shape.model.stiffness(),
        );
        shared.shape.model.mass().add_to(
            1.0 + rayleigh.mass * weights.b1,
            &mut shared.answer.effective,
        );
        shared.answer.effective.constrain(&shared.shape.is_fixed);
        self.factored_for = None;
        self.following.factorize(&shared.shape)?;
        shared.answer.factor.factorize(&shared.answer.effective)?;
        shared.answer.n_factorizations += 1;
        shared.answer.compliance.clear();
        if shared.shape.kind == Frame::Free {
            check_rigid_motion(shared, 1.0 + rayleigh.mass * weights.b1)?;
        }
        self.factored_for = Some(weights);
        Ok(())
    }
}

/// Takes out of the forces in `local` what gives a free body one acceleration `a`, `κ M a`, and returns that. Found by itself it is exact, where the factor of
/// a stiff body would make vibrations of the rounding of its weight: plates of 2e11 Pa that fall upon each other would press each other on the way.
fn take_out_common(shared: &mut Shared, kept: f64) -> Vec2 {
    if shared.shape.kind != Frame::Free {
        return Vec2::zeros();
    }
    let forces = shared.local.chunks_exact(2);
    let sum: Vec2 = forces.map(|force| Vec2::new(force[0], force[1])).sum();
    let common = sum / (kept * shared.shape.arms.mass);
    for node in 0..shared.shape.model.n_nodes() {
        set_node_vec(&mut shared.scratch, node, common);
    }
    let mass = shared.shape.model.mass();
    mass.multiply_add(-kept, &shared.scratch, &mut shared.local);
    common
}

/// Refuses a matrix in which rounding of the stiffness hides the mass: `A e = (1 + α b1) M e` for every rigid translation `e`.
fn check_rigid_motion(shared: &mut Shared, factor: f64) -> Result<(), CholeskyError> {
    shared.scratch.iter_mut().enumerate().for_each(|(dof, e)| {
        *e = if dof % 2 == 0 { 1.0 } else { -1.0 };
    });
    shared.local.fill(0.0);
    shared
        .shape
        .model
        .mass()
        .multiply_add(factor, &shared.scratch, &mut shared.local);
    shared.answer.factor.solve_in_place(&mut shared.local);
    let pairs = shared.local.iter().zip(&shared.scratch);
    let error = pairs.fold(0.0f64, |error, (found, e)| error.max((found - e).abs()));
    if error <= MOST_HIDDEN {
        Ok(())
    } else {
        Err(CholeskyError::IllConditioned { error })
    }
}

#[cfg(test)]
mod tests;
