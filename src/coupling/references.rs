//! The faces that pairs of rigid parts were measured to in the last step: a stack of equal boxes would otherwise swap
//! contactor and target by rounding, and forget its multipliers.

use crate::constraint::contact::Owner;
use crate::constraint::geometry::PairReference;
use crate::math::HashMap;

/// A part of a collider.
type PartName = (Owner, u32);

/// Reference faces by pair, looked up by key only.
#[derive(Clone, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct References {
    #[cfg_attr(feature = "serde-serialize", serde(with = "crate::math::ordered"))]
    last: HashMap<[PartName; 2], PairReference>,
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    next: HashMap<[PartName; 2], PairReference>,
}

impl References {
    /// The reference of the last step, for the parts in the order given.
    pub fn recall(&self, parts: [PartName; 2]) -> Option<PairReference> {
        let (key, is_swapped) = ordered(parts);
        let found = *self.last.get(&key)?;
        Some(PairReference {
            on_b: found.on_b != is_swapped,
            ..found
        })
    }

    /// Notes a reference for the next step.
    pub fn remember(&mut self, parts: [PartName; 2], reference: Option<PairReference>) {
        let (key, is_swapped) = ordered(parts);
        if let Some(found) = reference {
            let kept = PairReference {
                on_b: found.on_b != is_swapped,
                ..found
            };
            self.next.insert(key, kept);
        }
    }

    /// Makes what was noted that of the last step.
    pub fn turn_over(&mut self) {
        std::mem::swap(&mut self.last, &mut self.next);
        self.next.clear();
    }

    /// Keeps references of the last step that nobody noted anew, of owners that `sleeps` names.
    pub fn keep(&mut self, sleeps: impl Fn(Owner) -> bool) {
        for (key, reference) in &self.last {
            if key.iter().any(|&(owner, _)| sleeps(owner)) {
                self.next.entry(*key).or_insert(*reference);
            }
        }
    }

    /// Throws away what was noted since the last turn-over.
    pub fn discard_notes(&mut self) {
        self.next.clear();
    }
}

fn ordered([one, other]: [PartName; 2]) -> ([PartName; 2], bool) {
    if one <= other {
        ([one, other], false)
    } else {
        ([other, one], true)
    }
}
