//! Solving a step: again, as long as members leave the boxes they were looked for in.

use super::accounts::Books;
use super::clock::Clock;
use super::error::StepError;
use super::flex_pipeline::FlexPipeline;
use super::islands::{Progress, Task};
use super::quality::Unsolved;
use crate::body::FlexBodySet;
use crate::coupling::{Ends, RapierSets};
use crate::rapier::math::Real;
use crate::system::Step;

/// Times that a step is solved again because members have left the boxes they were looked for in: each time with more of what is there.
const MOST_LOOKS: usize = 3;

impl FlexPipeline {
    /// Solves every component, again while members leave the boxes they were looked for in, and with larger ones where they are likely to;
    /// commits nothing.
    pub(super) fn solve_and_look(
        &mut self,
        step: Step,
        sets: &mut RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        clock: &mut Clock,
    ) -> Result<(), StepError> {
        let dissipated = self.report.energy.dissipated;
        let mut looks = 0;
        self.solver.begin_step();
        loop {
            let likely = self.claims.likely_excess(sets);
            let may_call = likely > 0.0 && looks == 0;
            let progress = self.solve_islands((step, may_call), sets, flex_bodies, clock)?;
            if progress == Progress::CallsForRoom {
                self.detect_once(sets);
                self.look_wider((likely, dissipated), sets, flex_bodies);
                continue;
            }
            self.report.n_solves += 1;
            let excess = self.left_by(sets);
            if excess == 0.0 {
                break;
            }
            self.detect_once(sets);
            if !self.meets_more(sets) {
                break;
            }
            if looks == MOST_LOOKS {
                let overlap = self.report.gap_violation;
                let unseen = Unsolved::unseen(&self.claims, flex_bodies, overlap);
                self.report.tell(unseen);
                break;
            }
            looks += 1;
            self.look_wider((excess, dissipated), sets, flex_bodies);
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

    /// By how much members have left the boxes that they were looked for in (m).
    fn left_by(&self, sets: &RapierSets<'_>) -> Real {
        let ends = Ends {
            pool: self.solver.pool(),
            landings: &self.outcome.landings,
        };
        self.claims.left_by(&ends, sets)
    }

    /// Whether a member that has left its box has met something that was not in the problem.
    fn meets_more(&mut self, sets: &RapierSets<'_>) -> bool {
        let ends = Ends {
            pool: self.solver.pool(),
            landings: &self.outcome.landings,
        };
        self.claims.meets_more(&ends, sets)
    }

    /// Lets rapier detect, if it has not in this step: only then does the tree know everything that is there.
    fn detect_once(&mut self, sets: &mut RapierSets<'_>) {
        if !self.report.is_detected {
            self.detect(sets);
            self.report.note_quarantine(sets);
            self.report.is_detected = true;
        }
    }

    /// Forgets the solution of a step in which members leave their boxes by `excess` (m), and looks around in larger ones.
    fn look_wider(
        &mut self,
        (excess, dissipated): (Real, f64),
        sets: &mut RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
    ) {
        self.claims.widen(excess, sets, flex_bodies);
        self.report.n_asleep = self.claims.flex.asleep().len();
        for (_, body) in flex_bodies.iter_mut() {
            body.forget_start();
        }
        self.report.forget_solution(dissipated);
        self.claims.sweep(sets);
        self.claims.walk(sets);
    }

    /// Solves every component; commits nothing.
    fn solve_islands(
        &mut self,
        (step, may_call_for_room): (Step, bool),
        sets: &RapierSets<'_>,
        flex_bodies: &mut FlexBodySet,
        clock: &mut Clock,
    ) -> Result<Progress, StepError> {
        self.outcome.clear();
        self.events.discard_notes();
        self.memory.begin_step();
        let task = Task {
            parameters: &self.parameters,
            step,
            claims: &self.claims,
            sets,
            may_call_for_room,
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
