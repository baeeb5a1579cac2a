//! The first guess of a proximal step.

use super::Proximal;
use crate::linalg::cone::State;
use crate::linalg::cone::law::ConeStatus;
use crate::linalg::cone::problem::ConeProblem;
use crate::linalg::cone::reduced::Reduced;
use crate::linalg::cone::system::System;

impl Proximal {
    /// Solves on the pieces of the law that rows were on last, and keeps that if it is nearer to the answer; returns the size of the
    /// imbalance there, or nothing if it is not.
    ///
    /// A stiff penalty magnifies small changes of slip or geometry until rows seem to change sides, though they do not.
    pub(super) fn predict(
        &mut self,
        problem: &ConeProblem,
        reduced: &Reduced,
        system: &mut System,
        state: &mut State,
        most: usize,
    ) -> Option<f64> {
        self.weigh(problem);
        self.step.clear();
        self.step.extend(self.linear.iter().map(|value| -value));
        for (index, row) in problem.rows.iter().enumerate() {
            let (low, high) = row.bounds();
            let [nn, nt, tt] = self.weights[index];
            let b = self.request(row, state, index);
            let force = match self.status[index] {
                _ if reduced.resistance[index] <= 0.0 => state.forces[index],
                ConeStatus::SlipPositive if !row.has_tangent() => [high, 0.0],
                ConeStatus::SlipNegative if !row.has_tangent() => [low, 0.0],
                _ => [nn * b[0] + nt * b[1], nt * b[0] + tt * b[1]],
            };
            problem.push(row, 1.0, force, &mut self.step);
        }
        let fit = system.fit(problem, &self.weights);
        self.find_step(problem, system, (fit, true), most)?;
        self.evaluate(problem, reduced, state);
        let before = self.energy;
        self.trace_step(problem);
        self.go(state, 1.0);
        let norm = self.evaluate(problem, reduced, state);
        if self.energy > before {
            self.go(state, -1.0);
            return None;
        }
        Some(norm)
    }
}
