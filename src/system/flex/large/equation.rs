//! The equation of a step of a body of large strain, and the factor of its matrix.

use crate::fe::finite_strain::{Deformation, FiniteStrainModel, Form, Linearization};
use crate::fe::material::Rayleigh;
use crate::large::{Equation, Inertia, largest_row_sum, most_growth};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};
use crate::math::rounding;
use crate::system::step::Step;

/// What a factorization has found.
pub(super) struct Factored {
    pub row_sum: f64,
    /// Whether the tangent itself was definite.
    pub is_definite: bool,
}

/// The decay of the integrator, and the viscosity of the material as one.
pub(super) fn total_decay(step: &Step, damping: Rayleigh) -> f64 {
    step.decay + 2.0 * damping.stiffness / step.dt
}

/// The equation of a step under `load` from `start` by way of `coast`.
///
/// - `takes_end`: whether the stress is that of the end.
pub(super) fn equation_of<'a>(
    model: &'a FiniteStrainModel,
    step: &Step,
    takes_end: bool,
    [load, start, coast]: [&'a [f64]; 3],
    is_held: &'a [bool],
) -> Equation<'a> {
    let (dt, damping) = (step.dt, model.damping());
    let form = if takes_end {
        Form::Equilibrium
    } else {
        Form::EnergyMomentum {
            decay: total_decay(step, damping),
        }
    };
    Equation {
        model,
        form,
        inertia: Inertia {
            acceleration: 2.0 / (dt * dt),
            drag: damping.mass / dt,
        },
        load,
        start,
        coast,
        is_held,
        most_growth: most_growth(),
    }
}

/// Share of the largest row of a matrix that is added to its diagonal where rounding has left it indefinite (-).
const SHIFT: f64 = rounding::FEW;

/// Factorizes the tangent at the deformation last evaluated, or its definite part where it is not definite.
///
/// Cells that are all but flat are so stiff that rounding may leave their definite part indefinite: more and more is added to its diagonal
/// then, which makes the iteration slower, not wrong.
pub(super) fn factorize(
    equation: &Equation<'_>,
    scale: f64,
    deformation: &Deformation,
    (tangent, effective): (&mut BlockMatrix, &mut BlockMatrix),
    factor: &mut BlockCholesky,
) -> Result<Factored, CholeskyError> {
    equation.assemble(Linearization::Consistent, deformation, tangent);
    effective.assign_scaled(scale, tangent);
    if factor.factorize(effective).is_ok() {
        return Ok(Factored {
            row_sum: largest_row_sum(tangent),
            is_definite: true,
        });
    }
    let asked = (equation, Linearization::Definite);
    factorize_definite(asked, scale, deformation, (tangent, effective), factor)
}

/// Stiffness of a point over the masses' part of the matrix beyond which it is rigid in the step, and rounding would take the masses (-).
const RIGID: f64 = 1.0 / rounding::ITERATED;

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

/// Factorizes a tangent whose stiffness is positive semidefinite, so that `A >= M`: what the consistent tangent alone leaves may be as near to
/// singular as it likes, and throw what it answers for.
pub(super) fn factorize_definite(
    (equation, kind): (&Equation<'_>, Linearization),
    scale: f64,
    deformation: &Deformation,
    (tangent, effective): (&mut BlockMatrix, &mut BlockMatrix),
    factor: &mut BlockCholesky,
) -> Result<Factored, CholeskyError> {
    equation.assemble(kind, deformation, tangent);
    effective.assign_scaled(scale, tangent);
    let mut outcome = factor.factorize(effective);
    let mut shift = SHIFT * scale * largest_row_sum(tangent);
    while outcome.is_err() && shift.is_finite() && shift > 0.0 {
        for node in 0..equation.model.n_nodes() {
            effective.add_diagonal(node, [shift; 2]);
        }
        outcome = factor.factorize(effective);
        shift *= 1e2;
    }
    outcome?;
    Ok(Factored {
        row_sum: largest_row_sum(tangent),
        is_definite: false,
    })
}
