//! Places that the whole of a step has reached, under forces that are not quite those of the laws.
//!
//! Where no forces hold to the laws, the best of these places ends the step: first one where gaps and slips miss them by less than the
//! margins of the ways, then one where a contact has slid off the surface that it pressed on, as if that went on. An implicit step has
//! no other end there: with the force the contact is over before the step is, and without it the bodies end in one another, however
//! short the step.

use super::{Island, Passed};

impl Island {
    /// How far the laws are from holding, relative to the margins of the ways (-); what has slid off counts only with `counts_lost`.
    pub(super) fn shortfall(&mut self, counts_lost: bool) -> f64 {
        let least = self.margin;
        let mut worst = self.measure_joints() / least;
        let counted = |is_lost: bool| counts_lost || !is_lost;
        for contact in self.contacts.iter().filter(|one| counted(one.is_lost)) {
            let friction = self.candidates[contact.candidate].law.friction;
            let margin = contact
                .base
                .map_or(least, |base| self.path.margin(&base.near));
            worst = worst.max(contact.shortfall(friction) / margin);
        }
        worst
    }

    /// Keeps the base, which the whole of the step has reached, if it is the best of its kind so far.
    pub(super) fn keep_arrival(&mut self) {
        let has_left = self.note_left();
        if self.leads_around() {
            return;
        }
        let error = self.shortfall(false);
        let kept = if has_left {
            &mut self.departure
        } else {
            &mut self.arrival
        };
        if error >= 1.0 || kept.is_known && error >= kept.error {
            return;
        }
        let mut stage = std::mem::take(kept);
        self.keep(&mut stage, error);
        if has_left {
            self.departure = stage;
        } else {
            self.arrival = stage;
        }
    }

    /// Ends the step at the best place that the whole of it has reached, if there is one.
    pub(super) fn end_at_arrival(&mut self) -> Option<Passed> {
        let is_arrival = self.arrival.is_known;
        if !is_arrival && !self.departure.is_known {
            return None;
        }
        let kept = if is_arrival {
            &mut self.arrival
        } else {
            &mut self.departure
        };
        let stage = std::mem::take(kept);
        self.return_to(&stage);
        self.keep_applied_rows();
        if is_arrival {
            self.arrival = stage;
        } else {
            self.departure = stage;
        }
        self.correct();
        Some(Passed::Arrived)
    }
}
