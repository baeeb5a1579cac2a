//! The position stage along a feasible path: from where the bodies are apart, towards where the forces would have them, as far as they
//! stay apart.
//!
//! A *pass* lists the near pairs at the base, solves one contact problem on their rows for new forces, finds where the bodies end under
//! them, and moves the base that way until the time of impact. It is over when the base is where the forces lead and the laws hold
//! there in truth. Whatever the forces are, the base is free of overlaps: what is not solved within the budget stops at the base.

mod arrival;
mod consistent;
mod listing;
mod parted;
mod parting;
mod trend;

pub(super) use self::arrival::Stage;
pub(super) use self::parting::Parting;

use self::listing::Listing;
use self::trend::Trend;
use super::island::{Island, SolveSettings};
use super::position::{OVERLAPPED, PARTING_RATE, Turned};
use super::summary::IslandSummary;
use crate::constraint::contact::ContactMemory;
use crate::linalg::cone::SETTLING;
use crate::math::{REAL_EPSILON, exp, is_held};
use crate::system::Block;

/// Turning below this angle (rad) changes no position by more than round-off.
pub(super) const ANGLE_TOLERANCE: f64 = 1e-11;

/// Passes of a step that stop short of where the forces lead. Every one of them goes on with forces that do not know what comes after: bodies
/// that are stopped that often meet in ways that the step does not resolve.
const MOST_STOPS: usize = 20;

/// Share of the margin within which the laws hold where the contacts are many (-): a thousandth moves no force that counts.
pub(super) const LARGE_TOLERANCE: f64 = 1e-3;

/// The same where bodies of large strain find their equilibrium to a residual (-).
const CURVED_TOLERANCE: f64 = 1e-6;

/// Passes that count as one iteration. In the second half of them the laws need only hold to [`CLOSE_ENOUGH`].
const PASSES_PER_ITERATION: usize = 2;

/// The same where contacts are many: after these passes their laws need hold no better either.
const FEW_PASSES: usize = 6;

/// Share of its way's margin by which a true gap or slip may miss what the law asks for (-).
const CLOSE_ENOUGH: f64 = 0.05;

/// Multiple of the tolerance within which the multipliers of the last step are right but for what happened since.
const NEAR: f64 = 1e5;

/// What a pass may leave of the error of the one before (-) without bodies being led where that is left to do.
const SLOWEST: f64 = 0.25;

/// How a step along the path has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passed {
    /// The laws hold where the forces lead.
    Solved,
    /// The forces lead to a place that the path reaches, where gaps miss the laws by less than the margin.
    Arrived,
    /// The base was stopped on the way.
    Stopped,
}

impl Island {
    /// Solves the positions along the path. Where the laws cannot be made to hold, the best place that was reached by the whole of the step
    /// counts, or else the first impact.
    pub(super) fn follow_path(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        tolerance: f64,
        summary: &mut IslandSummary,
    ) -> Passed {
        self.find_margin(tolerance);
        if !self.path.is_empty() {
            self.path.rest(&self.blocks);
        }
        self.path.list_pressed(memory, &mut self.pressed_before);
        self.impact.is_known = false;
        self.arrival.is_known = false;
        self.departure.is_known = false;
        self.softness = 0.0;
        self.left.clear();
        self.tell_base(false);
        let passed = self.try_passes(settings, memory, tolerance, summary);
        if passed != Passed::Stopped {
            return passed;
        }
        if let Some(passed) = self.end_at_arrival() {
            return passed;
        }
        if self.return_to_first_stop() {
            self.correct();
        }
        Passed::Stopped
    }

    /// Finds what the laws may miss at the very most: the least margin of the ways, or where there is no path, what counts as near.
    pub(super) fn find_margin(&mut self, tolerance: f64) {
        self.margin = if self.path.is_empty() {
            NEAR / CLOSE_ENOUGH * tolerance
        } else {
            self.path.least_margin()
        };
    }

    fn try_passes(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        tolerance: f64,
        summary: &mut IslandSummary,
    ) -> Passed {
        let kept = exp(-PARTING_RATE * settings.dt);
        let mut listing = Listing {
            memory: Some(memory),
            pass: 0,
            is_again: false,
            keeps_rows: false,
            slop: OVERLAPPED * tolerance,
            kept,
        };
        self.list_near(&listing);
        self.note_pressing();
        listing.memory = None;
        self.note_yielding(settings.b0);
        let mut turned = self.correct();
        let mut n_stopped = 0;
        let mut has_left = false;
        let (mut last, mut is_idle) = (f64::INFINITY, false);
        let (n_passes, mut trend) = (PASSES_PER_ITERATION * settings.max_newton, Trend::new());
        for pass in 0..n_passes {
            summary.n_newton += 1;
            // Under the forces of the last step bodies may be anywhere: that way is gone only if they are nearly right.
            let is_guess = pass == 0 && !(self.contacts.is_empty() && self.ties.is_empty());
            let is_eased = pass >= self.n_exact_passes(settings);
            let near = self.enough(is_eased, NEAR * tolerance);
            let guessed = is_guess.then(|| self.measure_guess());
            let misleads = guessed.is_some_and(|guessed| guessed > near);
            if pass == 0 {
                self.note_start(guessed, settings);
            }
            let mut arrives = false;
            let mut error = 0.0;
            if !self.is_finite() || has_left && self.leads_around() {
                return Passed::Stopped;
            }
            if !misleads {
                arrives = self.path.is_empty() || self.path.advance(&self.blocks);
                let led = self.tell_base(pass >= FEW_PASSES && is_idle);
                (turned.angle, turned.way) = (turned.angle.max(led.angle), turned.way.max(led.way));
                if !arrives {
                    self.path.list_stopping(&mut self.left);
                }
                n_stopped += usize::from(!arrives);
                listing.pass = pass + 1;
                // Rows that turn to and fro are left as they are in the end. Gaps along a path are true all the same; those of signed rows follow
                // their rows.
                listing.keeps_rows = is_eased && arrives;
                self.list_near(&listing);
                self.leave_contradictions(arrives, settings);
                error = self.measure(listing.keeps_rows);
                is_idle = error > SLOWEST * last;
                last = error;
            }
            let has_more = !misleads && self.add_violated(tolerance, kept, memory);
            // Forces of the last step that are kept must be right, or what rests creeps.
            let enough = if is_guess {
                tolerance
            } else {
                self.enough(is_eased, tolerance)
            };
            let lack = if is_eased && arrives {
                self.shortfall(true).max(CLOSE_ENOUGH * turned.way / enough)
            } else {
                f64::INFINITY
            };
            let is_close = if is_eased {
                lack <= CLOSE_ENOUGH
            } else {
                let is_near = !self.path.is_empty() && turned.way <= enough;
                error <= enough && (turned.angle <= ANGLE_TOLERANCE || is_near)
            };
            if arrives && is_close && !has_more {
                self.end_at_base();
                self.keep_applied_rows();
                let has_strayed = listing.keeps_rows && self.measure_signed() > self.margin;
                return match (self.leads_around(), has_strayed) {
                    (true, _) => Passed::Stopped,
                    (false, true) => Passed::Arrived,
                    (false, false) => Passed::Solved,
                };
            }
            if arrives && !has_more && turned.angle <= CLOSE_ENOUGH {
                self.keep_arrival();
            }
            if is_eased && trend.is_hopeless(lack, n_passes - pass - 1) {
                return Passed::Stopped;
            }
            let may_retreat =
                !(misleads || listing.keeps_rows || self.path.is_empty() || self.is_led());
            if may_retreat && self.path.retreat(&self.blocks) {
                self.tell_base(false);
                self.list_near(&Listing {
                    is_again: true,
                    ..listing
                });
                self.measure(false);
            }
            if !(error + turned.angle).is_finite() || n_stopped > MOST_STOPS {
                return Passed::Stopped;
            }
            if !self.ties.is_empty() && pass > 0 && pass % 5 == 0 {
                self.restiffen_turns(settings);
            }
            let contradicts = is_idle && pass >= FEW_PASSES && !settings.may_be_cut;
            if self
                .share_out_overlaps(listing.slop, contradicts, settings.b0)
                .is_err()
            {
                return Passed::Stopped;
            }
            has_left = self.note_left();
            self.turn_signed_rows(!misleads && !listing.keeps_rows);
            if !self.solve_consistently(settings, tolerance, summary) {
                return Passed::Stopped;
            }
            self.note_yielding(settings.b0);
            self.leave_immovable();
            if n_stopped > 0 && !self.impact.is_known {
                self.keep_impact();
            }
            turned = self.correct();
        }
        Passed::Stopped
    }

    /// Whether some block is led from the base: its iterate is not where the last way led any more.
    fn is_led(&self) -> bool {
        let is_led = |block: &Block| matches!(block, Block::Flex(block) if block.is_led());
        self.blocks.iter().any(is_led)
    }

    /// Ends the step of what is led at the base, which its iterate is as near to as the laws ask for.
    fn end_at_base(&mut self) {
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.end_at_base();
            }
        }
    }

    /// Tells the blocks of large strain where the base is; returns how far from there the iterate of those is that are led.
    ///
    /// - `leads`: whether those are led from now on that are in the last part of a step.
    fn tell_base(&mut self, leads: bool) -> Turned {
        let mut led = Turned::default();
        for (index, block) in self.blocks.iter_mut().enumerate() {
            if let Block::Flex(block) = block
                && block.is_large()
                && let Some(base) = self.path.base_of(index, block.positions().len())
            {
                let left = block.set_base(base, leads);
                led.angle = led.angle.max(left);
                led.way = led.way.max(left * block.size());
            }
        }
        led
    }

    /// Whether the blocks' iterate consists of numbers: what is none is passed over by every search.
    fn is_finite(&self) -> bool {
        self.blocks.iter().all(|block| match block {
            Block::Flex(block) => block.positions().iter().all(|x| x.is_finite()),
            Block::Rigid(block) => {
                let motion = block.current();
                motion.centre.iter().all(|x| x.is_finite()) && motion.angle.is_finite()
            }
        })
    }

    /// Whether the blocks' iterate is where rapier's numbers reach.
    pub(super) fn is_in_range(&self) -> bool {
        self.blocks.iter().all(|block| match block {
            Block::Flex(block) => block.positions().iter().all(|x| is_held(*x)),
            Block::Rigid(block) => block.current().centre.iter().all(|x| is_held(*x)),
        })
    }

    /// Whether the contacts at hand are so many that they are solved as a sparse problem.
    fn has_many_rows(&self) -> bool {
        self.is_sparse(2 * self.contacts.len() + self.ties.len())
    }

    /// Passes in which the laws have to hold as well as they can be made to.
    fn n_exact_passes(&self, settings: &SolveSettings) -> usize {
        if self.has_many_rows() {
            FEW_PASSES.min(settings.max_newton)
        } else {
            settings.max_newton
        }
    }

    /// Notes how fine the laws are to hold at the least: by what the multipliers of the last step miss, if there are any, as far down as rapier's
    /// numbers hold positions. With a tolerance of lengths alone, what rests in an `f64` world may tremble for good.
    fn note_start(&mut self, guessed: Option<f64>, settings: &SolveSettings) {
        let of_guess = guessed.map_or(f64::INFINITY, |guessed| SETTLING.get() * guessed);
        self.finest = of_guess.max(REAL_EPSILON * self.extent(settings));
    }

    /// How far the laws may be from holding at the end of a pass (m).
    fn enough(&self, is_eased: bool, tolerance: f64) -> f64 {
        let margin = self.margin;
        if is_eased {
            CLOSE_ENOUGH * margin
        } else if self.has_many_rows() {
            tolerance.max((LARGE_TOLERANCE * margin).min(self.finest))
        } else if self.has_large() {
            tolerance.max((CURVED_TOLERANCE * margin).min(self.finest))
        } else {
            tolerance
        }
    }

    /// Whether some block is of large strain, whose equilibrium is found to a residual.
    pub fn has_large(&self) -> bool {
        let is_large = |block: &Block| matches!(block, Block::Flex(block) if block.is_large());
        self.blocks.iter().any(is_large)
    }

    /// Goes back to where the step begins, with the contacts that are near there.
    pub(super) fn return_to_start(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        tolerance: f64,
    ) {
        for block in &mut self.blocks {
            match block {
                Block::Flex(block) => block.restart(),
                Block::Rigid(block) => block.restart(),
            }
        }
        self.open_working_set(settings, tolerance, memory);
        self.path.rest(&self.blocks);
        self.list_near(&Listing {
            memory: Some(memory),
            pass: 0,
            is_again: false,
            keeps_rows: false,
            slop: 0.0,
            kept: 0.0,
        });
    }

    /// Notes what has slid off the other body of its contact within the step: its force is taken out by the next solve. Returns whether
    /// anything has.
    fn note_left(&mut self) -> bool {
        let lost = self.contacts.iter().filter(|contact| contact.is_lost);
        let keys = lost.map(|contact| self.candidates[contact.candidate].key);
        self.path.list_left(keys, &mut self.left)
    }

    /// Whether something that was stopped or has slid off within the step and is near no more ends, without a force, behind what it met: it
    /// would have gone around within the step.
    fn leads_around(&mut self) -> bool {
        let left = std::mem::take(&mut self.left);
        let is_led = left
            .iter()
            .any(|way| self.path.leads_around(*way, &self.blocks));
        self.left = left;
        is_led
    }

    /// Goes back to the rows that the forces of the iterate acted along, with the gaps of the base.
    fn keep_applied_rows(&mut self) {
        for contact in self.contacts.iter_mut().filter(|one| one.base.is_some()) {
            let gap = contact.kinematics.gap;
            contact.kinematics = contact.applied;
            contact.kinematics.gap = gap;
        }
    }

    /// Notes the rows that the forces of signed contacts and joints acted along; with `refreshes` they turn to the measured geometry.
    fn turn_signed_rows(&mut self, refreshes: bool) {
        for contact in self.contacts.iter_mut().filter(|one| one.base.is_none()) {
            contact.applied = contact.kinematics;
            if refreshes {
                let gap = contact.kinematics.gap;
                contact.kinematics = contact.measured;
                contact.kinematics.gap = gap;
                contact.known = None;
            }
        }
        if refreshes {
            self.refresh_joints();
        } else {
            self.keep_joints();
        }
    }
}
