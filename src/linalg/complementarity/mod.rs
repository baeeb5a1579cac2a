//! The complementarity solver of the contact stage: `w = W p + b` with a law between `p_i` and `w_i` per row.
//!
//! It sees only the Delassus matrix `W`, the free velocity `b` and the laws ([`RowKind`]). One sign rules
//! them all: a multiplier at its upper bound goes with `w <= 0`, at its lower bound with `w >= 0`. Whatever
//! solver made the answer, [`natural_map_residual`] judges it.
//!
//! [`Solver`] first follows the active set from the last step's statuses, one direct solve per pivot
//! (1–3 in steady contact). If that repeats itself, it asks projected Gauss–Seidel and then Lemke's method
//! for better statuses.
//!
//! Redundant rows (a rigid box on four points) share their load with minimum norm. Where that would
//! overstep friction (the feet of a pyramid), or above 256 sticking rows, where the solve is iterative, they
//! keep as much as they can of the load they had. Redundant rows that contradict each other slightly are
//! averaged, see [`Solver::with_redundancy_tolerance`]. Rows that contradict each other by more, as those of a body between two that are driven
//! together, have no multipliers: they get those of rows that give way by a thousandth of their mobility.
//!
//! ```
//! use foil2d::linalg::complementarity::{Problem, RowKind, Solver, Status};
//!
//! // a body of 4 kg falls at 3 m/s and slides at 10 m/s over rough ground
//! let problem = Problem {
//!     delassus: &[0.25, 0.0, 0.0, 0.25],
//!     free: &[-3.0, 10.0],
//!     rows: &[RowKind::Unilateral, RowKind::Friction { normal: 0, coefficient: 0.5 }],
//!     acted: &[],
//! };
//! let (mut impulses, mut status) = ([0.0; 2], [Status::Open; 2]);
//! let outcome = Solver::new().solve(&problem, &mut impulses, &mut status)?;
//! assert_eq!(impulses, [12.0, -6.0]);
//! assert_eq!(status, [Status::Stick, Status::SlipNegative]);
//! assert!(outcome.residual <= 1e-12);
//! # Ok::<(), foil2d::linalg::complementarity::ComplementarityError>(())
//! ```

mod active_set;
mod condense;
mod contradiction;
mod dense;
mod gauss_seidel;
mod give;
mod krylov;
mod lemke;
mod orthogonal;
mod problem;
mod residual;
mod status;

pub use problem::{ComplementarityError, Problem, RowKind, Status};
pub use residual::natural_map_residual;

pub(crate) use dense::solve_lu_in_place;
pub(crate) use give::{INDEPENDENT, give};

use crate::math::rounding;
use active_set::{ActiveSet, Redundancy};
use condense::Condensed;
use contradiction::Softened;
use lemke::Lemke;
use problem::Checked;
use residual::{Measure, measure};
use status::{identify, slide};

/// What is tried in turn when the active set repeats itself: its warm start once more with the least
/// change of multipliers, then with another weight of the velocities, sweeps (how many at most), Lemke's method (which path).
const NEAR: [(Method, usize); 4] = [
    (Method::ActiveSet, 1),
    (Method::ActiveSet, 1000),
    (Method::GaussSeidel, 50),
    (Method::Lemke, 0),
];

/// What is tried where that has not solved a problem, nor have rows that give way a little: other paths, and more sweeps.
const PATHS: [(Method, usize); 2] = [(Method::Lemke, 1), (Method::Lemke, 2)];
/// What is tried where rows that give way have come to no end.
const LAST: [(Method, usize); 1] = [(Method::GaussSeidel, 500)];

/// Sweeps of a solver that is asked for Gauss–Seidel, before the active set takes over: contacts of masses take some ten, and
/// those of a surface that transmits forces as many as it has nodes, squared.
const MOST_SWEEPS: usize = 20_000;

/// The [`natural_map_residual`] up to which sweeps that have stalled are the answer.
const SWEPT: f64 = rounding::ITERATED;

/// The solver that found the answer. The last two are finished by an active-set solve if it improves them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Method {
    /// The active set alone.
    #[default]
    ActiveSet,
    /// Projected Gauss–Seidel found the statuses.
    GaussSeidel,
    /// Lemke's method found the statuses.
    Lemke,
}

/// What a solve did and how good the answer is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Outcome {
    /// Statuses tried by the active set, each with one linear solve.
    pub n_pivots: usize,
    /// Dense factorizations, `O(n³)` each.
    pub n_factorizations: usize,
    /// Matrix-vector products of the iterative solves, `O(n²)` each; only above 256 sticking rows.
    pub n_products: usize,
    /// Sweeps of projected Gauss–Seidel, `O(n²)` each.
    pub n_sweeps: usize,
    /// Pivots of Lemke's tableau, `O(n²)` each.
    pub n_lemke_pivots: usize,
    /// The [`natural_map_residual`] of the multipliers handed back (-).
    pub residual: f64,
    /// The solver that found them.
    pub method: Method,
}

/// The best multipliers so far.
#[derive(Debug, Clone, Default)]
struct Answer {
    multipliers: Vec<f64>,
    status: Vec<Status>,
    residual: f64,
    is_moderate: bool,
    method: Method,
    /// The solver now at work.
    candidate: Method,
}

impl Answer {
    fn judge(&mut self, now: Measure) {
        self.residual = now.residual;
        self.is_moderate = now.is_moderate();
    }

    /// Takes over multipliers that are better than the present ones.
    fn offer(&mut self, multipliers: &[f64], status: &[Status], now: Measure) {
        if now.residual < self.residual {
            self.multipliers.copy_from_slice(multipliers);
            self.status.copy_from_slice(status);
            self.judge(now);
            self.method = self.candidate;
        }
    }
}

/// Solves complementarity problems of any size; holds the scratch, which only grows.
#[derive(Debug, Clone)]
pub struct Solver {
    redundancy_tolerance: f64,
    independence: Vec<f64>,
    first: Method,
    active_set: ActiveSet,
    lemke: Lemke,
    best: Answer,
    trial: Vec<f64>,
    status: Vec<Status>,
    /// The statuses of the start.
    given: Vec<Status>,
    condensed: Condensed,
    softened: Softened,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            redundancy_tolerance: 1e-6,
            independence: Vec::new(),
            first: Method::ActiveSet,
            active_set: ActiveSet::default(),
            lemke: Lemke::default(),
            best: Answer::default(),
            trial: Vec::new(),
            status: Vec::new(),
            given: Vec::new(),
            condensed: Condensed::default(),
            softened: Softened::default(),
        }
    }
}

impl Solver {
    /// Makes a solver without scratch; the first solve of each size reserves it.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the residual (-) up to which redundant rows that contradict each other are averaged.
    ///
    /// Four gaps of a rigid box are never exactly in line. Below this residual the minimum-norm
    /// least-squares multipliers are the answer, which vary smoothly; above it the solver looks for the
    /// exact one, in which some of the rows open. Default `1e-6`; gaps read from an `f32` world need more.
    pub fn with_redundancy_tolerance(mut self, residual: f64) -> Self {
        self.set_redundancy_tolerance(residual);
        self
    }

    /// See [`Solver::with_redundancy_tolerance`].
    pub fn set_redundancy_tolerance(&mut self, residual: f64) {
        self.redundancy_tolerance = residual;
    }

    /// Tells how much of every row's mobility the bilateral rows before it must leave (-), in the order of the rows; a millionth of rows that
    /// nothing is told of. Bilateral rows with less depend on each other, see [`Solver::solve_condensed`].
    pub fn set_independence(&mut self, least: impl IntoIterator<Item = f64>) {
        self.independence.clear();
        self.independence.extend(least);
    }

    /// Chooses the solver that is asked first: the active set by default.
    ///
    /// [`Method::GaussSeidel`] is the modified Gauss–Seidel method of Carpenter, Taylor and Katona (1991), which needs no
    /// factorization: fast for multipliers that hardly couple, slow for others. Where it does not converge the active set
    /// takes over. [`Method::Lemke`] is only ever asked when others fail; here it means the active set.
    pub fn set_first(&mut self, method: Method) {
        self.first = method;
    }

    /// Solves the problem as well as it can; `outcome.residual` says how well.
    ///
    /// An unsolvable problem (joints that contradict each other, a body between two that are driven together) hands back the
    /// multipliers of rows that give way a little, which bring no energy. Rows that nothing can move (`W_ii = 0`) get the admissible
    /// multiplier nearest to zero and the status [`Status::Open`].
    ///
    /// - `multipliers`: `p` of the last step or zeros, then the answer, shape `(n)`.
    /// - `status`: the statuses of the last step or [`Status::Open`], then those of the answer, shape `(n)`.
    ///
    /// # Panics
    /// If the shapes do not agree.
    ///
    /// # Errors
    /// If `W` or `b` is not finite, or a row has impossible data; the arguments are then left as they were.
    pub fn solve(
        &mut self,
        problem: &Problem,
        multipliers: &mut [f64],
        status: &mut [Status],
    ) -> Result<Outcome, ComplementarityError> {
        let n = problem.rows.len();
        assert_eq!(multipliers.len(), n, "give one multiplier per row");
        assert_eq!(status.len(), n, "give one status per row");
        let problem = problem.check()?;
        self.start(problem, multipliers, status);
        let mut outcome = Outcome::default();
        if self.first == Method::GaussSeidel && self.sweep(problem, &mut outcome) {
            multipliers.copy_from_slice(&self.best.multipliers);
            status.copy_from_slice(&self.best.status);
            outcome.residual = self.best.residual;
            outcome.method = Method::GaussSeidel;
            return Ok(outcome);
        }
        let is_solved =
            self.follow_active_set(problem, (Redundancy::MinimumNorm, 1.0), &mut outcome)
                || self.rescue(problem, &NEAR, &mut outcome);
        if !is_solved {
            self.give_way(problem, &mut outcome);
        }
        multipliers.copy_from_slice(&self.best.multipliers);
        status.copy_from_slice(&self.best.status);
        outcome.residual = self.best.residual;
        outcome.method = self.best.method;
        Ok(outcome)
    }

    /// Makes room, and takes the given multipliers, made admissible, as the best so far.
    fn start(&mut self, problem: Checked, multipliers: &[f64], status: &[Status]) {
        let n = problem.n_rows();
        self.active_set.reserve(n);
        self.trial.resize(n, 0.0);
        self.best.multipliers.resize(n, 0.0);
        self.best.status.resize(n, Status::Open);
        self.status.clear();
        self.status.extend_from_slice(status);
        self.given.clear();
        self.given.extend_from_slice(status);
        for (row, (start, &given)) in self.trial.iter_mut().zip(multipliers).enumerate() {
            let usable = given.is_finite() && problem.is_movable(row);
            let normal = problem.normal_multiplier(row, multipliers);
            *start = problem.project(row, if usable { given } else { 0.0 }, normal);
        }
        self.best.candidate = Method::ActiveSet;
        self.best.method = Method::ActiveSet;
        self.best.residual = f64::INFINITY;
        self.best.multipliers.copy_from_slice(&self.trial);
        self.best.status.copy_from_slice(&self.status);
    }

    /// Sweeps from the start; returns whether that solved the problem. If not, the active set starts from where they ended.
    fn sweep(&mut self, problem: Checked, outcome: &mut Outcome) -> bool {
        let n_sweeps = gauss_seidel::sweep(problem, 1.0, &mut self.trial, MOST_SWEEPS);
        outcome.n_sweeps += n_sweeps;
        self.best.candidate = Method::GaussSeidel;
        self.judge_trial(problem);
        if self.best.residual <= SWEPT {
            return true;
        }
        self.best.candidate = Method::ActiveSet;
        self.best.residual = f64::INFINITY;
        self.trial.copy_from_slice(&self.best.multipliers);
        self.status.copy_from_slice(&self.best.status);
        false
    }

    fn follow_active_set(
        &mut self,
        problem: Checked,
        (redundancy, weight): (Redundancy, f64),
        outcome: &mut Outcome,
    ) -> bool {
        let Self {
            active_set,
            trial,
            status,
            best,
            ..
        } = self;
        let redundancy = (redundancy, self.redundancy_tolerance);
        let start = (&trial[..], &mut status[..], weight);
        active_set.run(problem, start, redundancy, best, outcome)
    }

    /// Tries one way after the other until an answer is exact; returns whether one is.
    fn rescue(
        &mut self,
        problem: Checked,
        ways: &[(Method, usize)],
        outcome: &mut Outcome,
    ) -> bool {
        ways.iter().any(|&(method, effort)| {
            self.best.candidate = method;
            let weight = match method {
                Method::ActiveSet => effort as f64,
                Method::GaussSeidel | Method::Lemke => 1.0,
            };
            self.look_elsewhere(problem, method, effort, outcome)
                && self.follow_active_set(problem, (Redundancy::LeastChange, weight), outcome)
        })
    }

    /// Puts new multipliers and statuses in `trial` and `status`; false if the method has none.
    fn look_elsewhere(
        &mut self,
        problem: Checked,
        method: Method,
        effort: usize,
        outcome: &mut Outcome,
    ) -> bool {
        match method {
            // the warm start itself, unless it was empty and has just been tried
            Method::ActiveSet => {
                self.status.copy_from_slice(&self.given);
                if effort > 1 {
                    return slide(problem, &mut self.status);
                }
                return self.trial.iter().any(|&multiplier| multiplier != 0.0);
            }
            Method::GaussSeidel => {
                self.trial.copy_from_slice(&self.best.multipliers);
                outcome.n_sweeps +=
                    gauss_seidel::sweep(problem, gauss_seidel::RELAXATION, &mut self.trial, effort);
            }
            Method::Lemke => {
                let n_pivots = &mut outcome.n_lemke_pivots;
                if !self.lemke.solve(problem, effort, &mut self.trial, n_pivots) {
                    return false;
                }
            }
        }
        self.judge_trial(problem);
        true
    }

    /// Reads the statuses of the trial multipliers and offers both.
    fn judge_trial(&mut self, problem: Checked) {
        let trial = &self.trial;
        let now = measure(problem, trial, |row| problem.velocity(row, trial));
        // contacts that carry nothing start open: what is left is then independent
        self.status.fill(Status::Open);
        let slack = rounding::SHARE * now.scale;
        identify(
            problem,
            trial,
            |row| problem.velocity(row, trial),
            (slack, 1.0),
            &mut self.status,
        );
        self.best.offer(trial, &self.status, now);
    }
}
