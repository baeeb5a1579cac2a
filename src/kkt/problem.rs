//! The problem at hand: rows of contacts with those of joints after them, what is known of each, and what was found.

use super::delassus::RowDirection;
use super::settings::KktError;
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
    /// Pivots and factorizations of contact problems since the step was begun.
    pub n_pivots: usize,
}

impl RowProblem {
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
