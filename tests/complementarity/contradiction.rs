//! Rows that contradict each other: what they ask for is met in the mean, by multipliers that bring no energy.

use crate::support::{Case, Numbers, random_contacts};
use foil2d::linalg::complementarity::{Problem, RowKind, Solver, Status, natural_map_residual};

/// `p·(b + W p / 2)`, and the largest `sqrt(W_ii) |p_i|` over the largest `|b_i| / sqrt(W_ii)`.
fn gain_and_size(problem: &Problem, multipliers: &[f64]) -> (f64, f64) {
    let n = multipliers.len();
    let (mut gain, mut carried, mut given) = (0.0, 0.0_f64, 0.0_f64);
    for (row, line) in problem.delassus.chunks_exact(n).enumerate() {
        let moved: f64 = line.iter().zip(multipliers).map(|(w, p)| w * p).sum();
        gain += multipliers[row] * (problem.free[row] + 0.5 * moved);
        let weight = line[row].sqrt();
        carried = carried.max(weight * multipliers[row].abs());
        given = given.max(problem.free[row].abs() / weight);
    }
    (gain, carried / given)
}

#[test]
fn a_body_between_walls_that_close_moves_with_their_mean() {
    // 4 kg between walls at 3 m/s from the left and 1 m/s from the right, rough or not, alone or beside one that falls
    for friction in [0.0, 0.5] {
        for is_alone in [true, false] {
            let mut jacobian = vec![
                vec![1.0, 0.0, 0.0],
                vec![0.0, 1.0, 0.0],
                vec![-1.0, 0.0, 0.0],
                vec![0.0, -1.0, 0.0],
            ];
            let rough = |normal| RowKind::Friction {
                normal,
                coefficient: friction,
            };
            let mut rows = vec![RowKind::Unilateral, rough(0), RowKind::Unilateral, rough(2)];
            if !is_alone {
                jacobian.push(vec![0.0, 0.0, 1.0]);
                rows.push(RowKind::Unilateral);
            }
            let mut case = Case::from_bodies(&jacobian, &[0.25; 3], &[0.0, 0.0, -1.0], rows);
            case.free[0] = -3.0;
            case.free[2] = -1.0;
            let (multipliers, status, outcome) = case.solve();
            let velocities = case.velocities(&multipliers);
            assert!((velocities[0] - -2.0).abs() < 1e-2, "{velocities:?}");
            assert!((velocities[2] - -2.0).abs() < 1e-2, "{velocities:?}");
            assert_eq!([status[0], status[2]], [Status::Stick; 2]);
            if !is_alone {
                assert!((multipliers[4] - 4.0).abs() < 1e-5, "{multipliers:?}");
            }
            let (gain, size) = gain_and_size(&case.problem(), &multipliers);
            assert!(gain < 0.0, "{gain:e}");
            assert!(size < 1e4, "{size:e}");
            // and what goes on along the ray is no better for its size
            let far: Vec<f64> = multipliers.iter().map(|p| 1e12 * p).collect();
            assert!(natural_map_residual(&case.problem(), &far) > 1e-4);
            // the outcome tells of it, and no path was followed for what has no end
            assert!(outcome.residual > 1e-5, "{outcome:?}");
            assert!(outcome.n_sweeps <= 50, "{outcome:?}");
        }
    }
}

#[test]
fn what_is_driven_into_each_other_gains_no_energy_and_carries_no_boundless_forces() {
    let (mut n_solved, mut n_contradicted) = (0, 0);
    for (n_bodies, n_contacts) in [(1, 4), (1, 7), (2, 6), (3, 12), (6, 10)] {
        for seed in 0..100 {
            let mut case = random_contacts(seed, n_bodies, n_contacts, 0.8);
            let mut numbers = Numbers(seed);
            for (free, kind) in case.free.iter_mut().zip(&case.rows) {
                // walls of their own
                if *kind == RowKind::Unilateral {
                    *free -= numbers.unit();
                }
            }
            let n = case.rows.len();
            let (mut multipliers, mut status) = (vec![0.0; n], vec![Status::Open; n]);
            let mut solver = Solver::new();
            let mut outcome = Default::default();
            // from nothing, and from its own answer
            for _ in 0..2 {
                outcome = solver
                    .solve(&case.problem(), &mut multipliers, &mut status)
                    .expect("the data of the case is finite");
                let (gain, size) = gain_and_size(&case.problem(), &multipliers);
                let scale = case.free.iter().map(|b| b * b).fold(0.0, f64::max);
                assert!(
                    gain <= 1e-6 * scale,
                    "{n_contacts} on {n_bodies}, seed {seed}: {gain:e} J, {outcome:?}"
                );
                assert!(
                    size < 1e4 || outcome.residual <= 1e-9,
                    "{n_contacts} on {n_bodies}, seed {seed}: {size:e} times what acts, {outcome:?}"
                );
            }
            n_solved += usize::from(outcome.residual <= 1e-9);
            n_contradicted += usize::from(outcome.residual > 1e-6);
        }
    }
    assert!(
        n_solved > 50 && n_contradicted > 50,
        "{n_solved} {n_contradicted}"
    );
}
