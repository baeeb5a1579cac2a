//! The position stage: (C.5) with `g(x') >= 0`, `p >= 0` and Coulomb friction on the slip of the step.
//!
//! Divided by `b0` the second row of (C.5) reads `w = W p + b`, symmetric in `G`. Each Newton iteration solves the blocks
//! under the multipliers it has, beginning with those of the last step; measures gaps and slips there; and, unless they
//! hold, finds new multipliers from `b = g / b0 - W p`. A contact at rest so costs one solve.

use super::constraint_function::ContactMethod;
use super::follow::{self, Passed};
use super::island::{Island, SolveSettings};
use super::smooth::{self, Trial};
use super::summary::IslandSummary;
use super::{together, working_set};
use crate::constraint::contact::ContactMemory;
use crate::system::Block;

pub(super) fn solve_positions(
    island: &mut Island,
    settings: &SolveSettings,
    memory: &ContactMemory,
    summary: &mut IslandSummary,
) {
    let tolerance = working_set::gap_tolerance(island, settings);
    working_set::open_working_set(island, settings, tolerance, memory);
    follow::find_margin(island, settings, tolerance);
    let is_solved = match &settings.contact {
        ContactMethod::Lagrange => false,
        ContactMethod::ConstraintFunction(functions) => {
            let trial = Trial {
                functions,
                settings,
                memory,
                tolerance,
            };
            smooth::iterate_functions(island, &trial, summary)
        }
    };
    let mut passed = if is_solved {
        Passed::Solved
    } else {
        follow::follow_path(island, settings, memory, tolerance, summary)
    };
    if island.path.is_empty() {
        // What is out of range ends its body's step, and is told by name.
        if follow::is_in_range(island) && island.path.has_met_itself(&island.blocks) {
            working_set::start_again(island, settings, tolerance, memory);
            passed = follow::follow_path(island, settings, memory, tolerance, summary);
        }
    }
    summary.is_cut = passed == Passed::Arrived;
    summary.is_stopped = passed == Passed::Stopped;
    if !island.path.is_empty() {
        if summary.is_unsolved() {
            island.path.stop(&mut island.blocks);
            working_set::measure_signed(island);
        }
        follow::list_parted(island);
    } else if summary.is_stopped && !settings.may_be_cut {
        // No path tells how far the bodies may go.
        together::end_together(island, (settings.dt, settings.length_unit), summary);
    }
    if !island.joints.ties.is_empty() {
        island.joints.prepare(&mut island.blocks);
        island.joints.relax_turns(&mut island.blocks);
    }
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.place_velocities();
            block.measure_elastic_energy();
        }
    }
    // Blocks may answer by another factor from here on.
    island.joints.prepare(&mut island.blocks);
    summary.gap_violation = working_set::gap_violation(island, summary.is_unsolved());
    summary.slip_violation = working_set::slip_violation(island);
    // Where all end together that is told already.
    if !island.joints.ties.is_empty() {
        summary.joint_violation = follow::joint_violation(island, settings.length_unit, false);
    }
}
