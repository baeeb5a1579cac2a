//! Bodies of large strain: world coordinates, energy–momentum steps, Newton's iteration on a factor that is renewed where it must be.
//!
//! ```text
//! x' = x + dt/2 (v + v'),    M (v' - v)/dt + α M (x' - x)/dt + f_int(x, x') = f + Gᵀp
//! ```
//!
//! with the conserving stress between both ends (see [`finite_strain`](crate::fe::finite_strain)). Multipliers act wholly within their step,
//! see [`Step::with_large`]. The matrix is
//!
//! ```text
//! A = dt²/2 (2/dt² M + α/dt M + ∂f_int/∂x'),    ∂x'/∂p = dt²/2 A⁻¹ Gᵀ,    ∂v'/∂p = 2/dt ∂x'/∂p
//! ```
//!
//! so that positions answer forces as those of other blocks do, `b0 A⁻¹`, and velocities impulses, `A⁻¹`. Vibrations decay as the member's
//! spectral radius says, see [`Beta2::decay`](crate::integrator::Beta2::decay).

use super::compliance::Compliance;
use super::explicit_block::Explicit;
use super::flex_block::FlexBlock;
use super::large_equation::{MOST_GROWTH, equation_of, factorize};
use super::large_led::Led;
use super::large_reference::Reference;
use crate::body::{FlexState, Frame};
use crate::fe::finite_strain::{Deformation, FiniteStrainModel};
use crate::fe::model::Model;
use crate::large::Evaluation;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};
use crate::math::{Mat2, Vec2, add_node_vec, cross, node_vec, perp, rotation, set_node_vec};
use std::sync::Arc;

/// Residual over the largest load or inertia force that ends the iterations (-): momentum is balanced beyond that by a shift of the whole body.
const TOLERANCE: f64 = 1e-8;

/// Turn that the tolerance of the iterations may leave (rad).
const MOST_TURN: f64 = 1e-4;

/// A residual of which an iteration leaves more than this asks for a new factor.
const SLOWEST: f64 = 0.25;

/// An increment is cut to 1/64 before the iterations are given up.
const MOST_CUTS: usize = 6;

/// What is told of an end that was not found: further than any that may count.
pub(super) const NOT_FOUND: f64 = 1e3;

/// Iterations under given contact forces.
const MOST_ITERATIONS: usize = 24;

/// What a block of large strain has beside others.
#[derive(Clone, Debug)]
pub(super) struct Large {
    pub(super) model: Arc<FiniteStrainModel>,
    pub(super) deformation: Deformation,
    pub(super) tangent: BlockMatrix,
    /// `x + dt v` (m).
    pub(super) coast: Vec<f64>,
    /// Mean force over the step, applied and of contacts (N).
    pub(super) load: Vec<f64>,
    pub(super) residual: Vec<f64>,
    /// Mean force that holds the held dofs (N).
    pub(super) reaction: Vec<f64>,
    /// Mean acceleration over the step (m/s²).
    pub(super) acceleration: Vec<f64>,
    /// The part of the velocities that the step resolves, at its beginning and at its end (m/s).
    pub(super) start_resolved: Vec<f64>,
    pub(super) resolved: Vec<f64>,
    pub(super) row_sum: f64,
    /// Whether the tangent is indefinite where the step begins: under the same forces the body may end it in more ways than one.
    pub(super) is_ambiguous: bool,
    /// Whether what is not found without detours need not be found: the step is cut then.
    pub(super) may_give_up: bool,
    pub(super) led: Led,
    pub(super) reference: Reference,
}

impl FlexBlock {
    /// A block of a body of large strain.
    pub fn large(
        model: Arc<Model>,
        large: Arc<FiniteStrainModel>,
        is_fixed: Vec<bool>,
        kind: Frame,
    ) -> Self {
        let tangent = large.new_matrix();
        let factor = BlockCholesky::analyze(&tangent);
        let matrix = (tangent.clone(), factor, Compliance::new(&model));
        let mut block = Self::with_matrix(model, is_fixed, kind, matrix, Explicit::default());
        let zeros = || vec![0.0; large.n_dofs()];
        block.large = Some(Box::new(Large {
            deformation: large.deformation(large.rest_positions()),
            tangent,
            coast: zeros(),
            load: zeros(),
            residual: zeros(),
            reaction: zeros(),
            acceleration: zeros(),
            start_resolved: zeros(),
            resolved: zeros(),
            row_sum: 0.0,
            is_ambiguous: false,
            may_give_up: false,
            led: Led::default(),
            reference: Reference::default(),
            model: large,
        }));
        block
    }

    /// Takes over a body of large strain of the same model, whose inner pressures may have changed; `false` if its matrix couples other nodes.
    pub fn take_large(&mut self, model: Option<&Arc<FiniteStrainModel>>) -> bool {
        match (&mut self.large, model) {
            (Some(large), Some(model)) if Arc::ptr_eq(&large.model, model) => true,
            (Some(large), Some(model)) if large.model.has_layout_of(model) => {
                large.model = Arc::clone(model);
                true
            }
            (None, None) => true,
            _ => false,
        }
    }

    /// Whether the body is one of large strain.
    pub fn is_large(&self) -> bool {
        self.large.is_some()
    }

    /// Whether a body of large strain may end the step in more ways than one under the same forces: the step is too long for it.
    pub fn is_ambiguous(&self) -> bool {
        self.large.as_ref().is_some_and(|large| large.is_ambiguous)
    }

    /// Whether the end of a step under given forces may be told not to be found once it is not found without detours.
    pub fn let_give_up(&mut self, may: bool) {
        if let Some(large) = &mut self.large {
            large.may_give_up = may;
        }
    }

    /// Begins a step at the committed state, which has been taken over; the iterate is where the last step's acceleration leads.
    pub(super) fn predict_large(&mut self, state: &FlexState) -> Result<(), CholeskyError> {
        let dt = self.step.dt;
        self.turn = Mat2::identity();
        self.frame = state.frame;
        self.frame_q = state.frame;
        self.clear_contact_force();
        let Some(large) = &mut self.large else {
            return Ok(());
        };
        large.led.forget();
        large.deformation.begin_with(&state.flowed);
        large.model.begin(&state.position, &mut large.deformation);
        self.end_flow = 0.0;
        for (dof, coast) in large.coast.iter_mut().enumerate() {
            *coast = state.position[dof] + dt * state.velocity[dof];
        }
        self.start_momentum = self.start_spin_momentum();
        let Some(mut large) = self.large.take() else {
            return Ok(());
        };
        let outcome = self.factorize_large(&mut large, state);
        if outcome.is_ok() {
            self.resolve(&state.position, &state.velocity, &mut large.start_resolved);
            self.guess_large(state, &large);
        }
        self.large = Some(large);
        self.follow_positions();
        outcome
    }

    /// Begins the iterations where the velocities that the step resolves lead, with the last step's acceleration: without forces and at small
    /// strains that is where the step ends.
    fn guess_large(&mut self, state: &FlexState, large: &Large) {
        let (dt, turn) = (self.step.dt, rotation(state.frame.angle));
        for node in 0..self.model.n_nodes() {
            let sped = turn * node_vec(&state.acceleration, node);
            let moved = dt * node_vec(&large.start_resolved, node) + 0.5 * dt * dt * sped;
            let start = node_vec(&state.position, node);
            set_node_vec(&mut self.position, node, start + moved);
        }
    }

    fn start_spin_momentum(&self) -> f64 {
        let (centre, velocity) = (self.start_frame.centre, self.start_frame.velocity);
        let masses = self.arms.node_mass.iter().enumerate();
        masses
            .map(|(node, mass)| {
                let arm = node_vec(&self.start_position, node) - centre;
                mass * cross(arm, node_vec(&self.start_velocity, node) - velocity)
            })
            .sum()
    }

    /// Finds the end of the step under the contact forces given; returns how far it is from there, relative to the body's size.
    pub(super) fn solve_large(&mut self) -> f64 {
        let Some(mut large) = self.large.take() else {
            return 0.0;
        };
        let mut left = NOT_FOUND;
        if !large.led.is_led {
            left = self.iterate_large(&mut large);
            large.led.is_led = left > 0.0 && !large.may_give_up && large.led.has_base();
            if large.led.is_led {
                large.led.takes_end = true;
                self.linearize_at_base(&mut large);
            }
        } else {
            self.answer_at_base(&mut large);
        }
        if large.led.is_led {
            left = self.look_ahead(&mut large);
        } else if large.led.has_base() && !large.may_give_up {
            self.look_ahead(&mut large);
        }
        self.ease_pins(&mut large);
        // A Newton step from the base balances the momentum by itself.
        let is_balanced = large.led.is_led && large.led.left.is_finite();
        let is_ended = left.is_finite() || large.led.is_led;
        if self.kind == Frame::Free && is_ended && !is_balanced {
            self.balance_momentum(&large);
        }
        self.large = Some(large);
        self.follow_positions();
        left
    }

    /// Pins move at the mean velocity of their step, and what they hold gets that velocity in it, not twice as much.
    pub(super) fn ease_pins(&self, large: &mut Large) {
        for &dof in &self.fixed_dofs {
            let late = (self.position[dof] - large.coast[dof]) / (self.step.dt * self.step.dt);
            large.reaction[dof] -= self.arms.node_mass[dof / 2] * late;
        }
    }

    fn iterate_large(&mut self, large: &mut Large) -> f64 {
        for &dof in &self.fixed_dofs {
            self.position[dof] = self.model.rest_positions()[dof] + self.prescribed[dof];
        }
        let scale = self.step.weights.b0;
        for (dof, load) in large.load.iter_mut().enumerate() {
            *load = self.force[dof] + self.contact_force[dof];
        }
        let Large {
            model,
            deformation,
            tangent,
            coast,
            load,
            residual,
            reaction,
            row_sum,
            may_give_up,
            led,
            ..
        } = large;
        let not_found = match may_give_up {
            true => f64::INFINITY,
            false => NOT_FOUND,
        };
        let equation = equation_of(
            model,
            &self.step,
            led.takes_end,
            [load, &self.start_position, coast],
            &self.is_fixed,
        );
        let mut last: Option<Evaluation> = None;
        let (mut n_cuts, mut n_iterations, mut n_guesses) = (0, 0, 0);
        // Whether the factor is that of where the last increment began.
        let mut is_fresh = false;
        let mut renews = false;
        loop {
            let outcome = equation.evaluate(&self.position, deformation, residual, reaction);
            // Forces that rounding of the positions makes, which may grow and shrink as they like.
            let rounding = f64::EPSILON * *row_sum * self.extent();
            let bound = last.map_or(f64::INFINITY, |last| MOST_GROWTH * last.norm.max(rounding));
            let accepted = outcome
                .ok()
                .filter(|now| now.norm.is_finite() && now.norm <= bound);
            let Some(now) = accepted else {
                if last.is_none() {
                    // The guess cannot be: nearer to the beginning of the step it can.
                    n_guesses += 1;
                    if n_guesses > 2 * MOST_CUTS {
                        return f64::INFINITY;
                    }
                    let part = if n_guesses == 2 * MOST_CUTS { 0.0 } else { 0.5 };
                    for (dof, x) in self.position.iter_mut().enumerate() {
                        if !self.is_fixed[dof] {
                            let start = self.start_position[dof];
                            *x = start + part * (*x - start);
                        }
                    }
                    continue;
                }
                if !is_fresh {
                    // Taken back whole: another factor leads elsewhere.
                    for (x, increment) in self.position.iter_mut().zip(&self.local) {
                        *x -= *increment;
                    }
                    (last, renews) = (None, true);
                    continue;
                }
                n_cuts += 1;
                // What is left of the increment is taken back at last: no place counts that was not looked at.
                let part = if n_cuts > MOST_CUTS { 1.0 } else { 0.5 };
                for (x, increment) in self.position.iter_mut().zip(&mut self.local) {
                    *increment *= part;
                    *x -= *increment;
                }
                if n_cuts > MOST_CUTS {
                    return not_found;
                }
                continue;
            };
            let is_slow = last.is_some_and(|last| now.norm > SLOWEST * last.norm);
            let has_ended = now.norm <= TOLERANCE * now.scale || is_slow && now.norm <= rounding;
            if n_iterations == MOST_ITERATIONS && !has_ended {
                let moved = self.local.iter().fold(0.0f64, |most, x| most.max(x.abs()));
                return moved / self.size;
            }
            if has_ended {
                return 0.0;
            }
            is_fresh = is_slow || std::mem::take(&mut renews);
            if is_fresh {
                self.n_factorizations += 1;
                let matrices = (&mut *tangent, &mut self.effective);
                let found = factorize(&equation, scale, deformation, matrices, &mut self.factor);
                self.compliance.clear();
                let Ok(found) = found else {
                    // What is asked of the body from here on is answered as where the step began.
                    model.begin(&self.start_position, deformation);
                    let matrices = (&mut *tangent, &mut self.effective);
                    let _ = factorize(&equation, scale, deformation, matrices, &mut self.factor);
                    return not_found;
                };
                *row_sum = found.row_sum;
                if *may_give_up && !found.is_definite {
                    return not_found;
                }
            }
            self.local.copy_from_slice(residual);
            self.factor.solve_in_place(&mut self.local);
            self.n_solves += 1;
            for (x, increment) in self.position.iter_mut().zip(&mut self.local) {
                *increment *= scale;
                *x += *increment;
            }
            last = Some(now);
            n_cuts = 0;
            n_iterations += 1;
        }
    }

    /// `2/dt² + α/dt` (1/s²).
    fn momentum_factor(&self, large: &Large) -> f64 {
        let dt = self.step.dt;
        2.0 / (dt * dt) + large.model.damping().mass / dt
    }

    /// Load less inertia force of a node at `x` (N): all that inner forces would have to be.
    fn lacking_force(&self, large: &Large, node: usize, x: Vec2) -> Vec2 {
        let dt = self.step.dt;
        let (inertia, drag) = (2.0 / (dt * dt), large.model.damping().mass / dt);
        let (coast, start) = (
            node_vec(&large.coast, node),
            node_vec(&self.start_position, node),
        );
        // About where the iterate is, so that no digits are lost far from the origin.
        let mass = self.arms.node_mass[node];
        node_vec(&large.load, node) - mass * (inertia * (x - coast) + drag * (x - start))
    }

    /// How far the centre of a free body is from where the forces bring it (m).
    pub(super) fn lacking_shift(&self, large: &Large) -> Vec2 {
        let nodes = 0..self.arms.node_mass.len();
        let lacking =
            nodes.map(|node| self.lacking_force(large, node, node_vec(&self.position, node)));
        lacking.sum::<Vec2>() / (self.arms.mass * self.momentum_factor(large))
    }

    /// Shifts and turns a free body so that its centre of mass is where the forces bring it, and its angular momentum what their couple makes
    /// it, beyond the tolerance of the iterations.
    ///
    /// Inner forces have neither a resultant nor, about the middles `(x + x')/2`, a couple.
    pub(super) fn balance_momentum(&mut self, large: &Large) {
        let factor = self.momentum_factor(large);
        let shift = self.lacking_shift(large);
        let masses = || self.arms.node_mass.iter().enumerate();
        let (mut first, mut moment) = (Vec2::zeros(), Vec2::zeros());
        for (node, &mass) in masses() {
            first += mass * (node_vec(&self.position, node) - self.start_frame.centre);
            moment += mass * (node_vec(&self.start_position, node) - self.start_frame.centre);
        }
        let [centre, started] =
            [first, moment].map(|sum| self.start_frame.centre + sum / self.arms.mass);
        let (mut couple, mut polar) = (0.0, 0.0);
        for (node, &mass) in masses() {
            let x = node_vec(&self.position, node);
            let (arm, before) = (x - centre, node_vec(&self.start_position, node) - started);
            let middle = 0.5 * (arm + before);
            couple += cross(middle, self.lacking_force(large, node, x + shift));
            polar += mass * factor * middle.dot(&arm);
        }
        // A body that turns by half a circle within the step has no such middles.
        let rest = Some(couple / polar).filter(|turn| turn.abs() <= MOST_TURN);
        let turn = rest.unwrap_or(0.0);
        for node in 0..self.arms.node_mass.len() {
            let arm = node_vec(&self.position, node) - centre;
            add_node_vec(&mut self.position, node, shift + turn * perp(arm));
        }
    }
}
