//! Problems that are hard, degenerate or hopeless.

use crate::support::{Case, Numbers, random_contacts};
use foil2d::linalg::complementarity::{Method, RowKind, Solver, Status, natural_map_residual};

/// Solves and checks that the outcome tells the truth.
fn solve_honestly(case: &Case) -> (Vec<f64>, Method, f64) {
    let (multipliers, _, outcome) = case.solve();
    assert!(multipliers.iter().all(|p| p.is_finite()), "{multipliers:?}");
    let residual = natural_map_residual(&case.problem(), &multipliers);
    // the same sums in another order
    assert!(
        (residual - outcome.residual).abs() <= 1e-14 + 1e-6 * residual,
        "{outcome:?}"
    );
    (multipliers, outcome.method, residual)
}

#[test]
fn random_contacts_of_any_rank_are_solved() {
    let mut found_by = [0; 3];
    for (n_bodies, n_contacts) in [
        (1, 1),
        (1, 4),
        (1, 9),
        (2, 3),
        (2, 12),
        (5, 5),
        (5, 20),
        (10, 12),
    ] {
        for seed in 0..60 {
            let case = random_contacts(seed, n_bodies, n_contacts, 0.8);
            let (_, method, residual) = solve_honestly(&case);
            assert!(
                residual <= 1e-9,
                "{n_contacts} on {n_bodies}, seed {seed}: {residual:e}"
            );
            found_by[method as usize] += 1;
        }
    }
    // all three ways are walked by this test, the first one mostly
    assert!(found_by.iter().all(|&count| count > 0), "{found_by:?}");
    assert!(found_by[0] > found_by[1] + found_by[2], "{found_by:?}");
}

#[test]
fn random_contacts_with_motors_and_joints_are_solved() {
    for seed in 0..200 {
        let mut case = random_contacts(7_000 + seed, 4, 10, 0.8);
        let mut numbers = Numbers(seed);
        // the last four contacts become joints, limits and motors; their tangents are tied
        for contact in 6..10 {
            let limit = numbers.unit();
            case.rows[2 * contact] = match contact {
                6 => RowKind::Bilateral,
                7 => RowKind::Box {
                    low: -limit,
                    high: 2.0 * limit,
                },
                8 => RowKind::Box {
                    low: f64::NEG_INFINITY,
                    high: 0.0,
                },
                _ => RowKind::Box {
                    low: 0.0,
                    high: f64::INFINITY,
                },
            };
            case.rows[2 * contact + 1] = match contact {
                6 | 7 => RowKind::Bilateral,
                _ => RowKind::Box {
                    low: -limit,
                    high: limit,
                },
            };
        }
        let (_, _, residual) = solve_honestly(&case);
        assert!(residual <= 1e-9, "seed {seed}: {residual:e}");
    }
}

#[test]
fn lemke_ends_a_cycle_of_limits() {
    // only boxes and joints, so that Lemke's part for them is used too
    let mut found_by = [0; 3];
    for seed in 0..300 {
        let mut case = random_contacts(90_000 + seed, 3, 12, 0.5);
        for row in 0..24 {
            case.rows[row] = match row % 6 {
                0 => RowKind::Bilateral,
                1 => RowKind::Unilateral,
                2 => RowKind::Box {
                    low: -0.2,
                    high: 0.1,
                },
                3 => RowKind::Box {
                    low: f64::NEG_INFINITY,
                    high: 0.0,
                },
                4 => RowKind::Unilateral,
                _ => RowKind::Friction {
                    normal: row - 1,
                    coefficient: 0.6,
                },
            };
        }
        let (_, method, residual) = solve_honestly(&case);
        assert!(residual <= 1e-9, "seed {seed}: {residual:e}");
        found_by[method as usize] += 1;
    }
    assert!(found_by[Method::Lemke as usize] > 0, "{found_by:?}");
}

#[test]
fn a_row_between_two_fixed_bodies_is_left_alone() {
    // rows 1 and 2 cannot move: their lines are zero, whatever their laws and free velocities say
    let kinds = [
        (RowKind::Unilateral, 0.0),
        (RowKind::Bilateral, 0.0),
        (
            RowKind::Friction {
                normal: 0,
                coefficient: 0.5,
            },
            0.0,
        ),
        (
            RowKind::Box {
                low: 2.0,
                high: 3.0,
            },
            2.0,
        ),
    ];
    for (kind, idle) in kinds {
        let case = Case {
            delassus: vec![0.25, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            free: vec![-1.0, -1.0, 5.0],
            rows: vec![RowKind::Unilateral, RowKind::Unilateral, kind],
        };
        let (multipliers, status, outcome) = case.solve();
        assert_eq!(multipliers, [4.0, 0.0, idle]);
        assert_eq!(status, [Status::Stick, Status::Open, Status::Open]);
        assert_eq!(outcome.residual, 0.0);
    }
    let nothing = Case {
        delassus: vec![],
        free: vec![],
        rows: vec![],
    };
    assert_eq!(nothing.solve().2.residual, 0.0);
    let all_fixed = Case {
        delassus: vec![0.0],
        free: vec![-1.0],
        rows: vec![RowKind::Unilateral],
    };
    assert_eq!(all_fixed.solve().0, [0.0]);
}

#[test]
fn a_rod_that_slides_on_its_tip_is_stopped_although_friction_pushes_it_into_the_ground() {
    // W_nn + mu W_nt < 0: in sliding, more normal force means faster approach (Painlevé). The impulse that
    // ends the sliding is the answer, or the one that lets go.
    let coupling = -1.8;
    for coefficient in [0.5, 0.6, 1.0, 2.0] {
        for normal in [-1.0, -1e-3, 0.0, 0.5] {
            for tangential in [-5.0, -0.1, 0.0, 0.1, 5.0] {
                let case = Case {
                    delassus: vec![1.0, coupling, coupling, 4.0],
                    free: vec![normal, tangential],
                    rows: vec![
                        RowKind::Unilateral,
                        RowKind::Friction {
                            normal: 0,
                            coefficient,
                        },
                    ],
                };
                let (_, _, residual) = solve_honestly(&case);
                assert!(
                    residual <= 1e-12,
                    "{coefficient} {normal} {tangential}: {residual:e}"
                );
            }
        }
    }
}

#[test]
fn a_contact_pressed_by_a_joint_that_cannot_yield_reports_its_residual() {
    // the joint holds the body at -1 m/s, which the contact forbids
    let case = Case {
        delassus: vec![1.0; 4],
        free: vec![0.0, 1.0],
        rows: vec![RowKind::Unilateral, RowKind::Bilateral],
    };
    let (_, _, residual) = solve_honestly(&case);
    assert!(
        residual > 0.1,
        "there is no answer, but the residual is {residual:e}"
    );
}

#[test]
fn a_matrix_that_is_not_positive_still_gives_finite_multipliers() {
    for seed in 0..200 {
        let mut numbers = Numbers(seed);
        let n = 6;
        let rows = (0..n).map(|row| match row % 2 {
            0 => RowKind::Unilateral,
            _ => RowKind::Friction {
                normal: row - 1,
                coefficient: 3.0 * numbers.unit(),
            },
        });
        let rows: Vec<RowKind> = rows.collect();
        let mut delassus = vec![0.0; n * n];
        for row in 0..n {
            for column in 0..=row {
                let entry = numbers.signed();
                delassus[row * n + column] = entry;
                delassus[column * n + row] = entry;
            }
        }
        let free = (0..n).map(|_| numbers.signed()).collect();
        solve_honestly(&Case {
            delassus,
            free,
            rows,
        });
    }
}

#[test]
fn numbers_near_the_end_of_their_range_do_not_become_nan() {
    let mut solver = Solver::new();
    for (entry, free) in [
        (1e300, 1e300),
        (1e-300, 1e300),
        (1e300, 1e-300),
        (1e-300, 1e-300),
    ] {
        let case = Case {
            delassus: vec![entry, -0.5 * entry, -0.5 * entry, entry],
            free: vec![-free, free],
            rows: vec![
                RowKind::Unilateral,
                RowKind::Friction {
                    normal: 0,
                    coefficient: 0.5,
                },
            ],
        };
        let (mut multipliers, mut status) = ([0.0; 2], [Status::Open; 2]);
        let outcome = solver.solve(&case.problem(), &mut multipliers, &mut status);
        let outcome = outcome.expect("the data is finite");
        assert!(multipliers.iter().all(|p| p.is_finite()), "{multipliers:?}");
        assert!(!outcome.residual.is_nan());
    }
}
