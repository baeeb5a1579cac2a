//! Newton's iteration on one factor, renewed when it converges slowly: `x' += Q K⁻¹ Qᵀ r`.
//!
//! `K` is the tangent of an earlier iterate, or of an earlier step; `Q` is how far the body has turned since.

use super::LargeError;
use super::equation::{Equation, Evaluation, Inertia};
use super::turn::turn;
use crate::fe::finite_strain::{Deformation, FiniteStrainModel, Form, Inadmissible, Linearization};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::BlockCholesky;
use crate::math::judged::Judged;

/// A residual of which an iteration leaves more than this asks for a new factor: within a tenth of the cheapest of the rules tried
/// in swings of 126 to 8,442 dofs.
pub(crate) const SLOWEST: Judged = Judged::new("large::SLOWEST", 0.25);

/// An increment is cut to 1/64 before the attempt is given up: a direction that does not do for that is wrong.
pub(crate) const MOST_CUTS: usize = 6;

/// New factors in one attempt, after which its beginning was too far away.
const MOST_FACTORS: usize = 12;

/// What the iterations of a step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Work {
    pub(super) n_iterations: usize,
    pub(super) n_factorizations: usize,
    pub(super) n_definite: usize,
    pub(super) n_cut_increments: usize,
    pub(super) n_at_rounding: usize,
    /// The largest residual left over the scale of its attempt, where that is within the tolerance (-).
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
    /// What is out of balance at the last evaluation (N).
    pub(super) residual: Vec<f64>,
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

    /// Forgets the factor, as other dofs are held from now on.
    pub(super) fn forget_factor(&mut self) {
        self.factor_of = None;
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
            self.forget_factor();
        }
        outcome
    }

    /// Moves what is free by what the body answers to the way of the held dofs where it is, so that the iterations begin without the strains of ends
    /// that have moved alone: those would flow, and turn thin cells over.
    pub(super) fn follow_held(&mut self, equation: &Equation<'_>, end: &mut [f64]) {
        let mut ways = end.iter().zip(equation.start).zip(equation.is_held);
        if ways.all(|((end, start), &is_held)| !is_held || end == start) {
            return;
        }
        if self.evaluate(equation, equation.start).is_err() {
            return;
        }
        self.matrix.fill_zero();
        let kind = Linearization::Consistent;
        let model = equation.model;
        model.add_tangent(equation.form, kind, &self.deformation, &mut self.matrix);
        for (dof, way) in self.residual.iter_mut().enumerate() {
            let moved = end[dof] - equation.start[dof];
            *way = if equation.is_held[dof] { moved } else { 0.0 };
        }
        self.increment.fill(0.0);
        self.matrix
            .multiply_add(-1.0, &self.residual, &mut self.increment);
        self.matrix.constrain(equation.is_held);
        self.work.n_factorizations += 1;
        self.forget_factor();
        if self.cholesky.factorize(&self.matrix).is_err() {
            return;
        }
        for (increment, &is_held) in self.increment.iter_mut().zip(equation.is_held) {
            *increment = if is_held { 0.0 } else { *increment };
        }
        self.cholesky.solve_in_place(&mut self.increment);
        for (end, increment) in end.iter_mut().zip(&self.increment) {
            *end += increment;
        }
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
                Err(reason) => {
                    self.go_back(equation, &mut attempt, reason, end)?;
                    continue;
                }
            };
            let is_slow = attempt
                .last
                .is_some_and(|last| now.norm > SLOWEST * last.norm);
            if self.has_ended(equation, limits, now, is_slow) {
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

    /// Whether a residual is within the tolerance, or as small as rounding lets it be.
    fn has_ended(
        &mut self,
        equation: &Equation<'_>,
        limits: Limits,
        now: Evaluation,
        is_slow: bool,
    ) -> bool {
        if now.norm <= limits.tolerance * now.scale {
            let left = now.norm / now.scale.max(f64::MIN_POSITIVE);
            self.work.residual = self.work.residual.max(left);
            return true;
        }
        // Positions are known to half their rounding ε |x|, so a residual to that times the matrix. Where iterations no longer help and
        // leave no more, they have ended.
        let rounding = f64::EPSILON * self.row_sum * largest(equation.start);
        let is_rounding = is_slow && now.norm <= rounding;
        self.work.n_at_rounding += usize::from(is_rounding);
        is_rounding
    }

    fn has_factor_for(&self, equation: &Equation<'_>) -> bool {
        self.factor_of
            .is_some_and(|(purpose, _)| purpose == Purpose::of(equation))
    }

    /// Takes half of an increment back that cannot be taken, or half of the guess where there was none.
    ///
    /// # Errors
    /// The reason, if that was done often enough.
    fn go_back(
        &mut self,
        equation: &Equation<'_>,
        attempt: &mut Attempt,
        reason: LargeError,
        end: &mut [f64],
    ) -> Result<(), LargeError> {
        attempt.n_cuts += 1;
        if attempt.n_cuts > MOST_CUTS {
            return Err(reason);
        }
        self.work.n_cut_increments += 1;
        if attempt.last.is_some() {
            for (end, increment) in end.iter_mut().zip(&mut self.increment) {
                *increment *= 0.5;
                *end -= *increment;
            }
            return Ok(());
        }
        for (dof, end) in end.iter_mut().enumerate() {
            if !equation.is_held[dof] {
                *end = 0.5 * (*end + equation.start[dof]);
            }
        }
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
        self.factorize(equation, angle)
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

/// The largest sum of the sizes of a row.
pub(crate) fn largest_row_sum(matrix: &BlockMatrix) -> f64 {
    let row_sums = (0..matrix.n_nodes()).map(|node| {
        let blocks = matrix.row_blocks(node).iter();
        let [x, y] = blocks.fold([0.0, 0.0], |[x, y], [xx, xy, yx, yy]| {
            [x + xx.abs() + xy.abs(), y + yx.abs() + yy.abs()]
        });
        f64::max(x, y)
    });
    row_sums.fold(0.0, f64::max)
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()))
}
