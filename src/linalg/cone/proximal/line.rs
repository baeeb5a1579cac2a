//! The exact search along a Newton step.

use super::{Proximal, metric};
use crate::linalg::cone::State;
use crate::linalg::cone::law::project;
use crate::linalg::cone::problem::ConeProblem;
use crate::linalg::cone::reduced::Reduced;

impl Proximal {
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

/// The root of a rising function that is negative at 0; 1 if the function is small enough there.
///
/// - `start`: its value at 0.
fn least(start: f64, slope: impl Fn(f64) -> f64) -> f64 {
    let full = slope(1.0);
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
