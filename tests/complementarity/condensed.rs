//! Bilateral rows eliminated first: the same answer.

use crate::support::{Case, Numbers};
use foil2d::linalg::complementarity::{RowKind, Solver, Status, natural_map_residual};

/// Bodies with more dofs than rows, so that the answer is unique: bilateral rows in turn with contacts, motors and limits.
fn case(seed: u64) -> Case {
    let mut numbers = Numbers(seed);
    let (n_dofs, n_rows) = (60, 36);
    let jacobian: Vec<Vec<f64>> = (0..n_rows)
        .map(|_| (0..n_dofs).map(|_| numbers.signed()).collect())
        .collect();
    let inverse_mass: Vec<f64> = (0..n_dofs).map(|_| 0.1 + numbers.unit()).collect();
    let velocity: Vec<f64> = (0..n_dofs).map(|_| numbers.signed()).collect();
    let rows = (0..n_rows)
        .map(|row| match row % 6 {
            0 | 2 | 4 => RowKind::Bilateral,
            1 => RowKind::Unilateral,
            3 => RowKind::Friction {
                normal: row - 2,
                coefficient: 0.4,
            },
            _ => RowKind::Box {
                low: -0.05,
                high: 0.1,
            },
        })
        .collect();
    Case::from_bodies(&jacobian, &inverse_mass, &velocity, rows)
}

#[test]
fn condensed_problems_have_the_answer_of_the_whole() {
    for seed in 0..40 {
        let case = case(seed);
        let (whole, _, outcome) = case.solve();
        let n = whole.len();
        let (mut multipliers, mut status) = (vec![0.0; n], vec![Status::Open; n]);
        let condensed = Solver::new()
            .solve_condensed(&case.problem(), &mut multipliers, &mut status)
            .expect("the data is finite");
        assert!(outcome.residual < 1e-10 && condensed.residual < 1e-10);
        // Rounding, times the condition of random matrices.
        let residual = natural_map_residual(&case.problem(), &multipliers);
        assert!(residual < 1e-9, "{residual:e}");
        let size = whole.iter().fold(0.0f64, |size, p| size.max(p.abs()));
        for (one, other) in whole.iter().zip(&multipliers) {
            assert!(
                (one - other).abs() < 1e-8 * size,
                "seed {seed}: {one} {other}"
            );
        }
    }
}

/// The third row again in the place of the fifth, off by some velocity.
fn doubled(off: f64) -> Case {
    let mut case = case(7);
    let n = case.rows.len();
    for column in 0..n {
        case.delassus[4 * n + column] = case.delassus[2 * n + column];
    }
    for row in 0..n {
        case.delassus[row * n + 4] = case.delassus[row * n + 2];
    }
    case.free[4] = case.free[2] + off;
    case
}

fn condensed(case: &Case, multipliers: &mut [f64]) {
    let mut status = vec![Status::Open; multipliers.len()];
    Solver::new()
        .solve_condensed(&case.problem(), multipliers, &mut status)
        .expect("the data is finite");
}

#[test]
fn redundant_bilateral_rows_share_the_load() {
    let case = doubled(0.0);
    let (whole, _, _) = case.solve();
    let mut multipliers = vec![0.0; whole.len()];
    for solves in 0..3 {
        condensed(&case, &mut multipliers);
        // Minimum norm shares the load evenly.
        let size = whole[2].abs().max(1.0);
        assert!((multipliers[2] - multipliers[4]).abs() < 1e-9 * size);
        // Proximal steps come from what they have found before.
        let left = [1e-4, 1e-7, 1e-10][solves];
        let off = multipliers.iter().zip(&whole);
        let off = off.fold(0.0f64, |most, (one, other)| most.max((one - other).abs()));
        assert!(off < left * size, "{off:e} after {solves}");
    }
}

/// Rows that are one, and contradict each other, have no answer: they end in forces of what they are off by, divided by a thousandth of their
/// mobility, for each of three rounds. Solved again and again these do not grow.
#[test]
fn bilateral_rows_that_contradict_each_other_do_not_ask_for_any_force() {
    for off in [1e-9, 1e-6, 1e-3, -1e-3] {
        let case = doubled(off);
        let n = case.rows.len();
        let mobility = case.delassus[2 * n + 2];
        let mut multipliers = vec![0.0; n];
        for _ in 0..6 {
            condensed(&case, &mut multipliers);
            let apart = multipliers[4] - multipliers[2];
            let expected = -3.0 * off / (1e-3 * mobility);
            assert!((apart - expected).abs() < 1e-6 * expected.abs() + 1e-9);
        }
    }
}
