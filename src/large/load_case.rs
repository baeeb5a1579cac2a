//! A load case gone through in increments, halved where no equilibrium is found: what all share who look for equilibria under one.

use super::LargeError;
use super::equation::{Equation, Inertia};
use super::increments::Increments;
use super::newton::Work;
use super::stepper::require_finite;
use crate::fe::finite_strain::{Deformation, FiniteStrainModel, Form};
use crate::fe::material::hyperelastic::PlasticState;
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
    /// Increments to begin with; none counts as one.
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

/// One increment of a load case.
#[derive(Clone, Copy, Debug)]
pub(super) struct Increment<'a> {
    pub(super) model: &'a FiniteStrainModel,
    /// Nodal loads at its end (N).
    pub(super) load: &'a [f64],
    pub(super) is_held: &'a [bool],
    /// Positions at its beginning (m).
    pub(super) start: &'a [f64],
    /// Shares of the case at its beginning and its end (-).
    pub(super) shares: [f64; 2],
    /// Whether it is the first of its case.
    pub(super) is_first: bool,
}

/// What finds the equilibrium at the end of an increment.
pub(super) trait Equilibrator {
    fn deformation(&mut self) -> &mut Deformation;

    /// What was done since the case began.
    fn work(&self) -> Work;

    /// Moves `end` (m) from a guess to the equilibrium.
    ///
    /// # Errors
    /// Who stopped the iterations; `end` then is of no use.
    fn find(&mut self, increment: &Increment<'_>, end: &mut [f64]) -> Result<(), LargeError>;
}

/// Goes through load cases.
#[derive(Clone, Debug)]
pub(super) struct Ramp {
    model: Arc<FiniteStrainModel>,
    max_cutbacks: usize,
    /// Loads of an increment (N), and where its equilibrium is sought (m).
    load: Vec<f64>,
    end: Vec<f64>,
    /// Positions at the beginning of the case, and at the last but one equilibrium (m).
    before: Vec<f64>,
    previous: Vec<f64>,
    /// What had flowed before the case.
    flowed_before: Vec<PlasticState>,
}

impl Increment<'_> {
    /// The equation of equilibrium at its end, whose residual may grow by so much in one iteration.
    pub(super) fn equation(&self, most_growth: f64) -> Equation<'_> {
        Equation {
            model: self.model,
            form: Form::Equilibrium,
            inertia: Inertia {
                acceleration: 0.0,
                drag: 0.0,
            },
            load: self.load,
            start: self.start,
            coast: self.start,
            is_held: self.is_held,
            most_growth,
        }
    }
}

impl Ramp {
    pub(super) fn new(model: Arc<FiniteStrainModel>, max_cutbacks: usize) -> Self {
        let zeros = vec![0.0; model.n_dofs()];
        Self {
            load: zeros.clone(),
            end: zeros.clone(),
            before: zeros.clone(),
            previous: zeros,
            flowed_before: model.virgin(),
            max_cutbacks,
            model,
        }
    }

    /// Refuses lists of a case that do not fit the body or are not finite.
    ///
    /// # Panics
    /// If there is not one flag per dof.
    pub(super) fn check(&self, case: &LoadCase<'_>, positions: &[f64]) -> Result<(), LargeError> {
        let n_dofs = self.model.n_dofs();
        assert_eq!(case.is_held.len(), n_dofs, "one flag per dof");
        require_finite("the positions", positions, n_dofs)?;
        require_finite("the load at the beginning", case.from, n_dofs)?;
        require_finite("the load at the end", case.to, n_dofs)?;
        require_finite("the places", case.places, n_dofs)
    }

    /// Moves `positions` (m) to the equilibrium at the end of a case.
    ///
    /// # Errors
    /// Who stopped the last attempt; positions and what has flowed then are as they were.
    pub(super) fn solve(
        &mut self,
        case: &LoadCase<'_>,
        equilibrator: &mut impl Equilibrator,
        positions: &mut [f64],
    ) -> Result<LoadReport, LargeError> {
        self.before.copy_from_slice(positions);
        let flowed = equilibrator.deformation().flowed();
        self.flowed_before.copy_from_slice(flowed);
        let outcome = self.follow(case, equilibrator, positions);
        if outcome.is_err() {
            positions.copy_from_slice(&self.before);
            equilibrator.deformation().begin_with(&self.flowed_before);
        }
        outcome
    }

    fn follow(
        &mut self,
        case: &LoadCase<'_>,
        equilibrator: &mut impl Equilibrator,
        positions: &mut [f64],
    ) -> Result<LoadReport, LargeError> {
        let mut increments = Increments::new(case.n_increments, self.max_cutbacks);
        let mut report = LoadReport::default();
        let mut share = 0.0;
        while let Some([reached, ahead]) = increments.next() {
            self.guess(case, [reached, ahead], positions);
            let increment = Increment {
                model: &self.model,
                load: &self.load,
                is_held: case.is_held,
                start: positions,
                shares: [share, reached],
                is_first: ahead == 0.0,
            };
            match equilibrator.find(&increment, &mut self.end) {
                Ok(()) => {
                    self.previous.copy_from_slice(positions);
                    positions.copy_from_slice(&self.end);
                    let flowed = equilibrator.deformation().flowed_mut();
                    report.flowed += self.model.commit_flow(&self.end, flowed);
                    report.n_increments += 1;
                    share = reached;
                    increments.accept();
                }
                Err(error) => {
                    if !increments.halve() {
                        // Without inertia it is what nothing holds that has no factor.
                        return Err(match error {
                            LargeError::Factor(_) => LargeError::Singular { factor: share },
                            other => other,
                        });
                    }
                    report.n_cutbacks += 1;
                }
            }
        }
        let work = equilibrator.work();
        report.n_iterations = work.n_iterations;
        report.n_factorizations = work.n_factorizations;
        report.n_at_rounding = work.n_at_rounding;
        report.residual = work.residual;
        Ok(report)
    }

    /// Loads of an increment to a share of the case, and where it is sought from: on as the last one went, by `ahead` of its length.
    fn guess(&mut self, case: &LoadCase<'_>, [reached, ahead]: [f64; 2], positions: &[f64]) {
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
    }
}
