//! Contact with friction, joints and motors between many bodies: one sparse problem on the friction cones.
//!
//! ```text
//! A a = r + Gᵀ p,      w = free + G a + give p,      P = p + acted
//! ```
//!
//! with a law between `w` and `P` on every row ([`ConeLaw`]). Friction is Coulomb's: De Saxcé's dilation `mu sigma` with
//! `sigma = |w_t|` makes the law of a contact a projection on its cone, and leaves no gap under a contact that slides.
//!
//! All solvers work on `H = A + Gᵀ S G`, as sparse as the graph of bodies that touch:
//!
//! 1. proximal steps from the last answer, by Newton's method (`proximal`), whose factor is corrected where few rows change
//!    sides (`correction`);
//! 2. if that takes more than a few factorizations without gaining, an interior point (`interior`),
//! 3. whose forces proximal steps finish, if they are not good enough;
//! 4. the budget spent, projected gradients (`sweep`), which obey every bound and bring no energy, but leave gaps.
//!
//! Whatever the solver, `a` is made from the forces handed back, so that `A a = r + Gᵀ p` to rounding.
//!
//! ```
//! use foil2d::linalg::block_matrix::BlockMatrix;
//! use foil2d::linalg::cone::{ConeEntry, ConeLaw, ConeProblem, ConeRow, ConeSolver};
//!
//! // a point of 4 kg falls at 3 m/s and slides at 10 m/s over rough ground
//! let mut mass = BlockMatrix::from_cells(1, [[0]].iter().map(|cell| &cell[..]));
//! mass.add_diagonal(0, [4.0, 4.0]);
//! let row = ConeRow {
//!     entries: (0, 1),
//!     law: ConeLaw::Contact { friction: 0.5 },
//!     free: [-3.0, 10.0],
//!     give: [0.0; 2],
//!     acted: [0.0; 2],
//!     scale: [0.25; 2],
//!     local: f64::INFINITY,
//! };
//! let entry = ConeEntry { node: 0, normal: [0.0, 1.0], tangent: [1.0, 0.0] };
//! let problem = ConeProblem { matrix: &mass, load: &[0.0; 2], rows: &[row], entries: &[entry] };
//! let (mut impulses, mut slip, mut change) = ([[0.0; 2]], [0.0], Vec::new());
//! let outcome = ConeSolver::default().solve(&problem, &mut impulses, &mut slip, &mut change)?;
//! assert!(outcome.is_solved);
//! assert!((impulses[0][0] - 12.0).abs() < 1e-7 && (impulses[0][1] + 6.0).abs() < 1e-7);
//! # Ok::<(), foil2d::linalg::cone::ConeError>(())
//! ```

mod analysis;
mod correction;
mod interior;
mod law;
mod problem;
mod proximal;
#[cfg(feature = "serde-serialize")]
mod record;
mod reduced;
mod settings;
mod slip;
mod start;
mod sweep;
mod system;
#[cfg(test)]
mod tests;

pub use law::ConeStatus;
pub use problem::{ConeEntry, ConeError, ConeLaw, ConeProblem, ConeRow};
#[cfg(feature = "serde-serialize")]
pub(crate) use record::ConeRecord;
pub use settings::{ConeOutcome, ConeSettings};

use crate::math::judged::Judged;
use interior::Interior;
use proximal::{Ending, Proximal};
use reduced::{Measure, Reduced};
use sweep::Sweep;
use system::System;

/// Penalties of the proximal steps, times `W_ii`, the next one where a step gains too little: a soft one finds its piece sooner, stiffer ones
/// only speed up the last digits.
const LEVELS: [f64; 3] = [1e2, 1e4, 1e6];
/// Factorizations allowed to warm proximal steps until the residual is lower by [`GAIN`](proximal); few if they have failed the last time.
const N_WARM: [usize; 2] = [12, 3];

/// The part of the error at the start that may be left (-), here and in passes of large strain: what comes to rest is solved the finer the less it
/// moves, and comes to rest.
pub(crate) const SETTLING: Judged = Judged::new("linalg::SETTLING", 5e-4);

/// Forces and the motion they cause, in whole multipliers.
#[derive(Debug, Clone, Default)]
struct State {
    forces: Vec<[f64; 2]>,
    slip: Vec<f64>,
    a: Vec<f64>,
    status: Vec<ConeStatus>,
    /// What the forces miss, where `a` is the motion that they cause and this is known.
    measure: Option<Measure>,
}

/// Solves cone problems of any size; holds factors and scratch, which only grow.
#[derive(Debug, Clone, Default)]
pub struct ConeSolver {
    /// What is good enough.
    pub settings: ConeSettings,
    /// Whether only the ratios of the multipliers at the start tell something: they are taken as far as they bring the energy down.
    pub scales_start: bool,
    is_hard: bool,
    reduced: Reduced,
    system: System,
    proximal: Proximal,
    interior: Interior,
    sweep: Sweep,
    state: State,
    /// What the load and the start move.
    moves: [Vec<f64>; 2],
    start: Vec<[f64; 2]>,
    start_slip: Vec<f64>,
    completed: Vec<[f64; 2]>,
    completed_slip: Vec<f64>,
}

impl ConeSolver {
    /// Makes a solver without scratch; the first solve of each pattern reserves it.
    pub fn new(settings: ConeSettings) -> Self {
        Self {
            settings,
            ..Self::default()
        }
    }

    /// Where each row of the last problem stands.
    pub fn status(&self) -> &[ConeStatus] {
        &self.state.status
    }

    /// Solves the problem as well as it can; the outcome says how well.
    ///
    /// Rows that contradict each other are not solved: they end in a compromise with a residual.
    ///
    /// - `multipliers`: `p` of the last step or zeros, then the answer, normal and tangential, one pair per row.
    /// - `slip`: `sigma` of the last step or zeros, then that of the answer, one per row.
    /// - `acceleration`: overwritten with `a`, length `n_dofs`.
    ///
    /// # Errors
    /// If lengths disagree, a number is not finite, or `A` has no factor; the arguments are then left as they were.
    pub fn solve(
        &mut self,
        problem: &ConeProblem,
        multipliers: &mut [[f64; 2]],
        slip: &mut [f64],
        acceleration: &mut Vec<f64>,
    ) -> Result<ConeOutcome, ConeError> {
        self.solve_like(None, problem, multipliers, slip, acceleration)
    }

    /// [`Self::solve`], with the pattern of another solver that has solved all the rows of the problem, and more, if this one knows of none that
    /// has them: what is pressed is among what is near.
    pub(crate) fn solve_like(
        &mut self,
        other: Option<&Self>,
        problem: &ConeProblem,
        multipliers: &mut [[f64; 2]],
        slip: &mut [f64],
        acceleration: &mut Vec<f64>,
    ) -> Result<ConeOutcome, ConeError> {
        let n_rows = problem.rows.len();
        for (what, found) in [
            ("the multipliers", multipliers.len()),
            ("the slips", slip.len()),
        ] {
            if found != n_rows {
                return Err(ConeError::Length {
                    what,
                    found,
                    expected: n_rows,
                });
            }
        }
        problem.check()?;
        let (n_factorizations, n_analyses) = (self.system.n_factorizations, self.system.n_analyses);
        self.system
            .prepare(problem, other.map(|other| &other.system))?;
        self.reduced.restate(problem);
        if self.scales_start {
            self.scale_start(problem, multipliers);
        }
        self.warm_start(problem, multipliers, slip);
        self.set_goal(problem);
        let used_interior_point = self.improve(problem);
        let outcome = self.hand_back(problem, multipliers, slip);
        acceleration.clone_from(&self.state.a);
        Ok(ConeOutcome {
            n_factorizations: self.system.n_factorizations - n_factorizations,
            n_analyses: self.system.n_analyses - n_analyses,
            used_interior_point,
            ..outcome
        })
    }

    /// Runs one solver after the other until one succeeds; whether the interior point was among them.
    fn improve(&mut self, problem: &ConeProblem) -> bool {
        let (begun, n_changes) = (self.system.spent(), self.system.n_changes);
        let limit = begun + self.settings.max_factorizations;
        let n_most = self.settings.max_factorizations.div_ceil(2);
        let n_warm = N_WARM[usize::from(self.is_hard)].min(n_most);
        let (ending, _) = self.approach(problem, [n_warm, n_most]);
        // what stalls after it has gained may be slips that chase each other on the way
        let is_late = self.system.n_changes > n_changes + n_warm;
        self.is_hard = ending == Ending::Spent || ending == Ending::Stalled && is_late;
        if !self.is_hard {
            return false;
        }
        self.restart(problem);
        let n_left = limit - self.system.spent().min(limit);
        let suffices = self.interior.run(
            problem,
            &self.reduced,
            &mut self.system,
            &mut self.state,
            &self.settings,
            n_left,
        );
        self.state.measure = None;
        if suffices {
            return true;
        }
        let n_left = limit - self.system.spent().min(limit);
        let (ending, completed) = self.approach(problem, [n_left, n_left]);
        if ending == Ending::Spent {
            self.sweep_instead(problem, completed);
        }
        true
    }

    /// Takes the answer of sweeps, unless the last proximal step completed was nearer. Both obey every bound.
    fn sweep_instead(&mut self, problem: &ConeProblem, completed: Measure) {
        self.completed.clone_from(&self.state.forces);
        self.completed_slip.clone_from(&self.state.slip);
        self.restart(problem);
        self.sweep
            .run(problem, &self.reduced, &mut self.system, &mut self.state);
        self.move_by_forces(problem);
        let State {
            forces,
            slip,
            a,
            status,
            ..
        } = &mut self.state;
        let swept = self
            .reduced
            .measure(problem, a, forces, slip, &self.settings, status);
        if completed.worst() < swept.worst() {
            forces.clone_from(&self.completed);
            slip.clone_from(&self.completed_slip);
        }
    }

    fn approach(&mut self, problem: &ConeProblem, n_allowed: [usize; 2]) -> (Ending, Measure) {
        let Self {
            proximal,
            reduced,
            system,
            state,
            settings,
            ..
        } = self;
        proximal.run(problem, reduced, system, state, settings, n_allowed)
    }

    /// Makes `a` from the forces, judges both, and writes multipliers and slips.
    fn hand_back(
        &mut self,
        problem: &ConeProblem,
        multipliers: &mut [[f64; 2]],
        slip: &mut [f64],
    ) -> ConeOutcome {
        let known = self.state.measure;
        if known.is_none() {
            self.move_by_forces(problem);
        }
        let (settings, state) = (&self.settings, &mut self.state);
        let measure = known.unwrap_or_else(|| {
            self.reduced.measure(
                problem,
                &state.a,
                &state.forces,
                &state.slip,
                settings,
                &mut state.status,
            )
        });
        for (index, row) in problem.rows.iter().enumerate() {
            let acted = row.acted();
            multipliers[index] = [0, 1].map(|k| state.forces[index][k] - acted[k]);
        }
        slip.copy_from_slice(&state.slip);
        // rounding may leave a little more than the iterations saw
        let rounded = ConeSettings {
            tolerance: 2.0 * settings.tolerance,
            ..*settings
        };
        let is_solved = measure.is_within(&rounded, 2.0 * self.reduced.enough);
        ConeOutcome {
            residual: measure.residual,
            dilation: measure.dilation,
            is_solved,
            ..ConeOutcome::default()
        }
    }
}
