//! A place in which the equation of a step was looked at: what is out of balance there, and the factor of what the body answers there.

use crate::fe::finite_strain::{Deformation, FiniteStrainModel, Inadmissible, Linearization};
use crate::large::{Equation, Evaluation, largest_row_sum};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::CholeskyError;
use crate::math::rounding;
use crate::system::flex::answer::Answer;

/// Share of the largest row of a matrix that is added to its diagonal where rounding has left it indefinite (-).
const SHIFT: f64 = rounding::FEW;

/// Stiffness of a point over the masses' part of the matrix beyond which it is rigid in the step, and rounding would take the masses (-).
const RIGID: f64 = 1.0 / rounding::ITERATED;

/// The place last looked at, and the tangent last assembled.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    pub deformation: Deformation,
    tangent: BlockMatrix,
    /// What is out of balance (N).
    pub residual: Vec<f64>,
    /// Mean force that holds the held dofs (N).
    pub reaction: Vec<f64>,
    /// The largest sum of the sizes of a row of the tangent that the factor is of (N/m).
    pub row_sum: f64,
}

/// What a factorization has found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factored {
    row_sum: f64,
    /// Whether the tangent itself was definite.
    pub is_definite: bool,
}

impl Trial {
    /// The body at rest, and the pattern of its matrix.
    pub fn new(model: &FiniteStrainModel) -> (Self, BlockMatrix) {
        let tangent = model.new_matrix();
        let effective = tangent.clone();
        let zeros = vec![0.0; model.n_dofs()];
        let trial = Self {
            deformation: model.deformation(model.rest_positions()),
            tangent,
            residual: zeros.clone(),
            reaction: zeros,
            row_sum: 0.0,
        };
        (trial, effective)
    }

    /// Looks at the equation where the step ends at `end` (m).
    pub fn evaluate(
        &mut self,
        equation: &Equation<'_>,
        end: &[f64],
    ) -> Result<Evaluation, Inadmissible> {
        let (residual, reaction) = (&mut self.residual, &mut self.reaction);
        equation.evaluate(end, &mut self.deformation, residual, reaction)
    }

    /// Gives the body the answer of this place, `scale` times its tangent (s²): of this kind, or definite where the consistent one is not.
    pub fn factorize(
        &mut self,
        (equation, kind): (&Equation<'_>, Linearization),
        scale: f64,
        answer: &mut Answer,
    ) -> Result<Factored, CholeskyError> {
        answer.expect_factor();
        let found = self.refill((equation, kind), scale, answer)?;
        self.row_sum = found.row_sum;
        Ok(found)
    }

    /// Factorizes the tangent here; a consistent one that is not definite is left for its definite part, of positive semidefinite stiffness, so that
    /// `A >= M`: what the consistent tangent alone leaves may be as near to singular as it likes, and throw what it answers for.
    ///
    /// Cells that are all but flat are so stiff that rounding may leave their definite part indefinite: more and more is added to its diagonal
    /// then, which makes the iteration slower, not wrong.
    pub fn refill(
        &mut self,
        (equation, kind): (&Equation<'_>, Linearization),
        scale: f64,
        answer: &mut Answer,
    ) -> Result<Factored, CholeskyError> {
        let (effective, factor) = (&mut answer.effective, &mut answer.factor);
        equation.assemble(kind, &self.deformation, &mut self.tangent);
        effective.assign_scaled(scale, &self.tangent);
        let mut outcome = factor.factorize(effective);
        if kind == Linearization::Consistent {
            if outcome.is_ok() {
                return Ok(Factored {
                    row_sum: largest_row_sum(&self.tangent),
                    is_definite: true,
                });
            }
            return self.refill((equation, Linearization::Definite), scale, answer);
        }
        let mut shift = SHIFT * scale * largest_row_sum(&self.tangent);
        while outcome.is_err() && shift.is_finite() && shift > 0.0 {
            for node in 0..equation.model.n_nodes() {
                effective.add_diagonal(node, [shift; 2]);
            }
            outcome = factor.factorize(effective);
            shift *= 1e2;
        }
        outcome?;
        Ok(Factored {
            row_sum: largest_row_sum(&self.tangent),
            is_definite: false,
        })
    }
}

/// What impulses are answered by: masses and the definite part of the stiffness, of which no point resists a turn.
///
/// Impulses that bring velocities `A⁻¹ M v` to rest take kinetic energy from whatever moves, as long as `A >= M` (see [`resolve`]); but
/// they may only be sought with what then acts. Of cells that are all but flat the stiffness is 10^20 times the masses, rounding leaves nothing of
/// these, and what is stiff enough not to move in the step may as well be a little softer.
///
/// [`resolve`]: super::motion::resolve
pub(super) fn impulsive(equation: &Equation<'_>) -> Linearization {
    let masses = equation.model.masses();
    let mean = masses.iter().sum::<f64>() / masses.len() as f64;
    Linearization::Impulsive {
        most: RIGID * equation.inertia.acceleration * mean,
    }
}
