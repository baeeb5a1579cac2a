//! The position stage along a feasible path: from where the bodies are apart, towards where the forces would have them, as far as they
//! stay apart.
//!
//! A *pass* lists the near pairs at the base, solves one contact problem on their rows for new forces, finds where the bodies end under
//! them, and moves the base that way until the time of impact. It is over when the base is where the forces lead and the laws hold
//! there in truth. Whatever the forces are, the base is free of overlaps: what is not solved within the budget stops at the base.

mod arrival;
mod consistent;
mod fineness;
mod listing;
mod parted;
mod trend;
mod turning;

pub(super) use self::arrival::return_to_first_stop;
pub(super) use self::consistent::joint_violation;
pub(super) use self::parted::{end_losses, list_parted};

use self::fineness::{enough, n_exact_passes, note_start, still};
use self::listing::Listing;
use self::trend::Trend;
use self::turning::Settling;
use super::cones;
use super::island::{Island, SolveSettings};
use super::joints::put_apart;
use super::summary::IslandSummary;
use super::tolerances::{
    ANGLE_TOLERANCE, CLOSE_ENOUGH, FEW_PASSES, LARGE_TOLERANCE, OVERLAPPED, PARTING_RATE,
};
use super::working_set::{self, Turned};
use crate::constraint::contact::ContactMemory;
use crate::math::{exp, is_held};
use crate::system::Block;

/// Passes of a step that stop short of where the forces lead. Every one of them goes on with forces that do not know what comes after: bodies
/// that are stopped that often meet in ways that the step does not resolve.
const MOST_STOPS: usize = 20;

/// Passes that count as one iteration. In the second half of them the laws need only hold to [`CLOSE_ENOUGH`].
const PASSES_PER_ITERATION: usize = 2;

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

/// Solves the positions along the path. Where the laws cannot be made to hold, the best place that was reached by the whole of the step
/// counts, or else the first impact.
pub(super) fn follow_path(
    island: &mut Island,
    settings: &SolveSettings,
    memory: &ContactMemory,
    tolerance: f64,
    summary: &mut IslandSummary,
) -> Passed {
    find_margin(island, settings, tolerance);
    if !island.path.is_empty() {
        island.path.rest(&island.blocks);
    }
    island.path.list_pressed(memory, &mut island.pressed_before);
    island.passes.impact.is_known = false;
    island.passes.arrival.is_known = false;
    island.passes.departure.is_known = false;
    island.passes.softness = 0.0;
    island.passes.left.clear();
    tell_base(island, false);
    let passed = try_passes(island, settings, memory, tolerance, summary);
    if passed != Passed::Stopped {
        return passed;
    }
    if let Some(passed) = arrival::end_at_arrival(island) {
        return passed;
    }
    if arrival::return_to_first_stop(island) {
        working_set::correct(island);
    }
    Passed::Stopped
}

/// Finds what the laws may miss at the very most: the least margin of the ways, or where there is no path, what counts as near.
pub(super) fn find_margin(island: &mut Island, settings: &SolveSettings, tolerance: f64) {
    island.passes.margin = if island.path.is_empty() {
        NEAR / CLOSE_ENOUGH * tolerance
    } else {
        island.path.least_margin()
    };
    island.passes.slack = put_apart(settings.length_unit);
}

fn try_passes(
    island: &mut Island,
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
        rest: LARGE_TOLERANCE * island.passes.margin,
        kept,
    };
    listing::list_near(island, &listing);
    parted::note_pressing(island);
    listing.memory = None;
    cones::note_yielding(island, settings.b0);
    let mut turned = working_set::correct(island);
    let mut n_stopped = 0;
    let mut has_left = false;
    let (mut last, mut is_idle) = (f64::INFINITY, false);
    let (n_passes, mut trend) = (PASSES_PER_ITERATION * settings.max_newton, Trend::new());
    let mut rows: Option<Settling> = None;
    for pass in 0..n_passes {
        summary.n_newton += 1;
        // Under the forces of the last step bodies may be anywhere: that way is gone only if they are nearly right.
        let is_guess = pass == 0 && !(island.contacts.is_empty() && island.joints.ties.is_empty());
        let is_eased = pass >= n_exact_passes(island, settings);
        let near = enough(island, is_eased, NEAR * tolerance);
        let guessed = is_guess.then(|| working_set::measure_guess(island));
        let misleads = guessed.is_some_and(|guessed| guessed > near);
        if pass == 0 {
            note_start(island, guessed, settings);
        }
        let mut arrives = false;
        let mut error = 0.0;
        if !is_finite(island) || has_left && leads_around(island) {
            return Passed::Stopped;
        }
        if !misleads {
            arrives = island.path.is_empty() || island.path.advance(&island.blocks);
            let led = tell_base(island, pass >= FEW_PASSES && is_idle);
            (turned.angle, turned.way) = (turned.angle.max(led.angle), turned.way.max(led.way));
            if !arrives {
                island.path.list_stopping(&mut island.passes.left);
            }
            n_stopped += usize::from(!arrives);
            listing.pass = pass + 1;
            // Rows that turn to and fro are left as they are in the end. Gaps along a path are true all the same; those of signed rows follow
            // their rows.
            listing.keeps_rows = is_eased && arrives;
            listing::list_near(island, &listing);
            consistent::leave_contradictions(island, arrives, settings);
            error = working_set::measure(island, listing.keeps_rows);
            is_idle = error > SLOWEST * last;
            last = error;
        }
        let has_more = !misleads && working_set::add_violated(island, tolerance, kept, memory);
        // Forces of the last step that are kept must be right, or what rests creeps.
        let enough = if is_guess {
            still(island, tolerance)
        } else {
            enough(island, is_eased, tolerance)
        };
        let lack = if is_eased && arrives {
            arrival::shortfall(island, true).max(CLOSE_ENOUGH * turned.way / enough)
        } else {
            f64::INFINITY
        };
        let is_close = if is_eased {
            lack <= CLOSE_ENOUGH
        } else {
            let is_near = !island.path.is_empty() && turned.way <= enough;
            let has_settled = || rows.is_none_or(|rows| rows.has_settled(island));
            error <= enough && (turned.angle <= ANGLE_TOLERANCE || is_near) && has_settled()
        };
        if is_guess {
            rows = Some(Settling::of_guess(island, misleads));
        }
        if arrives && is_close && !has_more {
            end_at_base(island);
            keep_applied_rows(island);
            let has_strayed =
                listing.keeps_rows && working_set::measure_signed(island) > island.passes.margin;
            return match (leads_around(island), has_strayed) {
                (true, _) => Passed::Stopped,
                (false, true) => Passed::Arrived,
                (false, false) => Passed::Solved,
            };
        }
        if arrives && !has_more && turned.angle <= CLOSE_ENOUGH {
            arrival::keep_arrival(island);
        }
        if is_eased && trend.is_hopeless(lack, n_passes - pass - 1) {
            return Passed::Stopped;
        }
        let may_retreat =
            !(misleads || listing.keeps_rows || island.path.is_empty() || is_led(island));
        if may_retreat && island.path.retreat(&island.blocks) {
            tell_base(island, false);
            listing::list_near(
                island,
                &Listing {
                    is_again: true,
                    ..listing
                },
            );
            working_set::measure(island, false);
        }
        if !(error + turned.angle).is_finite() || n_stopped > MOST_STOPS {
            return Passed::Stopped;
        }
        if !island.joints.ties.is_empty() && pass > 0 && pass % 5 == 0 {
            island.joints.restiffen_turns(&mut island.blocks, settings);
        }
        let contradicts = is_idle && pass >= FEW_PASSES && !settings.may_be_cut;
        if consistent::share_out_overlaps(island, listing.slop, contradicts).is_err() {
            return Passed::Stopped;
        }
        has_left = note_left(island);
        turn_signed_rows(island, !misleads && !listing.keeps_rows);
        if !consistent::solve_consistently(island, settings, tolerance, summary) {
            return Passed::Stopped;
        }
        cones::note_yielding(island, settings.b0);
        consistent::leave_immovable(island);
        if n_stopped > 0 && !island.passes.impact.is_known {
            arrival::keep_impact(island);
        }
        turned = working_set::correct(island);
    }
    Passed::Stopped
}

/// Whether some block is led from the base: its iterate is not where the last way led any more.
fn is_led(island: &Island) -> bool {
    let is_led = |block: &Block| matches!(block, Block::Flex(block) if block.is_led());
    island.blocks.iter().any(is_led)
}

/// Ends the step of what is led at the base, which its iterate is as near to as the laws ask for.
fn end_at_base(island: &mut Island) {
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.end_at_base();
        }
    }
}

/// Tells the blocks of large strain where the base is; returns how far from there the iterate of those is that are led.
///
/// - `leads`: whether those are led from now on that are in the last part of a step.
fn tell_base(island: &mut Island, leads: bool) -> Turned {
    let mut led = Turned::default();
    for (index, block) in island.blocks.iter_mut().enumerate() {
        if let Block::Flex(block) = block
            && block.is_large()
            && let Some(base) = island.path.base_of(index, block.positions().len())
        {
            let left = block.set_base(base, leads);
            led.angle = led.angle.max(left);
            led.way = led.way.max(left * block.size());
        }
    }
    led
}

/// Whether the blocks' iterate consists of numbers: what is none is passed over by every search.
fn is_finite(island: &Island) -> bool {
    island.blocks.iter().all(|block| match block {
        Block::Flex(block) => block.positions().iter().all(|x| x.is_finite()),
        Block::Rigid(block) => {
            let motion = block.current();
            motion.centre.iter().all(|x| x.is_finite()) && motion.angle.is_finite()
        }
    })
}

/// Whether the blocks' iterate is where rapier's numbers reach.
pub(super) fn is_in_range(island: &Island) -> bool {
    island.blocks.iter().all(|block| match block {
        Block::Flex(block) => block.positions().iter().all(|x| is_held(*x)),
        Block::Rigid(block) => block.current().centre.iter().all(|x| is_held(*x)),
    })
}

/// Goes back to where the step begins, with the contacts that are near there.
pub(super) fn return_to_start(
    island: &mut Island,
    settings: &SolveSettings,
    memory: &ContactMemory,
    tolerance: f64,
) {
    for block in &mut island.blocks {
        match block {
            Block::Flex(block) => block.restart(),
            Block::Rigid(block) => block.restart(),
        }
    }
    working_set::open_working_set(island, settings, tolerance, memory);
    island.path.rest(&island.blocks);
    listing::list_near(
        island,
        &Listing {
            memory: Some(memory),
            pass: 0,
            is_again: false,
            keeps_rows: false,
            slop: 0.0,
            rest: 0.0,
            kept: 0.0,
        },
    );
}

/// Notes what has slid off the other body of its contact within the step: its force is taken out by the next solve. Returns whether
/// anything has.
fn note_left(island: &mut Island) -> bool {
    let lost = island.contacts.iter().filter(|contact| contact.is_lost);
    let keys = lost.map(|contact| island.candidates[contact.candidate].key);
    island.path.list_left(keys, &mut island.passes.left)
}

/// Whether something that was stopped or has slid off within the step and is near no more ends, without a force, behind what it met: it
/// would have gone around within the step.
fn leads_around(island: &mut Island) -> bool {
    let left = std::mem::take(&mut island.passes.left);
    let is_led = left
        .iter()
        .any(|way| island.path.leads_around(*way, &island.blocks));
    island.passes.left = left;
    is_led
}

/// Goes back to the rows that the forces of the iterate acted along, with the gaps of the base.
fn keep_applied_rows(island: &mut Island) {
    for contact in island.contacts.iter_mut().filter(|one| one.base.is_some()) {
        let gap = contact.kinematics.gap;
        contact.kinematics = contact.applied;
        contact.kinematics.gap = gap;
    }
}

/// Notes the rows that the forces of signed contacts and joints acted along; with `refreshes` they turn to the measured geometry.
fn turn_signed_rows(island: &mut Island, refreshes: bool) {
    for contact in island.contacts.iter_mut().filter(|one| one.base.is_none()) {
        contact.applied = contact.kinematics;
        if refreshes {
            let gap = contact.kinematics.gap;
            contact.kinematics = contact.measured;
            contact.kinematics.gap = gap;
            contact.known = None;
        }
    }
    if refreshes {
        island.joints.turn_rows(&island.blocks);
    } else {
        island.joints.keep_rows();
    }
}
