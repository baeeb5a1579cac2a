//! What a contact remembers from one step to the next: multipliers for the warm start, the feature it touched.

use super::candidate::{ContactKey, Owner};
use crate::constraint::geometry::Feature;
use crate::math::{HashMap, HashSet};

/// The last state of one contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Remembered {
    /// Normal multiplier of the position stage, compressive positive (N).
    pub normal: f64,
    /// Tangential multiplier (N).
    pub tangent: f64,
    /// What of both is left in the stored accelerations (N).
    pub lasting: [f64; 2],
    /// Feature of the target that was touched, for hysteresis.
    pub feature: Option<Feature>,
    /// Whether a part of an overlap was left for later.
    pub parts: bool,
}

/// All contacts of the last step that were closed or near.
///
/// Looked up by key, and listed into a set only, so that results do not depend on hashing.
#[derive(Clone, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct ContactMemory {
    #[cfg_attr(feature = "serde-serialize", serde(with = "crate::math::ordered"))]
    last: HashMap<ContactKey, Remembered>,
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    next: HashMap<ContactKey, Remembered>,
    /// Who pressed whom in the last step; see [`ContactKey::owners`].
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pressed: HashSet<[Owner; 2]>,
    /// Who was near whom.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    near: HashSet<[Owner; 2]>,
}

impl ContactMemory {
    /// The state of a contact in the last step.
    pub fn recall(&self, key: &ContactKey) -> Remembered {
        self.last.get(key).copied().unwrap_or_default()
    }

    /// Whether two owners pressed each other in the last step, by any of their points.
    pub fn has_pressed(&self, [one, other]: [Owner; 2]) -> bool {
        self.pressed.contains(&[one.min(other), one.max(other)])
    }

    /// Whether a contact begins with an overlap that the last step has not made: its owners were not near each other then, or it was
    /// left a part of an overlap.
    pub fn finds_overlap(&self, key: &ContactKey) -> bool {
        let parts = self.last.get(key).is_some_and(|state| state.parts);
        parts || !self.near.contains(&key.owners())
    }

    /// Notes the state of a contact for the next step.
    pub fn remember(&mut self, key: ContactKey, state: Remembered) {
        self.next.insert(key, state);
    }

    /// Makes the noted states those of the last step.
    pub fn turn_over(&mut self) {
        std::mem::swap(&mut self.last, &mut self.next);
        self.next.clear();
        self.list_owners();
    }

    /// Lists who presses whom, and who is near whom, once for all islands.
    pub fn list_owners(&mut self) {
        self.pressed.clear();
        let pressed = self.last.iter().filter(|(_, state)| state.normal > 0.0);
        self.pressed.extend(pressed.map(|(key, _)| key.owners()));
        self.near.clear();
        self.near.extend(self.last.keys().map(ContactKey::owners));
    }

    /// Keeps the states of the last step that nobody noted anew and that `sleeps` names.
    pub fn keep(&mut self, sleeps: impl Fn(&ContactKey) -> bool) {
        for (key, state) in &self.last {
            if sleeps(key) {
                self.next.entry(*key).or_insert(*state);
            }
        }
    }

    /// Throws away what was noted since the last turn-over.
    pub fn discard_notes(&mut self) {
        self.next.clear();
    }
}
