//! The problem in whole multipliers `P = p + acted`, and the one judge of every answer.

use super::law::{ConeStatus, project};
use super::problem::{ConeLaw, ConeProblem, ConeRow};
use super::{ConeSettings, LEVELS};

/// A problem restated for `P`: `A a = load + Gᵀ P`, `w = free + G a + give P`.
#[derive(Debug, Clone, Default)]
pub(super) struct Reduced {
    /// `r - Gᵀ acted`, length `n_dofs`.
    pub load: Vec<f64>,
    /// `free - give acted`, per row.
    pub free: Vec<[f64; 2]>,
    /// `W_ii + give_i`, the larger of both components, per row; zero if nothing can move the row. Of what is held for good, `W_ii` counts up to a multiple
    /// of what stiff bodies yield alone: by that errors of `w` are forces where several rows hold such a body. Rows that change sides press by `W_ii`.
    pub resistance: Vec<f64>,
    /// The reciprocal of the diagonal of `A`, length `n_dofs`.
    pub inverse_diagonal: Vec<f64>,
    /// The largest `|load| / sqrt(A_ii)`.
    pub largest_load: f64,
    /// The error of `w` that is good enough, in its unit.
    pub enough: f64,
    /// The residual that what comes to rest is solved to, if it can be (-).
    pub goal: f64,
}

/// Root mean squares over the rows that something can move.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Mean {
    /// Of the natural map, relative to the largest force (-).
    pub residual: f64,
    /// The same in the unit of `w`.
    pub miss: f64,
}

/// How well forces and motion fit the laws.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Measure {
    /// The natural map with the slips used, relative to the largest force (-).
    pub residual: f64,
    /// The same in the unit of `w`.
    pub miss: f64,
    /// Root mean squares of both over the rows.
    pub mean: Mean,
    /// What wrong dilation leaves, in the unit of `w`: the gap `mu |sigma - |w_t||` of what carries a force, or the overlap that it hides of what
    /// carries none.
    pub dilation: f64,
    /// The same as a force, relative to the largest force (-).
    pub relative_dilation: f64,
    /// Whether the dilation exceeds what the settings admit.
    pub is_dilated: bool,
}

impl Measure {
    /// Whether the answer is good enough, where the error of `w` may be `enough`.
    pub fn is_within(&self, settings: &ConeSettings, enough: f64) -> bool {
        let is_near = self.residual <= settings.tolerance || self.miss <= enough;
        is_near && !self.is_dilated
    }

    /// Whether the answer is as good as what the start was off by asks for.
    pub fn is_settled(&self, reduced: &Reduced) -> bool {
        self.residual <= reduced.goal || self.miss <= reduced.enough
    }

    /// The worse of both defects.
    pub fn worst(&self) -> f64 {
        self.residual.max(self.relative_dilation)
    }
}

impl Reduced {
    pub fn restate(&mut self, problem: &ConeProblem) {
        self.load.clear();
        self.load.extend_from_slice(problem.load);
        self.free.clear();
        self.resistance.clear();
        for row in problem.rows {
            let acted = row.acted();
            problem.push(row, -1.0, acted, &mut self.load);
            self.free
                .push([0, 1].map(|k| row.free[k] - row.give[k] * acted[k]));
            let normal = row.scale[0] + row.give[0];
            let tangential = if row.has_tangent() {
                row.scale[1] + row.give[1]
            } else {
                0.0
            };
            self.resistance.push(match row.law {
                ConeLaw::Bilateral => row.scale[0].min(LEVELS[0] * row.local) + row.give[0],
                _ => normal.max(tangential),
            });
        }
        self.inverse_diagonal.clear();
        for node in 0..problem.matrix.n_nodes() {
            let diagonal = problem
                .matrix
                .block(node, node)
                .map_or([1.0; 2], |block| [block[0], block[3]]);
            self.inverse_diagonal
                .extend(diagonal.map(|value| 1.0 / value));
        }
        self.largest_load = self
            .load
            .iter()
            .zip(&self.inverse_diagonal)
            .fold(0.0_f64, |most, (load, inverse)| {
                most.max(load * load * inverse)
            })
            .sqrt();
    }

    /// `free + G a` of one row.
    pub fn gap(&self, problem: &ConeProblem, row: usize, a: &[f64]) -> [f64; 2] {
        let motion = problem.motion(&problem.rows[row], a);
        [self.free[row][0] + motion[0], self.free[row][1] + motion[1]]
    }

    /// `w` of one row.
    pub fn slack(&self, problem: &ConeProblem, row: usize, a: &[f64], force: [f64; 2]) -> [f64; 2] {
        let gap = self.gap(problem, row, a);
        let give = problem.rows[row].give;
        [gap[0] + give[0] * force[0], gap[1] + give[1] * force[1]]
    }

    /// Where the natural map sends the force of one row; `w` with the dilation `mu sigma` in it.
    pub fn natural(
        &self,
        row: &ConeRow,
        index: usize,
        force: [f64; 2],
        w: [f64; 2],
    ) -> ([f64; 2], ConeStatus) {
        let resistance = self.resistance[index];
        project(
            row,
            [resistance * force[0] - w[0], resistance * force[1] - w[1]],
            [resistance; 2],
        )
    }

    /// The size of forces, in square roots of energy: `max sqrt(W_ii) |P|`, or a fraction of the load if that is more, so
    /// that forces next to nothing are not judged by themselves.
    pub fn force_scale(&self, forces: &[[f64; 2]]) -> f64 {
        let pressing = forces
            .iter()
            .zip(&self.resistance)
            .map(|(force, resistance)| {
                f64::sqrt(*resistance) * f64::max(force[0].abs(), force[1].abs())
            });
        let scale = pressing.fold(1e-3 * self.largest_load, f64::max);
        // rounding of a large free gap is no force
        let free = self
            .free
            .iter()
            .zip(&self.resistance)
            .filter(|(_, resistance)| **resistance > 0.0);
        free.map(|(free, resistance)| {
            1e-6 * f64::max(free[0].abs(), free[1].abs()) / f64::sqrt(*resistance)
        })
        .fold(scale, f64::max)
        .max(f64::MIN_POSITIVE)
    }

    /// Judges forces and the motion they cause, and reads the status of each row.
    pub fn measure(
        &self,
        problem: &ConeProblem,
        a: &[f64],
        forces: &[[f64; 2]],
        slip: &[f64],
        settings: &ConeSettings,
        status: &mut [ConeStatus],
    ) -> Measure {
        let mut measure = Measure::default();
        let (mut sums, mut n_rows) = (Mean::default(), 0);
        let scale = self.force_scale(forces);
        for (index, row) in problem.rows.iter().enumerate() {
            status[index] = ConeStatus::Open;
            if self.resistance[index] <= 0.0 {
                continue;
            }
            let (force, mu, weight) =
                (forces[index], row.friction(), self.resistance[index].sqrt());
            let mut w = self.slack(problem, index, a, force);
            let (slipped, overlap) = (w[1].abs(), (-w[0]).max(0.0));
            w[0] += mu * slip[index];
            let (mapped, now) = self.natural(row, index, force, w);
            status[index] = now;
            let error = (force[0] - mapped[0])
                .abs()
                .max((force[1] - mapped[1]).abs());
            let term = weight * error / scale;
            // `f64::max` would pass over a NaN
            let (miss, term) = if term.is_finite() {
                (self.resistance[index] * error, term)
            } else {
                (f64::INFINITY, f64::INFINITY)
            };
            measure.miss = measure.miss.max(miss);
            measure.residual = measure.residual.max(term);
            sums.miss += miss * miss;
            sums.residual += term * term;
            n_rows += 1;
            if row.has_tangent() {
                // more dilation than slip hides the overlap of what carries no force, any that is wrong leaves a gap under what slides
                let (gap, admitted) = if force[0] > 0.0 {
                    let error = (slipped - slip[index]).abs();
                    (mu * error, mu * settings.slip_tolerance * slipped)
                } else {
                    (overlap.min(mu * (slip[index] - slipped).max(0.0)), 0.0)
                };
                measure.dilation = measure.dilation.max(gap);
                measure.relative_dilation = measure.relative_dilation.max(gap / (weight * scale));
                measure.is_dilated |= gap - admitted > settings.gap_tolerance
                    && gap > settings.tolerance * weight * scale;
            }
        }
        let root = |sum: f64| (sum / f64::from(n_rows.max(1))).sqrt();
        measure.mean = Mean {
            residual: root(sums.residual),
            miss: root(sums.miss),
        };
        measure
    }

    /// Sets `sigma = |w_t|` on every row with friction.
    pub fn follow_slip(
        &self,
        problem: &ConeProblem,
        a: &[f64],
        forces: &[[f64; 2]],
        slip: &mut Vec<f64>,
    ) {
        slip.clear();
        slip.extend(problem.rows.iter().enumerate().map(|(index, row)| {
            if row.has_tangent() {
                self.slack(problem, index, a, forces[index])[1].abs()
            } else {
                0.0
            }
        }));
    }

    /// Overwrites `out` with `load + Gᵀ P`, or with the load alone if there are no forces.
    pub fn total_load(&self, problem: &ConeProblem, forces: &[[f64; 2]], out: &mut Vec<f64>) {
        out.clone_from(&self.load);
        for (row, &force) in problem.rows.iter().zip(forces) {
            problem.push(row, 1.0, force, out);
        }
    }
}
