//! Newton's iterations of an island by the constraint functions: each solves the bodies under the multipliers it has, measures
//! gaps and slips, and takes one Newton step.
//!
//! Where they fail they are tried once more from large `ε` to small, and if that fails too the step is solved by Lagrange
//! multipliers; both are counted.

use super::constraint_function::{ConstraintFunction, Scale};
use super::delassus::assemble;
use super::island::{Island, SolveSettings};
use super::multipliers::{self, prepare};
use super::summary::IslandSummary;
use super::tolerances::{ANGLE_TOLERANCE, PARTING_RATE};
use super::working_set;
use crate::constraint::contact::ContactMemory;
use crate::linalg::complementarity::{Problem, RowKind, Status};
use crate::math::{exp, rounding};
use crate::system::{Block, Response};
use std::f64::consts::FRAC_2_PI;

/// Where a second trial begins, `[ε_N, ε_T]`, and what each iteration multiplies them by.
const WIDE: [f64; 2] = [1e-1, 1.0];
const NARROWER: f64 = 0.1;

/// Residual below which the multipliers are nearly right, so that rows are measured once more.
const NEARLY: f64 = 1e-3;

/// Iteration from which gaps are extrapolated along the rows.
const GAPS_KEPT_FROM: usize = 30;

/// Iteration from which the rows, directions and levers of the forces, stay what they are.
const ROWS_KEPT_FROM: usize = 2;

/// Multiple of the tolerance by which the true gaps may differ from the extrapolated ones that the iterations ended with: some 1e-6 m in
/// scenes of a metre, where bodies press on an edge that they slide to and fro over.
const STRAYED: f64 = 2e5;

/// Least length of a problem, of the size of its bodies.
const LEAST_LENGTH: f64 = rounding::SHARE;

/// What the iterations of a step go by.
pub(super) struct Trial<'a> {
    pub functions: &'a ConstraintFunction,
    pub settings: &'a SolveSettings,
    pub memory: &'a ContactMemory,
    /// Rounding of a gap (m).
    pub tolerance: f64,
}

/// Iterates with the constraint functions, and again from wide ones; returns whether either converged.
pub(super) fn iterate_functions(
    island: &mut Island,
    trial: &Trial<'_>,
    summary: &mut IslandSummary,
) -> bool {
    if follow_functions(island, trial, trial.functions.epsilon, summary) {
        return true;
    }
    summary.has_failed = true;
    if trial.functions.has_continuation {
        working_set::start_again(island, trial.settings, trial.tolerance, trial.memory);
        if follow_functions(island, trial, WIDE, summary) {
            return true;
        }
    }
    summary.is_substituted = true;
    working_set::start_again(island, trial.settings, trial.tolerance, trial.memory);
    false
}

/// Newton's iterations, with `ε` that begins at `begin` and becomes what it should be; returns whether they converged.
fn follow_functions(
    island: &mut Island,
    trial: &Trial<'_>,
    begin: [f64; 2],
    summary: &mut IslandSummary,
) -> bool {
    let functions = trial.functions;
    let kept = exp(-PARTING_RATE * trial.settings.dt);
    let mut scale = None;
    let mut epsilon = begin;
    let mut is_near = false;
    for iteration in 0..functions.max_iterations {
        summary.n_newton += 1;
        let turned = working_set::correct(island).angle;
        let is_guess = iteration == 0 && !island.contacts.is_empty();
        let error = working_set::measure(island, is_guess || iteration >= GAPS_KEPT_FROM);
        let has_more = working_set::add_violated(island, trial.tolerance, kept, trial.memory);
        if !(turned + error).is_finite() {
            return false;
        }
        let residual = function_residual(island, trial.settings.b0, scale.as_ref());
        let is_quiet = turned <= ANGLE_TOLERANCE && !has_more;
        let allowed = scale.map_or(0.0, |scale: Scale| trial.tolerance / scale.length);
        let is_narrow = epsilon == functions.epsilon || island.contacts.is_empty();
        if is_quiet && is_narrow && residual <= allowed {
            settle_functions(island, functions);
            let is_true = iteration < GAPS_KEPT_FROM
                || working_set::measure(island, false) <= STRAYED * trial.tolerance;
            return is_true;
        }
        let refreshes = iteration < ROWS_KEPT_FROM || residual < NEARLY && !is_near;
        is_near |= residual < NEARLY;
        if refreshes {
            working_set::refresh_rows(island);
        }
        for (now, end) in epsilon.iter_mut().zip(functions.epsilon) {
            *now = (NARROWER * *now).max(end);
        }
        if island.contacts.is_empty() {
            continue;
        }
        let Some(found) = function_step(island, trial, epsilon, refreshes) else {
            return false;
        };
        scale = Some(found);
    }
    false
}

/// The largest `|w|`, `|v|` under the present multipliers, where the bodies are now (-).
fn function_residual(island: &mut Island, b0: f64, scale: Option<&Scale>) -> f64 {
    multipliers::position_rows(island, b0);
    match scale {
        _ if island.problem.rows.is_empty() => 0.0,
        None => f64::INFINITY,
        Some(scale) => {
            island
                .newton
                .start(&island.problem.kinds, &island.problem.multipliers, scale);
            island
                .newton
                .residual(&island.problem.kinds, &island.problem.free, scale)
        }
    }
}

/// One Newton step of all multipliers; what they were divided by, or `None` if the Jacobian is singular.
fn function_step(
    island: &mut Island,
    trial: &Trial<'_>,
    epsilon: [f64; 2],
    has_new_rows: bool,
) -> Option<Scale> {
    for contact in &island.contacts {
        prepare(&mut island.blocks, &contact.kinematics);
        if has_new_rows {
            prepare(&mut island.blocks, &contact.applied);
        }
    }
    let b0 = trial.settings.b0;
    multipliers::position_rows(island, b0);
    let contacts = &island.contacts;
    assemble(
        &island.blocks,
        &island.problem.rows,
        Response::Position,
        |index| &contacts[index].kinematics,
        &mut island.problem.delassus,
    );
    multipliers::take_out_multipliers(island, has_new_rows);
    let problem = Problem {
        delassus: &island.problem.delassus,
        free: &island.problem.free,
        rows: &island.problem.kinds,
        acted: &[],
    };
    let size = island
        .blocks
        .iter()
        .fold(0.0f64, |size, block| match block {
            Block::Flex(block) => size.max(block.size()),
            Block::Rigid(_) => size,
        });
    let mut scale = Scale::of(&problem, b0, LEAST_LENGTH * size, epsilon);
    if let Some([length, force]) = trial.functions.scale {
        (scale.length, scale.force) = (length, force);
    }
    island
        .newton
        .start(&island.problem.kinds, &island.problem.multipliers, &scale);
    let searches = trial.functions.has_line_search;
    let is_regular =
        island
            .newton
            .advance(&problem, &scale, searches, &mut island.problem.multipliers);
    for (row, direction) in island.problem.rows.iter().enumerate() {
        let contact = &mut island.contacts[direction.contact];
        contact.multiplier[direction.axis] = island.problem.multipliers[row];
    }
    is_regular.then_some(scale)
}

/// Reads statuses off the solution, and lets go of contacts on the open branch, `g/ℓ > p/F`, whose `p = ε_N ℓ F/g` is of the
/// size of what the method leaves undecided: later stages take whatever presses for closed.
fn settle_functions(island: &mut Island, functions: &ConstraintFunction) {
    let limit = functions.epsilon[0].sqrt();
    // The ratio where the slip is `sqrt(ε_T) ℓ`.
    let slides = 1.0 - FRAC_2_PI * functions.epsilon[1].sqrt();
    let mut lets_go = false;
    for (row, direction) in island.problem.rows.iter().enumerate() {
        let unknown = island.newton.unknown(row);
        let contact = &mut island.contacts[direction.contact];
        match island.problem.kinds[row] {
            RowKind::Friction { .. } if contact.status[0] == Status::Open => {}
            // Friction acts against the slip.
            RowKind::Friction { .. } if unknown > slides => {
                contact.status[1] = Status::SlipNegative;
            }
            RowKind::Friction { .. } if unknown < -slides => {
                contact.status[1] = Status::SlipPositive;
            }
            RowKind::Friction { .. } => contact.status[1] = Status::Stick,
            _ if unknown > limit => contact.status[0] = Status::Stick,
            _ => {
                lets_go |= contact.multiplier[0] > 0.0;
                contact.multiplier = [0.0; 2];
                contact.status = [Status::Open; 2];
            }
        }
    }
    if lets_go {
        working_set::correct(island);
        working_set::measure(island, true);
    }
}
