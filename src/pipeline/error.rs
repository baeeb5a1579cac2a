//! Why a step was not taken.

use super::participant::Participant;
use super::quality::Quality;
use crate::body::{AttachmentHandle, FlexBodyError, FlexBodyHandle};
use crate::coupling::{GatherError, ShapeFault};
use crate::integrator::IntegratorError;
use crate::kkt::KktError;
use crate::linalg::cholesky::CholeskyError;
use crate::rapier::prelude::{
    ColliderHandle, ImpulseJointHandle, MultibodyJointHandle, RigidBodyHandle,
};
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
    /// The effective matrix of a flexible body is not positive definite: the body has no mass somewhere, or its cells are so
    /// small and stiff for this step length that rounding hides their mass.
    #[error(
        "flexible body {body:?}: {source}; if its cells are very small and stiff, shorten the step or coarsen its mesh"
    )]
    Factorization {
        /// The body.
        body: FlexBodyHandle,
        /// What the factorization found.
        source: CholeskyError,
    },
    /// A rigid body is too light for the springs that an explicit body meets it with.
    #[error(
        "{body:?} is so light that on the surface of an explicit flexible body it vibrates faster than the step of {dt} s resolves: shorten the step below {critical} s, make the body heavier, keep the inertia of the surface (`ContactInertia::Kept`), or choose beta0 > 0"
    )]
    LightPartner {
        /// The rigid body.
        body: RigidBodyHandle,
        /// The step asked for (s).
        dt: f64,
        /// The longest stable step (s).
        critical: f64,
    },
    /// The contact problem could not be solved.
    #[error(transparent)]
    Kkt(#[from] KktError),
    /// The step is not solved, and the pipeline [refuses](super::FlexPipeline::refusing_unsolved) such steps.
    #[error(
        "the contacts of {bodies:?} are not solved within the budget ({quality:?}, overlap {overlap:e} m): shorten the step, or take the step and look at `StepReport::quality`"
    )]
    Unsolved {
        /// What would have become of it.
        quality: Quality,
        /// Flexible bodies of the island, and who its worst contact belongs to.
        bodies: Vec<Participant>,
        /// Largest overlap at its contacts (m).
        overlap: f64,
    },
    /// The step length is negative, not finite or out of range.
    #[error(
        "the step length is {0:e} s: set `integration_parameters.dt` to zero or a positive number from 1e-8 s to 1e4 s"
    )]
    StepLength(f64),
    /// A parameter of the pipeline is out of its range.
    #[error("the pipeline's parameter `{name}` is {value}: {cure}")]
    Parameter {
        /// Which field of [`FlexParameters`](super::FlexParameters).
        name: &'static str,
        /// Its value.
        value: f64,
        /// What to do.
        cure: &'static str,
    },
    /// Gravity is not finite or too large for rapier's precision.
    #[error("gravity is {0:?} m/s^2: set `gravity` to finite numbers")]
    Gravity([f64; 2]),
    /// Rapier's prediction distance is negative, not finite or too large.
    #[error(
        "the prediction distance is {0:e} m: set `integration_parameters.length_unit` and `normalized_prediction_distance` to finite numbers that are not negative"
    )]
    Prediction(f64),
    /// A collider, wherever it is, has a margin that rapier's boxes cannot be grown by.
    #[error(
        "{0:?} has a contact skin, or a rounding of its shape, that is negative, not finite or too large: set it to zero or a positive number (m), or disable the collider"
    )]
    Margin(ColliderHandle),
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
    /// A joint of a claimed body holds numbers that are not finite.
    #[error(
        "{0:?} joins a body that touches a flexible one, and its anchors, motor or softness are not finite: set them anew, or remove it"
    )]
    Joint(ImpulseJointHandle),
    /// A joint of a multibody that touches a flexible body has anchors, motors, springs, damping or friction that are not finite.
    #[error(
        "{0:?} is of a multibody that touches a flexible body, and its anchors, motors, springs, damping or friction are not finite: set them anew, or remove it"
    )]
    MultibodyJoint(MultibodyJointHandle),
    /// Two coordinates of a multibody that touches a flexible body are coupled, of which one is no angle, or by numbers that are not finite.
    #[error(
        "the coordinate of {0:?} is coupled to another, its multibody touches a flexible body, and not both are angles of joints, or the numbers are not finite: remove the coupling, and hold the motion by a motor"
    )]
    Coupling(MultibodyJointHandle),
    /// A joint holds on to the carrier of a flexible body, which is where rapier keeps its surface and moves with nothing.
    #[error(
        "{0:?} holds on to the carrier of a flexible body, which moves with nothing: remove it and attach the body with `FlexBodySet::attach`"
    )]
    CarrierJoint(ImpulseJointHandle),
    /// An explicit integrator cannot hold attachments.
    #[error(
        "{0:?} cannot be held by an integrator with beta0 = 0: choose one with beta0 > 0, pin nodes in the builder, or detach it"
    )]
    ExplicitAttachment(AttachmentHandle),
    /// A collider that touches a flexible body has a coefficient that is not finite.
    #[error(
        "{0:?} touches a flexible body, and its friction or restitution is not finite: set both to finite numbers"
    )]
    Coefficient(ColliderHandle),
    /// A collider that a flexible body meets, or a body that it touches, has a shape of numbers that no body can have.
    #[error(
        "{collider:?} meets a flexible body, or what touches one, and its shape has {fault}: {cure}, or disable the collider"
    )]
    Shape {
        /// The collider.
        collider: ColliderHandle,
        /// What is wrong with its shape.
        fault: &'static str,
        /// What to do.
        cure: &'static str,
    },
    /// `modify_solver_contacts` left numbers that are not finite.
    #[error(
        "the hook `modify_solver_contacts` left a normal, distance or coefficient that is not finite, or a normal of no length, between {0:?} and {1:?}: leave finite numbers, or clear the solver contacts"
    )]
    Hook(ColliderHandle, ColliderHandle),
}

impl From<GatherError> for StepError {
    fn from(error: GatherError) -> Self {
        match error {
            // The matrix of a body of large strain depends on where the body is.
            GatherError::Factorization {
                body,
                source: CholeskyError::NotPositiveDefinite { pivot, .. },
            } if !pivot.is_finite() => Self::NotFinite(body),
            GatherError::Factorization { body, source } => Self::Factorization { body, source },
            GatherError::RigidBody(handle) => Self::RigidBody(handle),
            GatherError::Joint(handle) => Self::Joint(handle),
            GatherError::MultibodyJoint(handle) => Self::MultibodyJoint(handle),
            GatherError::Coupling(handle) => Self::Coupling(handle),
            GatherError::Coefficient(handle) => Self::Coefficient(handle),
            GatherError::Shape(collider, ShapeFault { fault, cure }) => Self::Shape {
                collider,
                fault,
                cure,
            },
            GatherError::Hook([one, other]) => Self::Hook(one, other),
        }
    }
}
