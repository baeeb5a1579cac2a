//! The convex energy of a proximal step and its derivatives, where `a` is and along a step of Newton's method.

use super::line::least;
use super::{Proximal, metric};
use crate::linalg::cone::State;
use crate::linalg::cone::law::{ConeStatus, project, slope};
use crate::linalg::cone::problem::{ConeProblem, ConeRow};
use crate::linalg::cone::reduced::Reduced;

impl Proximal {
    /// Finds `A a - load` and the gaps `free + G a` of the present `a`.
    pub(super) fn place(&mut self, problem: &ConeProblem, reduced: &Reduced, state: &State) {
        self.linear.resize(reduced.load.len(), 0.0);
        problem.matrix.multiply(&state.a, &mut self.linear);
        self.linear
            .iter_mut()
            .zip(&reduced.load)
            .for_each(|(value, load)| *value -= load);
        self.gaps.clear();
        self.gaps
            .extend((0..problem.rows.len()).map(|index| reduced.gap(problem, index, &state.a)));
    }

    /// Finds how both change along the step.
    pub(super) fn trace_step(&mut self, problem: &ConeProblem) {
        self.product.resize(self.step.len(), 0.0);
        problem.matrix.multiply(&self.step, &mut self.product);
        self.moved.clear();
        let moved = |row: &ConeRow| problem.motion(row, &self.step);
        self.moved.extend(problem.rows.iter().map(moved));
    }

    /// Goes some part of the step, which has been traced.
    pub(super) fn go(&mut self, state: &mut State, length: f64) {
        let add = |to: &mut [f64], by: &[f64]| {
            to.iter_mut()
                .zip(by)
                .for_each(|(to, by)| *to += length * by);
        };
        add(&mut state.a, &self.step);
        add(&mut self.linear, &self.product);
        add(self.gaps.as_flattened_mut(), self.moved.as_flattened());
    }

    /// Finds `P(a)` and the imbalance `A a - load - Gᵀ P(a)`; returns its size as square root of an energy.
    pub(super) fn evaluate(
        &mut self,
        problem: &ConeProblem,
        reduced: &Reduced,
        state: &State,
    ) -> f64 {
        self.imbalance.clone_from(&self.linear);
        self.energy = state
            .a
            .iter()
            .zip(self.linear.iter().zip(&reduced.load))
            .map(|(a, (value, load))| 0.5 * a * (value - load))
            .sum();
        self.trial.clear();
        self.status.clear();
        for (index, row) in problem.rows.iter().enumerate() {
            let (force, status) = if reduced.resistance[index] > 0.0 {
                let (b, metric) = (
                    self.request(row, state, index),
                    metric(row.give, self.penalty[index]),
                );
                let (force, status) = project(row, b, metric);
                self.energy += (0..2)
                    .map(|k| force[k] * (b[k] - 0.5 * metric[k] * force[k]))
                    .sum::<f64>();
                (force, status)
            } else {
                (state.forces[index], ConeStatus::Open)
            };
            problem.push(row, -1.0, force, &mut self.imbalance);
            self.trial.push(force);
            self.status.push(status);
        }
        let energy = self
            .imbalance
            .iter()
            .zip(&reduced.inverse_diagonal)
            .map(|(value, inverse)| value * value * inverse);
        energy.sum::<f64>().sqrt()
    }

    /// `b = P_k/D - (free + G a + mu sigma)`.
    pub(super) fn request(&self, row: &ConeRow, state: &State, index: usize) -> [f64; 2] {
        let (gap, force, inverse) = (self.gaps[index], state.forces[index], self.penalty[index]);
        let dilation = row.friction() * state.slip[index];
        [
            force[0] * inverse - gap[0] - dilation,
            force[1] * inverse - gap[1],
        ]
    }

    pub(super) fn weigh(&mut self, problem: &ConeProblem) {
        self.weights.clear();
        let rows = problem.rows.iter().zip(&self.status).zip(&self.penalty);
        self.weights.extend(
            rows.map(|((row, &status), &penalty)| slope(row, status, metric(row.give, penalty))),
        );
    }

    /// The length of the Newton step, which has been traced, at which the convex energy is least, to a tenth of its first slope.
    pub(super) fn search(
        &mut self,
        problem: &ConeProblem,
        reduced: &Reduced,
        state: &State,
    ) -> f64 {
        let (mut constant, mut linear, mut start) = (0.0, 0.0, 0.0);
        for (dof, step) in self.step.iter().enumerate() {
            constant += step * self.linear[dof];
            linear += step * self.product[dof];
            start += step * self.imbalance[dof];
        }
        let slope = |length: f64| {
            let mut slope = constant + length * linear;
            for (index, row) in problem.rows.iter().enumerate() {
                let (moved, at) = (self.moved[index], self.request(row, state, index));
                let force = if reduced.resistance[index] > 0.0 {
                    project(
                        row,
                        [0, 1].map(|k| at[k] - length * moved[k]),
                        metric(row.give, self.penalty[index]),
                    )
                    .0
                } else {
                    state.forces[index]
                };
                slope -= force[0] * moved[0] + force[1] * moved[1];
            }
            slope
        };
        least(start, slope)
    }
}
