//! Accelerated projected gradient on the multipliers: the last resort, which never brings energy.
//!
//! One sweep moves all rows by `P ← Π(V - w(V)/(L W_ii))` and takes one solve with the factor of `A`, so that nothing
//! dense is stored. `V` looks ahead along the last change; it is reset where that leads uphill.

use super::State;
use super::law::project;
use super::problem::ConeProblem;
use super::reduced::Reduced;
use super::system::System;

const N_SWEEPS: usize = 100;

/// Buffers of the sweeps.
#[derive(Debug, Clone, Default)]
pub(super) struct Sweep {
    ahead: Vec<[f64; 2]>,
    ahead_slack: Vec<[f64; 2]>,
    next: Vec<[f64; 2]>,
    next_slack: Vec<[f64; 2]>,
    slack: Vec<[f64; 2]>,
}

impl Sweep {
    /// Sweeps from the forces of `state`, which must obey their bounds.
    pub fn run(
        &mut self,
        problem: &ConeProblem,
        reduced: &Reduced,
        system: &mut System,
        state: &mut State,
    ) {
        let n_rows = problem.rows.len();
        for buffer in [
            &mut self.ahead,
            &mut self.ahead_slack,
            &mut self.next,
            &mut self.next_slack,
            &mut self.slack,
        ] {
            buffer.resize(n_rows, [0.0; 2]);
        }
        respond(
            problem,
            reduced,
            system,
            &mut state.a,
            &state.forces,
            &mut self.slack,
        );
        self.ahead.copy_from_slice(&state.forces);
        self.ahead_slack.copy_from_slice(&self.slack);
        let (mut stiffness, mut momentum) = (1.0_f64, 1.0_f64);
        for sweep in 0..N_SWEEPS {
            for (index, row) in problem.rows.iter().enumerate() {
                self.next[index] =
                    self.project_row(reduced, row, index, state.slip[index], stiffness);
            }
            respond(
                problem,
                reduced,
                system,
                &mut state.a,
                &self.next,
                &mut self.next_slack,
            );
            let (curved, length, uphill) = self.compare(reduced, &state.forces);
            if curved > stiffness * length * (1.0 + 1e-12) {
                stiffness = (1.05 * curved / length).max(1.5 * stiffness);
                continue;
            }
            let last_momentum = if uphill { 1.0 } else { momentum };
            momentum = 0.5 * (1.0 + (1.0 + 4.0 * last_momentum * last_momentum).sqrt());
            let forward = (last_momentum - 1.0) / momentum;
            for index in 0..n_rows {
                for k in 0..2 {
                    let (next, slack) = (self.next[index][k], self.next_slack[index][k]);
                    self.ahead[index][k] = next + forward * (next - state.forces[index][k]);
                    self.ahead_slack[index][k] = slack + forward * (slack - self.slack[index][k]);
                }
            }
            state.forces.copy_from_slice(&self.next);
            self.slack.copy_from_slice(&self.next_slack);
            if sweep % 10 == 9 {
                for (index, row) in problem.rows.iter().enumerate() {
                    state.slip[index] = if row.has_tangent() {
                        self.slack[index][1].abs()
                    } else {
                        0.0
                    };
                }
            }
        }
    }

    fn project_row(
        &self,
        reduced: &Reduced,
        row: &super::ConeRow,
        index: usize,
        slip: f64,
        stiffness: f64,
    ) -> [f64; 2] {
        let metric = stiffness * reduced.resistance[index];
        if metric <= 0.0 {
            return self.ahead[index];
        }
        let (force, mut slack) = (self.ahead[index], self.ahead_slack[index]);
        slack[0] += row.friction() * slip;
        project(
            row,
            [0, 1].map(|k| metric * force[k] - slack[k]),
            [metric; 2],
        )
        .0
    }

    /// Of the change `next - ahead`: its energy, its square in the metric, and whether it turns against the change of forces.
    fn compare(&self, reduced: &Reduced, forces: &[[f64; 2]]) -> (f64, f64, bool) {
        let (mut curved, mut length, mut turn) = (0.0, 0.0, 0.0);
        for (index, resistance) in reduced.resistance.iter().enumerate() {
            for (k, force) in forces[index].iter().enumerate() {
                let change = self.next[index][k] - self.ahead[index][k];
                curved += change * (self.next_slack[index][k] - self.ahead_slack[index][k]);
                length += resistance * change * change;
                turn += resistance * change * (self.next[index][k] - force);
            }
        }
        (curved, length, turn < 0.0)
    }
}

/// Writes `a = A⁻¹ (load + Gᵀ P)` and `w` of every row.
fn respond(
    problem: &ConeProblem,
    reduced: &Reduced,
    system: &mut System,
    a: &mut Vec<f64>,
    forces: &[[f64; 2]],
    slack: &mut [[f64; 2]],
) {
    reduced.total_load(problem, forces, a);
    system.solve_bodies(a);
    for (index, slack) in slack.iter_mut().enumerate() {
        *slack = reduced.slack(problem, index, a, forces[index]);
    }
}
