//! More contacts than degrees of freedom: who carries the load?
//!
//! ```text
//!        +-----------------+
//!        |        c        |        mass m, inertia J, four points x_i under the box
//!        +--o----o---o----o+        W_ij = 1/m + x_i x_j / J   (rank 2)
//!      ------------------------
//! ```

use crate::support::{Case, Numbers, assert_close};
use foil2d::linalg::complementarity::{RowKind, Solver, Status};
use nalgebra::{DMatrix, DVector};

const MASS: f64 = 3.0;
const INERTIA: f64 = 0.7;

/// A rigid box that falls at `speed` and turns at `spin`, on frictionless points under it.
fn box_on_points(points: &[f64], speed: f64, spin: f64, kind: RowKind) -> Case {
    let jacobian: Vec<Vec<f64>> = points.iter().map(|&x| vec![1.0, x]).collect();
    let rows = vec![kind; points.len()];
    Case::from_bodies(
        &jacobian,
        &[1.0 / MASS, 1.0 / INERTIA],
        &[-speed, spin],
        rows,
    )
}

/// `-W⁺ b` by singular values.
fn pseudo_inverse_answer(case: &Case) -> Vec<f64> {
    let n = case.rows.len();
    let svd = DMatrix::from_row_slice(n, n, &case.delassus).svd(true, true);
    let load = -DVector::from_column_slice(&case.free);
    let threshold = 1e-10 * svd.singular_values.max();
    svd.solve(&load, threshold)
        .expect("both factors were asked for")
        .as_slice()
        .to_vec()
}

#[test]
fn a_box_on_four_points_gets_the_forces_of_the_pseudo_inverse() {
    for kind in [RowKind::Unilateral, RowKind::Bilateral] {
        for points in [
            [-1.0, -0.4, 0.3, 1.0],
            [-2.0, -1.0, 1.0, 2.0],
            [-1.0, -0.999, 0.5, 1.0],
        ] {
            let case = box_on_points(&points, 0.16, 0.01, kind);
            let (multipliers, status, outcome) = case.solve();
            assert_close(&multipliers, &pseudo_inverse_answer(&case), 1e-13);
            assert_eq!(status, [Status::Stick; 4]);
            assert!(outcome.residual <= 1e-14, "{outcome:?}");
            assert!((multipliers.iter().sum::<f64>() - MASS * 0.16).abs() <= 1e-14);
        }
    }
}

#[test]
fn a_symmetric_box_stands_on_equal_forces() {
    for n in [3, 4, 5, 8, 16] {
        let points: Vec<f64> = (0..n)
            .map(|index| 2.0 * index as f64 / (n - 1) as f64 - 1.0)
            .collect();
        let case = box_on_points(&points, 0.16, 0.0, RowKind::Unilateral);
        let (multipliers, _, outcome) = case.solve();
        assert_close(&multipliers, &vec![MASS * 0.16 / n as f64; n], 1e-14);
        assert!(outcome.residual <= 1e-14);
    }
}

#[test]
fn a_box_that_slides_on_four_points_is_braked_by_mu_times_its_weight() {
    // points 0.5 below the centre: friction tips the box forward, so that the front points carry more
    let (coefficient, speed) = (0.3, 0.16);
    let points = [-1.0, -0.5, 0.5, 1.0];
    let mut jacobian = Vec::new();
    let mut rows = Vec::new();
    for (contact, &x) in points.iter().enumerate() {
        jacobian.push(vec![0.0, 1.0, x]);
        jacobian.push(vec![1.0, 0.0, 0.5]);
        rows.push(RowKind::Unilateral);
        rows.push(RowKind::Friction {
            normal: 2 * contact,
            coefficient,
        });
    }
    let inverse_mass = [1.0 / MASS, 1.0 / MASS, 1.0 / INERTIA];
    let case = Case::from_bodies(&jacobian, &inverse_mass, &[4.0, -speed, 0.0], rows);
    let (multipliers, status, outcome) = case.solve();
    let normals: Vec<f64> = multipliers.iter().step_by(2).copied().collect();
    let weight: f64 = normals.iter().sum();
    assert!((weight - MASS * speed).abs() <= 1e-14);
    for contact in 0..4 {
        let friction = multipliers[2 * contact + 1];
        assert!((friction + coefficient * normals[contact]).abs() <= 1e-15);
        assert_eq!(status[2 * contact + 1], Status::SlipNegative);
    }
    // no rotation: the moments of the normals and of the friction cancel
    let moment: f64 = normals.iter().zip(points).map(|(p, x)| p * x).sum();
    assert!((moment - 0.5 * coefficient * weight).abs() <= 1e-14);
    // minimum norm under those two conditions: p_i = weight / 4 + moment x_i / sum x²
    let expected: Vec<f64> = points
        .iter()
        .map(|x| weight / 4.0 + moment * x / 2.5)
        .collect();
    assert_close(&normals, &expected, 1e-14);
    assert!(outcome.residual <= 1e-14);
}

#[test]
fn gaps_that_are_not_quite_in_line_do_not_unbalance_the_box() {
    let exact = box_on_points(&[-1.0, -0.4, 0.4, 1.0], 0.16, 0.0, RowKind::Unilateral);
    let (quiet, ..) = exact.solve();
    for seed in 0..100 {
        let mut numbers = Numbers(seed);
        let mut noisy = exact.clone();
        for free in &mut noisy.free {
            *free *= 1.0 + 1e-9 * numbers.signed();
        }
        let (multipliers, _, outcome) = noisy.solve();
        // the noise, times m and J: nothing is divided by round-off
        assert_close(&multipliers, &quiet, 1e-8);
        let total: f64 = multipliers.iter().sum();
        assert!((total - MASS * 0.16).abs() <= 1e-9, "total {total}");
        assert!(outcome.residual <= 1e-8, "{outcome:?}");
        assert_eq!(
            outcome.n_pivots,
            quiet_pivots(&exact),
            "noise must not cost pivots"
        );
    }
}

fn quiet_pivots(case: &Case) -> usize {
    case.solve().2.n_pivots
}

#[test]
fn above_the_redundancy_tolerance_the_exact_answer_is_found_instead() {
    let mut case = box_on_points(&[-1.0, -0.4, 0.4, 1.0], 0.16, 0.0, RowKind::Unilateral);
    case.free[1] += 1e-4;
    let solve = |mut solver: Solver| {
        let (mut multipliers, mut status) = ([0.0; 4], [Status::Open; 4]);
        let outcome = solver.solve(&case.problem(), &mut multipliers, &mut status);
        (multipliers, status, outcome.expect("the data is finite"))
    };
    let (_, status, outcome) = solve(Solver::new());
    assert!(outcome.residual <= 1e-12, "{outcome:?}");
    assert_eq!(
        status[1],
        Status::Open,
        "the point with the larger gap is off the ground"
    );
    let (multipliers, status, outcome) = solve(Solver::new().with_redundancy_tolerance(1e-2));
    assert_eq!(status, [Status::Stick; 4]);
    assert!(
        outcome.residual > 1e-6 && outcome.residual < 1e-2,
        "{outcome:?}"
    );
    assert_close(&multipliers, &[MASS * 0.04; 4], 1e-3);
}

#[test]
fn joints_that_contradict_each_other_get_the_least_squares_forces() {
    // both rows measure the same motion of a 1 kg body, one wants 0 m/s and the other -1 m/s
    let case = Case {
        delassus: vec![1.0; 4],
        free: vec![0.0, 1.0],
        rows: vec![RowKind::Bilateral; 2],
    };
    let (multipliers, _, outcome) = case.solve();
    assert_close(&multipliers, &[-0.25, -0.25], 1e-15);
    assert!(
        outcome.residual > 0.1,
        "the residual must not hide the contradiction: {outcome:?}"
    );
}

/// A pyramid of unit boxes, a small gap between neighbours, each on four points, falling at 1 m/s.
fn pyramid(n_layers: usize, coefficient: f64) -> Case {
    let n_bodies = n_layers * (n_layers + 1) / 2;
    let first_of = |layer: usize| layer * n_layers - layer * layer.saturating_sub(1) / 2;
    let centre = |layer: usize, place: usize| 1.1 * place as f64 + 0.55 * layer as f64;
    let (mut jacobian, mut rows) = (Vec::new(), Vec::new());
    for layer in 0..n_layers {
        for place in 0..n_layers - layer {
            let upper = (first_of(layer) + place, centre(layer, place));
            for offset in [-0.5, -0.05, 0.05, 0.5] {
                let below = place + usize::from(offset > 0.0);
                let lower =
                    (layer > 0).then(|| (first_of(layer - 1) + below, centre(layer - 1, below)));
                let mut normal = vec![0.0; 3 * n_bodies];
                let mut tangent = normal.clone();
                let sides = [(Some(upper), 1.0, -0.5), (lower, -1.0, 0.5)];
                for (body, side, height) in sides {
                    let Some((body, x)) = body else { continue };
                    normal[3 * body + 1] = side;
                    normal[3 * body + 2] = side * (upper.1 + offset - x);
                    tangent[3 * body] = side;
                    tangent[3 * body + 2] = -side * height;
                }
                rows.push(RowKind::Unilateral);
                rows.push(RowKind::Friction {
                    normal: jacobian.len(),
                    coefficient,
                });
                jacobian.extend([normal, tangent]);
            }
        }
    }
    let inverse_mass: Vec<f64> = (0..n_bodies).flat_map(|_| [1.0, 1.0, 6.0]).collect();
    let velocity: Vec<f64> = (0..n_bodies).flat_map(|_| [0.0, -1.0, 0.0]).collect();
    Case::from_bodies(&jacobian, &inverse_mass, &velocity, rows)
}

#[test]
fn a_pyramid_on_the_limit_of_its_friction_is_steady_once_it_has_been_solved() {
    // at mu = 0.1 the forces of minimum norm leave the friction cones, those of the last step do not
    for (n_layers, coefficient) in [(5, 0.1), (5, 0.7), (7, 0.1)] {
        let case = pyramid(n_layers, coefficient);
        let (mut multipliers, mut status, outcome) = case.solve();
        assert!(outcome.residual <= 1e-12, "{n_layers} layers: {outcome:?}");
        assert_eq!(outcome.n_lemke_pivots, 0, "sweeps are enough: {outcome:?}");
        let on_ground: f64 = multipliers[..8 * n_layers].iter().step_by(2).sum();
        let weight = (n_layers * (n_layers + 1) / 2) as f64;
        assert!(
            (on_ground - weight).abs() <= 1e-11 * weight,
            "{on_ground} carries {weight}"
        );
        for _ in 0..3 {
            let outcome = Solver::new().solve(&case.problem(), &mut multipliers, &mut status);
            let outcome = outcome.expect("the data is finite");
            assert!(outcome.residual <= 1e-12, "{outcome:?}");
            assert_eq!((outcome.n_sweeps, outcome.n_lemke_pivots), (0, 0));
            assert!(outcome.n_pivots <= 8, "{outcome:?}");
        }
    }
}
