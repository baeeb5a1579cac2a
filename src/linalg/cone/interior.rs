//! Mehrotra's predictor–corrector on the rays of the laws, for the forces that proximal steps then finish.
//!
//! A force is a sum over rays `P = Σ zeta_k (1, ± mu)` with `low <= zeta <= high`: two rays span the cone of a contact, one
//! carries any other row. Each bound has a slack `y` and `y (zeta - low)` is driven to zero. `H` is the same as elsewhere, with
//! weights from `y / (zeta - low)`. A small proximal term keeps rays apart that redundant rows make alike, and makes rows
//! without bounds solvable.

mod ray;

use super::problem::ConeProblem;
use super::reduced::Reduced;
use super::system::System;
use super::{ConeSettings, State};
use ray::{Pair, Ray};

const MOST_ITERATIONS: usize = 60;
/// The weight a ray may have at most, times `W_ii`.
const STIFFEST: f64 = 1e8;
/// Distance from the bounds at the start, of the size of forces. Less starts warmer and jams sooner.
const CLEARANCE: f64 = 0.1;
/// Products of force and slack at the end, down to which slips are followed: enough to tell which rays carry.
const CLOSE_ENOUGH: f64 = 1e-8;
/// Products from which on the forces are looked at: they may be good enough before it is known which rays carry.
const NEARLY: f64 = 1e-3;

/// Buffers of the interior point.
#[derive(Debug, Clone, Default)]
pub(super) struct Interior {
    pairs: Vec<Pair>,
    forces: Vec<[f64; 2]>,
    weights: Vec<[f64; 3]>,
    balance: Vec<f64>,
    step: Vec<f64>,
    /// Forces and motion of the iterate, while what they would be on their bounds is looked at.
    kept: Vec<[f64; 2]>,
    kept_motion: Vec<f64>,
    /// The size of forces, in square roots of energy.
    scale: f64,
}

impl Interior {
    /// Replaces the forces and slips of `state` by better ones, or leaves them if that fails; returns whether they are good enough.
    pub fn run(
        &mut self,
        problem: &ConeProblem,
        reduced: &Reduced,
        system: &mut System,
        state: &mut State,
        settings: &ConeSettings,
        n_allowed: usize,
    ) -> bool {
        let limit = system.n_factorizations + n_allowed;
        if !self.start(problem, reduced, state) {
            return false;
        }
        let mut closeness = 1.0;
        for iteration in 0..MOST_ITERATIONS {
            let (imbalance, apart) = self.evaluate(
                problem,
                reduced,
                state,
                iteration > 0 && closeness > CLOSE_ENOUGH,
            );
            closeness = self.mean_product() / (self.scale * self.scale);
            if closeness < CLOSE_ENOUGH && apart < 1e-4 && imbalance < 1e-4 {
                break;
            }
            if closeness.max(apart).max(imbalance) < NEARLY
                && self.suffices(problem, reduced, system, state, settings)
            {
                return true;
            }
            self.weigh(problem, reduced);
            // what rounding or the budget ends is still a start for proximal steps
            if system.n_factorizations >= limit || system.factorize(problem, &self.weights).is_err()
            {
                break;
            }
            self.advance(problem, system, state);
        }
        self.hand_back(problem, reduced, state);
        false
    }

    /// Whether the forces are good enough with the rays that do not carry put on their bounds, which they are then.
    fn suffices(
        &mut self,
        problem: &ConeProblem,
        reduced: &Reduced,
        system: &mut System,
        state: &mut State,
        settings: &ConeSettings,
    ) -> bool {
        self.kept.clone_from(&state.forces);
        self.kept_motion.clone_from(&state.a);
        self.hand_back(problem, reduced, state);
        reduced.total_load(problem, &state.forces, &mut state.a);
        system.solve_bodies(&mut state.a);
        let State {
            forces,
            slip,
            a,
            status,
            ..
        } = state;
        let measure = reduced.measure(problem, a, forces, slip, settings, status);
        let suffices = measure.is_within(settings, reduced.enough);
        if !suffices {
            forces.copy_from_slice(&self.kept);
            a.copy_from_slice(&self.kept_motion);
        }
        suffices
    }

    /// Puts every ray off its bounds, starting from the forces and the motion at hand; false if nothing pushes.
    fn start(&mut self, problem: &ConeProblem, reduced: &Reduced, state: &State) -> bool {
        let mut energy = 0.0;
        for (index, row) in problem
            .rows
            .iter()
            .enumerate()
            .filter(|(index, _)| reduced.resistance[*index] > 0.0)
        {
            let force = state.forces[index];
            let mapped = reduced
                .natural(
                    row,
                    index,
                    force,
                    reduced.slack(problem, index, &state.a, force),
                )
                .0;
            let most = force
                .iter()
                .chain(&mapped)
                .fold(0.0_f64, |most, value| most.max(value.abs()));
            energy += reduced.resistance[index] * most * most;
        }
        self.scale = (energy / problem.rows.len().max(1) as f64).sqrt();
        self.pairs.clear();
        for (index, row) in problem.rows.iter().enumerate() {
            let (mu, force) = (row.friction(), state.forces[index]);
            let (low, high) = row.bounds();
            let mut pair = Pair::default();
            let w = reduced.slack(problem, index, &state.a, force);
            let size = self.scale / reduced.resistance[index].max(f64::MIN_POSITIVE).sqrt();
            let signs: &[f64] = if row.has_tangent() {
                &[1.0, -1.0]
            } else {
                &[0.0]
            };
            // a row that nothing can move, or whose bounds meet, keeps its force
            if reduced.resistance[index] > 0.0 && low < high {
                pair.n_rays = signs.len();
            }
            for (ray, &sign) in pair.rays.iter_mut().zip(signs) {
                let share = if sign == 0.0 {
                    force[0]
                } else {
                    0.5 * (force[0] + sign * force[1] / mu)
                };
                let slack = w[0] + mu * state.slip[index] + sign * mu * w[1];
                let margin = CLEARANCE * size.min(high - low);
                let gap = CLEARANCE * size * reduced.resistance[index];
                *ray = Ray {
                    sign,
                    bounds: [low, high],
                    force: share.max(low + margin).min(high - margin),
                    ..Ray::default()
                };
                for (side, slack) in [slack, -slack].into_iter().enumerate() {
                    ray.slack[side] = if ray.has_bound(side) {
                        slack.max(gap)
                    } else {
                        0.0
                    };
                }
            }
            self.pairs.push(pair);
        }
        self.scale > 0.0 && self.scale.is_finite()
    }

    /// Refreshes forces, gaps and balance; returns the worst of balance and gaps, relative.
    fn evaluate(
        &mut self,
        problem: &ConeProblem,
        reduced: &Reduced,
        state: &mut State,
        follow: bool,
    ) -> (f64, f64) {
        self.forces.clear();
        let mut apart = 0.0_f64;
        for (index, row) in problem.rows.iter().enumerate() {
            let mu = row.friction();
            let pair = &mut self.pairs[index];
            let force = pair.force(mu).unwrap_or(state.forces[index]);
            self.forces.push(force);
            let w = reduced.slack(problem, index, &state.a, force);
            if follow && row.has_tangent() {
                state.slip[index] = w[1].abs();
            }
            for ray in &mut pair.rays[..pair.n_rays] {
                ray.gap = w[0] + mu * state.slip[index] + ray.sign * mu * w[1] - ray.slack[0]
                    + ray.slack[1];
                apart = apart.max(ray.gap.abs() / (self.scale * reduced.resistance[index].sqrt()));
            }
        }
        self.balance.resize(reduced.load.len(), 0.0);
        reduced.total_load(problem, &self.forces, &mut self.balance);
        problem
            .matrix
            .multiply_add(-1.0, &state.a, &mut self.balance);
        let worst = self
            .balance
            .iter()
            .zip(&reduced.inverse_diagonal)
            .fold(0.0_f64, |worst, (value, inverse)| {
                worst.max(value * value * inverse)
            });
        (worst.sqrt() / self.scale, apart)
    }

    fn rays(&self) -> impl Iterator<Item = &Ray> {
        self.pairs.iter().flat_map(|pair| &pair.rays[..pair.n_rays])
    }

    fn mean_product(&self) -> f64 {
        let n_bounds = self
            .rays()
            .map(|ray| (0..2).filter(|&side| ray.has_bound(side)).count())
            .sum::<usize>();
        self.rays().map(Ray::product).sum::<f64>() / n_bounds.max(1) as f64
    }

    fn weigh(&mut self, problem: &ConeProblem, reduced: &Reduced) {
        self.weights.clear();
        for (index, row) in problem.rows.iter().enumerate() {
            let (mu, [give_n, give_t]) = (row.friction(), row.give);
            let proximal = reduced.resistance[index] / STIFFEST;
            let pair = &mut self.pairs[index];
            let own = |ray: &Ray| {
                proximal + ray.eliminated().0 + give_n + ray.sign * ray.sign * mu * mu * give_t
            };
            pair.stiffness = match pair.n_rays {
                0 => [0.0; 3],
                1 => [1.0 / own(&pair.rays[0]), 0.0, 0.0],
                _ => {
                    let (first, second, cross) = (
                        own(&pair.rays[0]),
                        own(&pair.rays[1]),
                        give_n - mu * mu * give_t,
                    );
                    let determinant = first * second - cross * cross;
                    [
                        second / determinant,
                        -cross / determinant,
                        first / determinant,
                    ]
                }
            };
            let [first, cross, second] = pair.stiffness;
            let sign = pair.rays[0].sign;
            let sum = first + second;
            self.weights.push([
                sum + 2.0 * cross,
                sign * mu * (first - second),
                sign * sign * mu * mu * (sum - 2.0 * cross),
            ]);
        }
    }

    /// One predictor and one corrector with the factor at hand.
    fn advance(&mut self, problem: &ConeProblem, system: &mut System, state: &mut State) {
        let mean = self.mean_product();
        for ray in self.pairs.iter_mut().flat_map(|pair| &mut pair.rays) {
            ray.target = [0, 1].map(|side| {
                if ray.has_bound(side) {
                    ray.slack[side] * ray.room(side)
                } else {
                    0.0
                }
            });
        }
        self.find_direction(problem, system);
        let (length, mut predicted, mut n_bounds) = (self.longest().min(1.0), 0.0, 0);
        for ray in self.rays() {
            for side in (0..2).filter(|&side| ray.has_bound(side)) {
                predicted += (ray.slack[side] + length * ray.slack_change[side])
                    * (ray.room(side) + length * ray.room_change(side));
                n_bounds += 1;
            }
        }
        let ratio = if mean > 0.0 {
            predicted / n_bounds.max(1) as f64 / mean
        } else {
            0.0
        };
        // a tenth at least: full steps to the edge jam on degenerate contacts
        let centre = mean * ratio.powi(3).max(0.1);
        for ray in self.pairs.iter_mut().flat_map(|pair| &mut pair.rays) {
            for side in 0..2 {
                if ray.has_bound(side) {
                    ray.target[side] += ray.slack_change[side] * ray.room_change(side) - centre;
                }
            }
        }
        self.find_direction(problem, system);
        let length = (0.99 * self.longest()).min(1.0);
        state
            .a
            .iter_mut()
            .zip(&self.step)
            .for_each(|(a, step)| *a += length * step);
        for ray in self.pairs.iter_mut().flat_map(|pair| &mut pair.rays) {
            ray.force += length * ray.change;
            for side in 0..2 {
                ray.slack[side] += length * ray.slack_change[side];
            }
        }
    }

    fn find_direction(&mut self, problem: &ConeProblem, system: &mut System) {
        self.step.clear();
        self.step.extend_from_slice(&self.balance);
        for (row, pair) in problem.rows.iter().zip(&self.pairs) {
            let right = pair.rays.map(|ray| ray.eliminated().1);
            problem.push(
                row,
                -1.0,
                pair.combine(row.friction(), pair.stiffen(right)),
                &mut self.step,
            );
        }
        system.solve(&mut self.step);
        for (row, pair) in problem.rows.iter().zip(&mut self.pairs) {
            let (mu, along) = (row.friction(), problem.motion(row, &self.step));
            let total = pair
                .rays
                .map(|ray| ray.eliminated().1 + along[0] + ray.sign * mu * along[1]);
            let change = pair.stiffen(total);
            for (ray, change) in pair.rays[..pair.n_rays].iter_mut().zip(change) {
                ray.change = -change;
                for side in 0..2 {
                    ray.slack_change[side] = if ray.has_bound(side) {
                        (-ray.target[side] - ray.slack[side] * ray.room_change(side))
                            / ray.room(side)
                    } else {
                        0.0
                    };
                }
            }
        }
    }

    /// The step at which the first force or slack meets its bound.
    fn longest(&self) -> f64 {
        let mut longest = f64::INFINITY;
        for ray in self.rays() {
            for side in (0..2).filter(|&side| ray.has_bound(side)) {
                for (value, change) in [
                    (ray.room(side), ray.room_change(side)),
                    (ray.slack[side], ray.slack_change[side]),
                ] {
                    if change < 0.0 {
                        longest = longest.min(-value / change);
                    }
                }
            }
        }
        longest
    }

    /// Rays whose force is small beside their slack are put on their bound.
    fn hand_back(&self, problem: &ConeProblem, reduced: &Reduced, state: &mut State) {
        for (index, row) in problem.rows.iter().enumerate() {
            let mut pair = self.pairs[index];
            for ray in &mut pair.rays[..pair.n_rays] {
                for side in 0..2 {
                    if ray.has_bound(side)
                        && ray.room(side) * reduced.resistance[index] < 1e-3 * ray.slack[side]
                    {
                        ray.force = ray.bounds[side];
                    }
                }
            }
            if let Some(force) = pair
                .force(row.friction())
                .filter(|force| force[0].is_finite() && force[1].is_finite())
            {
                state.forces[index] = force;
            }
        }
    }
}
