//! Load cases against obstacles.

use super::iteration::Iteration;
use super::obstacle::Obstacle;
use super::touch::ContactPoint;
use crate::fe::finite_strain::FiniteStrainModel;
use crate::fe::material::hyperelastic::PlasticState;
use crate::large::load_case::Ramp;
use crate::large::newton::Work;
use crate::large::{LargeError, LargeSettings, LoadCase, LoadReport};
use std::sync::Arc;

/// Loads, held dofs and obstacles, and from where to where they go.
#[derive(Clone, Copy, Debug)]
pub struct ContactCase<'a> {
    /// Loads and held dofs.
    pub load: LoadCase<'a>,
    /// What the surface of the body is kept out of; where several are near, a node is kept out of one.
    pub obstacles: &'a [Obstacle],
}

/// Finds equilibria of one body of large strain between rigid obstacles.
///
/// What touches stays known to the next case, for the same list of obstacles. Friction is that of the slip of every increment: many show a load that turns round.
///
/// ```
/// use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
/// use foil2d::fe::material::hyperelastic::NeoHookean;
/// use foil2d::fe::mesh::{CellKind, generate::rectangle};
/// use foil2d::large::{ContactCase, ContactStepper, LargeSettings, LoadCase, Obstacle};
///
/// // A disc of 10 cm goes 2 cm into a block.
/// let mesh = rectangle([0.4, 0.2], [16, 8], CellKind::Tri6)?;
/// let law = NeoHookean::plane_strain(1e6, 0.3);
/// let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, 1000.0))?;
/// let rest = model.rest_positions().to_vec();
/// let is_held: Vec<bool> = rest.chunks_exact(2).flat_map(|x| [x[1] == 0.0; 2]).collect();
/// let disc = Obstacle::disc([0.2, 0.3], 0.1).moving_by([0.0, -0.02]);
///
/// let none = vec![0.0; rest.len()];
/// let load = LoadCase { from: &none, to: &none, is_held: &is_held, places: &rest, n_increments: 4 };
/// let mut positions = rest.clone();
/// let mut stepper = ContactStepper::new(model, LargeSettings::default())?;
/// stepper.solve(ContactCase { load, obstacles: &[disc] }, &mut positions)?;
/// let pressed: f64 = stepper.contacts().iter().map(|point| point.normal_force * point.normal[1]).sum();
/// let held: f64 = stepper.reaction().chunks_exact(2).map(|force| force[1]).sum();
/// assert!(held > 5e3 && (pressed + held).abs() < 1e-3 * held);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ContactStepper {
    model: Arc<FiniteStrainModel>,
    ramp: Ramp,
    iteration: Iteration,
}

impl ContactStepper {
    /// A solver for equilibria; the decay of the settings is not used.
    ///
    /// # Errors
    /// If a setting is out of its range, or there is no memory for the factor.
    pub fn new(
        model: impl Into<Arc<FiniteStrainModel>>,
        settings: LargeSettings,
    ) -> Result<Self, LargeError> {
        settings.check()?;
        let model = model.into();
        Ok(Self {
            iteration: Iteration::new(&model, settings)?,
            ramp: Ramp::new(Arc::clone(&model), settings.max_cutbacks),
            model,
        })
    }

    /// Forces that hold the held dofs in the last equilibrium (N); zero at others.
    pub fn reaction(&self) -> &[f64] {
        &self.iteration.reaction
    }

    /// What touches in the last equilibrium.
    pub fn contacts(&self) -> &[ContactPoint] {
        &self.iteration.contacts
    }

    /// What has flowed at the quadrature points in all cases, as [`LoadStepper::flowed`](crate::large::LoadStepper::flowed).
    pub fn flowed(&self) -> &[PlasticState] {
        self.iteration.deformation.flowed()
    }

    /// Moves `positions` (m) to the equilibrium at the end of a case.
    ///
    /// # Errors
    /// Who stopped the last attempt; positions then are as they were. [`LargeError::Obstacle`] and the errors of lists for what is wrong before.
    ///
    /// # Panics
    /// If there is not one flag per dof.
    pub fn solve(
        &mut self,
        case: ContactCase<'_>,
        positions: &mut [f64],
    ) -> Result<LoadReport, LargeError> {
        self.ramp.check(&case.load, positions)?;
        for (index, obstacle) in case.obstacles.iter().enumerate() {
            obstacle.check(index)?;
        }
        let touches = self.iteration.touches.clone();
        self.iteration.work = Work::default();
        self.iteration.obstacles = case.obstacles.to_vec();
        self.iteration.list_touches(&self.model, case.load.is_held);
        let outcome = self.ramp.solve(&case.load, &mut self.iteration, positions);
        if outcome.is_err() {
            self.iteration.touches = touches;
        }
        outcome
    }
}
