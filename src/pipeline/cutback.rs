//! Cutback: what is not solved in one piece is solved in halves, these in halves again, as implicit codes do.
//!
//! A part of the smallest length that finds no end is halved further, a few times in a step: where a corner slides off what it presses on, its force
//! acts to the end of the part, and a shorter one has less of it.
//!
//! Only the island that asks for it is cut, on our side: rapier takes the whole step at once. The report tells of the step as a whole:
//! impulses of the parts over its length, what dissipates summed, the rest as it is at the end.

use super::accounts::Books;
use super::checks::SHORTEST;
use super::error::StepError;
use super::islands::{Part, Progress, Solver, Task, Tried};
use super::names::Names;
use super::quality::Quality;
use super::settings::FlexParameters;
use super::solved::{Entry, FURTHER};
use crate::body::FlexBodySet;
use crate::coupling::Span;
use crate::kkt::{DOUBLED, GAINED};
use crate::system::Step;

/// How often a step may be cut at most after this many unfinished ones on end: once less after each, until none is left. After as many steps it is tried
/// again, in halves once more than `most` times, then twice more after twice as many, and so on. A step that ends where it began leaves the next one what
/// it could not finish itself: without another try what holds it up, long gone, would do so for ever, and so would what `most` cuts are too few for.
fn n_cuts_after(n_unfinished: usize, most: usize) -> usize {
    let n_tries = (n_unfinished / (most + 1) + 1).ilog2();
    let begun = (most + 1) * ((1 << n_tries) - 1);
    match n_unfinished - begun {
        0 if most > 0 => most + n_tries as usize,
        n_since => most.saturating_sub(n_since),
    }
}

impl Solver {
    /// Solves the step of one island, in parts if it must be.
    pub(super) fn solve_island(
        &mut self,
        component: usize,
        task: Task<'_, '_>,
        flex_bodies: &mut FlexBodySet,
        books: &mut Books<'_>,
    ) -> Result<Progress, StepError> {
        let mut entry = books.open();
        self.under_way.begin();
        let whole = Part {
            component,
            span: Span::WHOLE,
            n_cuts: 0,
        };
        let outcome = self.solve_parts(whole, task, flex_bodies, (books, &mut entry));
        self.under_way.end(flex_bodies);
        books.report.n_parts = books.report.n_parts.max(entry.n_parts);
        outcome
    }

    /// Whether a part of the step of the island that was gathered, which has been cut `n_cuts` times, may be solved in halves. What could not be finished
    /// in the steps before, as bodies that were put into each other for good, is cut once less for each, and for each of the last parts of this one: it would not be finished in all the parts either, and cost their
    /// number. It is tried in all its parts again [now and then](n_cuts_after). What has used up its pivots is not cut any more.
    pub(super) fn may_be_cut(
        &self,
        step: Step,
        n_cuts: usize,
        parameters: &FlexParameters,
        flex_bodies: &FlexBodySet,
    ) -> bool {
        let most = parameters.most_cutbacks(self.island.has_large());
        let most = n_cuts_after(self.n_unfinished(flex_bodies), most);
        let most = most.saturating_sub(self.under_way.n_unfinished());
        let is_long = 0.5 * step.dt >= SHORTEST;
        n_cuts < most && !self.is_spent(parameters) && is_long && !step.is_explicit()
    }

    /// Solves a part of the step, in halves if it is not solved in one piece.
    fn solve_parts(
        &mut self,
        part: Part,
        task: Task<'_, '_>,
        flex_bodies: &mut FlexBodySet,
        (books, entry): (&mut Books<'_>, &mut Entry),
    ) -> Result<Progress, StepError> {
        let Task {
            parameters,
            step,
            sets,
            ..
        } = task;
        let Tried {
            summary,
            reserve: [before, reserve],
            may_be_cut,
        } = self.solve_part(part, task, flex_bodies, books)?;
        // What contact adds and cannot take back is the error of a step that is longer than the impact; what is parted costs energy at any pace, but not
        // more than there is. What joints leave in stored accelerations swings, and a change of the step's length makes it swing more: with joints it must
        // be as much as there was, on a path.
        let swings = self.island.has_swinging_joints(step.is_within());
        let is_coarse = match (summary.is_parting, swings, parameters.leads(step)) {
            (true, _, true) => {
                summary.calmed - reserve > summary.most_of_parting() + (-before).max(0.0)
            }
            (false, false, _) => summary.added > GAINED.get(),
            (false, true, true) => summary.added > DOUBLED.get(),
            (_, _, false) => false,
        };
        let is_good = !is_coarse && !summary.is_unsolved();
        let goes_on = !may_be_cut && summary.quality() == Quality::Unfinished && {
            let n_cuts = part.n_cuts.saturating_sub(FURTHER);
            self.may_be_cut(step, n_cuts, parameters, flex_bodies) && entry.may_go_further()
        };
        if !is_good && may_be_cut || goes_on {
            // The few that are halved further are tried again: where a step may go on is counted anew.
            if may_be_cut {
                self.known_cuts.note(self.first_body(), part.span);
            }
            if part.n_cuts > 0 && task.may_call_for_room {
                return Ok(Progress::CallsForRoom);
            }
            let step = step.halved(&parameters.integrator);
            self.under_way.keep(&self.island, flex_bodies);
            for span in part.span.halves() {
                self.gatherer.pool.put_back(&mut self.island);
                let n_cuts = part.n_cuts + 1;
                let half = Part {
                    span,
                    n_cuts,
                    ..part
                };
                let task = Task { step, ..task };
                let progress = self.solve_parts(half, task, flex_bodies, (books, entry))?;
                if progress == Progress::CallsForRoom {
                    return Ok(progress);
                }
            }
            return Ok(Progress::Done);
        }
        let is_finished = summary.quality() != Quality::Unfinished;
        self.under_way.note_end(is_finished);
        let names = Names { sets, flex_bodies };
        self.enter_part((part, step), &summary, (names, entry), books);
        if !part.span.is_last() {
            let seats = &self.gatherer.seats;
            let mut kept = Vec::new();
            seats.add_kept_forces(&self.island, &mut kept);
            let left = (seats.claimed(), &kept[..]);
            self.under_way
                .go_on(&self.island, left, part.span, flex_bodies);
        }
        Ok(Progress::Done)
    }
}

#[cfg(test)]
mod tests {
    use super::n_cuts_after;

    #[test]
    fn what_is_not_finished_is_cut_less_and_less_and_tried_again_ever_more_seldom_and_finer() {
        for most in [1, 3, 5] {
            let cuts: Vec<usize> = (0..200).map(|n| n_cuts_after(n, most)).collect();
            let round = most + 1;
            let falling: Vec<usize> = (0..most).rev().collect();
            for n_tries in 0..4 {
                let begun = round * ((1 << n_tries) - 1);
                assert_eq!(cuts[begun], most + n_tries, "{most}: {begun}");
                assert!(cuts[begun + 1..].starts_with(&falling), "{most}: {begun}");
                let idle = &cuts[begun + round..2 * begun + round];
                assert!(idle.iter().all(|n| *n == 0), "{most}: {begun}");
            }
        }
        assert!((0..200).all(|n| n_cuts_after(n, 0) == 0));
        // Whatever the number of steps is.
        assert_eq!(n_cuts_after(u32::MAX as usize, 5), 0);
    }
}
