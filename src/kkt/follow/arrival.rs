//! Places that the whole of a step has reached, under forces that are not quite those of the laws.
//!
//! Where no forces hold to the laws, the best of these places ends the step: first one where gaps and slips miss them by less than the
//! margins of the ways, then one where a contact has slid off the surface that it pressed on, as if that went on. An implicit step has
//! no other end there: with the force the contact is over before the step is, and without it the bodies end in one another, however
//! short the step.

use super::{Island, Passed};
use crate::constraint::joint::JointGrip;
use crate::kkt::feasible::KeptBase;
use crate::kkt::island::ActiveContact;
use crate::kkt::joint_rows::ActiveJoint;

/// A state on the way, with the forces that belong to it.
#[derive(Debug, Default)]
pub(in crate::kkt) struct Stage {
    pub(super) is_known: bool,
    pub(super) contacts: Vec<ActiveContact>,
    pub(super) ties: Vec<ActiveJoint>,
    grips: Vec<JointGrip>,
    base: KeptBase,
    /// How far the laws are from holding, relative to the margins (-).
    error: f64,
}

impl Island {
    /// How far the laws are from holding, relative to the margins of the ways (-), a number if all of them are; what has slid off counts only with
    /// `counts_lost`.
    pub(super) fn shortfall(&mut self, counts_lost: bool) -> f64 {
        let least = self.margin;
        let mut worst = self.measure_joints() / least;
        let counted = |is_lost: bool| counts_lost || !is_lost;
        for contact in self.contacts.iter().filter(|one| counted(one.is_lost)) {
            let friction = self.candidates[contact.candidate].law.friction;
            let margin = contact
                .base
                .map_or(least, |base| self.path.margin(&base.near));
            // What is lost misses as much as there are numbers for, over a margin more: infinite is what nobody has measured.
            let missed = contact.shortfall(friction);
            let share = if missed == f64::MAX {
                missed
            } else {
                missed / margin
            };
            worst = worst.max(share);
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

    /// Keeps the base of the first impact of a step, and the forces that answer it.
    pub(super) fn keep_impact(&mut self) {
        let mut stage = std::mem::take(&mut self.impact);
        self.keep(&mut stage, 0.0);
        self.impact = stage;
    }

    /// Goes back to the first impact; returns whether there was one.
    pub(in crate::kkt) fn return_to_first_stop(&mut self) -> bool {
        if !self.impact.is_known {
            return false;
        }
        let stage = std::mem::take(&mut self.impact);
        self.return_to(&stage);
        self.impact = stage;
        true
    }

    fn keep(&self, stage: &mut Stage, error: f64) {
        stage.is_known = true;
        stage.error = error;
        stage.contacts.clone_from(&self.contacts);
        stage.ties.clone_from(&self.ties);
        stage.grips.clone_from(&self.joint_grips);
        self.path.keep_base(&mut stage.base);
    }

    /// Puts the forces and the blocks back. Forces alone do not tell where a body is that turns under them: what is found from them begins
    /// there.
    fn return_to(&mut self, stage: &Stage) {
        self.contacts.clone_from(&stage.contacts);
        self.ties.clone_from(&stage.ties);
        self.joint_grips.clone_from(&stage.grips);
        self.path.return_to(&stage.base);
        self.path.stop(&mut self.blocks);
    }
}

#[cfg(test)]
mod tests {
    use super::super::FEW_PASSES;
    use super::super::trend::Trend;
    use super::*;
    use crate::constraint::contact::{
        Candidate, ContactKey, ContactLaw, Kinematics, Owner, Pair, Remembered,
    };
    use crate::math::Vec2;

    /// A contact that is lost in every pass misses its law by a number, whatever the margin is, and the passes are given up.
    #[test]
    fn passes_that_what_is_lost_holds_up_are_given_up() {
        for margin in [1e-3, 10.0] {
            let mut island = Island {
                margin,
                ..Island::default()
            };
            island.candidates.push(Candidate {
                key: ContactKey {
                    contactor: Owner::Flex(0),
                    point: 0,
                    target: Owner::Collider(0),
                    part: 0,
                },
                pair: Pair::Near { blocks: [0, 1] },
                law: ContactLaw::default(),
            });
            let row = Kinematics::with_levers(0.0, Vec2::new(0.0, 1.0), Vec2::zeros(), &[]);
            let mut contact = ActiveContact::new(0, row, Remembered::default(), 0.0, &[]);
            contact.is_lost = true;
            island.contacts.push(contact);
            assert_eq!(island.shortfall(false), 0.0);
            let mut trend = Trend::new();
            let given_up =
                (0..20).find(|pass| trend.is_hopeless(island.shortfall(true), 19 - pass));
            assert_eq!(given_up, Some(FEW_PASSES), "margin {margin} m");
        }
    }
}
