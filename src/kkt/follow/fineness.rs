//! How finely the laws are asked to hold in a pass.

use crate::kkt::cones;
use crate::kkt::island::{Island, SolveSettings};
use crate::kkt::tolerances::{CLOSE_ENOUGH, FEW_PASSES, LARGE_TOLERANCE};
use crate::kkt::working_set;
use crate::linalg::cone::SETTLING;
use crate::math::REAL_EPSILON;

/// Share of the margin within which the laws need not hold any better where bodies of large strain find their equilibrium to a residual (-).
const CURVED_TOLERANCE: f64 = 1e-6;

/// Whether the contacts at hand are so many that they are solved as a sparse problem.
fn has_many_rows(island: &Island) -> bool {
    cones::is_sparse(island, 2 * island.contacts.len() + island.joints.ties.len())
}

/// Passes in which the laws have to hold as well as they can be made to.
pub(super) fn n_exact_passes(island: &Island, settings: &SolveSettings) -> usize {
    if has_many_rows(island) {
        FEW_PASSES.min(settings.max_newton)
    } else {
        settings.max_newton
    }
}

/// Notes what the multipliers of the last step miss, if there are any, and how well rapier's numbers hold positions: with a tolerance of lengths
/// alone what rests may tremble by it for good, as vertices that roll on each other do from step to step.
pub(super) fn note_start(island: &mut Island, guessed: Option<f64>, settings: &SolveSettings) {
    island.passes.guessed = guessed.unwrap_or(f64::INFINITY);
    island.passes.rounding = REAL_EPSILON * working_set::extent(island, settings);
}

/// What forces of the last step may miss and be kept (m).
pub(super) fn still(island: &Island, tolerance: f64) -> f64 {
    if island.joints.ties.is_empty() && has_many_rows(island) {
        next_to_nothing(island, tolerance)
    } else {
        tolerance
    }
}

/// Where contacts alone are many, what is nothing to that which is nothing to the margin (m). What rests creeps by no more in a step.
fn next_to_nothing(island: &Island, tolerance: f64) -> f64 {
    tolerance.max(LARGE_TOLERANCE * LARGE_TOLERANCE * island.passes.margin)
}

/// How far the laws may be from holding at the end of a pass (m).
pub(super) fn enough(island: &Island, is_eased: bool, tolerance: f64) -> f64 {
    let margin = island.passes.margin;
    // Of what large strain or joints hold errors are forces of what is stiff: they may be as large as is small beside how far what touches has moved
    // on each other, which what is at rest, or pressed and still, has not, and as rapier's numbers do not see. What joints hold may be held by forces of
    // any size.
    let curved = || {
        let share = SETTLING.get();
        let rounding = island.passes.rounding;
        let settled = (share * island.passes.guessed).max(rounding);
        let beside = match island.joints.ties.is_empty() {
            true => (share * moved_on_each_other(island)).min(rounding),
            false => 0.0,
        };
        let most = beside.clamp(CURVED_TOLERANCE * margin, LARGE_TOLERANCE * margin);
        tolerance.max(most.min(settled))
    };
    if is_eased {
        CLOSE_ENOUGH * margin
    } else if !has_many_rows(island) {
        if island.has_large() {
            curved()
        } else {
            tolerance
        }
    } else if island.joints.ties.is_empty() {
        let missed = island
            .passes
            .guessed
            .max(next_to_nothing(island, tolerance));
        tolerance.max((LARGE_TOLERANCE * margin).min(CLOSE_ENOUGH * missed))
    } else {
        curved()
    }
}

/// How far bodies that press on each other have moved against each other since the step began, at most (m).
fn moved_on_each_other(island: &Island) -> f64 {
    let closed = island.contacts.iter().filter(|contact| contact.is_closed());
    let moved = closed.filter_map(|contact| contact.base.map(|base| base.moved.norm()));
    moved.fold(0.0, f64::max)
}
