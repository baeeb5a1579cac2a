//! What can stop a non-linear step.

use crate::integrator::IntegratorError;
use thiserror::Error;

/// Why a step was not taken. The motion is as it was before the step.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NonLinearError {
    /// The iterations ran out.
    #[error(
        "{iterations} Newton iterations left a residual of {residual:e} N where {limit:e} N was asked: shorten the step, allow more iterations, or check the tangent against finite differences"
    )]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// The last residual (N).
        residual: f64,
        /// The residual that would do (N).
        limit: f64,
    },
    /// No share of Newton's increment lowers the residual.
    #[error(
        "iteration {iteration}: {cuts} cuts of the Newton increment did not lower the residual of {residual:e} N below (limit {limit:e} N): check the tangent against finite differences, shorten the step, or allow a larger tolerance if the residual is at its rounding"
    )]
    Stalled {
        /// The iteration, from 1.
        iteration: usize,
        /// Cuts of the line search.
        cuts: usize,
        /// The residual that stayed (N).
        residual: f64,
        /// The residual that would do (N).
        limit: f64,
    },
    /// A force, a tangent or the motion is not a number.
    #[error(
        "{what} is not finite at dof {dof}: shorten the step, or give the force law a value there"
    )]
    NotFinite {
        /// What is not finite.
        what: &'static str,
        /// The first dof.
        dof: usize,
    },
    /// The matrix of the increment has no inverse.
    #[error(
        "the matrix b2 M + b1 C + b0 K of the increment is singular at dof {dof} (pivot {pivot:e}): give that dof mass, or a tangent that is not zero"
    )]
    SingularTangent {
        /// The dof whose pivot vanished.
        dof: usize,
        /// The pivot (kg).
        pivot: f64,
    },
    /// The step length is not a positive finite number.
    #[error("the step is {0} s: give a positive finite length")]
    StepLength(f64),
    /// A list has the wrong length.
    #[error("{name} has {found} entries, {expected} are needed")]
    Length {
        /// Which list.
        name: &'static str,
        /// Entries given.
        found: usize,
        /// Entries needed.
        expected: usize,
    },
    /// A setting is out of its range.
    #[error(transparent)]
    Setting(#[from] IntegratorError),
}
