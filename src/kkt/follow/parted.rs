//! What pressed at the beginning of the step and is near no more.

use super::Island;
use crate::kkt::island::{ActiveContact, AtBase};

/// Notes what pressed in the last step: the first list of near pairs has just been made.
pub(super) fn note_pressing(island: &mut Island) {
    let pressing = |contact: &&ActiveContact| contact.remembered.normal > 0.0;
    island.passes.parted.clear();
    island
        .passes
        .parted
        .extend(island.contacts.iter().filter(pressing).copied());
    let candidates = island.passes.parted.iter().map(|contact| contact.candidate);
    island.passes.pressed.clear();
    island.passes.pressed.extend(candidates);
    island.passes.pressed.sort_unstable();
}

/// Lists what pressed in the last step and has flown out of reach as open contacts. Part of that force still acts in this step, and what
/// energy it adds there can be taken back along its row only.
pub(in crate::kkt) fn list_parted(island: &mut Island) {
    end_losses(island);
    let listed = island.contacts.iter().map(|contact| contact.candidate);
    island.passes.listed.clear();
    island.passes.listed.extend(listed);
    island.passes.listed.sort_unstable();
    for slot in 0..island.passes.parted.len() {
        let before = island.passes.parted[slot];
        let Some(base) = before.base else {
            continue;
        };
        let found = island.passes.listed.binary_search(&before.candidate);
        if found.is_ok() {
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
        island.contacts.push(parted);
    }
}

/// The iterations are over: nothing is lost any more. What geometry has no gap for, and does not press, is out of reach.
pub(in crate::kkt) fn end_losses(island: &mut Island) {
    for contact in island.contacts.iter_mut().filter(|one| one.is_lost) {
        contact.is_lost = false;
        if contact.multiplier[0] <= f64::MIN_POSITIVE {
            contact.multiplier = [0.0; 2];
            contact.kinematics.gap = f64::INFINITY;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraint::contact::{Kinematics, Remembered};
    use crate::kkt::working_set;
    use crate::math::Vec2;

    /// What geometry has no gap for has none to tell of; what presses without one keeps the last.
    #[test]
    fn what_is_lost_and_does_not_press_tells_of_no_overlap() {
        let row = Kinematics::with_levers(-3.0, Vec2::new(0.0, 1.0), Vec2::zeros(), &[]);
        for (force, told) in [(0.0, 0.0), (f64::MIN_POSITIVE, 0.0), (1.0, 3.0)] {
            let mut contact = ActiveContact::new(0, row, Remembered::default(), 0.5, &[]);
            contact.multiplier[0] = force;
            contact.is_lost = true;
            let mut island = Island::default();
            island.contacts.push(contact);
            end_losses(&mut island);
            assert!(!island.contacts[0].is_lost);
            assert_eq!(island.contacts[0].is_closed(), told > 0.0);
            for is_stopped in [true, false] {
                assert_eq!(working_set::gap_violation(&island, is_stopped), told);
            }
        }
    }
}
