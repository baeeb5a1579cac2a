//! What the user knows the sides of contacts and the joints of an island as.

use crate::body::{AttachmentHandle, FlexBodyHandle};
use crate::rapier::prelude::{ColliderHandle, ImpulseJointHandle, MultibodyJointHandle};

/// One side of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Participant {
    /// A flexible body.
    Flex(FlexBodyHandle),
    /// A collider of a rigid body, or one without a body.
    Rigid(ColliderHandle),
}

/// What holds without touching.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Held {
    /// An impulse joint of rapier.
    Joint(ImpulseJointHandle),
    /// A joint of a multibody.
    MultibodyJoint(MultibodyJointHandle),
    /// An attachment of a flexible body.
    Attachment(AttachmentHandle),
}
