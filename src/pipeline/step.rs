//! The step as the list of its stages.

use super::checks::{check_bodies, check_colliders, check_step};
use super::clock::Clock;
use super::error::StepError;
use super::flex_pipeline::FlexPipeline;
use super::joint_accounts::{commit_attachments, drop_orphans, joins_sleepers};
use super::notes::notes_of_newcomers;
use super::overbent::list_overbent;
use crate::body::FlexBodySet;
use crate::coupling::{
    Loan, RapierSets, WorldChange, disable_joints_of_disabled, look_whether_still, quarantine,
    quarantine_carriers, rests, stop_if_asleep, sync_settings, wake_disturbed, write_impulses,
    write_surface,
};
use crate::system::Step;

impl FlexPipeline {
    /// Takes the step; a body that would end where no number is leaves the world, and the step is tried again without it: one sick body does
    /// not stop the world.
    pub(super) fn step_without_the_sick(
        &mut self,
        sets: &mut RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
    ) -> Result<(), StepError> {
        self.sick.clear();
        quarantine_carriers(sets, flex_bodies, &mut self.sick);
        // What rapier disabled in a try is not disabled again in the next.
        let (mut bodies, mut colliders) = (Vec::new(), Vec::new());
        loop {
            match self.try_step(sets, flex_bodies) {
                Err(StepError::NotFinite(body)) if !self.sick.contains(&body) => {
                    let quarantine_of_rapier = sets.physics_pipeline.quarantine();
                    bodies.extend_from_slice(quarantine_of_rapier.bodies());
                    colliders.extend_from_slice(quarantine_of_rapier.colliders());
                    quarantine(body, sets, flex_bodies);
                    self.sick.push(body);
                }
                Err(error) => return Err(error),
                Ok(()) => break,
            }
        }
        let report = &mut self.report;
        report.quarantined_bodies.append(&mut bodies);
        report.quarantined_colliders.append(&mut colliders);
        report.quarantined_flex_bodies.extend_from_slice(&self.sick);
        Ok(())
    }

    /// One try of a step.
    fn try_step(
        &mut self,
        sets: &mut RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
    ) -> Result<(), StepError> {
        self.report.clear();
        if flex_bodies.is_empty() {
            self.step_without_flex_bodies(sets);
            return Ok(());
        }
        let mut clock = Clock::start();
        let dissipated = self.report.energy.dissipated;
        let step = check_step(&self.parameters, sets)?;
        drop_orphans(sets, flex_bodies);
        disable_joints_of_disabled(sets);
        let change = self.claims.look_for_changes(sets, flex_bodies);
        check_colliders(sets, self.claims.marked_colliders())?;
        let is_quiet = step.dt > 0.0 && change == WorldChange::None;
        if is_quiet && self.claims.is_all_asleep(sets, flex_bodies) {
            self.step_asleep(sets, flex_bodies);
            return Ok(());
        }
        check_bodies(&self.parameters, step.dt, sets, flex_bodies)?;
        self.wake(change, sets, flex_bodies);
        self.claim(step, change, sets, flex_bodies, &mut clock)?;
        if step.dt == 0.0 {
            // The tree may be out to be optimized: a detection step without changes puts it back for queries.
            self.detect(sets);
            self.events.tell_detected(sets);
            return Ok(());
        }
        if let Err(error) = self.solve_and_look(step, sets, flex_bodies, &mut clock) {
            let is_detected = self.report.is_detected;
            self.undo(flex_bodies, dissipated);
            if is_detected {
                // As above.
                self.detect(sets);
            }
            return Err(error);
        }
        self.take_step(step, sets, flex_bodies, &mut clock);
        self.commit(sets, flex_bodies);
        self.events.tell(sets);
        clock.lap(&mut self.report.times.hand_back);
        Ok(())
    }

    fn step_without_flex_bodies(&mut self, sets: &mut RapierSets<'_>) {
        if self.events.is_empty() {
            sets.step();
        } else {
            sets.step_through(sets.hooks, &self.events.gate(sets.events, None));
            self.events.tell(sets);
        }
    }

    /// Rapier's own step, where everything sleeps: the contacts of flexible bodies stay as they are.
    fn step_asleep(&mut self, sets: &mut RapierSets<'_>, flex_bodies: &FlexBodySet) {
        let book = &self.memory.hooks;
        let gate = self.lent.gate(sets.hooks, book, &self.claims, true);
        sets.step_through(&gate, &self.events.gate(sets.events, Some(&self.claims)));
        if !self.events.is_empty() {
            self.events.tell(sets);
        }
        self.report.note_quarantine(sets);
        self.report.n_asleep = flex_bodies.len();
        self.tell_what_was_put_together(sets, flex_bodies);
        self.report.keep_all_contacts();
        self.report.keep_joints(|held| joins_sleepers(held, sets));
    }

    /// Wakes what the user has disturbed, and what rested on, or beside, something that was changed: rapier's detection step knows who
    /// touched it, places tell the rest.
    fn wake(
        &mut self,
        change: WorldChange,
        sets: &mut RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
    ) {
        self.claims.note_world(sets);
        sync_settings(flex_bodies, sets.colliders);
        wake_disturbed(sets, flex_bodies, change == WorldChange::Everywhere);
        if change == WorldChange::Somewhere {
            self.claims.wake_beside_changes(sets, flex_bodies);
            self.detect(sets);
            self.report.note_quarantine(sets);
            self.claims.note_changes_taken_over(sets);
        }
    }

    /// Looks ahead until nothing that sleeps is met.
    fn look_ahead(&mut self, sets: &mut RapierSets<'_>, flex_bodies: &FlexBodySet) {
        self.claims.look_ahead(sets, flex_bodies);
        while self.claims.wake_met(sets) {
            self.claims.look_ahead(sets, flex_bodies);
        }
        self.report.n_asleep = self.claims.flex.asleep().len();
    }

    /// Looks ahead, detects where that is needed, and claims; in a step without length it ends with the detection.
    fn claim(
        &mut self,
        step: Step,
        change: WorldChange,
        sets: &mut RapierSets<'_>,
        flex_bodies: &FlexBodySet,
        clock: &mut Clock,
    ) -> Result<(), StepError> {
        self.claims.bind(self.memory.masters.bonds(), sets.bodies);
        self.look_ahead(sets, flex_bodies);
        if let Some(joint) = self.claims.flex.joint_to_carrier(sets) {
            return Err(StepError::CarrierJoint(joint));
        }
        let was_detected = change == WorldChange::Somewhere;
        let is_detected = step.dt == 0.0 || was_detected || self.claims.needs_detection(sets);
        clock.lap(&mut self.report.times.claim);
        self.report.is_detected = is_detected;
        if is_detected {
            if !was_detected {
                self.detect(sets);
                self.report.note_quarantine(sets);
            }
            clock.lap(&mut self.report.times.rapier);
            if step.dt == 0.0 {
                return Ok(());
            }
            self.claims.sweep(sets);
        }
        self.claims.walk(sets);
        while self.claims.wake_touched(sets) {
            self.look_ahead(sets, flex_bodies);
            if is_detected {
                self.claims.sweep(sets);
            }
            self.claims.walk(sets);
        }
        self.solver.retain(sets, flex_bodies);
        let notes = notes_of_newcomers(&self.claims, sets, flex_bodies, &mut self.put_together);
        self.report.insertion_notes.extend(notes);
        clock.lap(&mut self.report.times.claim);
        Ok(())
    }

    /// Rapier's step without length: what it stops is not told before the full step confirms it.
    pub(super) fn detect(&self, sets: &mut RapierSets<'_>) {
        let book = &self.memory.hooks;
        let gate = self.lent.gate(sets.hooks, book, &self.claims, false);
        sets.detect_through(&gate, &self.events.gate(sets.events, None));
    }

    /// Leaves no trace of a step that failed, before which energy of `dissipated` was lost (J).
    fn undo(&mut self, flex_bodies: &mut FlexBodySet, dissipated: f64) {
        self.outcome.clear();
        self.events.discard_notes();
        self.memory.discard_notes();
        self.report.clear();
        self.report.energy.dissipated = dissipated;
        for (_, body) in flex_bodies.iter_mut() {
            body.forget_start();
        }
    }

    /// Leads rapier's world through its full step to where the islands end.
    fn take_step(
        &mut self,
        step: Step,
        sets: &mut RapierSets<'_>,
        flex_bodies: &FlexBodySet,
        clock: &mut Clock,
    ) {
        self.outcome
            .keep_awake(self.solver.pool(), sets, flex_bodies);
        let events = self.events.gate(sets.events, Some(&self.claims));
        let mut loan = Loan::new(&mut self.lent, &self.outcome.landings, sets);
        clock.lap(&mut self.report.times.hand_back);
        loan.step(&self.memory.hooks, &self.claims, &events);
        self.report.note_quarantine(loan.sets());
        clock.lap(&mut self.report.times.rapier);
        self.outcome
            .wake_moving(self.solver.pool(), loan.sets(), flex_bodies);
        let is_led = self.parameters.leads(step);
        loan.land(&self.outcome.landings, is_led, &mut self.memory.masters);
        write_impulses(&self.outcome.joint_impulses, sets);
    }

    /// Makes the solved motions the committed ones, writes the surfaces, and tells of what the step has left behind.
    fn commit(&mut self, sets: &mut RapierSets<'_>, flex_bodies: &mut FlexBodySet) {
        commit_attachments(&self.report, flex_bodies);
        let flex = &self.claims.flex;
        if !flex.asleep().is_empty() {
            self.memory.keep(|owner| flex.sleeps(sets, owner));
            self.report.keep_contacts(
                |one| flex.sleeps(sets, one.owner()),
                |one| self.claims.moves(one.owner(), sets),
            );
            self.report.keep_joints(|held| joins_sleepers(held, sets));
        }
        self.memory.turn_over();
        for end in &self.outcome.flexible {
            let Some(body) = flex_bodies.at_index_mut(end.index) else {
                continue;
            };
            body.set_energy_reserve(end.reserve);
            body.keep_forces(end.index, &self.outcome.kept_forces);
            body.count_step(end.is_unfinished);
            self.solver.commit(end.index, body);
            look_whether_still(body, sets);
            let is_still = rests(body, sets);
            write_surface(
                body,
                is_still,
                sets.colliders,
                sets.broad_phase,
                sets.integration_parameters,
            );
            stop_if_asleep(body, sets.bodies);
            body.greet();
        }
        let solved = self.outcome.flexible.iter().map(|end| end.index);
        list_overbent(solved, flex_bodies, &mut self.report.overbent);
        let known = self.report.gap_violation;
        let claims = &mut self.claims;
        for one in self.trespassers.find(claims, sets, flex_bodies, known) {
            self.report.tell(one.into());
        }
        self.tell_what_was_put_together(sets, flex_bodies);
    }

    /// Tells how deep what the user has put into each other still is.
    fn tell_what_was_put_together(&mut self, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) {
        let depth = self
            .put_together
            .measure(&mut self.claims, sets, flex_bodies);
        self.report.gap_violation = self.report.gap_violation.max(depth);
    }
}
