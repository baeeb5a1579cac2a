//! Newton's iterations of the position stage, in rounds.
//!
//! A round measures true gaps while it can; where geometry keeps changing it ends along gaps extrapolated on its rows, which
//! always converges. What it found is then measured in truth, and if that is not it, the next round begins there with new rows.

use super::island::{Island, SolveSettings};
use super::position::PARTING_RATE;
use super::summary::IslandSummary;
use crate::constraint::contact::ContactMemory;
use crate::math::exp;

/// Turning below this angle (rad) changes no position by more than round-off.
pub(super) const ANGLE_TOLERANCE: f64 = 1e-11;

/// Iteration from which the rows, directions and levers of the forces, stay what they are.
pub(super) const ROWS_KEPT_FROM: usize = 2;

/// Iteration from which gaps are extrapolated along the rows.
const GAPS_KEPT_FROM: usize = 12;

/// Multiple of the tolerance by which true gaps may differ from extrapolated ones without another round.
const CLOSE: f64 = 1e2;

/// Multiple of the tolerance by which the true gaps may differ from the extrapolated ones that a round ended with: some 1e-6 m in
/// scenes of a metre, where bodies press on an edge that they slide to and fro over.
pub(super) const STRAYED: f64 = 2e5;

/// Rounds of iterations, each with rows of its own: the extrapolated gaps that a round ends with may not be the true ones.
const ROUNDS: usize = 5;

/// Round from which rows follow the geometry only half the way.
const EASED_FROM: usize = 2;

/// Iterations after which the stiffness of hinged bodies against turning is found anew.
const RESTIFFENED_EVERY: usize = 5;

/// Multiple of the tolerance within which the multipliers of the last step are right but for what happened since.
const NEAR: f64 = 1e5;

/// Iterations in which the working set still forms.
const SETTLING: usize = 6;

/// Growth of the error, from the largest while the working set forms, that will not come back.
const DIVERGENCE: f64 = 1e2;

/// Multiple of the tolerance that still counts when the iterations are used up.
const ACCEPTABLE: f64 = 1e5;

impl Island {
    /// Newton's iterations; returns whether they converged.
    pub(super) fn iterate(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        tolerance: f64,
        summary: &mut IslandSummary,
    ) -> bool {
        let mut peak = 0.0f64;
        for round in 0..ROUNDS {
            let found =
                self.iterate_round(settings, memory, (tolerance, &mut peak), round, summary);
            let Some(strayed) = found else {
                return false;
            };
            // Where bodies slide to and fro over an edge further rounds are no nearer.
            let enough = if round == 0 { CLOSE } else { STRAYED };
            if strayed <= enough * tolerance {
                return true;
            }
            // What the rows found is near: there they are measured anew.
            self.refresh_rows(round >= EASED_FROM);
            let solved = self.solve_multipliers(settings, true, tolerance, summary);
            if solved.is_err() {
                return false;
            }
        }
        false
    }

    /// Newton's iterations with rows of the first two; returns how far from holding the laws are in truth, if they converged (m).
    fn iterate_round(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        (tolerance, peak): (f64, &mut f64),
        round: usize,
        summary: &mut IslandSummary,
    ) -> Option<f64> {
        let kept = exp(-PARTING_RATE * settings.dt);
        for iteration in 0..settings.max_newton {
            summary.n_newton += 1;
            let turned = self.correct().angle;
            let is_guess =
                round == 0 && iteration == 0 && !(self.contacts.is_empty() && self.ties.is_empty());
            let extrapolates = iteration >= GAPS_KEPT_FROM;
            let mut error = if is_guess {
                self.measure_guess()
            } else {
                self.measure(extrapolates)
            };
            // Under the last step's multipliers bodies may be anywhere: geometry counts if these are nearly right.
            let misleads = is_guess && error > NEAR * tolerance;
            if is_guess && !misleads {
                error = self.measure(false);
            }
            let has_more = !misleads && self.add_violated(tolerance, kept, memory);
            let is_last = iteration + 1 == settings.max_newton;
            let enough = if is_last {
                ACCEPTABLE * tolerance
            } else {
                tolerance
            };
            let has_turned = turned > if is_last { enough } else { ANGLE_TOLERANCE };
            if !(has_turned || error > enough || has_more) {
                summary.is_doubtful |= extrapolates;
                return Some(if extrapolates {
                    self.measure(false)
                } else {
                    error
                });
            }
            if iteration < SETTLING {
                *peak = peak.max(turned).max(error);
            }
            let is_diverging = turned.max(error) > DIVERGENCE * *peak;
            // Extrapolation ends what is on its way, not what has fled.
            let has_fled = iteration + 1 == GAPS_KEPT_FROM && error > *peak;
            if is_last || is_diverging || has_fled || !(turned + error).is_finite() {
                return None;
            }
            let has_joints = !self.ties.is_empty();
            if has_joints && iteration > 0 && iteration % RESTIFFENED_EVERY == 0 {
                self.restiffen_turns(settings);
                self.correct();
                self.measure(extrapolates);
            }
            let refreshes = iteration < ROWS_KEPT_FROM && !misleads;
            if refreshes {
                self.refresh_rows(round > EASED_FROM);
            }
            self.solve_multipliers(settings, refreshes, tolerance, summary)
                .ok()?;
        }
        None
    }
}
