//! Newton's iteration on the increment of acceleration, with backtracking on the norm of the residual.

use super::dense::{DenseLu, Singular};
use super::difference::Differences;
use super::error::NonLinearError;
use super::force::{InternalForce, TangentSource};
use crate::integrator::{IntegratorError, Weights};

/// When to stop, and how hard to try.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// Residual over the largest force of the step that ends the iterations (-).
    ///
    /// Forces are the norms of load, inertia, internal force and residual of the predictor.
    pub tolerance: f64,
    /// Iterations at most.
    pub max_iterations: usize,
    /// Halvings of one increment at most; 0 for none, which takes every increment whole.
    pub max_cuts: usize,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            max_iterations: 25,
            max_cuts: 12,
        }
    }
}

impl NewtonSettings {
    pub(super) fn check(&self) -> Result<(), IntegratorError> {
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err(IntegratorError::Parameter {
                name: "the tolerance of Newton's iterations",
                value: self.tolerance,
                range: "(0, 1)",
            });
        }
        Ok(())
    }
}

/// What the iterations of one step did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NewtonReport {
    /// Norm of the residual (N): of the predictor, then after every iteration.
    pub residuals: Vec<f64>,
    /// The residual that ended the iterations (N).
    pub limit: f64,
    /// Halvings of increments, over all iterations.
    pub line_search_cuts: usize,
    /// Evaluations of the force, differences included.
    pub n_force_evaluations: usize,
    /// Where the tangents came from.
    pub tangent: TangentSource,
}

impl NewtonReport {
    /// Iterations done, each with one factorization.
    pub fn n_iterations(&self) -> usize {
        self.residuals.len().saturating_sub(1)
    }
}

/// The residual must fall by this part of what a linear one would, at least (Armijo).
const SUFFICIENT_DECREASE: f64 = 1e-4;

/// The equation of one step: `M ẍ' + Q(x', ẋ') = R'` with `x' = q0 + b0 Δ`, `ẋ' = q1 + b1 Δ`, `ẍ' = q2 + Δ`.
pub(super) struct StepEquation<'a, F: ?Sized> {
    pub(super) law: &'a F,
    /// Row-major (kg).
    pub(super) mass: &'a [f64],
    pub(super) load: &'a [f64],
    pub(super) dt: f64,
    pub(super) weights: Weights,
    /// `[q0, q1, q2]`.
    pub(super) operators: [&'a [f64]; 3],
}

/// Motion at one value of the increment, and the forces there.
#[derive(Clone, Debug, Default)]
pub(super) struct Iterate {
    pub(super) position: Vec<f64>,
    pub(super) velocity: Vec<f64>,
    pub(super) acceleration: Vec<f64>,
    force: Vec<f64>,
    residual: Vec<f64>,
    /// Norm of the residual (N).
    norm: f64,
    /// The largest of the norms of load, inertia and internal force (N).
    scale: f64,
}

/// Buffers of the iteration.
#[derive(Clone, Debug, Default)]
pub(super) struct Newton {
    pub(super) current: Iterate,
    trial: Iterate,
    increment: Vec<f64>,
    trial_increment: Vec<f64>,
    direction: Vec<f64>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    matrix: DenseLu,
    differences: Differences,
    pub(super) report: NewtonReport,
}

impl Newton {
    pub(super) fn new(n_dofs: usize) -> Self {
        let zeros = vec![0.0; n_dofs];
        let iterate = Iterate {
            position: zeros.clone(),
            velocity: zeros.clone(),
            acceleration: zeros.clone(),
            force: zeros.clone(),
            residual: zeros.clone(),
            ..Iterate::default()
        };
        Self {
            current: iterate.clone(),
            trial: iterate,
            increment: zeros.clone(),
            trial_increment: zeros.clone(),
            direction: zeros,
            stiffness: vec![0.0; n_dofs * n_dofs],
            damping: vec![0.0; n_dofs * n_dofs],
            matrix: DenseLu::new(n_dofs),
            differences: Differences::new(n_dofs),
            report: NewtonReport::default(),
        }
    }

    /// Iterates from the predictor until the residual is small; the result is in `current`.
    pub(super) fn solve<F: InternalForce + ?Sized>(
        &mut self,
        equation: &StepEquation<'_, F>,
        settings: &NewtonSettings,
    ) -> Result<(), NonLinearError> {
        self.report.residuals.clear();
        self.report.line_search_cuts = 0;
        self.report.n_force_evaluations = 1;
        self.increment.fill(0.0);
        equation.evaluate(&self.increment, &mut self.current);
        self.current.require_finite()?;
        let predictor = self.current.norm;
        self.report.residuals.push(predictor);
        loop {
            let limit = settings.tolerance * self.current.scale.max(predictor);
            self.report.limit = limit;
            if self.current.norm <= limit {
                return Ok(());
            }
            if self.report.n_iterations() == settings.max_iterations {
                return Err(NonLinearError::NotConverged {
                    iterations: self.report.n_iterations(),
                    residual: self.current.norm,
                    limit,
                });
            }
            self.find_direction(equation)?;
            self.search_line(equation, settings)?;
            self.report.residuals.push(self.current.norm);
        }
    }

    /// Solves `(b2 M + b1 C + b0 K) dΔ = r`.
    fn find_direction<F: InternalForce + ?Sized>(
        &mut self,
        equation: &StepEquation<'_, F>,
    ) -> Result<(), NonLinearError> {
        let (x, v) = (&self.current.position, &self.current.velocity);
        let (k, c) = (&mut self.stiffness, &mut self.damping);
        k.fill(0.0);
        c.fill(0.0);
        self.report.tangent = equation.law.tangent(x, v, k, c);
        if self.report.tangent == TangentSource::FiniteDifferences {
            self.report.n_force_evaluations +=
                self.differences
                    .tangent(equation.law, [x, v], equation.dt, [k, c]);
        }
        let Weights { b0, b1 } = equation.weights;
        let matrix = self.matrix.values_mut();
        for (slot, entry) in matrix.iter_mut().enumerate() {
            *entry = equation.mass[slot] + b1 * self.damping[slot] + b0 * self.stiffness[slot];
        }
        require_finite("the tangent", matrix, |slot| slot / self.direction.len())?;
        self.matrix
            .factorize()
            .map_err(
                |Singular { column: dof, pivot }| NonLinearError::SingularTangent { dof, pivot },
            )?;
        self.direction.copy_from_slice(&self.current.residual);
        self.matrix.solve_in_place(&mut self.direction);
        require_finite("the increment", &self.direction, |dof| dof)
    }

    /// Takes the largest of the shares 1, 1/2, 1/4, ... of the increment that lowers the residual.
    fn search_line<F: InternalForce + ?Sized>(
        &mut self,
        equation: &StepEquation<'_, F>,
        settings: &NewtonSettings,
    ) -> Result<(), NonLinearError> {
        let mut share = 1.0;
        for cut in 0..=settings.max_cuts {
            for ((trial, increment), direction) in self
                .trial_increment
                .iter_mut()
                .zip(&self.increment)
                .zip(&self.direction)
            {
                *trial = increment + share * direction;
            }
            equation.evaluate(&self.trial_increment, &mut self.trial);
            self.report.n_force_evaluations += 1;
            // A residual that is not a number fails the comparison and is cut like one that is too large.
            let falls = self.trial.norm <= (1.0 - SUFFICIENT_DECREASE * share) * self.current.norm;
            let is_taken_whole = settings.max_cuts == 0 && self.trial.norm.is_finite();
            if falls || is_taken_whole {
                self.report.line_search_cuts += cut;
                std::mem::swap(&mut self.current, &mut self.trial);
                std::mem::swap(&mut self.increment, &mut self.trial_increment);
                return Ok(());
            }
            share *= 0.5;
        }
        self.trial.require_finite()?;
        Err(NonLinearError::Stalled {
            iteration: self.report.n_iterations() + 1,
            cuts: settings.max_cuts,
            residual: self.current.norm,
            limit: self.report.limit,
        })
    }
}

impl<F: InternalForce + ?Sized> StepEquation<'_, F> {
    /// Motion, forces and residual `r = R - [M ẍ' + Q(x', ẋ')]` at an increment.
    fn evaluate(&self, increment: &[f64], at: &mut Iterate) {
        let Weights { b0, b1 } = self.weights;
        let motions = [&mut at.position, &mut at.velocity, &mut at.acceleration];
        for ((motion, q), b) in motions.into_iter().zip(self.operators).zip([b0, b1, 1.0]) {
            for ((value, q), increment) in motion.iter_mut().zip(q).zip(increment) {
                *value = q + b * increment;
            }
        }
        self.law.force(&at.position, &at.velocity, &mut at.force);
        let n_dofs = increment.len();
        let (mut residual, mut inertia) = (0.0, 0.0);
        for (dof, row) in self.mass.chunks_exact(n_dofs.max(1)).enumerate() {
            let own: f64 = row.iter().zip(&at.acceleration).map(|(m, a)| m * a).sum();
            at.residual[dof] = self.load[dof] - (own + at.force[dof]);
            residual += at.residual[dof] * at.residual[dof];
            inertia += own * own;
        }
        at.norm = residual.sqrt();
        at.scale = inertia.sqrt().max(norm(&at.force)).max(norm(self.load));
    }
}

impl Iterate {
    fn require_finite(&self) -> Result<(), NonLinearError> {
        require_finite("the internal force", &self.force, |dof| dof)?;
        require_finite("the residual", &self.residual, |dof| dof)
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Refuses a list with an entry that is not finite, naming its dof.
pub(super) fn require_finite(
    what: &'static str,
    values: &[f64],
    dof_of: impl Fn(usize) -> usize,
) -> Result<(), NonLinearError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(slot) => Err(NonLinearError::NotFinite {
            what,
            dof: dof_of(slot),
        }),
    }
}
