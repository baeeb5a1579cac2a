//! Bodies of large strain: world coordinates, energy–momentum steps, Newton's iteration on a factor that is renewed where it must be.
//!
//! ```text
//! x' = x + dt/2 (v + v'),    M (v' - v)/dt + α M (x' - x)/dt + f_int(x, x') = f + Gᵀp
//! ```
//!
//! with the conserving stress between both ends (see [`finite_strain`](crate::fe::finite_strain)). Multipliers act wholly within their step,
//! see [`Step::with_large`](crate::system::Step::with_large). The matrix is
//!
//! ```text
//! A = dt²/2 (2/dt² M + α/dt M + ∂f_int/∂x'),    ∂x'/∂p = dt²/2 A⁻¹ Gᵀ,    ∂v'/∂p = 2/dt ∂x'/∂p
//! ```
//!
//! so that positions answer forces as those of other blocks do, `b0 A⁻¹`, and velocities impulses, `A⁻¹`. Vibrations decay as the member's
//! spectral radius says, see [`Beta2::decay`](crate::integrator::Beta2::decay).

mod led;
mod motion;
mod path;
mod pins;
mod problem;
mod reference;
mod trial;

use self::led::Led;
use self::motion::resolve;
use self::problem::Problem;
use self::reference::{Reference, is_near};
use self::trial::Trial;
use super::shared::Shared;
use crate::body::{FlexState, Frame, Linearized};
use crate::fe::finite_strain::{FiniteStrainModel, Linearization};
use crate::large::{Evaluation, MOST_CUTS, SLOWEST, most_growth};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::CholeskyError;
use crate::math::{Mat2, cross, node_vec, rotation, set_node_vec};
use std::sync::Arc;

/// Residual over the largest load or inertia force that ends the iterations (-): momentum is balanced beyond that by a shift of the whole body.
const TOLERANCE: f64 = 1e-8;

/// What is told of an end that was not found: further than any that may count.
const NOT_FOUND: f64 = 1e3;

/// Iterations under given contact forces.
const MOST_ITERATIONS: usize = 24;

/// What a step by energy and momentum needs beside what all blocks have.
#[derive(Clone, Debug)]
pub(super) struct LargeStrain {
    problem: Problem,
    trial: Trial,
    /// Mean acceleration over the step (m/s²).
    pub(super) acceleration: Vec<f64>,
    /// The part of the velocities that the step resolves, at its beginning and at its end (m/s).
    pub(super) start_resolved: Vec<f64>,
    pub(super) resolved: Vec<f64>,
    /// Whether the tangent is indefinite where the step begins: under the same forces the body may end it in more ways than one.
    pub(super) is_ambiguous: bool,
    /// Whether what is not found without detours need not be found: the step is cut then.
    pub(super) may_give_up: bool,
    /// What had been dissipated by flow where the step, or this part of it, begins (J).
    flow_energy: f64,
    led: Led,
    reference: Reference,
}

impl LargeStrain {
    /// A body of a model of large strain, and the pattern of its matrix.
    pub fn new(model: Arc<FiniteStrainModel>) -> (Self, BlockMatrix) {
        let (trial, effective) = Trial::new(&model);
        let zeros = vec![0.0; model.n_dofs()];
        let large = Self {
            problem: Problem::new(model),
            trial,
            acceleration: zeros.clone(),
            start_resolved: zeros.clone(),
            resolved: zeros,
            is_ambiguous: false,
            may_give_up: false,
            flow_energy: 0.0,
            led: Led::default(),
            reference: Reference::default(),
        };
        (large, effective)
    }

    /// The body's model.
    pub fn model(&self) -> &FiniteStrainModel {
        &self.problem.model
    }

    /// Mean force that holds the held dofs (N).
    pub fn reaction(&self) -> &[f64] {
        &self.trial.reaction
    }

    /// Takes over a body of the same model, whose inner pressures may have changed; `false` if its matrix couples other nodes.
    pub fn take_over(&mut self, model: &Arc<FiniteStrainModel>) -> bool {
        if Arc::ptr_eq(&self.problem.model, model) {
            return true;
        }
        let fits = self.problem.model.has_layout_of(model);
        if fits {
            self.problem.model = Arc::clone(model);
        }
        fits
    }

    /// Begins a step at the committed state, which has been taken over; the iterate is where the last step's acceleration leads.
    pub fn predict(&mut self, shared: &mut Shared, state: &FlexState) -> Result<(), CholeskyError> {
        shared.now.turn = Mat2::identity();
        shared.now.frame = state.frame;
        shared.contact.clear();
        self.led.forget();
        self.trial.deformation.begin_with(&state.flowed);
        self.flow_energy = state.flow_energy;
        self.begin_at(&state.position);
        shared.energy.flow = 0.0;
        self.problem.begin(shared.step.dt, state);
        shared.start.momentum = start_spin_momentum(shared);
        let outcome = self.factorize(shared, state);
        if outcome.is_ok() {
            let motion = [&state.position[..], &state.velocity];
            resolve(
                &shared.shape,
                &shared.start.frame,
                &mut shared.answer,
                motion,
                &mut self.start_resolved,
            );
            self.guess(shared, state);
        }
        self.follow_positions(shared);
        outcome
    }

    /// Begins the deformation at these positions (m).
    fn begin_at(&mut self, positions: &[f64]) {
        let deformation = &mut self.trial.deformation;
        self.problem.model.begin(positions, deformation);
    }

    /// Begins the iterations where the velocities that the step resolves lead, with the last step's acceleration: without forces and at small
    /// strains that is where the step ends.
    fn guess(&self, shared: &mut Shared, state: &FlexState) {
        let (dt, turn) = (shared.step.dt, rotation(state.frame.angle));
        for node in 0..shared.shape.model.n_nodes() {
            let sped = turn * node_vec(&state.acceleration, node);
            let moved = dt * node_vec(&self.start_resolved, node) + 0.5 * dt * dt * sped;
            let start = node_vec(&state.position, node);
            set_node_vec(&mut shared.now.position, node, start + moved);
        }
    }

    /// Factorizes where the step begins, or where it was last done if that is near: contacts ask how the body answers before it has moved.
    fn factorize(&mut self, shared: &mut Shared, state: &FlexState) -> Result<(), CholeskyError> {
        self.is_ambiguous = false;
        let Linearized { position, dt } = &state.linearized;
        let may_serve = *dt == shared.step.dt && position.len() == shared.now.position.len();
        if may_serve && self.serves_again(shared, position, &state.position)? {
            return Ok(());
        }
        self.factorize_at(shared, &state.position)
    }

    /// Takes the factor of the tangent at these positions, if the step begins near enough to them; returns whether it does.
    fn serves_again(
        &mut self,
        shared: &mut Shared,
        at: &[f64],
        start: &[f64],
    ) -> Result<bool, CholeskyError> {
        let equation = (self.problem).equation(&shared.step, &shared.start, &shared.shape);
        let key = (&self.problem.model, &equation);
        if self.reference.is_of(key, at, &shared.answer.factor) {
            let gradients = self.reference.gradients();
            return Ok(is_near(gradients, &self.trial.deformation));
        }
        // A run that was restored.
        self.begin_at(at);
        let gradients = self.trial.deformation.start_gradients().to_vec();
        self.begin_at(start);
        if self.problem.model.flows() || !is_near(&gradients, &self.trial.deformation) {
            return Ok(false);
        }
        self.begin_at(at);
        self.factorize_at(shared, at)?;
        self.begin_at(start);
        Ok(!self.is_ambiguous)
    }

    /// Factorizes where the deformation begins, at these positions.
    fn factorize_at(&mut self, shared: &mut Shared, at: &[f64]) -> Result<(), CholeskyError> {
        let equation = (self.problem).equation(&shared.step, &shared.start, &shared.shape);
        let scale = shared.step.weights.b0;
        let asked = (&equation, Linearization::Consistent);
        let found = (self.trial).factorize(asked, scale, &mut shared.answer)?;
        self.is_ambiguous = !found.is_definite;
        let key = (&self.problem.model, &equation);
        let place = (at, &self.trial.deformation);
        let factor = &shared.answer.factor;
        self.reference.note(key, place, factor, found.is_definite);
        Ok(())
    }

    /// Finds the end of the step under the contact forces given; returns how far it is from there, relative to the body's size.
    pub fn solve(&mut self, shared: &mut Shared) -> f64 {
        let mut left = NOT_FOUND;
        if !self.led.is_led {
            left = self.iterate(shared);
            self.led.is_led = left > 0.0 && !self.may_give_up && self.led.has_base();
            if self.led.is_led {
                self.problem.takes_end = true;
                self.linearize_at_base(shared);
            }
        } else {
            self.answer_at_base(shared);
        }
        if self.led.is_led {
            left = self.look_ahead(shared);
        } else if self.led.has_base() && !self.may_give_up {
            self.look_ahead(shared);
        }
        self.ease_pins(shared);
        // A Newton step from the base balances the momentum by itself.
        let is_balanced = self.led.is_led && self.led.left.is_finite();
        let is_ended = left.is_finite() || self.led.is_led;
        if shared.shape.kind == Frame::Free && is_ended && !is_balanced {
            self.balance_momentum(shared);
        }
        self.follow_positions(shared);
        left
    }

    /// Pins move at the mean velocity of their step, and what they hold gets that velocity in it, not twice as much.
    pub(super) fn ease_pins(&mut self, shared: &Shared) {
        for &dof in &shared.shape.fixed_dofs {
            let way = shared.now.position[dof] - self.problem.coast[dof];
            let late = way / (shared.step.dt * shared.step.dt);
            self.trial.reaction[dof] -= shared.shape.arms.node_mass[dof / 2] * late;
        }
    }

    fn iterate(&mut self, shared: &mut Shared) -> f64 {
        shared.place_pins();
        let scale = shared.step.weights.b0;
        self.problem.take_loads(shared);
        let Self { problem, trial, .. } = self;
        let not_found = match self.may_give_up {
            true => f64::INFINITY,
            false => NOT_FOUND,
        };
        let equation = problem.equation(&shared.step, &shared.start, &shared.shape);
        let asked = (&equation, Linearization::Consistent);
        let mut last: Option<Evaluation> = None;
        let (mut n_cuts, mut n_iterations, mut n_guesses) = (0, 0, 0);
        // Whether the factor is that of where the last increment began.
        let mut is_fresh = false;
        let mut renews = false;
        loop {
            let outcome = trial.evaluate(&equation, &shared.now.position);
            // Forces that rounding of the positions makes, which may grow and shrink as they like.
            let rounding = f64::EPSILON * trial.row_sum * shared.extent();
            let bound = last.map_or(f64::INFINITY, |last| {
                most_growth() * last.norm.max(rounding)
            });
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
                    for (dof, x) in shared.now.position.iter_mut().enumerate() {
                        if !shared.shape.is_fixed[dof] {
                            let start = shared.start.position[dof];
                            *x = start + part * (*x - start);
                        }
                    }
                    continue;
                }
                if !is_fresh {
                    // Taken back whole: another factor leads elsewhere.
                    for (x, increment) in shared.now.position.iter_mut().zip(&shared.local) {
                        *x -= *increment;
                    }
                    (last, renews) = (None, true);
                    continue;
                }
                n_cuts += 1;
                // What is left of the increment is taken back at last: no place counts that was not looked at.
                let part = if n_cuts > MOST_CUTS { 1.0 } else { 0.5 };
                for (x, increment) in shared.now.position.iter_mut().zip(&mut shared.local) {
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
                let moved = shared
                    .local
                    .iter()
                    .fold(0.0f64, |most, x| most.max(x.abs()));
                return moved / shared.shape.size;
            }
            if has_ended {
                return 0.0;
            }
            is_fresh = is_slow || std::mem::take(&mut renews);
            if is_fresh {
                let Ok(found) = trial.factorize(asked, scale, &mut shared.answer) else {
                    // What is asked of the body from here on is answered as where the step began.
                    let deformation = &mut trial.deformation;
                    problem.model.begin(&shared.start.position, deformation);
                    let _ = trial.refill(asked, scale, &mut shared.answer);
                    return not_found;
                };
                if self.may_give_up && !found.is_definite {
                    return not_found;
                }
            }
            shared.local.copy_from_slice(&trial.residual);
            shared.answer.solve(&mut shared.local);
            for (x, increment) in shared.now.position.iter_mut().zip(&mut shared.local) {
                *increment *= scale;
                *x += *increment;
            }
            last = Some(now);
            n_cuts = 0;
            n_iterations += 1;
        }
    }
}

fn start_spin_momentum(shared: &Shared) -> f64 {
    let (centre, velocity) = (shared.start.frame.centre, shared.start.frame.velocity);
    let masses = shared.shape.arms.node_mass.iter().enumerate();
    masses
        .map(|(node, mass)| {
            let arm = node_vec(&shared.start.position, node) - centre;
            mass * cross(arm, node_vec(&shared.start.velocity, node) - velocity)
        })
        .sum()
}
