//! Newton's iteration for a point of the path.

use super::bordered::{Bordered, Row, dot};
use super::case::PathCase;
use crate::fe::finite_strain::{Deformation, FiniteStrainModel, Form, Linearization};
use crate::large::LargeError;
use crate::large::equation::{Equation, Evaluation, Inertia};
use crate::large::newton::largest_row_sum;
use crate::linalg::cholesky::BlockCholesky;
use std::sync::Arc;

/// Each gains some digits of a mode whose eigenvalue is all but zero beside the others.
const INVERSE_ITERATIONS: usize = 8;

/// A point of the path.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Point {
    pub(super) positions: Vec<f64>,
    pub(super) factor: f64,
}

/// What the iterations did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Work {
    pub(super) n_iterations: usize,
    pub(super) n_factorizations: usize,
    pub(super) n_at_rounding: usize,
    pub(super) residual: f64,
}

/// The equations of a case, and what solving them needs.
#[derive(Clone, Debug)]
pub(super) struct Corrector {
    pub(super) model: Arc<FiniteStrainModel>,
    pub(super) case: PathCase,
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
    /// Where the path began (m).
    start: Vec<f64>,
    deformation: Deformation,
    system: Bordered,
    cholesky: BlockCholesky,
    load: Vec<f64>,
    residual: Vec<f64>,
    pub(super) reaction: Vec<f64>,
    pub(super) work: Work,
}

impl Corrector {
    pub(super) fn new(
        model: Arc<FiniteStrainModel>,
        case: PathCase,
        start: &[f64],
        [tolerance, max_iterations]: [f64; 2],
    ) -> Result<Self, LargeError> {
        let matrix = model.new_matrix();
        let mut added = Vec::new();
        for follower in &case.followers {
            follower.list_derivative(1.0, start, &mut added);
        }
        added.retain(|entry| !(case.is_held[entry.row] || case.is_held[entry.column]));
        let zeros = vec![0.0; model.n_dofs()];
        let n_dofs = model.n_dofs();
        Ok(Self {
            deformation: model.deformation(start),
            cholesky: BlockCholesky::analyze(&matrix),
            system: Bordered::new(matrix, added).map_err(|_| LargeError::Memory { n_dofs })?,
            start: start.to_vec(),
            load: zeros.clone(),
            residual: zeros.clone(),
            reaction: zeros,
            work: Work::default(),
            tolerance,
            max_iterations: max_iterations as usize,
            model,
            case,
        })
    }

    /// Way of a dof while the load factor grows by one, at held dofs (m).
    fn way(&self, dof: usize) -> f64 {
        match self.case.is_held[dof] {
            true => self.case.places[dof] - self.start[dof],
            false => 0.0,
        }
    }

    /// Puts held dofs where the load factor has them.
    pub(super) fn place(&self, point: &mut Point) {
        for dof in 0..self.start.len() {
            if self.case.is_held[dof] {
                point.positions[dof] = self.start[dof] + point.factor * self.way(dof);
            }
        }
    }

    fn evaluate(&mut self, point: &Point) -> Result<Evaluation, LargeError> {
        let case = &self.case;
        for (dof, load) in self.load.iter_mut().enumerate() {
            *load = case.from[dof] + point.factor * (case.to[dof] - case.from[dof]);
        }
        for follower in &case.followers {
            let force = point.factor * follower.at(&point.positions);
            self.load[2 * follower.node] += force.x;
            self.load[2 * follower.node + 1] += force.y;
        }
        let equation = equation(&self.model, &self.load, &self.start, &case.is_held);
        Ok(equation.evaluate(
            &point.positions,
            &mut self.deformation,
            &mut self.residual,
            &mut self.reaction,
        )?)
    }

    /// Brings the reactions to a point.
    pub(super) fn evaluate_at(&mut self, point: &Point) -> Result<(), LargeError> {
        self.evaluate(point).map(|_| ())
    }

    /// Fills and factorizes the system at the point last evaluated.
    fn renew(&mut self, point: &Point) -> Result<(), LargeError> {
        let Self { case, system, .. } = self;
        system.matrix.fill_zero();
        self.model.add_tangent(
            Form::Equilibrium,
            Linearization::Consistent,
            &self.deformation,
            &mut system.matrix,
        );
        system.added.clear();
        for (dof, rate) in system.rate.iter_mut().enumerate() {
            *rate = case.to[dof] - case.from[dof];
        }
        for follower in &case.followers {
            let force = follower.at(&point.positions);
            system.rate[2 * follower.node] += force.x;
            system.rate[2 * follower.node + 1] += force.y;
            follower.list_derivative(-point.factor, &point.positions, &mut system.added);
        }
        // What held dofs do to free ones on their way.
        let ways: Vec<f64> = (0..self.start.len()).map(|dof| self.way(dof)).collect();
        let system = &mut self.system;
        if ways.iter().any(|&way| way != 0.0) {
            system.matrix.multiply_add(-1.0, &ways, &mut system.rate);
            for entry in &system.added {
                system.rate[entry.row] -= entry.value * ways[entry.column];
            }
        }
        let is_held = &self.case.is_held;
        for (dof, rate) in system.rate.iter_mut().enumerate() {
            if is_held[dof] {
                *rate = ways[dof];
            }
        }
        system
            .added
            .retain(|entry| !(is_held[entry.row] || is_held[entry.column]));
        system.matrix.constrain(is_held);
        self.work.n_factorizations += 1;
        system.factorize(point.factor)
    }

    /// Moves a guess to the point of the path where `row · (point - guess) = 0`.
    ///
    /// # Errors
    /// Why it was not found; the guess then is of no use.
    pub(super) fn correct(&mut self, row: &Row, point: &mut Point) -> Result<usize, LargeError> {
        let guess = point.clone();
        let mut last = f64::INFINITY;
        self.place(point);
        for iteration in 0.. {
            let now = self.evaluate(point)?;
            if !now.norm.is_finite() {
                return Err(LargeError::Diverged {
                    node: now.node,
                    residual: now.norm,
                });
            }
            if now.norm <= self.tolerance * now.scale {
                let left = now.norm / now.scale.max(f64::MIN_POSITIVE);
                self.work.residual = self.work.residual.max(left);
                return Ok(iteration);
            }
            let most = point.positions.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let rounding = f64::EPSILON * largest_row_sum(&self.system.matrix) * most;
            if now.norm > 0.25 * last && now.norm <= rounding {
                self.work.n_at_rounding += 1;
                return Ok(iteration);
            }
            if iteration == self.max_iterations {
                return Err(LargeError::NotConverged {
                    iterations: iteration,
                    node: now.node,
                    residual: now.norm,
                    limit: self.tolerance * now.scale,
                });
            }
            last = now.norm;
            self.renew(point)?;
            let moved: Vec<f64> = (point.positions.iter().zip(&guess.positions))
                .map(|(x, guess)| x - guess)
                .collect();
            let away = dot(&row.positions, &moved) + row.factor * (point.factor - guess.factor);
            let (dx, change) = self.system.solve(&self.residual, row, -away);
            point.factor += change;
            for (x, dx) in point.positions.iter_mut().zip(&dx) {
                *x += dx;
            }
            self.place(point);
            self.work.n_iterations += 1;
        }
        Ok(0)
    }

    /// The motion that the body resists least at a point, its longest way along an axis one: by inverse iteration, which gains as many digits each
    /// time as the tangent is near to being singular.
    pub(super) fn mode(&mut self, point: &Point) -> Result<Vec<f64>, LargeError> {
        self.evaluate(point)?;
        self.renew(point)?;
        // Any force has a part along a mode, but for one of a symmetry: this has none.
        let mut mode: Vec<f64> = (0..self.start.len())
            .map(|dof| 1.0 + 0.5 * ((dof * dof + 3 * dof) % 17) as f64 / 17.0)
            .collect();
        for _ in 0..INVERSE_ITERATIONS {
            for (x, &is_held) in mode.iter_mut().zip(&self.case.is_held) {
                *x = if is_held { 0.0 } else { *x };
            }
            self.system.solve_alone(&mut mode);
            let longest =
                mode.iter().fold(
                    0.0f64,
                    |longest, &x| {
                        if x.abs() > longest.abs() { x } else { longest }
                    },
                );
            mode.iter_mut().for_each(|x| *x /= longest);
        }
        match mode.iter().all(|x| x.is_finite()) {
            true => Ok(mode),
            false => Err(LargeError::Singular {
                factor: point.factor,
            }),
        }
    }

    /// Whether the load factor says nothing of where the body is at the point last asked for: it may move as a whole.
    pub(super) fn is_singular(&self) -> bool {
        self.system.is_singular(&self.case.is_held)
    }

    /// The tangent `[x', λ']` at a point of the path, with `row · [x', λ'] = 1`, and whether the point is stable under dead loads.
    pub(super) fn tangent(
        &mut self,
        row: &Row,
        point: &Point,
    ) -> Result<(Vec<f64>, f64, bool), LargeError> {
        self.evaluate(point)?;
        self.renew(point)?;
        let is_stable = self.cholesky.factorize(&self.system.matrix).is_ok();
        let zeros = vec![0.0; self.start.len()];
        let (along, rate) = self.system.solve(&zeros, row, 1.0);
        Ok((along, rate, is_stable))
    }
}

fn equation<'a>(
    model: &'a FiniteStrainModel,
    load: &'a [f64],
    start: &'a [f64],
    is_held: &'a [bool],
) -> Equation<'a> {
    Equation {
        model,
        form: Form::Equilibrium,
        inertia: Inertia {
            acceleration: 0.0,
            drag: 0.0,
        },
        load,
        start,
        coast: start,
        is_held,
        most_growth: f64::INFINITY,
    }
}
