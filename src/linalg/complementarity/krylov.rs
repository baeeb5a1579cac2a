//! Iterative solves of large systems `A x = r` at `O(n²)` a step: conjugate gradients, or BiCGStab for slip.
//!
//! Both are preconditioned with the diagonal and start from the multipliers of the last solve. In a
//! consistent singular system the iterates stay in `x_0 + range(D⁻¹ A)`, so that from zero they
//! find the solution of minimum norm in the metric of the diagonal. (Hestenes and Stiefel 1952; van der
//! Vorst 1992.)

use super::dense::{add_scaled, dot};
use crate::math::rounding;

/// The residual, relative to the right-hand side, at which the iteration stops.
const TOLERANCE: f64 = rounding::FEW;
/// The true residual, relative to the right-hand side, that counts as solved.
const SOLVED: f64 = rounding::SOLVED;

/// Scratch vectors.
#[derive(Debug, Clone, Default)]
pub(super) struct Krylov {
    residual: Vec<f64>,
    shadow: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    inverse_diagonal: Vec<f64>,
    preconditioned: Vec<f64>,
    second_image: Vec<f64>,
    n: usize,
}

impl Krylov {
    /// Makes room for systems of up to `n` unknowns.
    pub fn reserve(&mut self, n: usize) {
        for vector in [
            &mut self.residual,
            &mut self.shadow,
            &mut self.direction,
            &mut self.image,
            &mut self.inverse_diagonal,
            &mut self.preconditioned,
            &mut self.second_image,
        ] {
            if vector.len() < n {
                vector.resize(n, 0.0);
            }
        }
    }

    /// Solves `A x = r` from the start `x`, within `budget` products with `A`; false if that is not enough.
    ///
    /// - `a`: row-major, kept, shape `(n, n)`; `symmetric` selects conjugate gradients.
    /// - `n_products`: counts the products with `A`.
    pub fn solve(
        &mut self,
        (a, symmetric): (&[f64], bool),
        right_side: &[f64],
        x: &mut [f64],
        budget: usize,
        n_products: &mut usize,
    ) -> bool {
        self.n = x.len();
        for (row, inverse) in self.inverse_diagonal[..self.n].iter_mut().enumerate() {
            let diagonal = a[row * x.len() + row].abs();
            *inverse = if diagonal > 0.0 {
                diagonal.recip()
            } else {
                1.0
            };
        }
        let load = weighted_square(right_side, &self.inverse_diagonal);
        if load == 0.0 {
            x.fill(0.0);
            return true;
        }
        let end = *n_products + budget;
        // the recurrences drift from the true residual: measure it and start again once
        for _ in 0..2 {
            self.restart(a, right_side, x, n_products);
            let target = TOLERANCE * TOLERANCE * load;
            if symmetric {
                self.conjugate_gradients(a, x, target, end, n_products);
            } else {
                self.stabilized_biconjugate_gradients(a, x, target, end, n_products);
            }
            self.restart(a, right_side, x, n_products);
            let left = weighted_square(&self.residual[..self.n], &self.inverse_diagonal);
            if left <= SOLVED * SOLVED * load {
                return true;
            }
            if *n_products >= end || !left.is_finite() {
                break;
            }
        }
        false
    }

    /// The true residual `r - A x`.
    fn restart(&mut self, a: &[f64], right_side: &[f64], x: &[f64], n_products: &mut usize) {
        multiply(a, x, &mut self.image[..self.n]);
        *n_products += 1;
        for ((r, b), y) in self.residual.iter_mut().zip(right_side).zip(&self.image) {
            *r = b - y;
        }
    }

    fn conjugate_gradients(
        &mut self,
        a: &[f64],
        x: &mut [f64],
        target: f64,
        end: usize,
        n_products: &mut usize,
    ) {
        let n = self.n;
        self.direction[..n].fill(0.0);
        let mut last = 1.0;
        while *n_products < end {
            for row in 0..n {
                self.preconditioned[row] = self.inverse_diagonal[row] * self.residual[row];
            }
            let square = dot(&self.preconditioned[..n], &self.residual[..n]);
            if square <= target || !square.is_finite() {
                return;
            }
            for (d, z) in self.direction[..n].iter_mut().zip(&self.preconditioned) {
                *d = z + square / last * *d;
            }
            multiply(a, &self.direction[..n], &mut self.image[..n]);
            *n_products += 1;
            let curvature = dot(&self.direction[..n], &self.image[..n]);
            if curvature <= 0.0 || !curvature.is_finite() {
                return;
            }
            let step = square / curvature;
            add_scaled(x, step, &self.direction[..n]);
            add_scaled(&mut self.residual[..n], -step, &self.image[..n]);
            last = square;
        }
    }

    fn stabilized_biconjugate_gradients(
        &mut self,
        a: &[f64],
        x: &mut [f64],
        target: f64,
        end: usize,
        n_products: &mut usize,
    ) {
        let n = self.n;
        self.shadow[..n].copy_from_slice(&self.residual[..n]);
        self.direction[..n].fill(0.0);
        self.image[..n].fill(0.0);
        let (mut rho, mut alpha, mut omega) = (1.0, 1.0, 1.0);
        while *n_products + 1 < end && self.is_above(target) {
            let next = dot(&self.shadow[..n], &self.residual[..n]);
            let beta = next / rho * (alpha / omega);
            for row in 0..n {
                let kept = self.direction[row] - omega * self.image[row];
                self.direction[row] = self.residual[row] + beta * kept;
                self.preconditioned[row] = self.inverse_diagonal[row] * self.direction[row];
            }
            multiply(a, &self.preconditioned[..n], &mut self.image[..n]);
            alpha = next / dot(&self.shadow[..n], &self.image[..n]);
            // a breakdown: the caller measures what was reached
            if !(alpha.is_finite() && beta.is_finite()) {
                return;
            }
            add_scaled(x, alpha, &self.preconditioned[..n]);
            add_scaled(&mut self.residual[..n], -alpha, &self.image[..n]);
            for row in 0..n {
                self.preconditioned[row] = self.inverse_diagonal[row] * self.residual[row];
            }
            multiply(a, &self.preconditioned[..n], &mut self.second_image[..n]);
            *n_products += 2;
            let square = dot(&self.second_image[..n], &self.second_image[..n]);
            omega = dot(&self.second_image[..n], &self.residual[..n]) / square;
            if !omega.is_finite() {
                return;
            }
            add_scaled(x, omega, &self.preconditioned[..n]);
            add_scaled(&mut self.residual[..n], -omega, &self.second_image[..n]);
            rho = next;
        }
    }

    fn is_above(&self, target: f64) -> bool {
        weighted_square(&self.residual[..self.n], &self.inverse_diagonal) > target
    }
}

/// `vᵀ D⁻¹ v`.
fn weighted_square(v: &[f64], inverse_diagonal: &[f64]) -> f64 {
    v.iter()
        .zip(inverse_diagonal)
        .map(|(v, inverse)| v * v * inverse)
        .sum()
}

/// `y = A x`, row-major.
fn multiply(a: &[f64], x: &[f64], y: &mut [f64]) {
    for (y, line) in y.iter_mut().zip(a.chunks_exact(x.len())) {
        *y = dot(line, x);
    }
}
