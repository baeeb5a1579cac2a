//! The bordered system `K dx - q dλ = r`, `c·dx + d dλ = g`.

use crate::large::LargeError;
use crate::large::newton::largest_row_sum;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::lu::{Entry, LuError, SparseLu};

/// Times the residual of a solution is solved for again: near a limit point the parts of a solution cancel all but a few digits.
const REFINEMENTS: usize = 2;

/// A thousandth of the load, where a strip of 600 times its thickness leaves a millionth.
const LEAST_SHARE: f64 = 1e-3;

/// One more equation, for the unknowns `[dx, dλ]`.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) positions: Vec<f64>,
    pub(super) factor: f64,
}

impl Row {
    fn dot(&self, dx: &[f64], change: f64) -> f64 {
        dot(&self.positions, dx) + self.factor * change
    }
}

/// `K` with its factor, and `q`.
#[derive(Clone, Debug)]
pub(super) struct Bordered {
    pub(super) matrix: BlockMatrix,
    /// What followers add to the matrix, none in rows or columns of held dofs.
    pub(super) added: Vec<Entry>,
    /// `∂r/∂λ`: at held dofs the way they go.
    pub(super) rate: Vec<f64>,
    lu: SparseLu,
    /// `K⁻¹ q`.
    along: Vec<f64>,
}

impl Bordered {
    pub(super) fn new(matrix: BlockMatrix, added: Vec<Entry>) -> Result<Self, LuError> {
        let n_dofs = matrix.n_dofs();
        Ok(Self {
            lu: SparseLu::analyze(&matrix, &added)?,
            matrix,
            added,
            rate: vec![0.0; n_dofs],
            along: vec![0.0; n_dofs],
        })
    }

    /// Factorizes the matrix as it is.
    pub(super) fn factorize(&mut self, factor: f64) -> Result<(), LargeError> {
        let singular = LargeError::Singular { factor };
        self.lu
            .factorize(&self.matrix, &self.added)
            .map_err(|error| match error {
                LuError::Singular => singular,
                LuError::Memory { n_dofs } => LargeError::Memory { n_dofs },
            })?;
        self.along.copy_from_slice(&self.rate);
        self.lu.solve_in_place(&mut self.along);
        match self.along.iter().all(|x| x.is_finite()) {
            true => Ok(()),
            false => Err(singular),
        }
    }

    /// Whether `K⁻¹ q` is nothing but rounding: it is so large that forces as of its rounding are a share of `q`.
    pub(super) fn is_singular(&self, is_held: &[bool]) -> bool {
        let (mut most, mut force) = (0.0f64, 0.0f64);
        for (dof, &is_held) in is_held.iter().enumerate() {
            if !is_held {
                most = most.max(self.along[dof].abs());
                force = force.max(self.rate[dof].abs());
            }
        }
        f64::EPSILON * largest_row_sum(&self.matrix) * most > LEAST_SHARE * force
    }

    /// Writes `y = K x`.
    fn multiply(&self, x: &[f64], y: &mut [f64]) {
        self.matrix.multiply(x, y);
        for entry in &self.added {
            y[entry.row] += entry.value * x[entry.column];
        }
    }

    /// Replaces `b` by `K⁻¹ b`.
    pub(super) fn solve_alone(&self, b: &mut [f64]) {
        self.lu.solve_in_place(b);
    }

    /// Solves for `[dx, dλ]`.
    pub(super) fn solve(&self, residual: &[f64], row: &Row, g: f64) -> (Vec<f64>, f64) {
        let (mut dx, mut change) = self.eliminate(residual.to_vec(), row, g);
        let mut left = vec![0.0; dx.len()];
        for _ in 0..REFINEMENTS {
            self.multiply(&dx, &mut left);
            for ((left, r), q) in left.iter_mut().zip(residual).zip(&self.rate) {
                *left = r - *left + q * change;
            }
            let rest = g - row.dot(&dx, change);
            let (more, more_change) = self.eliminate(left.clone(), row, rest);
            dx.iter_mut().zip(&more).for_each(|(dx, more)| *dx += more);
            change += more_change;
        }
        (dx, change)
    }

    fn eliminate(&self, mut dx: Vec<f64>, row: &Row, g: f64) -> (Vec<f64>, f64) {
        self.lu.solve_in_place(&mut dx);
        let change = (g - row.dot(&dx, 0.0)) / row.dot(&self.along, 1.0);
        for (dx, along) in dx.iter_mut().zip(&self.along) {
            *dx += change * along;
        }
        (dx, change)
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
