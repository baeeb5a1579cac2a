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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::block_matrix::BlockMatrix;
    use crate::linalg::cone::problem::{ConeEntry, ConeLaw};

    /// A point between a wall that it slides along and a motor.
    fn with_problem(check: impl Fn(&ConeProblem)) {
        let mut matrix = BlockMatrix::from_cells(1, [[0]].iter().map(|cell| &cell[..]));
        matrix.add_diagonal(0, [4.0, 3.0]);
        let row = |entry: u32, law, free| ConeRow {
            entries: (entry, entry + 1),
            law,
            free,
            give: [0.01, 0.02],
            acted: [0.3, 0.1],
            scale: [0.3, 0.25],
            local: f64::INFINITY,
        };
        let rows = [
            row(0, ConeLaw::Contact { friction: 0.5 }, [-0.4, 0.7]),
            row(
                1,
                ConeLaw::Box {
                    low: -0.2,
                    high: 0.5,
                },
                [0.1, 0.0],
            ),
        ];
        let entries = [([0.6, 0.8], [-0.8, 0.6]), ([1.0, -0.5], [0.0; 2])];
        let entries = entries.map(|(normal, tangent)| ConeEntry {
            node: 0,
            normal,
            tangent,
        });
        let load = [1.0, -2.0];
        check(&ConeProblem {
            matrix: &matrix,
            load: &load,
            rows: &rows,
            entries: &entries,
        });
    }

    /// Differences of the energy give the imbalance; what is carried along a step is what is found at its end; and the search ends where the
    /// energy is least along it.
    #[test]
    fn the_merit_is_one_function_at_a_place_and_along_a_step() {
        with_problem(|problem| {
            let mut reduced = Reduced::default();
            reduced.restate(problem);
            let mut merit = Proximal::default();
            merit.penalize(&reduced, 10.0);
            for at in [[0.1, -0.2], [2.0, 1.0], [-1.0, 0.4], [0.0, -3.0]] {
                let state_at = |x: [f64; 2]| State {
                    forces: vec![[0.7, -0.2], [0.1, 0.0]],
                    slip: vec![0.3, 0.0],
                    a: x.to_vec(),
                    ..State::default()
                };
                let energy = |merit: &mut Proximal, x: [f64; 2]| {
                    let state = state_at(x);
                    merit.place(problem, &reduced, &state);
                    merit.evaluate(problem, &reduced, &state);
                    merit.energy
                };
                let h = 1e-6;
                for k in 0..2 {
                    let (mut less, mut more) = (at, at);
                    (less[k], more[k]) = (at[k] - h, at[k] + h);
                    let change = energy(&mut merit, more) - energy(&mut merit, less);
                    energy(&mut merit, at);
                    let slope = merit.imbalance[k];
                    assert!((change / (2.0 * h) - slope).abs() < 1e-7 * (1.0 + slope.abs()));
                }
                merit.step = merit.imbalance.iter().map(|value| -0.2 * value).collect();
                merit.trace_step(problem);
                let length = merit.search(problem, &reduced, &state_at(at));
                let along = |length: f64| [0, 1].map(|k| at[k] + length * merit.step[k]);
                let places = [0.0, 0.8 * length, length, 1.2 * length].map(along);
                let [start, short, end, long] = places.map(|x| energy(&mut merit.clone(), x));
                let least = short.min(long);
                assert!(end < start && end <= least + 0.02 * (start - end), "{at:?}");
                let mut state = state_at(at);
                merit.place(problem, &reduced, &state);
                merit.go(&mut state, length);
                let carried = merit.evaluate(problem, &reduced, &state);
                let carried = (carried, merit.energy);
                merit.place(problem, &reduced, &state);
                let anew = merit.evaluate(problem, &reduced, &state);
                assert!(
                    (carried.0 - anew).abs() < 1e-12 && (carried.1 - merit.energy).abs() < 1e-12
                );
            }
        });
    }
}
