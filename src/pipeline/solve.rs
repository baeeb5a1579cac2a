//! Solving the islands of a step.

use super::clock::Clock;
use super::error::StepError;
use super::flex_pipeline::FlexPipeline;
use crate::body::FlexBodySet;
use crate::coupling::{GatherSettings, RapierSets, Span};
use crate::kkt::{ContactMethod, Island, IslandSummary, SolveSettings};
use crate::system::Step;

/// Times that a step is solved again because members have left the boxes they were looked for in: each time with more of what is there.
const MOST_LOOKS: usize = 3;

impl FlexPipeline {
    /// Solves every component, again while members leave the boxes they were looked for in; commits nothing.
    pub(super) fn solve_and_look(
        &mut self,
        step: Step,
        sets: &mut RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        clock: &mut Clock,
    ) -> Result<(), StepError> {
        let dissipated = self.report.energy.dissipated;
        for look in 0..=MOST_LOOKS {
            self.solve_islands(step, sets, flex_bodies, clock)?;
            if !self.looks_again(sets) {
                break;
            }
            if look == MOST_LOOKS {
                self.note_unseen(flex_bodies);
                break;
            }
            for (_, body) in flex_bodies.iter_mut() {
                body.forget_start();
            }
            self.report.forget_solution(dissipated);
            if !self.report.is_detected {
                self.detect(sets);
                self.report.note_quarantine(sets);
                self.report.is_detected = true;
            }
            self.claims.sweep(sets);
            self.claims.walk(sets);
        }
        if self.parameters.refuses_unsolved
            && let Some(unsolved) = self.report.unsolved.pop()
        {
            return Err(StepError::Unsolved {
                quality: unsolved.quality,
                bodies: unsolved.bodies,
                overlap: unsolved.overlap,
            });
        }
        Ok(())
    }

    /// Whether members have left the boxes they were looked for in; these have grown then.
    pub(super) fn looks_again(&mut self, sets: &RapierSets<'_>) -> bool {
        let gatherer = &self.gatherer;
        self.claims
            .widen(|index| gatherer.block(index), &self.landings, sets)
    }

    /// Solves every component; commits nothing.
    pub(super) fn solve_islands(
        &mut self,
        step: Step,
        sets: &RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        clock: &mut Clock,
    ) -> Result<(), StepError> {
        self.discard_solution();
        self.gatherer.under_way.begin_step();
        self.island.begin_step();
        self.gatherer.turn_over(false);
        self.components.clear();
        for flex in 0..self.claims.flex.len() {
            let component = self.claims.component_of_flex(flex);
            let body = flex_bodies.at_index(self.claims.flex[flex].index);
            let is_large = body.is_some_and(|(_, body)| body.large().is_some());
            self.components.push((component, is_large));
        }
        self.components.sort_unstable();
        self.components.dedup_by(|next, kept| {
            kept.1 |= next.1 && next.0 == kept.0;
            next.0 == kept.0
        });
        let factorizations = self.gatherer.n_factorizations();
        for slot in 0..self.components.len() {
            let (component, has_large) = self.components[slot];
            let step = if has_large { step.with_large() } else { step };
            let outcome = self.solve_island(component, step, sets, flex_bodies, clock);
            if outcome.is_err() {
                // Buffers and blocks may hold numbers that are not finite: they are built anew.
                self.island = Island::default();
                return outcome;
            }
            self.gatherer.give_back(&mut self.island);
        }
        self.report.n_islands = self.components.len();
        self.report.n_claimed = self.landings.len();
        self.report.n_factorizations = self
            .gatherer
            .n_factorizations()
            .saturating_sub(factorizations);
        Ok(())
    }

    /// Whether surfaces are led along a feasible path.
    pub(super) fn leads(&self, step: Step) -> bool {
        self.parameters.feasible_path
            && !step.is_explicit()
            && self.parameters.contact_method == ContactMethod::Lagrange
    }

    /// Gathers and solves a part of an island's step, as if it were a step; returns its summary and the energy that contact may
    /// return before and after it (J).
    pub(super) fn solve_span(
        &mut self,
        (component, span, n_cuts): (usize, Span, usize),
        step: Step,
        sets: &RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        clock: &mut Clock,
    ) -> Result<(IslandSummary, [f64; 2]), StepError> {
        let gather = GatherSettings {
            component,
            step,
            span,
            prediction: f64::from(sets.integration_parameters.prediction_distance()),
            excess: self.claims.excess(),
            uses_path: self.leads(step),
        };
        let (claims, island) = (&mut self.claims, &mut self.island);
        let kept = (&self.masters, &self.links);
        self.gatherer
            .gather(&gather, sets, flex_bodies, claims, kept, island)?;
        clock.lap(&mut self.report.times.gather);
        let settings = SolveSettings {
            dt: step.dt,
            whole: f64::from(sets.integration_parameters.dt),
            b0: if step.is_explicit() {
                step.dt * step.dt
            } else {
                step.weights.b0
            },
            b1: step.weights.b1,
            is_within: step.is_within(),
            is_explicit: step.is_explicit(),
            insists: self.parameters.insists,
            impact: self.parameters.impact,
            contact: self.parameters.contact_method,
            solver: self.parameters.contact_solver,
            restitution_threshold: self.parameters.restitution_threshold,
            max_newton: self.parameters.max_newton,
            may_be_cut: self.may_be_cut(step, n_cuts),
            length_unit: f64::from(sets.integration_parameters.length_unit).abs(),
        };
        let before = self.reserve(flex_bodies);
        let mut reserve = before;
        let memory = if span.is_first() {
            &self.memory
        } else {
            &self.gatherer.under_way.contacts
        };
        let summary = self
            .island
            .solve(&settings, memory, &mut reserve)
            .map_err(|error| self.name_bodies(error, flex_bodies))?;
        // Where a step was left that is taken again in parts does not matter.
        if !(settings.may_be_cut && summary.is_unsolved()) {
            self.check_finite(flex_bodies)?;
        }
        clock.lap(&mut self.report.times.solve);
        Ok((summary, [before, reserve]))
    }

    /// Energy that contact has taken from the island's bodies and may return (J).
    fn reserve(&self, flex_bodies: &FlexBodySet) -> f64 {
        let indices = self.island.flex_index.iter().flatten();
        indices
            .filter_map(|&index| flex_bodies.at_index(index))
            .map(|(_, body)| body.energy_reserve())
            .sum()
    }
}
