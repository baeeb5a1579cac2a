//! What pressed at the beginning of the step and is near no more.

use super::Island;
use crate::kkt::island::{ActiveContact, AtBase};

impl Island {
    /// Notes what pressed in the last step: the first list of near pairs has just been made.
    pub(super) fn note_pressing(&mut self) {
        let pressing = |contact: &&ActiveContact| contact.remembered.normal > 0.0;
        self.parted.clear();
        self.parted
            .extend(self.contacts.iter().filter(pressing).copied());
    }

    /// Lists what pressed in the last step and has flown out of reach as open contacts. Part of that force still acts in this step, and what
    /// energy it adds there can be taken back along its row only.
    ///
    /// The iterations are over: nothing is lost any more.
    pub(in crate::kkt) fn list_parted(&mut self) {
        for contact in &mut self.contacts {
            contact.is_lost = false;
        }
        for slot in 0..self.parted.len() {
            let before = self.parted[slot];
            let Some(base) = before.base else {
                continue;
            };
            if self
                .contacts
                .iter()
                .any(|contact| contact.candidate == before.candidate)
            {
                continue;
            }
            let gap = f64::INFINITY;
            let mut parted = ActiveContact {
                multiplier: [0.0; 2],
                impulse: [0.0; 2],
                is_lost: false,
                base: Some(AtBase { gap, ..base }),
                ..before
            };
            parted.kinematics.gap = gap;
            self.contacts.push(parted);
        }
    }
}
