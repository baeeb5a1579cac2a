//! What a step of a body of large strain is solved for: loads, where it begins and where it would coast to.

use crate::body::FlexState;
use crate::fe::finite_strain::{FiniteStrainModel, Form};
use crate::large::{Equation, Inertia, most_growth};
use crate::system::flex::shape::Shape;
use crate::system::flex::shared::{Shared, Start};
use crate::system::step::Step;
use std::sync::Arc;

/// The data of a step's equation that are the body's own; [`Shared`] has the others.
#[derive(Clone, Debug)]
pub(super) struct Problem {
    pub model: Arc<FiniteStrainModel>,
    /// `x + dt v` (m).
    pub coast: Vec<f64>,
    /// Mean force over the step, applied and of contacts (N).
    pub load: Vec<f64>,
    /// Whether the stress is that of the end, for the rest of the step once a body has been led in it.
    pub takes_end: bool,
}

impl Problem {
    pub fn new(model: Arc<FiniteStrainModel>) -> Self {
        let zeros = vec![0.0; model.n_dofs()];
        Self {
            coast: zeros.clone(),
            load: zeros,
            takes_end: false,
            model,
        }
    }

    /// Begins a step of length `dt` (s).
    pub fn begin(&mut self, dt: f64, state: &FlexState) {
        self.takes_end = false;
        for (dof, coast) in self.coast.iter_mut().enumerate() {
            *coast = state.position[dof] + dt * state.velocity[dof];
        }
    }

    /// Takes the contact forces at hand for those of the step.
    pub fn take_loads(&mut self, shared: &Shared) {
        for (dof, load) in self.load.iter_mut().enumerate() {
            *load = shared.loads.force[dof] + shared.contact.nodal[dof];
        }
    }

    /// The equation of the step.
    pub fn equation<'a>(&'a self, step: &Step, start: &'a Start, shape: &'a Shape) -> Equation<'a> {
        let form = if self.takes_end {
            Form::Equilibrium
        } else {
            Form::EnergyMomentum {
                decay: self.decay(step),
            }
        };
        Equation {
            model: &self.model,
            form,
            inertia: self.inertia(step),
            load: &self.load,
            start: &start.position,
            coast: &self.coast,
            is_held: &shape.is_fixed,
            most_growth: most_growth(),
        }
    }

    /// What multiplies the masses in a step.
    pub fn inertia(&self, step: &Step) -> Inertia {
        Inertia {
            acceleration: 2.0 / (step.dt * step.dt),
            drag: self.model.damping().mass / step.dt,
        }
    }

    /// The decay of the integrator, and the viscosity of the material as one (-).
    pub fn decay(&self, step: &Step) -> f64 {
        step.decay + 2.0 * self.model.damping().stiffness / step.dt
    }
}
