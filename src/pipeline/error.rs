//! Why a step was not taken.

use crate::body::{FlexBodyError, FlexBodyHandle};
use crate::coupling::GatherError;
use crate::integrator::IntegratorError;
use crate::kkt::KktError;
use crate::rapier::prelude::{ColliderHandle, RigidBodyHandle};
use thiserror::Error;

/// Why a step was not taken. Flexible bodies, rigid bodies and contacts are as they were before it.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum StepError {
    /// A body or its carrier is not where it should be.
    #[error(transparent)]
    Body(#[from] FlexBodyError),
    /// The integrator is unstable for a body's mesh at this step length.
    #[error("flexible body {body:?}: {source}")]
    Integrator {
        /// The body.
        body: FlexBodyHandle,
        /// The critical step.
        source: IntegratorError,
    },
    /// The contact problem could not be solved.
    #[error(transparent)]
    Kkt(#[from] KktError),
    /// The step length is negative, not finite or out of range.
    #[error(
        "the step length is {0} s: set `integration_parameters.dt` to zero or a positive number from 1e-8 s to 1e4 s"
    )]
    StepLength(f64),
    /// Gravity is not finite or too large for rapier's precision.
    #[error("gravity is {0:?} m/s^2: set `gravity` to finite numbers")]
    Gravity([f64; 2]),
    /// The result is not finite, or too large for rapier's precision.
    #[error(
        "flexible body {0:?} would move to a position that is not finite: look at its loads and velocities"
    )]
    NotFinite(FlexBodyHandle),
    /// A rigid body that touches a flexible one has a motion, mass or force that is not finite.
    #[error(
        "{0:?} touches a flexible body, and its motion, mass, damping, force or torque is not finite: reset its forces and set its velocity, or remove it"
    )]
    RigidBody(RigidBodyHandle),
    /// A collider that touches a flexible body has a coefficient that is not finite.
    #[error(
        "{0:?} touches a flexible body, and its friction, restitution or contact skin is not finite: set all to finite numbers"
    )]
    Coefficient(ColliderHandle),
    /// `modify_solver_contacts` left numbers that are not finite.
    #[error(
        "the hook `modify_solver_contacts` left a normal, distance or coefficient that is not finite, or a normal of no length, between {0:?} and {1:?}: leave finite numbers, or clear the solver contacts"
    )]
    Hook(ColliderHandle, ColliderHandle),
}

impl From<GatherError> for StepError {
    fn from(error: GatherError) -> Self {
        match error {
            GatherError::Kkt(error) => Self::Kkt(error),
            GatherError::RigidBody(handle) => Self::RigidBody(handle),
            GatherError::Coefficient(handle) => Self::Coefficient(handle),
            GatherError::Hook([one, other]) => Self::Hook(one, other),
        }
    }
}
