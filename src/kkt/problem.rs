//! The problem at hand: rows of contacts with those of joints after them, what is known of each, and what was found.

use super::delassus::RowDirection;
use super::settings::KktError;
use crate::constraint::contact::Kinematics;
use crate::linalg::complementarity::{Outcome, Problem, RowKind, Solver, Status};

/// Rows, their Delassus matrix if they are solved as a dense problem, and their multipliers.
///
/// Every stage states its rows here anew; buffers stay.
#[derive(Debug, Default)]
pub(super) struct RowProblem {
    /// Rows of contacts; those of joints, which follow, are listed by [`Joints`](super::joints::Joints).
    pub rows: Vec<RowDirection>,
    /// The law of every row, and its motion without forces.
    pub kinds: Vec<RowKind>,
    pub free: Vec<f64>,
    /// `W`, row-major.
    pub delassus: Vec<f64>,
    /// What the multipliers move every row by, and its own share of that per unit.
    pub responses: Vec<f64>,
    pub diagonals: Vec<f64>,
    pub multipliers: Vec<f64>,
    /// What has acted already of the rows' multipliers; empty where nothing has.
    pub acted: Vec<f64>,
    pub statuses: Vec<Status>,
    pub solver: Solver,
    /// Share of its own mobility that every row gives way by to its impulse, and to the forces that accelerations follow from (-).
    pub impulse_give: f64,
    /// Pivots and factorizations of contact problems since the step was begun.
    pub n_pivots: usize,
}

impl RowProblem {
    /// Adds the rows of a contact: along its normal, and along its tangent if it has friction, with what they are without forces.
    pub fn push(&mut self, contact: usize, row: &Kinematics, friction: f64, free: [f64; 2]) {
        let normal = self.rows.len();
        let laws = [
            RowKind::Unilateral,
            RowKind::Friction {
                normal,
                coefficient: friction,
            },
        ];
        let directions = [row.normal, row.tangent()];
        let n_rows = 1 + usize::from(friction > 0.0);
        for axis in 0..n_rows {
            self.rows.push(RowDirection {
                contact,
                axis,
                direction: directions[axis],
            });
            self.kinds.push(laws[axis]);
            self.free.push(free[axis]);
        }
    }

    /// Takes all rows out.
    pub fn clear_rows(&mut self) {
        self.rows.clear();
        self.kinds.clear();
        self.free.clear();
    }

    /// Multipliers of joint rows, which follow those of contacts.
    pub fn of_joints(&self) -> &[f64] {
        &self.multipliers[self.rows.len()..]
    }

    /// Solves the rows from the multipliers and statuses at hand.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn solve(&mut self) -> Result<Outcome, KktError> {
        let has_joints = self.kinds.len() > self.rows.len();
        let problem = Problem {
            delassus: &self.delassus,
            free: &self.free,
            rows: &self.kinds,
            acted: &self.acted,
        };
        let (multipliers, statuses) = (&mut self.multipliers, &mut self.statuses);
        let outcome = match has_joints {
            true => self
                .solver
                .solve_condensed(&problem, multipliers, statuses)?,
            false => self.solver.solve(&problem, multipliers, statuses)?,
        };
        self.n_pivots += outcome.n_pivots;
        Ok(outcome)
    }
}
