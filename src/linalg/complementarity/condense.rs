//! Condensation: bilateral rows are eliminated once, so that only the others are left to the active set.
//!
//! With `B` the bilateral rows and `C` the others, `p_B = -W_BB⁻¹ (b_B + W_BC p_C)` leaves
//! `W_CC - W_CB W_BB⁻¹ W_BC` and `b_C - W_CB W_BB⁻¹ b_B`. A chain of a hundred links that carries one box then costs one factorization
//! and a problem of the box's contacts, instead of a factorization per pivot.
//!
//! Bilateral rows that depend on each other are solved by proximal steps instead.

use super::dense::{dot, factorize_cholesky, solve_cholesky_in_place};
use super::give::{INDEPENDENT, ROUNDS, approach, give};
use super::problem::{ComplementarityError, Problem, RowKind, Status};
use super::{Outcome, Solver};
use crate::math::rounding;

/// Bilateral rows from which condensing pays.
const LEAST: usize = 8;

/// What must be left of a row's mobility once the bilateral rows hold (-); rows with less are redundant.
const LEFT: f64 = rounding::SHARE;

/// Rank tolerance of the bilateral rows.
const RANK_TOLERANCE: f64 = rounding::SOLVED;

/// What has become of the bilateral rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ties {
    /// They are eliminated.
    Eliminated,
    /// There is nothing to gain by that.
    Few,
    /// They depend on each other, as those of two hinges between the same bodies.
    Dependent,
}

/// Buffers of the condensed problem.
#[derive(Debug, Clone, Default)]
pub(super) struct Condensed {
    tied: Vec<usize>,
    others: Vec<usize>,
    /// Place among `others`.
    place: Vec<usize>,
    matrix: Vec<f64>,
    /// `W_BB⁻¹ W_BC` by columns, then `W_BB⁻¹ b_B`.
    columns: Vec<f64>,
    delassus: Vec<f64>,
    free: Vec<f64>,
    rows: Vec<RowKind>,
    acted: Vec<f64>,
    multipliers: Vec<f64>,
    status: Vec<Status>,
    scratch: Vec<f64>,
}

impl Solver {
    /// [`Solver::solve`] for problems with bilateral rows: many are eliminated first where they are independent, and those that depend on
    /// each other are solved by proximal steps.
    ///
    /// # Panics
    /// If the shapes do not agree.
    ///
    /// # Errors
    /// As [`Solver::solve`].
    pub fn solve_condensed(
        &mut self,
        problem: &Problem,
        multipliers: &mut [f64],
        status: &mut [Status],
    ) -> Result<Outcome, ComplementarityError> {
        problem.check()?;
        let mut condensed = std::mem::take(&mut self.condensed);
        let ties = condensed.condense(problem, &self.independence, multipliers, status);
        let outcome = if ties == Ties::Eliminated {
            let reduced = Problem {
                delassus: &condensed.delassus,
                free: &condensed.free,
                rows: &condensed.rows,
                acted: &condensed.acted,
            };
            let solved = if condensed.rows.is_empty() {
                Ok(Outcome::default())
            } else {
                self.solve(&reduced, &mut condensed.multipliers, &mut condensed.status)
            };
            if solved.is_ok() {
                condensed.expand(multipliers, status);
            }
            solved
        } else if ties == Ties::Dependent {
            self.solve_dependent(problem, &mut condensed, multipliers, status)
        } else {
            self.solve(problem, multipliers, status)
        };
        self.condensed = condensed;
        outcome
    }

    /// Solves a problem whose bilateral rows depend on each other, by proximal steps on their multipliers.
    ///
    /// Rows that are off by rounding and have no motion left to agree in would ask for any force, and rows that turn would make motions of it.
    /// Steps from `p` leave of the forces what moves something, and add to the rest no more than what is asked for by [`give`].
    fn solve_dependent(
        &mut self,
        problem: &Problem,
        condensed: &mut Condensed,
        multipliers: &mut [f64],
        status: &mut [Status],
    ) -> Result<Outcome, ComplementarityError> {
        if !condensed.soften(problem, &self.independence, multipliers) {
            return self.solve(problem, multipliers, status);
        }
        let mut outcome = Outcome::default();
        for _ in 0..ROUNDS {
            let giving = [problem.delassus, &condensed.delassus];
            approach(giving, problem.free, multipliers, &mut condensed.free);
            let softened = Problem {
                delassus: &condensed.delassus,
                free: &condensed.free,
                ..*problem
            };
            let n_pivots = outcome.n_pivots;
            outcome = self.solve(&softened, multipliers, status)?;
            outcome.n_pivots += n_pivots;
        }
        Ok(outcome)
    }
}

impl Condensed {
    /// Writes the condensed problem, if there is something to gain.
    fn condense(
        &mut self,
        problem: &Problem,
        independence: &[f64],
        multipliers: &[f64],
        status: &[Status],
    ) -> Ties {
        self.split(problem);
        let n_tied = self.tied.len();
        self.copy_ties(problem.delassus, problem.rows.len());
        let is_regular = factorize_cholesky(&mut self.matrix, n_tied, RANK_TOLERANCE);
        let has_left = |(slot, &row): (usize, &usize)| {
            let least = independence.get(row).unwrap_or(&INDEPENDENT);
            let left = self.matrix[slot * (n_tied + 1)].powi(2);
            left > least * problem.delassus[row * (problem.rows.len() + 1)]
        };
        if !(is_regular && self.tied.iter().enumerate().all(has_left)) {
            return Ties::Dependent;
        }
        if n_tied < LEAST {
            return Ties::Few;
        }
        let n = problem.rows.len();
        self.columns.clear();
        for &other in &self.others {
            let line = &problem.delassus[other * n..(other + 1) * n];
            self.columns.extend(self.tied.iter().map(|&row| line[row]));
        }
        self.columns
            .extend(self.tied.iter().map(|&row| problem.free[row]));
        for column in self.columns.chunks_exact_mut(n_tied) {
            solve_cholesky_in_place(&self.matrix, n_tied, column);
        }
        match self.reduce(problem, multipliers, status) {
            true => Ties::Eliminated,
            false => Ties::Few,
        }
    }

    /// Copies the part of a Delassus matrix that belongs to the bilateral rows.
    fn copy_ties(&mut self, delassus: &[f64], n: usize) {
        self.matrix.clear();
        for &row in &self.tied {
            let line = &delassus[row * n..(row + 1) * n];
            self.matrix
                .extend(self.tied.iter().map(|&column| line[column]));
        }
    }

    /// Lets the bilateral rows give way by their share, and takes out of their multipliers what moves none of them; false if that is not enough to
    /// factorize them.
    fn soften(&mut self, problem: &Problem, independence: &[f64], multipliers: &mut [f64]) -> bool {
        let n = problem.rows.len();
        self.delassus.clear();
        self.delassus.extend_from_slice(problem.delassus);
        for &row in &self.tied {
            let least = independence.get(row).unwrap_or(&INDEPENDENT);
            self.delassus[row * (n + 1)] *= 1.0 + give(*least);
        }
        let delassus = std::mem::take(&mut self.delassus);
        self.copy_ties(&delassus, n);
        self.delassus = delassus;
        let n_tied = self.tied.len();
        if !factorize_cholesky(&mut self.matrix, n_tied, RANK_TOLERANCE) {
            return false;
        }
        self.columns.clear();
        for &row in &self.tied {
            let line = &problem.delassus[row * n..(row + 1) * n];
            let moved = self
                .tied
                .iter()
                .map(|&column| line[column] * multipliers[column]);
            self.columns.push(moved.sum());
        }
        solve_cholesky_in_place(&self.matrix, n_tied, &mut self.columns);
        for (&row, kept) in self.tied.iter().zip(&self.columns) {
            multipliers[row] = *kept;
        }
        true
    }

    fn split(&mut self, problem: &Problem) {
        let n = problem.rows.len();
        let diagonal = |row: usize| problem.delassus[row * (n + 1)];
        let largest = (0..n).map(diagonal).fold(0.0, f64::max);
        self.tied.clear();
        self.others.clear();
        self.place.clear();
        for (row, kind) in problem.rows.iter().enumerate() {
            self.place.push(self.others.len());
            if *kind == RowKind::Bilateral && diagonal(row) > f64::EPSILON * largest {
                self.tied.push(row);
            } else {
                self.others.push(row);
            }
        }
    }

    fn reduce(&mut self, problem: &Problem, multipliers: &[f64], status: &[Status]) -> bool {
        let (n, n_tied, n_others) = (problem.rows.len(), self.tied.len(), self.others.len());
        self.delassus.clear();
        self.delassus.resize(n_others * n_others, 0.0);
        self.free.clear();
        self.rows.clear();
        self.acted.clear();
        self.multipliers.clear();
        self.status.clear();
        let mut coupling = std::mem::take(&mut self.scratch);
        let mut is_regular = true;
        for (place, &row) in self.others.iter().enumerate() {
            let line = &problem.delassus[row * n..(row + 1) * n];
            coupling.clear();
            coupling.extend(self.tied.iter().map(|&column| line[column]));
            let mut columns = self.columns.chunks_exact(n_tied);
            for (other, &column) in self.others.iter().enumerate() {
                let answer = columns.next().map_or(0.0, |column| dot(&coupling, column));
                self.delassus[place * n_others + other] = line[column] - answer;
            }
            let answer = columns.next().map_or(0.0, |column| dot(&coupling, column));
            self.free.push(problem.free[row] - answer);
            let left = self.delassus[place * (n_others + 1)];
            is_regular &= left > LEFT * line[row] || line[row] == 0.0;
            self.rows.push(match problem.rows[row] {
                RowKind::Friction {
                    normal,
                    coefficient,
                } => RowKind::Friction {
                    normal: self.place[normal],
                    coefficient,
                },
                kind => kind,
            });
            self.acted.extend(problem.acted.get(row));
            self.multipliers.push(multipliers[row]);
            self.status.push(status[row]);
        }
        self.scratch = coupling;
        self.symmetrize(n_others);
        is_regular
    }

    fn symmetrize(&mut self, n: usize) {
        for row in 0..n {
            for column in 0..row {
                let (a, b) = (row * n + column, column * n + row);
                let mean = 0.5 * (self.delassus[a] + self.delassus[b]);
                (self.delassus[a], self.delassus[b]) = (mean, mean);
            }
        }
    }

    /// Writes the answer of the condensed problem over that of the whole.
    fn expand(&self, multipliers: &mut [f64], status: &mut [Status]) {
        let (n_tied, n_others) = (self.tied.len(), self.others.len());
        for (place, &row) in self.others.iter().enumerate() {
            multipliers[row] = self.multipliers[place];
            status[row] = self.status[place];
        }
        for (index, &row) in self.tied.iter().enumerate() {
            let mut sum = self.columns[n_others * n_tied + index];
            for (place, p) in self.multipliers.iter().enumerate() {
                sum += p * self.columns[place * n_tied + index];
            }
            multipliers[row] = -sum;
            status[row] = Status::Stick;
        }
    }
}
