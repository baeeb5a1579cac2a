//! What a joint row remembers from one step to the next: its multiplier, for the warm start.

use std::collections::HashMap;

/// What a joint row belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum JointOwner {
    /// An impulse joint of rapier, by index and generation.
    Impulse(u32, u32),
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

/// The multipliers of the last step.
///
/// Looked up by key only, never iterated, so that results do not depend on hashing.
#[derive(Clone, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct JointMemory {
    #[cfg_attr(feature = "serde-serialize", serde(with = "crate::math::ordered"))]
    last: HashMap<JointKey, f64>,
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    next: HashMap<JointKey, f64>,
}

impl JointMemory {
    /// The position multiplier of a row in the last step (N or N m).
    pub fn recall(&self, key: &JointKey) -> f64 {
        self.last.get(key).copied().unwrap_or_default()
    }

    /// Notes a multiplier for the next step.
    pub fn remember(&mut self, key: JointKey, multiplier: f64) {
        self.next.insert(key, multiplier);
    }

    /// Makes the noted multipliers those of the last step.
    pub fn turn_over(&mut self) {
        std::mem::swap(&mut self.last, &mut self.next);
        self.next.clear();
    }

    /// Throws away what was noted since the last turn-over.
    pub fn discard_notes(&mut self) {
        self.next.clear();
    }
}
