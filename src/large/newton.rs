//! Newton's iteration on one factor, renewed when it converges slowly: `x' += Q K⁻¹ Qᵀ r`.
//!
//! `K` is the tangent of an earlier iterate, or of an earlier step; `Q` is how far the body has turned since.

use super::LargeError;
use super::equation::{Equation, Evaluation, Inertia};
use super::turn::turn;
use crate::fe::finite_strain::{Deformation, FiniteStrainModel, Form, Inadmissible, Linearization};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::BlockCholesky;

/// A residual that falls by less than this a iteration asks for a new factor: with it, the next digits cost fewer solves than
/// the factor, at any number of dofs from a hundred to ten thousand.
const SLOWEST: f64 = 0.25;

/// An increment is cut to 1/64 before the attempt is given up: a direction that does not do for that is wrong.
const MOST_CUTS: usize = 6;

/// New factors in one attempt, after which its beginning was too far away.
const MOST_FACTORS: usize = 12;

/// What the iterations of a step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Work {
    pub(super) n_iterations: usize,
    pub(super) n_factorizations: usize,
    pub(super) n_definite: usize,
    pub(super) n_cut_increments: usize,
    /// The largest residual left over the scale of its attempt (-).
    pub(super) residual: f64,
}

/// What a factor was made for.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Purpose {
    form: Form,
    inertia: Inertia,
}

/// Matrix, factor and vectors of the iteration.
#[derive(Clone, Debug)]
pub(super) struct Newton {
    pub(super) deformation: Deformation,
    matrix: BlockMatrix,
    cholesky: BlockCholesky,
    /// What the factor is of, and the angle of the body then (rad).
    factor_of: Option<(Purpose, f64)>,
    /// The largest sum of the sizes of a row of the factored matrix (N/m).
    row_sum: f64,
    residual: Vec<f64>,
    increment: Vec<f64>,
    /// Forces that hold the held dofs, at the last evaluation (N).
    pub(super) reaction: Vec<f64>,
    pub(super) work: Work,
}

impl Purpose {
    fn of(equation: &Equation<'_>) -> Self {
        Self {
            form: equation.form,
            inertia: equation.inertia,
        }
    }
}

/// How one attempt is limited.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
    /// Iterations of all attempts.
    pub(super) budget: usize,
}

impl Newton {
    pub(super) fn new(model: &FiniteStrainModel) -> Self {
        let matrix = model.new_matrix();
        let zeros = vec![0.0; model.n_dofs()];
        Self {
            deformation: model.deformation(model.rest_positions()),
            cholesky: BlockCholesky::analyze(&matrix),
            matrix,
            factor_of: None,
            row_sum: 0.0,
            residual: zeros.clone(),
            increment: zeros.clone(),
            reaction: zeros,
            work: Work::default(),
        }
    }

    /// Moves `end` from a guess to a solution of the equation, whose body has turned by `angle` (rad).
    ///
    /// # Errors
    /// Who stopped the iterations; `end` then is of no use.
    pub(super) fn solve(
        &mut self,
        equation: &Equation<'_>,
        limits: Limits,
        angle: f64,
        end: &mut [f64],
    ) -> Result<(), LargeError> {
        let outcome = self.iterate(equation, limits, angle, end);
        if outcome.is_err() {
            // The last factor is of a state that led nowhere.
            self.factor_of = None;
        }
        outcome
    }

    fn iterate(
        &mut self,
        equation: &Equation<'_>,
        limits: Limits,
        angle: f64,
        end: &mut [f64],
    ) -> Result<(), LargeError> {
        let mut attempt = Attempt::default();
        loop {
            let outcome = self.evaluate(equation, end);
            let now = match attempt.accept(outcome, equation.most_growth) {
                Ok(now) => now,
                Err(error) => {
                    self.go_back(equation, &mut attempt, error, angle, end)?;
                    continue;
                }
            };
            let is_slow = attempt
                .last
                .is_some_and(|last| now.norm > SLOWEST * last.norm);
            // Positions are known to half their rounding ε |x|, so a residual to that times the matrix. Where iterations no longer help
            // and leave no more, they have ended.
            let rounding = f64::EPSILON * self.row_sum * largest(equation.start);
            if now.norm <= limits.tolerance * now.scale || is_slow && now.norm <= rounding {
                let left = now.norm / now.scale.max(rounding).max(f64::MIN_POSITIVE);
                self.work.residual = self.work.residual.max(left);
                return Ok(());
            }
            if attempt.n_iterations == limits.max_iterations
                || self.work.n_iterations >= limits.budget
            {
                return Err(LargeError::NotConverged {
                    iterations: attempt.n_iterations,
                    node: now.node,
                    residual: now.norm,
                    limit: limits.tolerance * now.scale,
                });
            }
            attempt.last = Some(now);
            attempt.is_fresh = false;
            if is_slow || !self.has_factor_for(equation) {
                self.renew(equation, &mut attempt, angle)?;
            }
            self.advance(angle, end);
            attempt.n_cuts = 0;
            attempt.n_iterations += 1;
            self.work.n_iterations += 1;
        }
    }

    fn evaluate(
        &mut self,
        equation: &Equation<'_>,
        end: &[f64],
    ) -> Result<Evaluation, Inadmissible> {
        equation.evaluate(
            end,
            &mut self.deformation,
            &mut self.residual,
            &mut self.reaction,
        )
    }

    fn has_factor_for(&self, equation: &Equation<'_>) -> bool {
        self.factor_of
            .is_some_and(|(purpose, _)| purpose == Purpose::of(equation))
    }

    /// After an increment that cannot be taken: suspects first an old factor, which is renewed where the increment began, then its length.
    fn go_back(
        &mut self,
        equation: &Equation<'_>,
        attempt: &mut Attempt,
        error: LargeError,
        angle: f64,
        end: &mut [f64],
    ) -> Result<(), LargeError> {
        if attempt.last.is_some() && !attempt.is_fresh {
            for (end, increment) in end.iter_mut().zip(&self.increment) {
                *end -= increment;
            }
            self.evaluate(equation, end)?;
            self.renew(equation, attempt, angle)?;
            self.advance(angle, end);
            return Ok(());
        }
        attempt.n_cuts += 1;
        if attempt.n_cuts > MOST_CUTS {
            return Err(error);
        }
        self.work.n_cut_increments += 1;
        self.cut(equation, attempt.last.is_some(), end);
        Ok(())
    }

    /// A new factor at the iterate last evaluated.
    fn renew(
        &mut self,
        equation: &Equation<'_>,
        attempt: &mut Attempt,
        angle: f64,
    ) -> Result<(), LargeError> {
        attempt.n_factors += 1;
        if attempt.n_factors > MOST_FACTORS
            && let Some(last) = attempt.last
        {
            return Err(diverged(last));
        }
        attempt.is_fresh = true;
        self.factorize(equation, angle)
    }

    /// Takes half of the last increment back, or half of the guess where there was none.
    fn cut(&mut self, equation: &Equation<'_>, has_moved: bool, end: &mut [f64]) {
        if has_moved {
            for (end, increment) in end.iter_mut().zip(&mut self.increment) {
                *increment *= 0.5;
                *end -= *increment;
            }
            return;
        }
        for (dof, end) in end.iter_mut().enumerate() {
            if !equation.is_held[dof] {
                *end = 0.5 * (*end + equation.start[dof]);
            }
        }
    }

    fn factorize(&mut self, equation: &Equation<'_>, angle: f64) -> Result<(), LargeError> {
        self.factor_of = None;
        equation.assemble(
            Linearization::Consistent,
            &self.deformation,
            &mut self.matrix,
        );
        self.work.n_factorizations += 1;
        if self.cholesky.factorize(&self.matrix).is_err() {
            equation.assemble(Linearization::Definite, &self.deformation, &mut self.matrix);
            self.work.n_factorizations += 1;
            self.work.n_definite += 1;
            self.cholesky.factorize(&self.matrix)?;
        }
        self.factor_of = Some((Purpose::of(equation), angle));
        self.row_sum = largest_row_sum(&self.matrix);
        Ok(())
    }

    /// Adds the increment to `end`.
    fn advance(&mut self, angle: f64, end: &mut [f64]) {
        let turned = self.factor_of.map_or(0.0, |(_, then)| angle - then);
        self.increment.copy_from_slice(&self.residual);
        if turned == 0.0 {
            self.cholesky.solve_in_place(&mut self.increment);
        } else {
            turn(&mut self.increment, -turned);
            self.cholesky.solve_in_place(&mut self.increment);
            turn(&mut self.increment, turned);
        }
        for (end, increment) in end.iter_mut().zip(&self.increment) {
            *end += increment;
        }
    }
}

/// Where one attempt stands.
#[derive(Clone, Copy, Debug, Default)]
struct Attempt {
    /// The iterate that the last increment began at.
    last: Option<Evaluation>,
    /// Whether the factor was made there.
    is_fresh: bool,
    n_iterations: usize,
    /// Cuts of the last increment.
    n_cuts: usize,
    n_factors: usize,
}

impl Attempt {
    /// An iterate that may be gone on from, or why not.
    fn accept(
        &self,
        outcome: Result<Evaluation, Inadmissible>,
        most_growth: f64,
    ) -> Result<Evaluation, LargeError> {
        let now = outcome?;
        let bound = self
            .last
            .map_or(f64::INFINITY, |last| most_growth * last.norm);
        if now.norm.is_finite() && now.norm <= bound {
            return Ok(now);
        }
        Err(diverged(self.last.unwrap_or(now)))
    }
}

fn diverged(at: Evaluation) -> LargeError {
    LargeError::Diverged {
        node: at.node,
        residual: at.norm,
    }
}

fn largest_row_sum(matrix: &BlockMatrix) -> f64 {
    let row_sums = (0..matrix.n_nodes()).map(|node| {
        let blocks = matrix.row_blocks(node).iter();
        let [x, y] = blocks.fold([0.0, 0.0], |[x, y], [xx, xy, yx, yy]| {
            [x + xx.abs() + xy.abs(), y + yx.abs() + yy.abs()]
        });
        f64::max(x, y)
    });
    row_sums.fold(0.0, f64::max)
}

fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()))
}
