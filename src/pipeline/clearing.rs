//! Writing reports: they are cleared with their buffers, and told what belongs to no island.

use super::participant::{Held, Participant};
use super::quality::Unsolved;
use super::report::StepReport;
use crate::coupling::RapierSets;

impl StepReport {
    /// Forgets the islands' solutions of a step that is solved again.
    pub(super) fn forget_solution(&mut self, dissipated: f64) {
        let before = std::mem::take(self);
        let (mut contacts, mut opened) = (before.contacts, before.opened);
        let mut joints = before.joints;
        contacts.clear();
        opened.clear();
        joints.clear();
        *self = Self {
            contacts,
            opened,
            joints,
            contacts_before: before.contacts_before,
            joints_before: before.joints_before,
            overbent: before.overbent,
            n_asleep: before.n_asleep,
            n_solves: before.n_solves,
            n_tried: before.n_tried,
            is_detected: before.is_detected,
            times: before.times,
            quarantined_flex_bodies: before.quarantined_flex_bodies,
            quarantined_bodies: before.quarantined_bodies,
            quarantined_colliders: before.quarantined_colliders,
            insertion_notes: before.insertion_notes,
            ..Self::default()
        };
        self.energy.dissipated = dissipated;
    }

    pub(super) fn clear(&mut self) {
        let contacts_before = std::mem::take(&mut self.contacts);
        let mut contacts = std::mem::take(&mut self.contacts_before);
        contacts.clear();
        let mut opened = std::mem::take(&mut self.opened);
        opened.clear();
        let joints_before = std::mem::take(&mut self.joints);
        let mut joints = std::mem::take(&mut self.joints_before);
        joints.clear();
        let mut overbent = std::mem::take(&mut self.overbent);
        overbent.clear();
        let dissipated = self.energy.dissipated;
        *self = Self {
            contacts,
            contacts_before,
            opened,
            joints,
            joints_before,
            overbent,
            ..Self::default()
        };
        self.energy.dissipated = dissipated;
    }

    /// Keeps the contacts of the step before of those who `sleep` and had no `part` in this one. What was solved is told as it was, whether
    /// its contacts have closed or opened: a body may fall asleep in the step that solves it.
    pub(super) fn keep_contacts(
        &mut self,
        sleeps: impl Fn(Participant) -> bool,
        part: impl Fn(Participant) -> bool,
    ) {
        let kept = self.contacts_before.iter().filter(|contact| {
            let pair = [contact.contactor, contact.target];
            pair.into_iter().any(&sleeps) && !pair.into_iter().any(&part)
        });
        self.contacts.extend(kept);
    }

    /// Keeps the joints of the step before that are not in this one and whose bodies `sleep`.
    pub(super) fn keep_joints(&mut self, sleep: impl Fn(Held) -> bool) {
        let n_solved = self.joints.len();
        for one in &self.joints_before {
            let is_solved = self.joints[..n_solved]
                .iter()
                .any(|own| own.joint == one.joint);
            if !is_solved && sleep(one.joint) {
                self.joints.push(*one);
            }
        }
    }

    /// The contacts of the step before, all of them, where nothing was solved.
    pub(super) fn keep_all_contacts(&mut self) {
        std::mem::swap(&mut self.contacts, &mut self.contacts_before);
    }

    /// Adds what rapier's last step disabled.
    pub(super) fn note_quarantine(&mut self, sets: &RapierSets<'_>) {
        let quarantine = sets.physics_pipeline.quarantine();
        self.quarantined_bodies
            .extend_from_slice(quarantine.bodies());
        self.quarantined_colliders
            .extend_from_slice(quarantine.colliders());
    }

    /// Tells that something was not solved.
    pub(super) fn tell(&mut self, unsolved: Unsolved) {
        self.quality = self.quality.max(unsolved.quality);
        self.gap_violation = self.gap_violation.max(unsolved.overlap);
        self.unsolved.push(unsolved);
    }

    /// Tells of an island that was not solved, once, whatever the number of its parts.
    pub(super) fn tell_again(&mut self, unsolved: Unsolved) {
        let Some(before) = self.unsolved.last_mut() else {
            return;
        };
        self.quality = self.quality.max(unsolved.quality);
        before.join(unsolved);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::ContactReport;
    use crate::rapier::prelude::ColliderHandle;

    fn touch(contactor: u32, target: u32, normal_force: f64) -> ContactReport {
        let [contactor, target] = [contactor, target]
            .map(|index| Participant::Rigid(ColliderHandle::from_raw_parts(index, 0)));
        ContactReport {
            position: [0.0; 2],
            normal: [0.0, 1.0],
            gap: 0.0,
            normal_force,
            tangential_force: 0.0,
            midway: [0.0; 2],
            sticks: false,
            contactor,
            target,
        }
    }

    /// 1 and 2 sleep, 3 is fixed; 4 and 5 take part, and 5 falls asleep in the step.
    #[test]
    fn contacts_are_kept_of_sleepers_that_had_no_part_in_the_step() {
        let mut report = StepReport::default();
        let before = [
            (1, 2),
            (1, 3),
            (3, 2),
            (1, 4),
            (4, 2),
            (5, 3),
            (5, 4),
            (4, 3),
        ];
        report.contacts_before = before.map(|(one, other)| touch(one, other, 7.0)).to_vec();
        report.contacts = vec![touch(5, 3, 8.0)];
        let among = |indices: &'static [u32]| {
            move |one: Participant| match one {
                Participant::Rigid(handle) => indices.contains(&handle.into_raw_parts().0),
                Participant::Flex(_) => false,
            }
        };
        report.keep_contacts(among(&[1, 2, 5]), among(&[4, 5]));
        let told = [(5, 3, 8.0), (1, 2, 7.0), (1, 3, 7.0), (3, 2, 7.0)];
        assert_eq!(
            report.contacts,
            told.map(|(one, other, force)| touch(one, other, force))
        );
    }
}
