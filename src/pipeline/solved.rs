//! A part of an island's step as it was solved, and what is read off it.

use super::entries::{ContactReport, Opened};
use super::names::Names;
use crate::constraint::contact::{ContactMemory, Remembered};
use crate::constraint::joint::JointMemory;
use crate::coupling::{PressedPoint, Seats, Span};
use crate::kkt::{ActiveContact, ActiveJoint, Island, IslandSummary};
use crate::linalg::complementarity::Status;
use crate::math::Vec2;
use crate::system::Step;

/// A part of the step of an island, as solved.
pub(super) struct SolvedPart<'a> {
    pub island: &'a Island,
    pub seats: &'a Seats,
    pub summary: &'a IslandSummary,
    pub step: Step,
    pub span: Span,
}

impl SolvedPart<'_> {
    /// Notes the multipliers that whatever is solved next begins with.
    pub fn remember(&self, contacts: &mut ContactMemory, joints: &mut JointMemory) {
        for contact in &self.island.contacts {
            let [normal, tangent] = contact.handed_on(self.step.dt);
            let state = Remembered {
                normal,
                tangent,
                lasting: contact.lasting(),
                feature: contact.kinematics.feature,
                parts: contact.allowance < 0.0,
            };
            contacts.remember(self.island.candidates[contact.candidate].key, state);
        }
        let of_joint =
            |one: &ActiveJoint, other: &ActiveJoint| one.row.key.owner == other.row.key.owner;
        for ties in self.island.joints.ties.chunk_by(of_joint) {
            // Where bodies turn, what one row has not closed yet is another one's.
            let closes = ties.iter().any(ActiveJoint::closes_on);
            for tie in ties {
                joints.remember(tie.row.key, tie.left_behind(closes));
            }
        }
    }

    /// Force of a contact (N), as a share of the step's.
    fn force(&self, contact: &ActiveContact) -> [f64; 2] {
        let force = contact.force(self.step.dt);
        force.map(|force| self.span.share() * force)
    }

    /// What it has beyond that as it acts midway through the step (N).
    fn midway(&self, contact: &ActiveContact) -> Vec2 {
        let [normal, tangent] = contact.midway_force(self.step.dt);
        let row = &contact.kinematics;
        self.span.share() * (normal * row.normal + tangent * row.tangent())
    }

    /// A contact as events tell of it, if it presses or is closed.
    pub fn pressed(&self, contact: &ActiveContact, names: Names<'_, '_>) -> Option<PressedPoint> {
        let force = self.force(contact);
        if !contact.is_closed() && force == [0.0; 2] {
            return None;
        }
        let key = self.island.candidates[contact.candidate].key;
        // Rapier knows no events of a collider with itself.
        if key.contactor == key.target {
            return None;
        }
        Some(PressedPoint {
            contactor: names.collider(key.contactor)?,
            target: names.collider(key.target)?,
            position: self.island.place_of(contact),
            normal: contact.kinematics.normal,
            gap: contact.gap(),
            force,
            is_closed: contact.is_closed(),
            was_above: false,
        })
    }

    /// What has been given at an open contact, if anything has.
    pub fn opened(&self, contact: &ActiveContact, names: Names<'_, '_>) -> Option<Opened> {
        let [normal, tangent] = self.force(contact);
        let row = &contact.kinematics;
        let force = normal * row.normal + tangent * row.tangent() + self.midway(contact);
        if force == Vec2::zeros() {
            return None;
        }
        let key = self.island.candidates[contact.candidate].key;
        Some(Opened {
            between: [
                names.participant(key.contactor)?,
                names.participant(key.target)?,
            ],
            force: force.into(),
        })
    }

    /// A closed contact as the report tells of it.
    pub fn contact_report(
        &self,
        contact: &ActiveContact,
        names: Names<'_, '_>,
    ) -> Option<ContactReport> {
        let key = self.island.candidates[contact.candidate].key;
        let [normal_force, tangential_force] = self.force(contact);
        Some(ContactReport {
            position: self.island.place_of(contact).into(),
            normal: contact.kinematics.normal.into(),
            gap: contact.gap(),
            normal_force,
            tangential_force,
            midway: self.midway(contact).into(),
            sticks: contact.status[1] == Status::Stick,
            contactor: names.participant(key.contactor)?,
            target: names.participant(key.target)?,
        })
    }
}

/// How often a part of the smallest length that has found no end is halved all the same: it would be left with another motion than its own.
pub(super) const FURTHER: usize = 3;

/// Parts of a step that are halved though they have the smallest length: as many as one part makes that is halved so at every level. What fails
/// in more of them is jammed, and would fail in all.
const MOST_FURTHER: usize = 1 << FURTHER;

/// What has been entered of one island, whose step may be taken in parts.
pub(super) struct Entry {
    /// Where its contacts and joints begin in the report.
    pub first_contact: usize,
    pub first_joint: usize,
    /// Where its impulses on rapier's joints begin in the outcome.
    pub first_impulse: usize,
    /// Parts that are over.
    pub n_parts: usize,
    /// Parts that were halved though they had the smallest length.
    n_further: usize,
    /// Whether the report tells that one of the parts was not solved.
    pub is_told: bool,
    /// Whether one of the parts ended before the laws held: its members have not come to rest, however still they are.
    pub is_unfinished: bool,
    /// What it has been counted for in the report.
    counted: [bool; 2],
}

impl Entry {
    /// Of an island of which nothing has been entered: where its contacts and joints begin in the report, and its impulses.
    pub fn begin([first_contact, first_joint, first_impulse]: [usize; 3]) -> Self {
        Self {
            first_contact,
            first_joint,
            first_impulse,
            n_parts: 0,
            n_further: 0,
            is_told: false,
            is_unfinished: false,
            counted: [false; 2],
        }
    }

    /// Whether a part that has found no end may be halved further; counts it if so.
    pub fn may_go_further(&mut self) -> bool {
        let may = self.n_further < MOST_FURTHER;
        self.n_further += usize::from(may);
        may
    }

    /// What of this happens for the first time in the step of the island: it is counted once, whatever the number of its parts.
    pub fn count(&mut self, happened: [bool; 2]) -> [usize; 2] {
        let pairs = self.counted.iter_mut().zip(happened);
        let mut new = [0; 2];
        for ((counted, happened), new) in pairs.zip(&mut new) {
            *new = usize::from(happened && !*counted);
            *counted |= happened;
        }
        new
    }
}

#[cfg(test)]
mod tests {
    use super::Entry;

    /// An island whose step is taken in parts counts once for what happens in several of them.
    #[test]
    fn what_happens_in_two_parts_of_a_step_is_counted_once() {
        let mut entry = Entry::begin([0; 3]);
        assert_eq!(entry.count([true, false]), [1, 0]);
        assert_eq!(entry.count([true, true]), [0, 1]);
        assert_eq!(entry.count([true, true]), [0; 2]);
    }
}
