//! Lanczos' iteration for the largest eigenvalue of an operator that is symmetric in its own inner product.
//!
//! `A V = V T + r e_kᵀ` with `T` tridiagonal: the largest eigenvalue of `T` rises towards that of `A`, and `|r| |s_k|`, with
//! `s` its eigenvector, bounds the distance to an eigenvalue of `A`. Rounding makes vectors lose their orthogonality only along
//! eigenvectors already found, which repeats the largest value and does not change it.

use crate::math::rounding;
use nalgebra::{DMatrix, SymmetricEigen};

/// What the iteration needs to know.
pub(super) trait Operator {
    /// Length of its vectors.
    fn n_dofs(&self) -> usize;
    /// Whether an entry is zero in all vectors.
    fn is_left_out(&self, dof: usize) -> bool;
    /// The inner product in which the operator is symmetric.
    fn inner(&self, x: &[f64], y: &[f64]) -> f64;
    /// `y = A x`, zero where left out.
    fn apply(&mut self, x: &[f64], y: &mut [f64]);
}

/// What was found.
pub(super) struct Found {
    pub(super) eigenvalue: f64,
    pub(super) error: f64,
    pub(super) n_products: usize,
    pub(super) is_converged: bool,
}

const MOST_PRODUCTS: usize = 400;
/// Products between two looks at the eigenvalues of `T`, which cost the cube of its size.
const BETWEEN_LOOKS: usize = 5;

/// Iterates until the eigenvalue is known to `tolerance` (relative).
pub(super) fn iterate(operator: &mut impl Operator, tolerance: f64) -> Found {
    let n_dofs = operator.n_dofs();
    let mut next = start(operator);
    let (mut current, mut previous) = (vec![0.0; n_dofs], vec![0.0; n_dofs]);
    let (mut diagonal, mut beside): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut found = Found {
        eigenvalue: 0.0,
        error: 0.0,
        n_products: 0,
        is_converged: true,
    };
    let mut length = operator.inner(&next, &next).sqrt();
    // Nothing is free to move.
    if length == 0.0 {
        return found;
    }
    while found.n_products < MOST_PRODUCTS {
        std::mem::swap(&mut previous, &mut current);
        std::mem::swap(&mut current, &mut next);
        current.iter_mut().for_each(|value| *value /= length);
        operator.apply(&current, &mut next);
        found.n_products += 1;
        let last = beside.last().copied().unwrap_or(0.0);
        let own = operator.inner(&current, &next);
        for ((next, current), previous) in next.iter_mut().zip(&current).zip(&previous) {
            *next -= own * current + last * previous;
        }
        diagonal.push(own);
        length = operator.inner(&next, &next).max(0.0).sqrt();
        // An invariant subspace: with a random start it holds the eigenvector looked for.
        let is_exhausted = length <= rounding::FEW * own.abs().max(last);
        if is_exhausted || diagonal.len().is_multiple_of(BETWEEN_LOOKS) {
            let (eigenvalue, end) = largest_pair(&diagonal, &beside);
            found.eigenvalue = eigenvalue;
            found.error = length * end;
            found.is_converged = is_exhausted || found.error <= tolerance * eigenvalue;
            if found.is_converged {
                return found;
            }
        }
        beside.push(length);
    }
    found
}

/// A random vector without entries that are left out, the same in every run (xorshift).
fn start(operator: &impl Operator) -> Vec<f64> {
    let mut state = 0x9E37_79B9_7F4A_7C15u64;
    (0..operator.n_dofs())
        .map(|dof| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            if operator.is_left_out(dof) {
                0.0
            } else {
                (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
            }
        })
        .collect()
}

/// The largest eigenvalue of a tridiagonal matrix and the modulus of the last entry of its eigenvector.
fn largest_pair(diagonal: &[f64], beside: &[f64]) -> (f64, f64) {
    let size = diagonal.len();
    let matrix = DMatrix::from_fn(size, size, |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => beside[i.min(j)],
        _ => 0.0,
    });
    let eigen = SymmetricEigen::new(matrix);
    let (largest, value) = eigen.eigenvalues.argmax();
    (value, eigen.eigenvectors[(size - 1, largest)].abs())
}
