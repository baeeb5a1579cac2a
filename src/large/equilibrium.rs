//! Equilibrium under loads that grow from nothing to their whole, in smaller increments where it is not found.

use super::equation::{Equation, Inertia};
use super::increments::Increments;
use super::newton::{Limits, Newton, Work};
use super::stepper::require_finite;
use super::{LargeError, LargeSettings};
use crate::fe::finite_strain::{FiniteStrainModel, Form};
use crate::fe::material::hyperelastic::PlasticState;
use crate::math::judged::Judged;
use std::sync::Arc;

/// From where to where loads and held dofs go.
#[derive(Clone, Copy, Debug)]
pub struct LoadCase<'a> {
    /// Nodal loads at the beginning (N); those under which the body is in equilibrium.
    pub from: &'a [f64],
    /// Nodal loads at the end (N).
    pub to: &'a [f64],
    /// Which dofs are held.
    pub is_held: &'a [bool],
    /// Where held dofs are at the end (m); other entries are not read.
    pub places: &'a [f64],
    /// Increments to begin with.
    pub n_increments: usize,
}

/// What an equilibrium took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadReport {
    /// Increments of the load that were solved.
    pub n_increments: usize,
    /// Increments that were halved.
    pub n_cutbacks: usize,
    /// Iterations, failed attempts included.
    pub n_iterations: usize,
    /// Factorizations.
    pub n_factorizations: usize,
    /// Increments that ended above the tolerance, where residuals are rounding of the positions.
    pub n_at_rounding: usize,
    /// The largest residual left by the others, over the largest load or reaction of its increment (-).
    pub residual: f64,
    /// What plastic flow has dissipated (J).
    pub flowed: f64,
}

/// Growth of the residual in one iteration beyond which half of an increment of a body that flows is taken back: of 1.2, 1.5, 2 and 3 the one that
/// needs the fewest iterations in limit loads.
const MOST_GROWTH: Judged = Judged::new("large::MOST_GROWTH", 1.5);

/// Finds equilibria of one body of large strain by load control.
///
/// Load control follows a path as long as the load can grow; at a limit load, where bodies snap through, no cutback helps and
/// the error names the node that does not come to rest: [`PathStepper`](super::PathStepper) goes on there.
#[derive(Clone, Debug)]
pub struct LoadStepper {
    model: Arc<FiniteStrainModel>,
    settings: LargeSettings,
    newton: Newton,
    end: Vec<f64>,
    load: Vec<f64>,
    /// Positions at the beginning of the case, and at the last but one equilibrium.
    before: Vec<f64>,
    previous: Vec<f64>,
    /// What had flowed before the case.
    flowed_before: Vec<PlasticState>,
}

impl LoadStepper {
    /// A solver for equilibria; the decay of the settings is not used.
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
            newton: Newton::new(&model),
            end: zeros.clone(),
            load: zeros.clone(),
            before: zeros.clone(),
            previous: zeros,
            flowed_before: model.virgin(),
            settings,
            model,
        })
    }

    /// Forces that hold the held dofs in the last equilibrium (N); zero at others.
    pub fn reaction(&self) -> &[f64] {
        &self.newton.reaction
    }

    /// What has flowed at the quadrature points in all load cases, in the order of [`FiniteStrainModel::points_of`]; nothing of laws that do not
    /// flow.
    pub fn flowed(&self) -> &[PlasticState] {
        self.newton.deformation.flowed()
    }

    /// Moves `positions` (m) to the equilibrium at the end of a load case.
    ///
    /// # Errors
    /// Who stopped the last attempt; positions then are as they were.
    ///
    /// # Panics
    /// If there is not one flag per dof.
    pub fn solve(
        &mut self,
        case: LoadCase<'_>,
        positions: &mut [f64],
    ) -> Result<LoadReport, LargeError> {
        let n_dofs = self.model.n_dofs();
        assert_eq!(case.is_held.len(), n_dofs, "one flag per dof");
        require_finite("the positions", positions, n_dofs)?;
        require_finite("the load at the beginning", case.from, n_dofs)?;
        require_finite("the load at the end", case.to, n_dofs)?;
        require_finite("the places", case.places, n_dofs)?;
        self.before.copy_from_slice(positions);
        self.newton.work = Work::default();
        self.newton.forget_factor();
        self.flowed_before
            .copy_from_slice(self.newton.deformation.flowed());
        let outcome = self.follow(case, positions);
        if outcome.is_err() {
            positions.copy_from_slice(&self.before);
            self.newton.deformation.begin_with(&self.flowed_before);
        }
        outcome
    }

    fn follow(
        &mut self,
        case: LoadCase<'_>,
        positions: &mut [f64],
    ) -> Result<LoadReport, LargeError> {
        let mut increments = Increments::new(case.n_increments, self.settings.max_cutbacks);
        let mut report = LoadReport::default();
        while let Some([reached, ahead]) = increments.next() {
            match self.attempt(&case, reached, ahead, positions) {
                Ok(()) => {
                    self.previous.copy_from_slice(positions);
                    positions.copy_from_slice(&self.end);
                    let flowed = self.newton.deformation.flowed_mut();
                    report.flowed += self.model.commit_flow(&self.end, flowed);
                    report.n_increments += 1;
                    increments.accept();
                }
                Err(error) => {
                    if !increments.halve() {
                        return Err(error);
                    }
                    report.n_cutbacks += 1;
                }
            }
        }
        let work = self.newton.work;
        report.n_iterations = work.n_iterations;
        report.n_factorizations = work.n_factorizations;
        report.n_at_rounding = work.n_at_rounding;
        report.residual = work.residual;
        Ok(report)
    }

    /// One increment of the load to a share of it, from a guess that goes on as the last one went by `ahead` of its length.
    fn attempt(
        &mut self,
        case: &LoadCase<'_>,
        reached: f64,
        ahead: f64,
        positions: &[f64],
    ) -> Result<(), LargeError> {
        for (dof, &x) in positions.iter().enumerate() {
            self.load[dof] = case.from[dof] + reached * (case.to[dof] - case.from[dof]);
            let way = case.places[dof] - self.before[dof];
            self.end[dof] = match case.is_held[dof] {
                true if reached == 1.0 => case.places[dof],
                true => self.before[dof] + reached * way,
                false if ahead > 0.0 => x + ahead * (x - self.previous[dof]),
                false => x,
            };
        }
        let flows = !self.newton.deformation.flowed().is_empty();
        let equation = Equation {
            model: &self.model,
            form: Form::Equilibrium,
            inertia: Inertia {
                acceleration: 0.0,
                drag: 0.0,
            },
            load: &self.load,
            start: positions,
            coast: positions,
            is_held: case.is_held,
            // An increment of bending stretches straight ways first, at any growth of the residual. What flows beyond its yield stress is far from
            // what its tangent tells.
            most_growth: if flows {
                MOST_GROWTH.get()
            } else {
                f64::INFINITY
            },
        };
        if ahead == 0.0 && flows {
            self.newton.follow_held(&equation, &mut self.end);
        }
        let limits = Limits {
            tolerance: self.settings.tolerance,
            max_iterations: self.settings.max_iterations,
            budget: usize::MAX,
        };
        self.newton.solve(&equation, limits, 0.0, &mut self.end)
    }
}
