//! One to three rows, worked out by hand.

use crate::support::{Case, assert_close};
use foil2d::linalg::complementarity::{
    ComplementarityError, Problem, RowKind, Solver, Status, natural_map_residual,
};

/// A body of 2 kg that meets flat ground with velocity (tangential, normal), coefficient 0.5.
fn body_on_ground(normal: f64, tangential: f64) -> Case {
    Case {
        delassus: vec![0.5, 0.0, 0.0, 0.5],
        free: vec![normal, tangential],
        rows: vec![
            RowKind::Unilateral,
            RowKind::Friction {
                normal: 0,
                coefficient: 0.5,
            },
        ],
    }
}

#[test]
fn a_body_that_moves_away_gets_no_impulse() {
    let (multipliers, status, outcome) = body_on_ground(0.3, 5.0).solve();
    assert_eq!(multipliers, [0.0, 0.0]);
    assert_eq!(status, [Status::Open, Status::Open]);
    assert_eq!(outcome.residual, 0.0);
}

#[test]
fn a_slow_slider_is_stopped_and_a_fast_one_is_braked_by_mu_times_the_normal_impulse() {
    // normal impulse m v_n = 6 N s, friction at most 3 N s, which stops 1.5 m/s
    for (tangential, friction, status) in [
        (1.0, -2.0, Status::Stick),
        (-1.0, 2.0, Status::Stick),
        (10.0, -3.0, Status::SlipNegative),
        (-10.0, 3.0, Status::SlipPositive),
    ] {
        let (multipliers, found, outcome) = body_on_ground(-3.0, tangential).solve();
        assert_close(&multipliers, &[6.0, friction], 1e-14);
        assert_eq!(found, [Status::Stick, status]);
        assert!(
            outcome.residual <= 1e-15 && outcome.n_pivots <= 2,
            "{outcome:?}"
        );
    }
}

#[test]
fn a_block_on_an_incline_slides_when_the_slope_exceeds_the_coefficient() {
    let (mass, impulse) = (3.0, 9.81 / 60.0);
    for slope in [0.05, 0.3, 0.7] {
        let (sin, cos) = f64::sin_cos(slope);
        for (factor, sticks) in [(1.0 + 1e-9, true), (1.0 - 1e-9, false)] {
            let coefficient = factor * slope.tan();
            let case = Case {
                delassus: vec![1.0 / mass, 0.0, 0.0, 1.0 / mass],
                free: vec![-impulse * cos, impulse * sin],
                rows: vec![
                    RowKind::Unilateral,
                    RowKind::Friction {
                        normal: 0,
                        coefficient,
                    },
                ],
            };
            let (multipliers, status, _) = case.solve();
            let grip = if sticks { sin } else { coefficient * cos };
            let expected = [mass * impulse * cos, -mass * impulse * grip];
            assert_close(&multipliers, &expected, 1e-15);
            let friction = if sticks {
                Status::Stick
            } else {
                Status::SlipNegative
            };
            assert_eq!(status, [Status::Stick, friction]);
        }
    }
}

#[test]
fn a_motor_drives_within_its_torque_and_saturates_beyond() {
    let motor = |free: f64, low: f64, high: f64| Case {
        delassus: vec![2.0],
        free: vec![free],
        rows: vec![RowKind::Box { low, high }],
    };
    let (endless, start) = (f64::INFINITY, f64::NEG_INFINITY);
    for (free, low, high, multiplier, status) in [
        (3.0, -5.0, 5.0, -1.5, Status::Stick),
        (30.0, -5.0, 5.0, -5.0, Status::SlipNegative),
        (-30.0, -5.0, 4.0, 4.0, Status::SlipPositive),
        (-30.0, -5.0, endless, 15.0, Status::Stick),
        (30.0, start, 5.0, -15.0, Status::Stick),
        (30.0, start, endless, -15.0, Status::Stick),
        (1.0, 2.0, 2.0, 2.0, Status::SlipNegative),
    ] {
        let (multipliers, found, outcome) = motor(free, low, high).solve();
        assert_close(&multipliers, &[multiplier], 1e-14);
        assert_eq!(found, [status]);
        assert!(outcome.residual <= 1e-15);
    }
}

#[test]
fn a_joint_takes_the_load_of_a_contact_next_to_it() {
    // two unit masses, tied (row 0: v1 - v0), the first above the ground (row 1: v0), both falling at 1
    let case = Case::from_bodies(
        &[vec![-1.0, 1.0], vec![1.0, 0.0]],
        &[1.0, 1.0],
        &[-1.0, -1.0],
        vec![RowKind::Bilateral, RowKind::Unilateral],
    );
    let (multipliers, status, outcome) = case.solve();
    assert_close(&multipliers, &[1.0, 2.0], 1e-15);
    assert_eq!(status, [Status::Stick, Status::Stick]);
    assert!(outcome.residual <= 1e-15);
}

#[test]
fn a_stack_of_masses_carries_its_weight_at_mass_ratios_of_a_million() {
    let ratio = |layer: usize, n: usize| 10.0_f64.powf(6.0 * layer as f64 / (n - 1) as f64);
    let n = 12;
    let patterns: [(&str, Vec<f64>); 3] = [
        (
            "heavy on light",
            (0..n).map(|layer| ratio(layer, n)).collect(),
        ),
        (
            "light on heavy",
            (0..n).map(|layer| ratio(n - 1 - layer, n)).collect(),
        ),
        (
            "alternating",
            (0..n)
                .map(|layer| if layer % 2 == 0 { 1.0 } else { 1e6 })
                .collect(),
        ),
    ];
    for (name, masses) in patterns {
        let inverse_mass: Vec<f64> = masses.iter().map(|mass| 1.0 / mass).collect();
        let mut jacobian = vec![vec![0.0; n]; n];
        for (layer, line) in jacobian.iter_mut().enumerate() {
            line[layer] = 1.0;
            if layer > 0 {
                line[layer - 1] = -1.0;
            }
        }
        let rows = vec![RowKind::Unilateral; n];
        let case = Case::from_bodies(&jacobian, &inverse_mass, &vec![-0.1; n], rows);
        let (multipliers, _, outcome) = case.solve();
        // multipliers of a million times what acts, of which a residual counts a thousand
        assert!(outcome.residual <= 1e-14 * 1e6 / 1e3, "{name}: {outcome:?}");
        let mut above = 0.0;
        for layer in (0..n).rev() {
            above += masses[layer];
            let error = (multipliers[layer] / (0.1 * above) - 1.0).abs();
            // the condition number of W, about 1e6 n², times round-off
            assert!(
                error <= 1e-8,
                "{name}, layer {layer}: relative error {error:e}"
            );
        }
    }
}

#[test]
fn the_residual_of_a_wrong_answer_is_large() {
    let case = body_on_ground(-3.0, 10.0);
    let residual = |multipliers: [f64; 2]| natural_map_residual(&case.problem(), &multipliers);
    assert_eq!(residual([6.0, -3.0]), 0.0);
    // too little, too much, pulling, friction in the direction of slip, friction beyond the cone
    for wrong in [
        [0.0, 0.0],
        [3.0, -1.5],
        [12.0, -6.0],
        [-6.0, 0.0],
        [6.0, 3.0],
        [6.0, -6.0],
    ] {
        assert!(
            residual(wrong) > 0.1,
            "{wrong:?} passes with {}",
            residual(wrong)
        );
    }
    assert_eq!(residual([f64::NAN, 0.0]), f64::INFINITY);
    assert_eq!(residual([6.0, f64::NAN]), f64::INFINITY);
}

#[test]
fn data_that_states_no_problem_is_refused_with_its_place() {
    let mut solver = Solver::new();
    let mut solve = |delassus: &[f64], free: &[f64], rows: &[RowKind]| {
        let (mut multipliers, mut status) = (vec![7.0; rows.len()], vec![Status::Open; rows.len()]);
        let problem = Problem {
            delassus,
            free,
            rows,
            acted: &[],
        };
        let answer = solver.solve(&problem, &mut multipliers, &mut status);
        assert_eq!(
            multipliers,
            vec![7.0; rows.len()],
            "a refused solve must not write"
        );
        answer.expect_err("the data is impossible")
    };
    let contact = [RowKind::Unilateral, RowKind::Unilateral];
    let error = solve(&[1.0, 0.0, f64::NAN, 1.0], &[0.0; 2], &contact);
    assert!(
        matches!(
            error,
            ComplementarityError::Delassus {
                row: 1,
                column: 0,
                ..
            }
        ),
        "{error}"
    );
    let error = solve(&[1.0, 0.0, 0.0, 1.0], &[0.0, f64::INFINITY], &contact);
    assert!(
        matches!(error, ComplementarityError::Free { row: 1, .. }),
        "{error}"
    );
    let identity = [1.0, 0.0, 0.0, 1.0];
    for normal in [1, 2] {
        let rows = [
            RowKind::Unilateral,
            RowKind::Friction {
                normal,
                coefficient: 0.5,
            },
        ];
        let error = solve(&identity, &[0.0; 2], &rows);
        assert_eq!(error, ComplementarityError::Normal { row: 1, normal });
    }
    for coefficient in [-0.1, f64::INFINITY] {
        let rows = [
            RowKind::Unilateral,
            RowKind::Friction {
                normal: 0,
                coefficient,
            },
        ];
        let error = solve(&identity, &[0.0; 2], &rows);
        assert_eq!(
            error,
            ComplementarityError::Coefficient {
                row: 1,
                coefficient
            }
        );
    }
    let error = solve(
        &[1.0],
        &[0.0],
        &[RowKind::Box {
            low: 1.0,
            high: -1.0,
        }],
    );
    assert_eq!(
        error,
        ComplementarityError::Bounds {
            row: 0,
            low: 1.0,
            high: -1.0
        }
    );
    assert!(error.to_string().contains("[1, -1]"), "{error}");
}
