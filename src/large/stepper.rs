//! One step of a large body, in halves where it is not found.

use super::balance::balance;
use super::equation::{Equation, Inertia};
use super::newton::{Limits, Newton, SLOWEST, Work};
use super::turn::{MeanRotation, turn};
use super::{LargeError, LargeSettings, WorldMotion};
use crate::body::Pin;
use crate::fe::finite_strain::{FiniteStrainModel, Form};
use crate::fe::material::hyperelastic::PlasticState;
use crate::math::{atan2, sin_cos};
use std::sync::Arc;

/// What a step took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepWork {
    /// Iterations, each one force and one solve, over all parts and failed attempts.
    pub n_iterations: usize,
    /// Factorizations.
    pub n_factorizations: usize,
    /// Factorizations of the definite part of a tangent that was not definite.
    pub n_definite: usize,
    /// Increments, or guesses, of which a part was taken.
    pub n_cut_increments: usize,
    /// Steps that were halved.
    pub n_cutbacks: usize,
    /// Parts that ended above the tolerance, where residuals are rounding of the positions: at rest, or in stiff bodies far from the origin.
    pub n_at_rounding: usize,
    /// The largest residual left by the other parts, over the largest force of its part (-).
    pub residual: f64,
    /// What plastic flow has dissipated (J).
    pub flowed: f64,
}

/// Steps one body of large strain; keeps its factor and buffers, so that nothing is allocated after `new`.
///
/// The result depends, within the tolerance, on the steps before: the last one's acceleration begins the iterations.
///
/// ```
/// use foil2d::body::Pin;
/// use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
/// use foil2d::fe::material::hyperelastic::Corotated;
/// use foil2d::fe::mesh::{CellKind, generate::rectangle};
/// use foil2d::large::{LargeSettings, LargeStepper, WorldMotion};
///
/// // A strip clamped at its left end swings down under its weight.
/// let mesh = rectangle([1.0, 0.05], [20, 2], CellKind::Tri6)?;
/// let law = Corotated::plane_strain(1e6, 0.3);
/// let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, 1000.0))?;
/// let mut motion = WorldMotion::at_rest(&model);
/// let weight: Vec<f64> = model.masses().iter().flat_map(|mass| [0.0, -9.81 * mass]).collect();
///
/// let mut stepper = LargeStepper::new(model, LargeSettings::default())?;
/// stepper.pin_where(|[x, _]| x == 0.0, Pin::both());
/// for _ in 0..10 {
///     stepper.step(1.0 / 60.0, &weight, &mut motion)?;
/// }
/// assert!(motion.position[41] < -0.04);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LargeStepper {
    model: Arc<FiniteStrainModel>,
    settings: LargeSettings,
    is_held: Vec<bool>,
    is_free: bool,
    newton: Newton,
    rotation: MeanRotation,
    /// Mean acceleration of the last step (m/s²), and how fast the body turned in it (rad/s): they begin the next.
    acceleration: Vec<f64>,
    spin: f64,
    end: Vec<f64>,
    coast: Vec<f64>,
    /// The motion at the beginning of the step, for the case that it is not found.
    before: WorldMotion,
    /// What the holds have given at held dofs so far (N s).
    reaction_impulse: Vec<f64>,
    n_cutbacks: usize,
    /// What had flowed before the step, and what the step dissipates by that so far (J).
    flowed_before: Vec<PlasticState>,
    flow_energy: f64,
}

impl LargeStepper {
    /// A stepper of a body no dof of which is held.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(
        model: impl Into<Arc<FiniteStrainModel>>,
        settings: LargeSettings,
    ) -> Result<Self, LargeError> {
        settings.check()?;
        let model = model.into();
        let zeros = vec![0.0; model.n_dofs()];
        Ok(Self {
            is_held: vec![false; model.n_dofs()],
            is_free: true,
            newton: Newton::new(&model),
            rotation: MeanRotation::new(&model),
            acceleration: zeros.clone(),
            spin: 0.0,
            end: zeros.clone(),
            coast: zeros.clone(),
            before: WorldMotion::at_rest(&model),
            reaction_impulse: zeros,
            n_cutbacks: 0,
            flowed_before: model.virgin(),
            flow_energy: 0.0,
            settings,
            model,
        })
    }

    /// Holds directions of a node: from now on they move with the velocity that the motion has there.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn pin(&mut self, node: usize, pin: Pin) {
        self.is_held[2 * node] = pin.x;
        self.is_held[2 * node + 1] = pin.y;
        self.is_free = !self.is_held.contains(&true);
        self.forget();
        self.newton.forget_factor();
    }

    /// Holds directions of all nodes whose undeformed position (m) is chosen.
    pub fn pin_where(&mut self, is_chosen: impl Fn([f64; 2]) -> bool, pin: Pin) {
        for node in 0..self.model.n_nodes() {
            let rest = self.model.rest_positions();
            if is_chosen([rest[2 * node], rest[2 * node + 1]]) {
                self.pin(node, pin);
            }
        }
    }

    /// The body.
    pub fn model(&self) -> &FiniteStrainModel {
        &self.model
    }

    /// Mean force over the last step by which held dofs are held (N); zero at others.
    ///
    /// Its work along their way and that of the loads is what the energy rises by, without decay.
    pub fn reaction(&self) -> &[f64] {
        &self.reaction_impulse
    }

    /// What has flowed at the quadrature points, in the order of [`FiniteStrainModel::points_of`]; nothing of laws that do not flow. Beside the
    /// motion it is the state of the body.
    pub fn flowed(&self) -> &[PlasticState] {
        self.newton.deformation.flowed()
    }

    /// Goes on with a body in which this has flowed.
    ///
    /// # Panics
    /// If it is not that of the same body.
    pub fn set_flowed(&mut self, flowed: &[PlasticState]) {
        self.newton.deformation.begin_with(flowed);
        self.forget();
    }

    /// Quadrature points that are turned inside out at the end of the last step.
    pub fn n_inverted(&self) -> usize {
        self.newton.deformation.n_inverted()
    }

    /// Advances a motion by `dt` (s) under nodal loads (N) that are constant over the step.
    ///
    /// # Errors
    /// Who stopped the last attempt; the motion then is as it was. [`LargeError::Length`], [`LargeError::NotFinite`] and
    /// [`LargeError::StepLength`] for what is wrong before the step.
    pub fn step(
        &mut self,
        dt: f64,
        load: &[f64],
        motion: &mut WorldMotion,
    ) -> Result<StepWork, LargeError> {
        self.check(dt, load, motion)?;
        self.before.position.copy_from_slice(&motion.position);
        self.before.velocity.copy_from_slice(&motion.velocity);
        self.newton.work = Work::default();
        self.n_cutbacks = 0;
        self.reaction_impulse.fill(0.0);
        self.flow_energy = 0.0;
        self.flowed_before
            .copy_from_slice(self.newton.deformation.flowed());
        if let Err(error) = self.advance(dt, 0, load, motion) {
            motion.position.copy_from_slice(&self.before.position);
            motion.velocity.copy_from_slice(&self.before.velocity);
            self.newton.deformation.begin_with(&self.flowed_before);
            self.forget();
            return Err(error);
        }
        self.reaction_impulse.iter_mut().for_each(|sum| *sum /= dt);
        self.newton.deformation.accept();
        let work = self.newton.work;
        Ok(StepWork {
            n_iterations: work.n_iterations,
            n_factorizations: work.n_factorizations,
            n_definite: work.n_definite,
            n_cut_increments: work.n_cut_increments,
            n_cutbacks: self.n_cutbacks,
            n_at_rounding: work.n_at_rounding,
            residual: work.residual,
            flowed: self.flow_energy,
        })
    }

    fn check(&self, dt: f64, load: &[f64], motion: &WorldMotion) -> Result<(), LargeError> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(LargeError::StepLength(dt));
        }
        let n_dofs = self.model.n_dofs();
        require_finite("the load", load, n_dofs)?;
        require_finite("the position", &motion.position, n_dofs)?;
        require_finite("the velocity", &motion.velocity, n_dofs)
    }

    /// Forgets what the last step tells about the next.
    fn forget(&mut self) {
        self.acceleration.fill(0.0);
        self.spin = 0.0;
    }

    /// One step, or its two halves, or theirs.
    fn advance(
        &mut self,
        dt: f64,
        depth: usize,
        load: &[f64],
        motion: &mut WorldMotion,
    ) -> Result<(), LargeError> {
        let Err(error) = self.attempt(dt, load, motion) else {
            return Ok(());
        };
        if depth == self.settings.max_cutbacks {
            return Err(error);
        }
        let iterations = self.newton.work.n_iterations;
        if iterations >= self.settings.budget {
            return Err(match error {
                LargeError::NotConverged { node, .. } | LargeError::Diverged { node, .. } => {
                    LargeError::Budget { iterations, node }
                }
                other => other,
            });
        }
        self.n_cutbacks += 1;
        self.forget();
        self.advance(0.5 * dt, depth + 1, load, motion)?;
        self.advance(0.5 * dt, depth + 1, load, motion)
    }

    /// One step as a whole; an error leaves the motion as it was.
    fn attempt(
        &mut self,
        dt: f64,
        load: &[f64],
        motion: &mut WorldMotion,
    ) -> Result<(), LargeError> {
        self.model
            .begin(&motion.position, &mut self.newton.deformation);
        let angle = self.predict(dt, motion);
        let damping = self.model.damping();
        let equation = Equation {
            model: &self.model,
            form: Form::EnergyMomentum {
                decay: self.settings.decay + 2.0 * damping.stiffness / dt,
            },
            inertia: Inertia {
                acceleration: 2.0 / (dt * dt),
                drag: damping.mass / dt,
            },
            load,
            start: &motion.position,
            coast: &self.coast,
            is_held: &self.is_held,
            most_growth: most_growth(),
        };
        let limits = Limits {
            tolerance: self.settings.tolerance,
            max_iterations: self.settings.max_iterations,
            budget: self.settings.budget,
        };
        self.newton.solve(&equation, limits, angle, &mut self.end)?;
        if self.is_free {
            let Inertia { acceleration, drag } = equation.inertia;
            let (rate, residual) = (acceleration + drag, &self.newton.residual);
            let start = &motion.position;
            balance(&self.model, rate, residual, start, &mut self.end);
        }
        self.commit(dt, angle, motion);
        Ok(())
    }

    /// Writes `coast = x + dt v` and the guess `end = coast + dt²/2 Q a` of the end; returns the angle of the body there (rad).
    fn predict(&mut self, dt: f64, motion: &WorldMotion) -> f64 {
        if self.is_free {
            turn(&mut self.acceleration, dt * self.spin);
        }
        let states = motion.position.iter().zip(&motion.velocity);
        for (dof, (x, v)) in states.enumerate() {
            self.coast[dof] = x + dt * v;
            // The acceleration of held dofs is zero.
            self.end[dof] = self.coast[dof] + 0.5 * dt * dt * self.acceleration[dof];
        }
        if self.is_free {
            self.rotation.angle(&self.end)
        } else {
            0.0
        }
    }

    /// Makes the end of the step the motion.
    fn commit(&mut self, dt: f64, angle: f64, motion: &mut WorldMotion) {
        if self.is_free {
            let turned = angle - self.rotation.angle(&motion.position);
            // The short way round.
            let (sin, cos) = sin_cos(turned);
            self.spin = atan2(sin, cos) / dt;
        }
        let flowed = self.newton.deformation.flowed_mut();
        self.flow_energy += self.model.commit_flow(&self.end, flowed);
        let states = motion.position.iter_mut().zip(&mut motion.velocity);
        for (dof, (x, v)) in states.enumerate() {
            self.reaction_impulse[dof] += dt * self.newton.reaction[dof];
            self.acceleration[dof] = 0.0;
            if !self.is_held[dof] {
                // v' - v from the difference to the coast, in which most of x' has cancelled.
                let change = 2.0 / dt * (self.end[dof] - self.coast[dof]);
                self.acceleration[dof] = change / dt;
                *v += change;
            }
            *x = self.end[dof];
        }
    }
}

/// Growth of a residual in one iteration that has left the neighbourhood in which the factor means something, as much as an iteration is to
/// leave of it: fourfold. The growth by the
/// first increment of a body that turns, by the stretch `θ²/2` of straight ways, stays below.
pub(crate) fn most_growth() -> f64 {
    1.0 / SLOWEST.get()
}

pub(super) fn require_finite(
    name: &'static str,
    values: &[f64],
    expected: usize,
) -> Result<(), LargeError> {
    let found = values.len();
    if found != expected {
        return Err(LargeError::Length {
            name,
            found,
            expected,
        });
    }
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(dof) => Err(LargeError::NotFinite {
            name,
            node: dof / 2,
        }),
    }
}
