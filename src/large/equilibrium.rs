//! Equilibrium under loads that grow from nothing to their whole, in smaller increments where it is not found.

use super::load_case::{Equilibrator, Increment, LoadCase, LoadReport, Ramp};
use super::newton::{Limits, Newton, Work};
use super::{LargeError, LargeSettings};
use crate::fe::finite_strain::{Deformation, FiniteStrainModel};
use crate::fe::material::hyperelastic::PlasticState;
use crate::math::judged::Judged;
use std::sync::Arc;

/// Growth of the residual in one iteration beyond which half of an increment of a body that flows is taken back: of 1.2, 1.5, 2 and 3 the one that
/// needs the fewest iterations in limit loads.
const MOST_GROWTH: Judged = Judged::new("large::MOST_GROWTH", 1.5);

/// Finds equilibria of one body of large strain by load control.
///
/// Load control follows a path as long as the load can grow. At a limit load, where bodies snap through, it either fails and names the node that does not
/// come to rest, or lands on another equilibrium far away, which no report can tell from a long way: [`PathStepper`](super::PathStepper) goes on there.
#[derive(Clone, Debug)]
pub struct LoadStepper {
    ramp: Ramp,
    free: Free,
}

/// Finds equilibria of a body that nothing but held dofs keeps anywhere.
#[derive(Clone, Debug)]
struct Free {
    limits: Limits,
    newton: Newton,
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
        let limits = Limits {
            tolerance: settings.tolerance,
            max_iterations: settings.max_iterations,
            budget: usize::MAX,
        };
        let newton = Newton::new(&model);
        Ok(Self {
            ramp: Ramp::new(model, settings.max_cutbacks),
            free: Free { limits, newton },
        })
    }

    /// Forces that hold the held dofs in the last equilibrium (N); zero at others.
    pub fn reaction(&self) -> &[f64] {
        &self.free.newton.reaction
    }

    /// What has flowed at the quadrature points in all load cases, in the order of [`FiniteStrainModel::points_of`]; nothing of laws that do not
    /// flow.
    pub fn flowed(&self) -> &[PlasticState] {
        self.free.newton.deformation.flowed()
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
        self.ramp.check(&case, positions)?;
        self.free.newton.work = Work::default();
        self.free.newton.forget_factor();
        self.ramp.solve(&case, &mut self.free, positions)
    }
}

impl Equilibrator for Free {
    fn deformation(&mut self) -> &mut Deformation {
        &mut self.newton.deformation
    }

    fn work(&self) -> Work {
        self.newton.work
    }

    fn find(&mut self, increment: &Increment<'_>, end: &mut [f64]) -> Result<(), LargeError> {
        let flows = !self.newton.deformation.flowed().is_empty();
        // An increment of bending stretches straight ways first, at any growth of the residual. What flows beyond its yield stress is far from
        // what its tangent tells.
        let equation = increment.equation(if flows {
            MOST_GROWTH.get()
        } else {
            f64::INFINITY
        });
        if increment.is_first {
            self.newton.follow_held(&equation, end);
        }
        self.newton.solve(&equation, self.limits, 0.0, end)
    }
}
