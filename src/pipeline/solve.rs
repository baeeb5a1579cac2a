//! Solving a step: again, as long as members leave the boxes they were looked for in.

use super::accounts::Books;
use super::clock::Clock;
use super::error::StepError;
use super::flex_pipeline::FlexPipeline;
use super::islands::Task;
use super::quality::Unsolved;
use crate::body::FlexBodySet;
use crate::coupling::{Ends, RapierSets};
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
            self.report.n_solves += 1;
            let ends = Ends {
                pool: self.solver.pool(),
                landings: &self.outcome.landings,
            };
            let excess = self.claims.left_by(&ends, sets);
            if excess == 0.0 {
                break;
            }
            // Only then does the tree know everything that is there.
            if !self.report.is_detected {
                self.detect(sets);
                self.report.note_quarantine(sets);
                self.report.is_detected = true;
            }
            if !self.claims.meets_more(&ends, sets) {
                break;
            }
            if look == MOST_LOOKS {
                let overlap = self.report.gap_violation;
                let unseen = Unsolved::unseen(&self.claims, flex_bodies, overlap);
                self.report.tell(unseen);
                break;
            }
            self.claims.widen(excess, sets, flex_bodies);
            self.report.n_asleep = self.claims.flex.asleep().len();
            for (_, body) in flex_bodies.iter_mut() {
                body.forget_start();
            }
            self.report.forget_solution(dissipated);
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

    /// Solves every component; commits nothing.
    fn solve_islands(
        &mut self,
        step: Step,
        sets: &RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        clock: &mut Clock,
    ) -> Result<(), StepError> {
        self.outcome.clear();
        self.events.discard_notes();
        self.memory.begin_step();
        let task = Task {
            parameters: &self.parameters,
            step,
            claims: &self.claims,
            sets,
        };
        let mut books = Books {
            memory: &mut self.memory,
            events: &mut self.events,
            outcome: &mut self.outcome,
            report: &mut self.report,
            clock,
        };
        self.solver.solve(task, flex_bodies, &mut books)
    }
}
