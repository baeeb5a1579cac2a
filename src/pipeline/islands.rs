//! Solving the islands of a step, one by one: nothing of it is committed.

use super::accounts::Books;
use super::checks::{check_finite, name_bodies};
use super::error::StepError;
use super::known_cuts::KnownCuts;
use super::names::Names;
use super::settings::FlexParameters;
use super::solved::{Entry, SolvedPart};
use crate::body::{FlexBody, FlexBodySet};
use crate::coupling::{
    Claims, FlexPool, GatherSettings, Gatherer, RapierSets, Sources, Span, UnderWay,
};
#[cfg(feature = "serde-serialize")]
use crate::kkt::KeptRecord;
use crate::kkt::{FEW_PASSES, Island, IslandSummary, SolveSettings};
use crate::system::{FlexBlock, Step};
#[cfg(feature = "serde-serialize")]
use std::sync::Arc;

/// What the islands of a step are solved from.
#[derive(Clone, Copy)]
pub(super) struct Task<'a, 'r> {
    pub parameters: &'a FlexParameters,
    pub step: Step,
    pub claims: &'a Claims,
    pub sets: &'a RapierSets<'r>,
    /// Whether a step that has to be cut had better be solved with more of what is around.
    pub may_call_for_room: bool,
}

/// How far the solution of a step, or of a part of it, has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Progress {
    /// To its end.
    Done,
    /// It has to be cut: it is better solved with more of what is around, and goes no further.
    CallsForRoom,
}

/// A part of the step of an island, which has been cut so many times for it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Component of the claim.
    pub component: usize,
    pub span: Span,
    pub n_cuts: usize,
}

/// Solves islands; has what they are built from, and one of them at a time.
#[derive(Debug, Default)]
pub(super) struct Solver {
    pub(super) gatherer: Gatherer,
    pub(super) island: Island,
    /// Where the members of the island are between two parts of its step.
    pub(super) under_way: UnderWay,
    /// What had to be cut since the step began.
    pub(super) known_cuts: KnownCuts,
    /// Components with flexible bodies, and whether some of these are of large strain.
    components: Vec<(usize, bool)>,
}

/// A part of a step as it was tried.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tried {
    pub summary: IslandSummary,
    /// Energy that contact may return before and after it (J).
    pub reserve: [f64; 2],
    /// Whether it might be cut: then what is not solved was left where it stood, and does not count. Pivots that it has used up since are for its halves
    /// to know.
    pub may_be_cut: bool,
}

impl Solver {
    /// Drops what belongs to removed bodies and colliders.
    pub fn retain(&mut self, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) {
        self.gatherer.retain(sets, flex_bodies);
    }

    /// The blocks of the flexible bodies, as the last step has left them.
    pub fn pool(&self) -> &FlexPool {
        &self.gatherer.pool
    }

    /// The rebuildable half of a body, as the last step has left it.
    pub fn block(&self, index: u32) -> Option<&FlexBlock> {
        self.gatherer.pool.block(index)
    }

    /// Makes the end of a body's step its state.
    pub fn commit(&self, index: u32, body: &mut FlexBody) {
        if let Some(block) = self.block(index) {
            block.commit(body.state_mut());
            block.write_contact_force(body.contact_force_mut());
            block.write_reactions(body.reaction_mut());
            self.under_way.average(index, body);
        }
    }

    /// Begins a step, however often it is solved.
    pub fn begin_step(&mut self) {
        self.island.begin_step();
        self.known_cuts.begin_step();
    }

    /// Solves every component.
    pub fn solve(
        &mut self,
        task: Task<'_, '_>,
        flex_bodies: &mut FlexBodySet,
        books: &mut Books<'_>,
    ) -> Result<Progress, StepError> {
        self.under_way.begin_step();
        self.list_components(task.claims, flex_bodies);
        let factorizations = self.gatherer.pool.n_factorizations();
        for slot in 0..self.components.len() {
            let (component, has_large) = self.components[slot];
            let step = if has_large {
                task.step.with_large()
            } else {
                task.step
            };
            let outcome = self.solve_island(component, Task { step, ..task }, flex_bodies, books);
            if outcome.is_err() {
                // Buffers and blocks may hold numbers that are not finite: they are built anew.
                self.island = Island::default();
                return outcome;
            }
            self.gatherer.pool.put_back(&mut self.island);
            if outcome == Ok(Progress::CallsForRoom) {
                return outcome;
            }
        }
        let pool = &self.gatherer.pool;
        books.report.n_islands = self.components.len();
        books.report.n_claimed = books.outcome.landings.len();
        books.report.n_factorizations = pool.n_factorizations().saturating_sub(factorizations);
        Ok(Progress::Done)
    }

    fn list_components(&mut self, claims: &Claims, flex_bodies: &FlexBodySet) {
        self.components.clear();
        for (flex, own) in claims.flex.iter().enumerate() {
            let body = flex_bodies.at_index(own.index);
            let is_large = body.is_some_and(|(_, body)| body.large().is_some());
            self.components
                .push((claims.component_of_flex(flex), is_large));
        }
        self.components.sort_unstable();
        self.components.dedup_by(|next, kept| {
            kept.1 |= next.1 && next.0 == kept.0;
            next.0 == kept.0
        });
    }

    /// Gathers and solves a part of an island's step, as if it were a step.
    pub(super) fn solve_part(
        &mut self,
        part: Part,
        task: Task<'_, '_>,
        flex_bodies: &mut FlexBodySet,
        books: &mut Books<'_>,
    ) -> Result<Tried, StepError> {
        let Task {
            parameters,
            step,
            claims,
            sets,
            ..
        } = task;
        let settings = GatherSettings {
            component: part.component,
            step,
            span: part.span,
            prediction: f64::from(sets.integration_parameters.prediction_distance()),
            excess: claims.excess(),
            uses_path: parameters.leads(step),
        };
        let sources = Sources {
            settings: &settings,
            sets,
            claims,
            under_way: &self.under_way,
        };
        self.gatherer
            .gather(sources, books.memory, flex_bodies, &mut self.island)?;
        books.clock.lap(&mut books.report.times.gather);
        let may_be_cut = self.may_be_cut(step, part.n_cuts, parameters, flex_bodies);
        let settings = settings_of(task, [may_be_cut, self.is_spent(parameters)]);
        let before = self.island.reserve();
        if may_be_cut && self.known_cuts.has(self.first_body(), part.span) {
            return Ok(Tried {
                summary: IslandSummary::stopped(),
                reserve: [before; 2],
                may_be_cut,
            });
        }
        books.report.n_tried += 1;
        let memory = if part.span.is_first() {
            &books.memory.contacts
        } else {
            &self.under_way.contacts
        };
        let seats = &self.gatherer.seats;
        let solved = self.island.solve(&settings, memory);
        let summary = match solved {
            Ok(summary) => summary,
            Err(error) => {
                // What is out of range is to blame for numbers that are none.
                check_finite(&self.island, seats, flex_bodies)?;
                return Err(name_bodies(error, &self.island, seats, flex_bodies));
            }
        };
        // Where a step was left that is taken again in parts does not matter.
        if !(settings.may_be_cut && summary.is_unsolved()) {
            check_finite(&self.island, seats, flex_bodies)?;
        }
        self.under_way.note_pivots(summary.n_pivots);
        books.clock.lap(&mut books.report.times.solve);
        Ok(Tried {
            summary,
            reserve: [before, self.island.reserve()],
            may_be_cut,
        })
    }

    /// Enters a part that counts, and goes on from its end.
    pub(super) fn enter_part(
        &mut self,
        (part, step): (Part, Step),
        summary: &IslandSummary,
        (names, entry): (Names<'_, '_>, &mut Entry),
        books: &mut Books<'_>,
    ) {
        let solved = SolvedPart {
            island: &self.island,
            seats: &self.gatherer.seats,
            summary,
            step,
            span: part.span,
        };
        if part.span.is_last() {
            solved.remember(&mut books.memory.contacts, &mut books.memory.joints);
        } else {
            solved.remember(&mut self.under_way.contacts, &mut self.under_way.joints);
        }
        books.enter(&solved, names, entry);
    }

    /// Index of the first flexible body of the island.
    pub(super) fn first_body(&self) -> u32 {
        let indices = self.island.flex_index.iter().flatten();
        indices.copied().min().unwrap_or(u32::MAX)
    }

    /// Steps on end that were not finished for any of the island's bodies.
    pub(super) fn n_unfinished(&self, flex_bodies: &FlexBodySet) -> usize {
        let bodies = self.flexible(flex_bodies);
        bodies.map(FlexBody::n_unfinished).min().unwrap_or(0) as usize
    }

    /// Whether the step of the island has used up its pivots.
    pub(super) fn is_spent(&self, parameters: &FlexParameters) -> bool {
        self.under_way.n_pivots() > parameters.max_pivots
    }

    fn flexible<'a>(&self, flex_bodies: &'a FlexBodySet) -> impl Iterator<Item = &'a FlexBody> {
        let indices = self.island.flex_index.iter().flatten();
        indices
            .filter_map(|&index| flex_bodies.at_index(index))
            .map(|(_, body)| body)
    }
}

/// What a snapshot writes of it.
#[cfg(feature = "serde-serialize")]
impl Solver {
    /// What the islands of the next step may go on from.
    pub(super) fn kept_records(&self, flex_bodies: &FlexBodySet) -> Vec<KeptRecord> {
        self.island.kept_records(|model| {
            let mut bodies = flex_bodies.iter();
            let (handle, _) = bodies.find(|(_, body)| Arc::ptr_eq(body.model(), model))?;
            Some(handle.into_raw_parts().0)
        })
    }

    /// A solver with the blocks of before, and what was kept of islands; `None` if a body of these does not exist.
    pub(super) fn restored(
        pool: FlexPool,
        kept: Vec<KeptRecord>,
        flex_bodies: &FlexBodySet,
    ) -> Option<Self> {
        let mut solver = Self::default();
        solver.gatherer.pool = pool;
        solver.island.restore_kept(kept, |index| {
            let (_, body) = flex_bodies.at_index(index)?;
            Some(Arc::clone(body.model()))
        })?;
        Some(solver)
    }
}

fn settings_of(task: Task<'_, '_>, [may_be_cut, is_spent]: [bool; 2]) -> SolveSettings {
    let Task {
        parameters,
        step,
        sets,
        ..
    } = task;
    let length_unit = f64::from(sets.integration_parameters.length_unit).abs();
    SolveSettings {
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
        insists: parameters.insists,
        impact: parameters.impact,
        contact: parameters.contact_method,
        solver: parameters.contact_solver,
        restitution_threshold: parameters.restitution_threshold * length_unit,
        // What has used up its pivots goes on after a few passes.
        max_newton: match is_spent {
            true => parameters.max_newton.min(FEW_PASSES),
            false => parameters.max_newton,
        },
        may_be_cut,
        length_unit,
    }
}
