//! Solving the islands of a step.

use super::clock::Clock;
use super::error::StepError;
use super::flex_pipeline::FlexPipeline;
use crate::body::FlexBodySet;
use crate::coupling::{GatherSettings, RapierSets};
use crate::kkt::{Island, SolveSettings};
use crate::system::Step;

impl FlexPipeline {
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
        self.landings.clear();
        self.links.pushes.clear();
        self.reserves.clear();
        self.joint_impulses.clear();
        self.memory.discard_notes();
        self.events.discard_notes();
        self.gatherer.turn_over(false);
        self.components.clear();
        for flex in 0..self.claims.flex.len() {
            let component = self.claims.component_of_flex(flex);
            self.components.push(component);
        }
        self.components.sort_unstable();
        self.components.dedup();
        let factorizations = self.gatherer.n_factorizations();
        for slot in 0..self.components.len() {
            let outcome = self.solve_island(self.components[slot], step, sets, flex_bodies, clock);
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

    fn solve_island(
        &mut self,
        component: usize,
        step: Step,
        sets: &RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        clock: &mut Clock,
    ) -> Result<(), StepError> {
        let gather = GatherSettings {
            component,
            step,
            prediction: f64::from(sets.integration_parameters.prediction_distance()),
            excess: self.claims.excess(),
            uses_path: self.parameters.feasible_path
                && !step.is_explicit()
                && self.parameters.contact_method == crate::kkt::ContactMethod::Lagrange,
        };
        let (claims, island) = (&mut self.claims, &mut self.island);
        let kept = (&self.masters, &self.links);
        self.gatherer
            .gather(&gather, sets, flex_bodies, claims, kept, island)?;
        clock.lap(&mut self.report.times.gather);
        let settings = SolveSettings {
            dt: step.dt,
            b0: if step.is_explicit() {
                step.dt * step.dt
            } else {
                step.weights.b0
            },
            b1: step.weights.b1,
            is_explicit: step.is_explicit(),
            insists: self.parameters.insists,
            impact: self.parameters.impact,
            contact: self.parameters.contact_method,
            solver: self.parameters.contact_solver,
            restitution_threshold: self.parameters.restitution_threshold,
            max_newton: self.parameters.max_newton,
            length_unit: f64::from(sets.integration_parameters.length_unit).abs(),
        };
        let mut reserve = self.reserve(flex_bodies);
        let summary = self
            .island
            .solve(&settings, &self.memory, &mut reserve)
            .map_err(|error| self.name_bodies(error, flex_bodies))?;
        self.check_finite(flex_bodies)?;
        self.note(step, &summary, reserve, sets, flex_bodies);
        if self.parameters.refuses_unsolved
            && let Some(unsolved) = self.report.unsolved.pop()
        {
            return Err(StepError::Unsolved {
                quality: unsolved.quality,
                bodies: unsolved.bodies,
                overlap: unsolved.overlap,
            });
        }
        clock.lap(&mut self.report.times.solve);
        Ok(())
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
