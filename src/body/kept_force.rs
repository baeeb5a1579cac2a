//! Forces that a flexible body keeps from one step to the next.

use crate::rapier::prelude::RigidBodyHandle;

/// What a body that stores accelerations keeps of its contact forces on one that is moved as it must: it acts on in the first part of the next step, whatever
/// has become of the contacts, and works along the way that the other one goes then.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct KeptForce {
    /// Whom it acts on.
    pub on: RigidBodyHandle,
    /// Force and torque about its centre of mass (N, N, N m).
    pub wrench: [f64; 3],
}
