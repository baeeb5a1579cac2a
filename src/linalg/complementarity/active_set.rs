//! The primary solver: a primal-dual active set, which is a semismooth Newton method on the natural map.
//!
//! Each pivot solves `w_i = 0` on the rows that stick, with `p_t = ±mu p_n` put in for the rows that slip,
//! and reads the next statuses from `p_i - c w_i / W_ii`. It ends after finitely many pivots with the exact
//! answer, or repeats itself. (Alart and Curnier 1991; Hintermüller, Ito and Kunisch 2002; Hüeber and
//! Wohlmuth 2005.) Sticking and frictionless rows give a symmetric matrix (Cholesky), slipping ones do not
//! (LU); a redundant set of rows gets the multipliers of minimum norm, or those nearest to the present ones.

use super::dense::{
    add_scaled, dot, factorize_cholesky, solve_cholesky_in_place, solve_lu_in_place,
};
use super::krylov::Krylov;
use super::orthogonal::CompleteOrthogonal;
use super::problem::{Checked, RowKind, Status};
use super::residual::{Measure, measure};
use super::status::{fingerprint, identify, make_admissible};
use super::{Answer, Outcome};
use crate::math::rounding;

/// A residual at which the answer is exact but for round-off.
const EXACT: f64 = rounding::SUM;
/// A residual that is good enough for statuses that no longer change.
pub(super) const GOOD: f64 = rounding::ITERATED;
/// A row is redundant when less than this fraction of it is independent of the rows before.
const RANK_TOLERANCE: f64 = rounding::SOLVED;
/// Systems above this size are solved by iteration first.
const DIRECT_LIMIT: usize = 256;

/// Pivots from statuses that another method has found: those that are nearly right settle in some four, the others never do.
const RESCUE_PIVOTS: usize = 12;

/// The same with another weight: what it is for settles in two.
const WEIGHTED_PIVOTS: usize = 4;

/// Pivots after which statuses that have not settled are given up: a stack of boxes that falls on the
/// ground closes one layer per pivot.
fn pivot_budget(n: usize) -> usize {
    20 + n / 4
}

/// Redundant pivots of minimum norm after which friction is taken to forbid it: in steady contact the
/// first one is right, in a new one the layers have to close.
fn redundant_pivot_budget(is_warm: bool) -> usize {
    if is_warm { 5 } else { 24 }
}

/// Which of the multipliers of redundant rows are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Redundancy {
    /// Those of minimum norm, whatever came before.
    MinimumNorm,
    /// Those nearest to the present ones: friction that shares a load unevenly may be all that holds it.
    LeastChange,
}

/// A slipping friction row: `p_row = factor * p_normal`, of the whole multipliers.
#[derive(Debug, Clone, Copy)]
struct Sliding {
    row: usize,
    normal: usize,
    factor: f64,
}

/// Scratch of the active-set method.
#[derive(Debug, Clone, Default)]
pub(super) struct ActiveSet {
    matrix: Vec<f64>,
    right_side: Vec<f64>,
    solution: Vec<f64>,
    column_size: Vec<f64>,
    unknowns: Vec<usize>,
    position: Vec<usize>,
    sliding: Vec<Sliding>,
    multipliers: Vec<f64>,
    velocities: Vec<f64>,
    seen: Vec<u64>,
    reference: Vec<f64>,
    orthogonal: CompleteOrthogonal,
    krylov: Krylov,
}

impl ActiveSet {
    /// Makes room for problems of up to `n` rows.
    pub fn reserve(&mut self, n: usize) {
        if self.position.len() < n {
            self.matrix.resize(n * n, 0.0);
            self.position.resize(n, 0);
            for vector in [
                &mut self.right_side,
                &mut self.solution,
                &mut self.column_size,
                &mut self.multipliers,
                &mut self.velocities,
                &mut self.reference,
            ] {
                vector.resize(n, 0.0);
            }
            self.unknowns.reserve(n);
            self.sliding.reserve(n);
            self.seen.reserve(pivot_budget(n));
        }
        self.orthogonal.reserve(n);
        self.krylov.reserve(n);
    }

    /// Follows the statuses until they settle; true if nothing better need be looked for.
    ///
    /// Every iterate is offered to `best`.
    ///
    /// - `start`: the multipliers that the iterative solves and [`Redundancy::LeastChange`] start from.
    /// - `status`: the statuses to start from, then those of the last iterate.
    /// - `weight`: `c`, 1 where velocities count by the rows' own mobilities. Where two mirrored contacts hardly move by friction that is mirrored, as
    ///   a ball between two sides of a taut strip, statuses that this makes repeat themselves end by a larger one.
    /// - `redundancy`: what redundant rows get, and the residual up to which they are averaged if they
    ///   contradict each other.
    pub fn run(
        &mut self,
        problem: Checked,
        (start, status, weight): (&[f64], &mut [Status], f64),
        (redundancy, redundancy_tolerance): (Redundancy, f64),
        best: &mut Answer,
        outcome: &mut Outcome,
    ) -> bool {
        let n = problem.n_rows();
        self.multipliers[..n].copy_from_slice(start);
        make_admissible(problem, status);
        self.seen.clear();
        let mut redundant_left = match redundancy {
            Redundancy::LeastChange => usize::MAX,
            Redundancy::MinimumNorm => redundant_pivot_budget(start.iter().any(|&p| p != 0.0)),
        };
        let n_pivots = match redundancy {
            Redundancy::MinimumNorm => pivot_budget(n),
            Redundancy::LeastChange if weight != 1.0 => WEIGHTED_PIVOTS,
            Redundancy::LeastChange => RESCUE_PIVOTS.min(pivot_budget(n)),
        };
        while self.seen.len() < n_pivots {
            self.seen.push(fingerprint(status));
            let redundant = self.pivot(problem, status, redundancy, outcome);
            for row in 0..n {
                self.velocities[row] = problem.velocity(row, &self.multipliers[..n]);
            }
            let now = measure(problem, &self.multipliers[..n], |row| self.velocities[row]);
            best.offer(&self.multipliers[..n], status, now);
            if now.residual <= EXACT {
                return true;
            }
            if !now.residual.is_finite() {
                return false;
            }
            if !self.update(problem, (now, weight), status) {
                let unavoidable = matches!(problem.rows[now.worst_row], RowKind::Bilateral);
                let is_small = unavoidable || now.residual <= redundancy_tolerance;
                return now.residual <= GOOD || redundant && is_small && now.is_moderate();
            }
            redundant_left -= usize::from(redundant);
            if redundant_left == 0 || self.seen.contains(&fingerprint(status)) {
                break;
            }
        }
        best.residual <= GOOD
    }

    /// Computes the multipliers that belong to `status`; true if the sticking rows were redundant.
    fn pivot(
        &mut self,
        problem: Checked,
        status: &[Status],
        redundancy: Redundancy,
        outcome: &mut Outcome,
    ) -> bool {
        outcome.n_pivots += 1;
        self.partition(problem, status);
        let n_unknowns = self.unknowns.len();
        for (index, &row) in self.unknowns.iter().enumerate() {
            self.solution[index] = self.multipliers[row];
            self.reference[index] = match redundancy {
                Redundancy::MinimumNorm => 0.0,
                Redundancy::LeastChange => self.multipliers[row],
            };
        }
        for (row, &at) in status.iter().enumerate() {
            self.multipliers[row] = match (at, problem.rows[row]) {
                (Status::SlipPositive, RowKind::Box { high, .. }) => high,
                (Status::SlipNegative, RowKind::Box { low, .. }) => low,
                _ if !problem.is_movable(row) => problem.idle_multiplier(row),
                _ => 0.0 - problem.acted(row),
            };
        }
        for &row in &self.unknowns {
            self.multipliers[row] = 0.0;
        }
        for slip in &self.sliding {
            self.multipliers[slip.row] += slip.factor * problem.acted(slip.normal);
        }
        for (load, &row) in self.right_side.iter_mut().zip(&self.unknowns) {
            *load = -problem.velocity(row, &self.multipliers[..problem.n_rows()]);
        }
        let redundant = n_unknowns > 0 && self.solve_unknowns(problem, outcome);
        for (&value, &row) in self.solution.iter().zip(&self.unknowns) {
            self.multipliers[row] = value;
        }
        for slip in &self.sliding {
            let normal = self.multipliers[slip.normal] + problem.acted(slip.normal);
            self.multipliers[slip.row] = slip.factor * normal - problem.acted(slip.row);
        }
        redundant
    }

    /// Lists the rows whose multiplier is unknown, and those that follow their normal multiplier.
    fn partition(&mut self, problem: Checked, status: &[Status]) {
        self.unknowns.clear();
        self.sliding.clear();
        for (row, &at) in status.iter().enumerate() {
            let sign = match at {
                Status::Open => continue,
                Status::Stick => {
                    self.position[row] = self.unknowns.len();
                    self.unknowns.push(row);
                    continue;
                }
                Status::SlipPositive => 1.0,
                Status::SlipNegative => -1.0,
            };
            if let Some((normal, coefficient)) = problem.friction(row) {
                self.sliding.push(Sliding {
                    row,
                    normal,
                    factor: sign * coefficient,
                });
            }
        }
    }

    /// Fills the matrix of the unknowns, the columns of slipping rows folded into those of their normals.
    fn assemble(&mut self, problem: Checked) {
        let n_unknowns = self.unknowns.len();
        for (line, &row) in self.matrix.chunks_exact_mut(n_unknowns).zip(&self.unknowns) {
            let source = problem.row(row);
            for (value, &column) in line.iter_mut().zip(&self.unknowns) {
                *value = source[column];
            }
            for slip in &self.sliding {
                line[self.position[slip.normal]] += slip.factor * source[slip.row];
            }
        }
    }

    /// Solves for the unknowns by the cheapest method that works; true if it was the minimum-norm one.
    fn solve_unknowns(&mut self, problem: Checked, outcome: &mut Outcome) -> bool {
        let n = self.unknowns.len();
        let symmetric = self.sliding.is_empty();
        self.assemble(problem);
        if n > DIRECT_LIMIT {
            let solved = self.krylov.solve(
                (&self.matrix[..n * n], symmetric),
                &self.right_side[..n],
                &mut self.solution[..n],
                n / 4,
                &mut outcome.n_products,
            );
            if solved {
                return false;
            }
        }
        self.solution[..n].copy_from_slice(&self.right_side[..n]);
        let matrix = &mut self.matrix[..n * n];
        let solution = &mut self.solution[..n];
        outcome.n_factorizations += 1;
        let solved = if symmetric {
            let regular = factorize_cholesky(matrix, n, RANK_TOLERANCE);
            if regular {
                solve_cholesky_in_place(matrix, n, solution);
            }
            regular
        } else {
            solve_lu_in_place(matrix, solution, &mut self.column_size, RANK_TOLERANCE)
        };
        if solved {
            return false;
        }
        outcome.n_factorizations += 1;
        self.assemble(problem);
        let (matrix, solution) = (&mut self.matrix[..n * n], &mut self.solution[..n]);
        let reference = &self.reference[..n];
        for ((x, load), line) in solution
            .iter_mut()
            .zip(&self.right_side)
            .zip(matrix.chunks_exact(n))
        {
            *x = load - dot(line, reference);
        }
        self.orthogonal
            .solve_in_place(matrix, solution, RANK_TOLERANCE);
        add_scaled(solution, 1.0, reference);
        true
    }

    /// Reads the next statuses from the natural map; true if one of them changed.
    fn update(
        &self,
        problem: Checked,
        (now, weight): (Measure, f64),
        status: &mut [Status],
    ) -> bool {
        identify(
            problem,
            &self.multipliers,
            |row| self.velocities[row],
            (EXACT * now.scale, weight),
            status,
        )
    }
}
