//! Cutback: what is not solved in one piece is solved in halves, these in halves again, as implicit codes do.
//!
//! Only the island that asks for it is cut, on our side: rapier takes the whole step at once. The report tells of the step as a whole:
//! impulses of the parts over its length, what dissipates summed, the rest as it is at the end.

use super::checks::SHORTEST;
use super::clock::Clock;
use super::error::StepError;
use super::flex_pipeline::FlexPipeline;
use super::quality::Quality;
use super::report::{ContactReport, JointReport, StepReport};
use crate::body::FlexBodySet;
use crate::coupling::{RapierSets, Span};
use crate::kkt::GAINED;
use crate::system::Step;

/// Energy gained in a step, relative to what there was and was brought, that no swing of stored accelerations explains (-).
const DOUBLED: f64 = 1.0;

impl FlexPipeline {
    /// Solves the step of one island, in parts if it must be.
    pub(super) fn solve_island(
        &mut self,
        component: usize,
        step: Step,
        sets: &RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        clock: &mut Clock,
    ) -> Result<(), StepError> {
        let report = &self.report;
        let firsts = [
            report.contacts.len(),
            report.joints.len(),
            self.joint_impulses.len(),
        ];
        self.gatherer.under_way.begin(firsts);
        let whole = (component, Span::WHOLE, 0);
        let outcome = self.solve_parts(whole, step, sets, flex_bodies, clock);
        let under_way = &mut self.gatherer.under_way;
        under_way.end(flex_bodies);
        self.report.n_parts = self.report.n_parts.max(under_way.n_parts);
        outcome
    }

    /// Whether a part of the step of the island that was gathered, which has been cut `n_cuts` times, may be solved in halves. Links of
    /// multibodies move as rapier moves them, in one piece.
    pub(super) fn may_be_cut(&self, step: Step, n_cuts: usize) -> bool {
        let most = match self.island.has_large() {
            true => self.parameters.max_cutbacks_large,
            false => self.parameters.max_cutbacks,
        };
        let is_long = 0.5 * step.dt >= SHORTEST;
        n_cuts < most && is_long && !step.is_explicit() && self.gatherer.links.is_empty()
    }

    /// Solves a part of the step that has been cut `n_cuts` times, in halves if it is not solved in one piece.
    fn solve_parts(
        &mut self,
        (component, span, n_cuts): (usize, Span, usize),
        step: Step,
        sets: &RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        clock: &mut Clock,
    ) -> Result<(), StepError> {
        let (summary, [before, reserve]) =
            self.solve_span((component, span, n_cuts), step, sets, flex_bodies, clock)?;
        // What contact adds and cannot take back is the error of a step that is longer than the impact; what is parted costs energy at any pace.
        // What joints leave in stored accelerations swings, and a change of the step's length makes it swing more: with joints it must be as
        // much as there was, on a path.
        let share = match (self.island.ties.is_empty(), self.leads(step)) {
            (true, _) => GAINED,
            (false, true) => DOUBLED,
            (false, false) => f64::INFINITY,
        };
        let owes_more = -reserve > share * summary.brought() + (-before).max(0.0);
        let is_coarse = owes_more && !summary.is_parting;
        if self.may_be_cut(step, n_cuts) && (is_coarse || summary.quality() != Quality::Solved) {
            let half = step.halved(&self.integrator());
            self.gatherer.under_way.keep(&self.island, flex_bodies);
            for part in span.halves() {
                self.gatherer.give_back(&mut self.island);
                let part = (component, part, n_cuts + 1);
                self.solve_parts(part, half, sets, flex_bodies, clock)?;
            }
            return Ok(());
        }
        self.note((step, span), &summary, reserve, sets, flex_bodies);
        let under_way = &mut self.gatherer.under_way;
        under_way.n_parts += 1;
        if !span.is_last() {
            let bodies = &self.gatherer.bodies;
            under_way.go_on(&self.island, bodies, reserve, span, flex_bodies);
        }
        Ok(())
    }
}

impl StepReport {
    /// Adds what contacts pressed in earlier parts of the step, the contacts from the `first` on, to those of the last part, from `own` on:
    /// one that has opened since stays with what it gave.
    pub(super) fn join_contacts(&mut self, first: usize, own: usize) {
        let earlier: Vec<ContactReport> = self.contacts.drain(first..own).collect();
        let n_own = self.contacts.len();
        for contact in earlier {
            let of_pair = |one: &&mut ContactReport| {
                (one.contactor, one.target) == (contact.contactor, contact.target)
            };
            let away = |one: &ContactReport| {
                let [x, y] = [0, 1].map(|axis| one.position[axis] - contact.position[axis]);
                x * x + y * y
            };
            let found = self.contacts[first..n_own].iter_mut();
            let nearest = found
                .filter(of_pair)
                .min_by(|one, other| away(one).total_cmp(&away(other)));
            let Some(nearest) = nearest else {
                self.contacts.push(contact);
                continue;
            };
            let force = contact.force();
            let [nx, ny] = nearest.normal;
            nearest.normal_force += force[0] * nx + force[1] * ny;
            nearest.tangential_force += force[1] * nx - force[0] * ny;
        }
    }

    /// Adds the reactions of earlier parts of the step, from the `first` on, to those of the last part, from `own` on.
    pub(super) fn join_joints(&mut self, first: usize, own: usize) {
        let earlier: Vec<JointReport> = self.joints.drain(first..own).collect();
        for before in earlier {
            let mut found = self.joints[first..].iter_mut();
            if let Some(now) = found.find(|now| now.joint == before.joint) {
                now.force[0] += before.force[0];
                now.force[1] += before.force[1];
                now.torque += before.torque;
            } else {
                self.joints.push(before);
            }
        }
    }
}
