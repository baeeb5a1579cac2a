//! Reports are cleared, and kept, with their buffers.

use super::report::StepReport;

impl StepReport {
    /// Forgets the islands' solutions of a step that is solved again.
    pub(super) fn forget_solution(&mut self, dissipated: f64) {
        let before = std::mem::take(self);
        let (mut contacts, mut joints) = (before.contacts, before.joints);
        contacts.clear();
        joints.clear();
        *self = Self {
            contacts,
            joints,
            contacts_before: before.contacts_before,
            overbent: before.overbent,
            n_asleep: before.n_asleep,
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
        let mut joints = std::mem::take(&mut self.joints);
        joints.clear();
        let mut overbent = std::mem::take(&mut self.overbent);
        overbent.clear();
        let dissipated = self.energy.dissipated;
        *self = Self {
            contacts,
            contacts_before,
            joints,
            overbent,
            ..Self::default()
        };
        self.energy.dissipated = dissipated;
    }
}
