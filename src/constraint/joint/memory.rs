//! What a joint row remembers from one step to the next: its multiplier, for the warm start, and how fast it was driven.

use crate::math::HashMap;

/// What a joint row belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum JointOwner {
    /// An impulse joint of rapier, by index and generation.
    Impulse(u32, u32),
    /// A joint of a multibody, by index and generation of the body that it leads to.
    Multibody(u32, u32),
    /// An attachment of a flexible body, by index and generation.
    Attachment(u32, u32),
}

/// Names a joint row across steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct JointKey {
    /// The joint.
    pub owner: JointOwner,
    /// Which of its rows.
    pub row: u32,
}

/// What a joint row has left behind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct RememberedJoint {
    /// Its multiplier (N or N m).
    pub multiplier: f64,
    /// What is left in the stored accelerations of flexible bodies (N or N m).
    pub lasting: f64,
    /// Rate at which it was driven from outside when the step ended (m/s or rad/s).
    pub driven: f64,
    /// Whether its ends were put apart and do not meet yet.
    pub closes: bool,
}

/// What the rows of the last step have left behind.
///
/// Looked up by key only, never iterated, so that results do not depend on hashing.
#[derive(Clone, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct JointMemory {
    #[cfg_attr(feature = "serde-serialize", serde(with = "crate::math::ordered"))]
    last: HashMap<JointKey, RememberedJoint>,
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    next: HashMap<JointKey, RememberedJoint>,
}

impl JointMemory {
    /// What a row has left behind in the last step, if it was there.
    pub fn recall(&self, key: &JointKey) -> Option<RememberedJoint> {
        self.last.get(key).copied()
    }

    /// Notes what a row leaves for the next step.
    pub fn remember(&mut self, key: JointKey, left: RememberedJoint) {
        self.next.insert(key, left);
    }

    /// Makes what was noted that of the last step.
    pub fn turn_over(&mut self) {
        std::mem::swap(&mut self.last, &mut self.next);
        self.next.clear();
    }

    /// Throws away what was noted since the last turn-over.
    pub fn discard_notes(&mut self) {
        self.next.clear();
    }
}
