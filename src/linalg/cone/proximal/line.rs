//! The exact search along a Newton step.

use super::{Proximal, metric};
use crate::linalg::cone::State;
use crate::linalg::cone::law::project;
use crate::linalg::cone::problem::ConeProblem;
use crate::linalg::cone::reduced::Reduced;

impl Proximal {
    /// The length of the Newton step at which the convex energy is least, to a tenth of its first slope.
    pub(super) fn search(
        &mut self,
        problem: &ConeProblem,
        reduced: &Reduced,
        state: &State,
    ) -> f64 {
        self.lines.clear();
        for (index, row) in problem.rows.iter().enumerate() {
            let along = problem.motion(row, &self.step);
            let request = self.request(problem, reduced, state, index);
            self.lines.push([request, along.map(|value| -value)]);
        }
        self.product.resize(self.step.len(), 0.0);
        problem.matrix.multiply(&self.step, &mut self.product);
        let (mut constant, mut linear) = (0.0, 0.0);
        for dof in 0..self.step.len() {
            constant += self.product[dof] * state.a[dof] - self.step[dof] * reduced.load[dof];
            linear += self.product[dof] * self.step[dof];
        }
        let slope = |length: f64| {
            let mut slope = constant + length * linear;
            for (index, row) in problem.rows.iter().enumerate() {
                let [at, along] = self.lines[index];
                let force = if reduced.resistance[index] > 0.0 {
                    project(
                        row,
                        [0, 1].map(|k| at[k] + length * along[k]),
                        metric(row.give, self.penalty[index]),
                    )
                    .0
                } else {
                    state.forces[index]
                };
                slope += force[0] * along[0] + force[1] * along[1];
            }
            slope
        };
        least(slope)
    }
}

/// The root of a rising function that is negative at 0; 1 if the function is small enough there.
fn least(slope: impl Fn(f64) -> f64) -> f64 {
    let (start, full) = (slope(0.0), slope(1.0));
    if full.abs() <= 0.1 * start.abs() {
        return 1.0;
    }
    let (mut low, mut at_low, mut high, mut at_high) = (0.0, start, 1.0, full);
    while at_high < 0.0 && high < 64.0 {
        (low, at_low) = (high, at_high);
        high *= 2.0;
        at_high = slope(high);
    }
    let mut length = high;
    for round in 0..40 {
        // a bisection now and then: the secant alone may creep along one piece
        length = if round % 3 == 2 {
            0.5 * (low + high)
        } else {
            low - at_low * (high - low) / (at_high - at_low)
        };
        let here = slope(length);
        if here.abs() < 0.02 * start.abs() {
            break;
        }
        if here > 0.0 {
            (high, at_high) = (length, here);
        } else {
            (low, at_low) = (length, here);
        }
    }
    if length.is_finite() { length } else { 1.0 }
}
