//! Steps in which everything sleeps, and what ends them.

use super::flex_pipeline::FlexPipeline;
use crate::body::FlexBodySet;
use crate::coupling::RapierSets;

impl FlexPipeline {
    /// Rapier's own step, where everything sleeps: the contacts of `n` flexible bodies stay as they are.
    pub(super) fn step_asleep(&mut self, sets: &mut RapierSets<'_>, n: usize) {
        let gate = self.hook_gate(sets.hooks, true);
        sets.step_through(&gate, &self.events.gate(sets.events, Some(&self.claims)));
        if !self.events.is_empty() {
            self.events.tell(sets);
        }
        self.report.note_quarantine(sets);
        self.report.n_asleep = n;
        self.report.keep_all_contacts();
    }

    /// Wakes what rested on, or beside, something that was changed: rapier's detection step knows who touched it, places tell the rest.
    pub(super) fn wake_for_changes(
        &mut self,
        sets: &mut RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) {
        self.claims.wake_beside_changes(sets, flex_bodies);
        self.detect(sets);
        self.report.note_quarantine(sets);
        self.claims.note_changes_taken_over(sets);
    }
}
