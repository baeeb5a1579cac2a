//! Forces of rows that contradict each other.
//!
//! Where a body is wedged, friction may hold it with forces of any size between two contacts, and rows that ask for places a little
//! apart are answered by forces without bound. Then every contact gives way to the change of its own force,
//!
//! ```text
//! w = W p + b + s D (p - p₀),     D the diagonal of W
//! ```
//!
//! (a proximal step, Rockafellar 1976): passes that go on so lead to the same forces where there are any, and forces that push against
//! each other grow no faster than what they cannot close. Along its tangent a contact gives way to the whole of its force, `p₀ = 0`: friction that
//! holds a corner in a notch against itself slips by a thousandth of what the force alone would move it, and there is one answer.

use super::Island;
use crate::constraint::geometry::RESTING_THIN;
use crate::kkt::active_contact::ActiveContact;
use crate::kkt::delassus::compliance;
use crate::kkt::island::SolveSettings;
use crate::kkt::island::scene;
use crate::kkt::joints::Rows;
use crate::kkt::summary::IslandSummary;
use crate::kkt::tolerances::{CLOSE_ENOUGH, FEW_PASSES, LARGE_TOLERANCE, SOFTNESS};
use crate::kkt::{multipliers, working_set};
use crate::linalg::cone::ConeError;
use crate::math::Mat2;
use crate::system::Response;

/// How far a multiplier may move its contact by itself, relative to the extent of the scene: a light body under one a thousand times
/// heavier that falls across the scene within the step.
const FARTHEST: f64 = 1e3;

/// Finds new forces, with as little compliance of the contacts as does; returns whether there are any.
pub(super) fn solve_consistently(
    island: &mut Island,
    settings: &SolveSettings,
    tolerance: f64,
    summary: &mut IslandSummary,
) -> bool {
    let mut before = std::mem::take(&mut island.passes.before_solve);
    before.contacts.clone_from(&island.contacts);
    before.ties.clone_from(&island.joints.ties);
    let given = island.passes.softness;
    let mut softer = SOFTNESS.into_iter().filter(|next| *next > given);
    let is_consistent = loop {
        let solved = multipliers::solve_multipliers(island, settings, true, tolerance, summary);
        if solved.is_ok() && !contradicts(island, settings) {
            break true;
        }
        // Joints that turn far contradict each other less in a shorter step; in the last part of one, and where nothing turns, they give way as
        // contacts do.
        if settings.may_be_cut && turns_far(island) && strains_joints(island, settings) {
            break false;
        }
        let Some(softness) = softer.next() else {
            break false;
        };
        island.passes.softness = softness;
        island.contacts.clone_from(&before.contacts);
        island.joints.ties.clone_from(&before.ties);
    };
    island.passes.before_solve = before;
    is_consistent
}

/// Leaves open what joints and attachments cannot close as they contradict each other: a body that is welded to two places a little farther
/// apart than it is long. Nothing has changed there for [`FEW_PASSES`] passes whose base arrived, and nothing would in another; forces are
/// those of the compromise. Where the step is to be cut first, for joints that turn far, only what was open when it began is left, up to twice as
/// far: the body sways between what holds it.
pub(super) fn leave_contradictions(island: &mut Island, arrives: bool, settings: &SolveSettings) {
    if !arrives {
        return;
    }
    let least = CLOSE_ENOUGH * island.passes.margin;
    // Springs give way by themselves.
    for tie in island.joints.ties.iter_mut().filter(|tie| tie.give == 0.0) {
        let before = std::mem::replace(&mut tie.seen, tie.gap);
        let is_same = (tie.gap - before).abs() <= LARGE_TOLERANCE * tie.gap.abs();
        tie.n_same = if is_same { tie.n_same + 1 } else { 0 };
        let began = (tie.start - tie.goal).abs();
        let is_old = began > least && tie.error() <= 2.0 * began;
        let may_be_left = !settings.may_be_cut || is_old;
        if tie.n_same >= FEW_PASSES && tie.error() > least && may_be_left {
            tie.is_left = true;
            tie.goal += tie.gap;
            tie.closing = 0.0;
            tie.asked = [tie.goal, 0.0];
        }
    }
}

/// Asks overlaps and open joints that the step began with for no more than the bodies can move by.
pub(super) fn share_out_overlaps(
    island: &mut Island,
    slop: f64,
    contradicts: bool,
) -> Result<(), ConeError> {
    let scene = scene(&island.blocks, &island.parts, &island.segments);
    let candidates = &island.candidates;
    let began = |contact: &ActiveContact| match contact.base {
        Some(base) => base.gap - contact.kinematics.normal.dot(&base.moved),
        None => {
            let start = candidates[contact.candidate].start_gap(&scene);
            start.unwrap_or(contact.gap()).min(0.0)
        }
    };
    let joints = (&mut island.joints.ties[..], &island.joints.grips[..]);
    island.passes.parting.share_out(
        &island.blocks,
        &mut island.contacts,
        joints,
        (slop, contradicts),
        began,
    )
}

/// Leaves overlaps that the step began with where nothing can part them: between surfaces that are pinned, or driven, both.
pub(super) fn leave_immovable(island: &mut Island) {
    for contact in &mut island.contacts {
        let row = &contact.kinematics;
        let along = |own: Mat2| row.normal.dot(&(own * row.normal));
        if contact.base.is_none() && contact.allowance < 0.0 && row.gap < 0.0 {
            let own = compliance(&island.blocks, row, row, Response::Position);
            if own.is_none_or(|own| along(own) <= 0.0) {
                contact.allowance += row.gap;
                contact.kinematics.gap = 0.0;
            }
        }
    }
}

/// How far from where they are to be in the end joints and attachments were left open at most (m or rad), or yield to their forces by more than a
/// tenth of what would count as put apart. Of a step that `is_unsolved`, whose forces mean nothing, all of them that are open by so much.
pub(in crate::kkt) fn joint_violation(island: &Island, length_unit: f64, is_unsolved: bool) -> f64 {
    let ties = island.joints.ties.iter();
    let off = ties.map(|tie| {
        let unit = match tie.row.measure.is_turn() {
            true => 1.0,
            false => length_unit,
        };
        let counts = |off: f64| if off > RESTING_THIN * unit { off } else { 0.0 };
        if is_unsolved {
            counts(tie.open())
        } else if tie.is_left || tie.is_out_of_reach {
            (tie.goal + tie.gap - tie.target).abs()
        } else {
            counts((tie.yielding * tie.multiplier).abs())
        }
    });
    off.fold(0.0, f64::max)
}

/// Whether joints turn so far within the step that a shorter one asks for something else.
fn turns_far(island: &Island) -> bool {
    island.joints.bend(&island.blocks) > CLOSE_ENOUGH * island.passes.margin
}

/// Whether some joint is in that contradiction.
fn strains_joints(island: &Island, settings: &SolveSettings) -> bool {
    let extent = working_set::extent(island, settings);
    (0..island.joints.ties.len()).any(|row| {
        let tie = &island.joints.ties[row];
        let size = if tie.row.measure.is_turn() {
            1.0
        } else {
            extent
        };
        let own = island
            .joints
            .mobility(&island.blocks, row, (Response::Position, Rows::Kept));
        let moved = settings.b0 * tie.multiplier.abs() * own;
        moved.is_nan() || moved > FARTHEST * size
    })
}

/// Whether some multiplier would move its contact by far more than any motion of the island: then rows contradict each other, and forces
/// of any size would answer.
fn contradicts(island: &Island, settings: &SolveSettings) -> bool {
    let farthest = FARTHEST * working_set::extent(island, settings);
    let mut moves = island.contacts.iter().map(|contact| {
        let own = compliance(
            &island.blocks,
            &contact.kinematics,
            &contact.kinematics,
            Response::Position,
        );
        let along = |own: Mat2| {
            contact
                .kinematics
                .normal
                .dot(&(own * contact.kinematics.normal))
        };
        settings.b0 * contact.multiplier[0] * own.map_or(0.0, along)
    });
    moves.any(|moved| moved.is_nan() || moved > farthest)
}
