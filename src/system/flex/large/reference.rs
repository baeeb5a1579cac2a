//! Which tangent the factor of a body of large strain is of, and whether it serves for another step.
//!
//! A factor costs as much as some iterations, and of a body that hardly changes its shape it is hardly another one from step to step. Where it was
//! made is part of the state ([`Linearized`]), so that a run that is restored makes the same one again and goes on as it was.

use crate::body::Linearized;
use crate::fe::finite_strain::{Deformation, FiniteStrainModel, Form};
use crate::large::{Equation, Inertia};
use crate::linalg::cholesky::BlockCholesky;
use crate::math::judged::Judged;
use std::sync::Arc;

/// Change of `F` at a point since its tangent was taken, up to which that one serves (-).
///
/// A turn or stretch by `δ` changes the stiffness by a few `δ`, of which an iteration leaves as much: a hundredth costs no more iterations than
/// the tangent of a step does, which is made symmetric and errs by the change within the step. A third, three times and ten times that make
/// between .9 and 1.05 of the work of a cantilever that swings.
const NEAR: Judged = Judged::new("system::NEAR", 1e-2);

/// What the factor at hand was made of.
#[derive(Clone, Debug, Default)]
pub(super) struct Reference {
    key: Option<Key>,
    positions: Vec<f64>,
    gradients: Vec<[f64; 4]>,
    is_held: Vec<bool>,
    /// Number of the factorization: another one since has taken its place.
    number: usize,
}

#[derive(Clone, Debug)]
struct Key {
    model: Arc<FiniteStrainModel>,
    form: Form,
    inertia: Inertia,
}

impl Reference {
    /// Notes that the factor is of the consistent tangent where the deformation begins, if that is definite; of others nothing is kept.
    pub fn note(
        &mut self,
        (model, equation): (&Arc<FiniteStrainModel>, &Equation<'_>),
        (positions, deformation): (&[f64], &Deformation),
        factor: &BlockCholesky,
        is_definite: bool,
    ) {
        self.key = None;
        if !is_definite || model.flows() {
            return;
        }
        self.key = Some(Key {
            model: Arc::clone(model),
            form: equation.form,
            inertia: equation.inertia,
        });
        self.positions.clear();
        self.positions.extend_from_slice(positions);
        self.gradients.clear();
        self.gradients
            .extend_from_slice(deformation.start_gradients());
        self.is_held.clear();
        self.is_held.extend_from_slice(equation.is_held);
        self.number = factor.n_factorizations();
    }

    /// Whether the factor at hand is the one that a step with this equation would make at these positions.
    pub fn is_of(
        &self,
        (model, equation): (&Arc<FiniteStrainModel>, &Equation<'_>),
        positions: &[f64],
        factor: &BlockCholesky,
    ) -> bool {
        self.key.as_ref().is_some_and(|key| {
            Arc::ptr_eq(&key.model, model)
                && key.form == equation.form
                && key.inertia == equation.inertia
                && self.is_held == equation.is_held
                && self.positions == positions
                && self.number == factor.n_factorizations()
        })
    }

    /// The gradients where the factor at hand was made.
    pub fn gradients(&self) -> &[[f64; 4]] {
        &self.gradients
    }

    /// Where the factor at hand was made, for the state to be committed; nowhere if it is of another place by now.
    pub fn tell(&self, factor: &BlockCholesky, dt: f64, linearized: &mut Linearized) {
        if self.key.is_none() || self.number != factor.n_factorizations() {
            linearized.forget();
        } else if linearized.dt != dt || linearized.position != self.positions {
            linearized.dt = dt;
            linearized.position.clone_from(&self.positions);
        }
    }
}

/// Whether a tangent taken where the gradients were `reference` serves for a step that begins with these.
pub(super) fn is_near(reference: &[[f64; 4]], deformation: &Deformation) -> bool {
    let pairs = reference.iter().zip(deformation.start_gradients());
    let mut changes = pairs.map(|(one, other)| {
        let parts = one.iter().zip(other).map(|(one, other)| one - other);
        parts.map(|change| change * change).sum::<f64>()
    });
    changes.all(|change| change <= NEAR * NEAR.get())
}
