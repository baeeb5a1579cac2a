//! Proximal steps on the multipliers, `P ← prox(P)`, each a strictly convex problem in `a` solved by Newton's method.
//!
//! One step looks for the `a` with `A a = load + Gᵀ P(a)`, where `P(a)` solves the law of every row with
//! `w = free + G a + give P + (P - P_k)/D` and `P_k` from the step before. The answer of the whole problem is where it
//! stays. It need not be unique: redundant rows keep as much as they can of what they carried.

mod line;
mod merit;
mod predict;

use super::law::ConeStatus;
use super::problem::{ConeProblem, ConeRow};
use super::reduced::{Measure, Reduced};
use super::slip::SlipIteration;
use super::system::{Fit, System};
use super::{ConeSettings, LEVELS, State};
use std::f64::consts::SQRT_2;

/// Proximal steps at most, those that follow the slip included.
const MOST_STEPS: usize = 80;
/// Newton steps at most within one proximal step; they end by themselves, since pieces are finite in number.
const MOST_NEWTON_STEPS: usize = 80;
/// Imbalance at which a proximal step ends, beside the tolerance: soft bodies answer it with more than its share of motion.
const SMALL: f64 = 1e-2;
/// Newton steps with the factor of a slightly other geometry before a new one is made.
const MOST_KEPT: usize = 5;
/// Penalties up to this one are raised even while rows still change sides.
const MODERATE: f64 = 1e4;
/// Proximal steps without a residual lower by a tenth after which there is no use in more.
const PATIENCE: usize = 6;

/// Gain in the residual that renews the factorizations allowed (-).
const GAIN: f64 = 0.1;

/// Share of the tolerance to which what is solved is refined, as far as the factor at hand goes.
pub(super) const FINE: f64 = 1e-4;

/// Imbalance, relative to forces, that rounding may keep up: stiff penalties times the digits of a number.
const ROUNDING: f64 = 1e-7;

/// How proximal steps ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ending {
    /// Within the tolerance.
    Solved,
    /// Nothing gets better any more: rows that contradict each other, or slips that chase each other.
    Stalled,
    /// Newton's method needed more factorizations than allowed, or one failed; the forces are those of the last step completed.
    Spent,
}

/// Buffers of the proximal steps.
#[derive(Debug, Clone, Default)]
pub(super) struct Proximal {
    /// `1/D` of each row.
    penalty: Vec<f64>,
    /// `P(a)`.
    trial: Vec<[f64; 2]>,
    status: Vec<ConeStatus>,
    weights: Vec<[f64; 3]>,
    imbalance: Vec<f64>,
    /// The convex energy of which `imbalance` is the gradient.
    energy: f64,
    /// `A a - load`, and `free + G a` of each row.
    linear: Vec<f64>,
    gaps: Vec<[f64; 2]>,
    step: Vec<f64>,
    /// `A` and `G` times the step.
    product: Vec<f64>,
    moved: Vec<[f64; 2]>,
    /// `A⁻¹ (load + Gᵀ P)`.
    settled: Vec<f64>,
    saved: Vec<[f64; 2]>,
    saved_slip: Vec<f64>,
    slips: SlipIteration,
    found: Vec<f64>,
    slip_weights: Vec<f64>,
    pieces: Vec<ConeStatus>,
}

/// The metric `M = give + 1/D` of one row.
fn metric(give: [f64; 2], inverse_penalty: f64) -> [f64; 2] {
    give.map(|give| give + inverse_penalty)
}

/// `2^round(log2 value)` of a positive number: a mantissa of `√2` or more goes up.
fn nearest_power_of_two(value: f64) -> f64 {
    const MANTISSA: u64 = (1 << f64::MANTISSA_DIGITS >> 1) - 1;
    let round_up = MANTISSA + 1 - (SQRT_2.to_bits() & MANTISSA);
    f64::from_bits((value.max(f64::MIN_POSITIVE).to_bits() + round_up) & !MANTISSA)
}

impl Proximal {
    /// Improves `state` by proximal steps until it is solved, stalls, or has spent `n_allowed` factorizations without a lower residual, or
    /// `n_most` in all.
    ///
    /// The measure is that of the last step completed, infinite if the budget did not last for one.
    ///
    pub fn run(
        &mut self,
        problem: &ConeProblem,
        reduced: &Reduced,
        system: &mut System,
        state: &mut State,
        settings: &ConeSettings,
        [n_allowed, n_most]: [usize; 2],
    ) -> (Ending, Measure) {
        let (start, n_changes) = (system.spent(), system.n_changes);
        let mut limit = start + n_allowed.min(n_most);
        let mut renewed = f64::INFINITY;
        let mut refined: Option<Measure> = None;
        let (mut best, mut last, mut n_idle) = (f64::INFINITY, f64::INFINITY, 0);
        let known = state.measure.take();
        let mut measure = known.unwrap_or_else(|| {
            reduced.measure(
                problem,
                &state.a,
                &state.forces,
                &state.slip,
                settings,
                &mut state.status,
            )
        });
        if measure.is_within(settings, reduced.enough) {
            if measure.residual <= FINE * settings.tolerance {
                state.measure = known;
                return (Ending::Solved, measure);
            }
            // a factor at hand refines it: what rests would creep by the tolerance of every step
            self.saved.clone_from(&state.forces);
            self.saved_slip.clone_from(&state.slip);
            refined = Some(measure);
        }
        self.status.clone_from(&state.status);
        let (mut level, mut is_lowered) = (self.first_level(problem, reduced, system), false);
        let (rests, mut n_refining) = (refined.is_some(), 1);
        self.slips.forget();
        let mut completed = Measure {
            residual: f64::INFINITY,
            ..measure
        };
        for _ in 0..MOST_STEPS {
            let n_before = system.n_changes;
            // what is solved is only refined as far as the factor at hand, or a first one of a penalty, goes
            let most = match &refined {
                Some(best) if best.is_settled(reduced) => {
                    (start + n_refining).min(limit).max(system.spent())
                }
                _ => limit,
            };
            self.place(problem, reduced, state);
            let norm = match self.predict(problem, reduced, system, state, most) {
                Some(norm) => norm,
                None => self.evaluate(problem, reduced, state),
            };
            let goal = (norm, settings.tolerance);
            if !self.newton(problem, reduced, system, state, goal, most) {
                if completed.residual.is_finite() {
                    state.slip.copy_from_slice(&self.saved_slip);
                }
                return match refined {
                    Some(measure) => (self.restore(state), measure),
                    None => (Ending::Spent, completed),
                };
            }
            state.forces.copy_from_slice(&self.trial);
            // judged by the motion that the forces cause, as the answer will be
            reduced.total_load(problem, &state.forces, &mut self.settled);
            system.solve_bodies(&mut self.settled);
            measure = reduced.measure(
                problem,
                &self.settled,
                &state.forces,
                &state.slip,
                settings,
                &mut state.status,
            );
            completed = measure;
            if refined.is_none() {
                self.saved_slip.clone_from(&state.slip);
            }
            let is_solved = measure.is_within(settings, reduced.enough);
            let is_fine = measure.residual <= FINE * settings.tolerance
                || refined.is_some_and(|best| measure.residual > 0.5 * best.residual);
            // where errors are admitted, only what rests is refined: what has changed its pieces goes on moving
            let has_moved = reduced.enough > 0.0 && system.n_changes > n_changes + 1;
            let is_undilated = measure.relative_dilation <= settings.tolerance;
            let may_end = has_moved && measure.is_settled(reduced);
            if is_solved && (may_end || is_fine && is_undilated) {
                std::mem::swap(&mut state.a, &mut self.settled);
                state.measure = Some(measure);
                return (Ending::Solved, measure);
            }
            let is_better = |best: Measure| {
                measure.relative_dilation < best.relative_dilation
                    || measure.relative_dilation <= settings.tolerance
            };
            if is_solved && refined.is_none_or(is_better) {
                self.saved.clone_from(&state.forces);
                self.saved_slip.clone_from(&state.slip);
                refined = Some(measure);
            }
            let merit = measure.worst();
            if merit < GAIN * renewed {
                renewed = merit;
                limit = (system.spent() + n_allowed).min(start + n_most);
            }
            if merit < 0.9 * best {
                (best, n_idle) = (merit, 0);
            } else {
                n_idle += 1;
            }
            if n_idle == PATIENCE && (level == 0 || is_lowered) {
                break;
            }
            // what a stiff penalty leaves is rounding, which it magnifies: a softer one finishes
            if n_idle == PATIENCE {
                (level, n_idle, is_lowered) = (level - 1, 0, true);
                self.penalize(reduced, LEVELS[level]);
            }
            let is_slow = measure.residual > reduced.goal && measure.residual > 0.2 * last;
            last = measure.residual;
            let may_stiffen = system.n_changes == n_before
                || LEVELS.get(level + 1).is_some_and(|&next| next <= MODERATE);
            if is_slow
                && may_stiffen
                && !is_lowered
                && level + 1 < LEVELS.len()
                && refined.is_none_or(|best| !best.is_settled(reduced))
            {
                level += 1;
                self.penalize(reduced, LEVELS[level]);
                (last, n_idle) = (f64::INFINITY, 0);
            }
            // softer ones leave much of it where many bodies lie on each other, which tremble by that for good
            if rests && n_idle == 0 && !is_lowered && level + 1 < LEVELS.len() {
                (level, n_refining) = (LEVELS.len() - 1, 2);
                self.penalize(reduced, LEVELS[level]);
            }
            if measure.is_dilated
                || refined.is_some()
                || measure.relative_dilation > measure.residual
            {
                self.move_slips(problem, reduced, state);
            }
        }
        match refined {
            Some(measure) => (self.restore(state), measure),
            None => (Ending::Stalled, measure),
        }
    }

    /// Follows the slips, with an eye on the past as long as rows stay on their pieces.
    fn move_slips(&mut self, problem: &ConeProblem, reduced: &Reduced, state: &mut State) {
        if self.pieces != self.status {
            self.slips.forget();
            self.pieces.clone_from(&self.status);
        }
        reduced.follow_slip(problem, &state.a, &state.forces, &mut self.found);
        self.slip_weights.clear();
        // open contacts slip freely, without a say
        let weight = |((row, resistance), force): ((&ConeRow, &f64), &[f64; 2])| {
            if force[0] > 0.0 {
                row.friction() / resistance.sqrt()
            } else {
                0.0
            }
        };
        self.slip_weights.extend(
            problem
                .rows
                .iter()
                .zip(&reduced.resistance)
                .zip(&state.forces)
                .map(weight),
        );
        self.slips
            .advance(&mut state.slip, &self.found, &self.slip_weights);
    }

    /// The stiffest penalty that the factor at hand serves for, or else the softest one.
    fn first_level(&mut self, problem: &ConeProblem, reduced: &Reduced, system: &System) -> usize {
        for level in (0..LEVELS.len()).rev() {
            self.penalize(reduced, LEVELS[level]);
            self.weigh(problem);
            if system.serves(&self.weights) {
                return level;
            }
        }
        0
    }

    /// Replaces the right-hand side in `step` by what `H` of the pieces at hand answers: by the factor at hand if it fits, corrected where few
    /// rows have changed, or by a new one. Whether that is exact; nothing if it would take more than `most` factorizations in all, or one fails.
    ///
    /// - `fit`, `may_keep`: how the factor at hand fits, and whether one of other numbers will do.
    fn find_step(
        &mut self,
        problem: &ConeProblem,
        system: &mut System,
        (fit, may_keep): (Fit, bool),
        most: usize,
    ) -> Option<bool> {
        if fit == Fit::Exact || fit == Fit::Near && may_keep {
            system.solve(&mut self.step);
            return Some(fit == Fit::Exact);
        }
        if system.spent() >= most {
            return None;
        }
        if may_keep && system.solve_changed(&self.weights, &mut self.step) {
            return Some(false);
        }
        // `A` has a factor: what fails here is a penalty too stiff for the digits of a number
        system.factorize(problem, &self.weights).ok()?;
        system.solve(&mut self.step);
        Some(true)
    }

    fn restore(&self, state: &mut State) -> Ending {
        state.forces.copy_from_slice(&self.saved);
        state.slip.copy_from_slice(&self.saved_slip);
        Ending::Solved
    }

    /// Chooses `D` as a power of two, so that the same factor serves while estimates move a little.
    fn penalize(&mut self, reduced: &Reduced, level: f64) {
        let inverse = |&resistance: &f64| {
            if resistance > 0.0 {
                nearest_power_of_two(resistance / level)
            } else {
                1.0
            }
        };
        self.penalty.clear();
        self.penalty.extend(reduced.resistance.iter().map(inverse));
    }

    /// Newton's method with exact line search on one proximal step, from the present `a`, which has been evaluated; `trial` becomes
    /// `P(a)`.
    ///
    /// - `norm`: the size of the imbalance.
    ///
    /// False if that takes more than `most` factorizations in all, or one that fails.
    fn newton(
        &mut self,
        problem: &ConeProblem,
        reduced: &Reduced,
        system: &mut System,
        state: &mut State,
        (mut norm, tolerance): (f64, f64),
        most: usize,
    ) -> bool {
        let mut is_full = false;
        let (mut n_kept, mut least_norm, mut n_idle) = (0, norm, 0);
        for _ in 0..MOST_NEWTON_STEPS {
            if norm <= SMALL * tolerance * reduced.force_scale(&self.trial) {
                return true;
            }
            self.weigh(problem);
            self.step.clear();
            self.step.extend(self.imbalance.iter().map(|value| -value));
            let fit = system.fit(problem, &self.weights);
            // the piece it was made for has been solved: what is left is rounding
            if fit == Fit::Exact && is_full {
                return true;
            }
            let Some(is_exact) = self.find_step(problem, system, (fit, n_kept < MOST_KEPT), most)
            else {
                return false;
            };
            n_kept = if is_exact { 0 } else { n_kept + 1 };
            self.trace_step(problem);
            let length = self.search(problem, reduced, state);
            self.go(state, length);
            let before = norm;
            norm = self.evaluate(problem, reduced, state);
            is_full = is_exact && norm > 0.5 * before && (length - 1.0).abs() < 1e-6;
            if n_kept > 0 && norm > 0.3 * before {
                n_kept = MOST_KEPT;
            }
            n_idle = if norm < 0.9 * least_norm {
                0
            } else {
                n_idle + 1
            };
            least_norm = least_norm.min(norm);
            // rows at the edge between two pieces change sides with every rounding error
            if n_idle >= 4 && norm <= ROUNDING * reduced.force_scale(&self.trial) {
                return true;
            }
        }
        false
    }
}
