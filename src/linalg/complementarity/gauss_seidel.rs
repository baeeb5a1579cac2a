//! The first fallback: projected Gauss–Seidel with over-relaxation, `p_i <- proj_i(p_i - omega w_i / W_ii)`. With
//! `omega = 1` it is the modified Gauss–Seidel method of Carpenter, Taylor and Katona (1991): every multiplier in turn is
//! solved for, dropped if it pulls, and cut to `mu p_n` if it holds more than friction can.
//!
//! Without friction it decreases `½ pᵀ W p + bᵀ p` at every row and converges for `0 < omega < 2`, also if
//! `W` is singular (Cryer 1971; Luo and Tseng 1992), if slowly. With friction there is no proof, but its
//! limit, if any, is a solution. Here it only has to come close enough for the active set to finish.

use super::problem::Checked;
use crate::math::rounding;
use faer::traits::pulp::{Arch, Simd, WithSimd};

/// Over-relaxation: above 1 for speed, well below 2 because friction adds a coupling of its own.
pub(super) const RELAXATION: f64 = 1.2;
/// A relative change per sweep below which nothing more will come.
const STALLED: f64 = rounding::FEW;

/// Sweeps over the rows, in place, at most `n_sweeps` times; returns how many were made.
///
/// - `multipliers`: the start, then the result, shape `(n)`.
pub(super) fn sweep(
    problem: Checked,
    relaxation: f64,
    multipliers: &mut [f64],
    n_sweeps: usize,
) -> usize {
    Arch::new().dispatch(Sweep {
        problem,
        relaxation,
        multipliers,
        n_sweeps,
    })
}

/// The sweeps, as a task for one instruction set; all give the same bits.
struct Sweep<'a> {
    problem: Checked<'a>,
    relaxation: f64,
    multipliers: &'a mut [f64],
    n_sweeps: usize,
}

impl WithSimd for Sweep<'_> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> usize {
        let Self {
            problem,
            relaxation,
            multipliers,
            n_sweeps,
        } = self;
        for done in 0..n_sweeps {
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for row in 0..problem.n_rows() {
                let present = multipliers[row];
                let next = if problem.is_movable(row) {
                    let step = problem.velocity(row, multipliers) / problem.diagonal(row);
                    let normal = problem.normal_multiplier(row, multipliers);
                    problem.project(row, present - relaxation * step, normal)
                } else {
                    problem.idle_multiplier(row)
                };
                let weight = problem.diagonal(row).max(0.0).sqrt();
                change = change.max(weight * (next - present).abs());
                size = size.max(weight * next.abs());
                multipliers[row] = next;
            }
            if change <= STALLED * size {
                return done + 1;
            }
        }
        n_sweeps
    }
}

#[cfg(test)]
mod tests {
    use super::super::problem::{Problem, RowKind};
    use super::*;

    #[test]
    fn sweeps_converge_to_the_impulses_of_a_braked_rod() {
        // W p + b = 0 for the normal row, with p_t = -p_n / 4: (3 - 1/4) p_n = 11
        let problem = Problem {
            delassus: &[3.0, 1.0, 1.0, 2.0],
            free: &[-11.0, 20.0],
            rows: &[
                RowKind::Unilateral,
                RowKind::Friction {
                    normal: 0,
                    coefficient: 0.25,
                },
            ],
            acted: &[],
        };
        let mut multipliers = [0.0; 2];
        let n_sweeps = problem
            .check()
            .map(|problem| sweep(problem, RELAXATION, &mut multipliers, 100));
        assert!(
            n_sweeps.is_ok_and(|n_sweeps| n_sweeps < 60),
            "the sweeps did not stall"
        );
        assert!((multipliers[0] - 4.0).abs() < 1e-12 && (multipliers[1] + 1.0).abs() < 1e-12);
    }
}
