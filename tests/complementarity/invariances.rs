//! What must not change the answer: order, units, mirror images, the warm start.

use crate::support::{Case, Numbers, assert_close, random_contacts};
use foil2d::linalg::complementarity::{
    Method, Problem, RowKind, Solver, Status, natural_map_residual,
};

/// Well-posed contacts: as many bodies as contacts and little friction, so that the answer is unique.
fn cases() -> impl Iterator<Item = Case> {
    (0..40).map(|seed| random_contacts(50_000 + seed, 8, 6, 0.3))
}

#[test]
fn the_order_of_the_rows_does_not_matter() {
    for (seed, case) in cases().enumerate() {
        let n = case.rows.len();
        let mut numbers = Numbers(seed as u64);
        let mut order: Vec<usize> = (0..n).collect();
        for last in (1..n).rev() {
            order.swap(last, (numbers.unit() * (last + 1) as f64) as usize);
        }
        let place = |row: usize| {
            order
                .iter()
                .position(|&other| other == row)
                .expect("a permutation")
        };
        let shuffled = Case {
            delassus: order
                .iter()
                .flat_map(|&row| order.iter().map(move |&column| (row, column)))
                .map(|(row, column)| case.delassus[row * n + column])
                .collect(),
            free: order.iter().map(|&row| case.free[row]).collect(),
            rows: order
                .iter()
                .map(|&row| match case.rows[row] {
                    RowKind::Friction {
                        normal,
                        coefficient,
                    } => RowKind::Friction {
                        normal: place(normal),
                        coefficient,
                    },
                    other => other,
                })
                .collect(),
        };
        let (multipliers, status, _) = case.solve();
        let (shuffled_multipliers, shuffled_status, _) = shuffled.solve();
        for row in 0..n {
            let difference = (multipliers[row] - shuffled_multipliers[place(row)]).abs();
            let size = multipliers
                .iter()
                .fold(1.0_f64, |size, p| size.max(p.abs()));
            assert!(
                difference <= 1e-11 * size,
                "seed {seed}, row {row}: {difference:e}"
            );
            assert_eq!(
                status[row],
                shuffled_status[place(row)],
                "seed {seed}, row {row}"
            );
        }
    }
}

#[test]
fn the_units_do_not_matter() {
    // powers of two scale without round-off: every decision must be the same to the last bit
    let (s, r) = (2.0_f64.powi(-40), 2.0_f64.powi(17));
    for case in cases().chain((0..40).map(|seed| random_contacts(seed, 2, 8, 0.8))) {
        let scaled = Case {
            delassus: case.delassus.iter().map(|entry| s * entry).collect(),
            free: case.free.iter().map(|entry| r * entry).collect(),
            rows: case.rows.clone(),
        };
        let (multipliers, status, outcome) = case.solve();
        let (scaled_multipliers, scaled_status, scaled_outcome) = scaled.solve();
        let back: Vec<f64> = scaled_multipliers.iter().map(|p| p * (s / r)).collect();
        let size = multipliers
            .iter()
            .fold(1e-300_f64, |size, p| size.max(p.abs()));
        // square roots of the diagonal round differently when 2^odd is taken out: not bits, but digits
        assert_close(&multipliers, &back, 1e-9 * size);
        assert_eq!(status, scaled_status);
        assert_eq!(outcome.method, scaled_outcome.method);
    }
}

#[test]
fn the_unit_of_a_single_row_does_not_matter() {
    for (seed, case) in cases().enumerate() {
        let n = case.rows.len();
        let mut numbers = Numbers(seed as u64);
        // a tangent keeps the unit of its normal, because the coefficient of friction has none
        let unit: Vec<f64> = (0..n / 2)
            .flat_map(|_| [10.0_f64.powf(3.0 * numbers.signed()); 2])
            .collect();
        let scaled = Case {
            delassus: (0..n * n)
                .map(|entry| case.delassus[entry] * unit[entry / n] * unit[entry % n])
                .collect(),
            free: case
                .free
                .iter()
                .zip(&unit)
                .map(|(b, unit)| b * unit)
                .collect(),
            rows: case.rows.clone(),
        };
        let (multipliers, status, _) = case.solve();
        let (scaled_multipliers, scaled_status, outcome) = scaled.solve();
        let back: Vec<f64> = scaled_multipliers
            .iter()
            .zip(&unit)
            .map(|(p, unit)| p * unit)
            .collect();
        let size = multipliers
            .iter()
            .fold(1.0_f64, |size, p| size.max(p.abs()));
        assert_close(&multipliers, &back, 1e-10 * size);
        assert_eq!(status, scaled_status);
        let here = natural_map_residual(&case.problem(), &vec![0.0; n]);
        let there = natural_map_residual(&scaled.problem(), &vec![0.0; n]);
        assert!((here - there).abs() <= 1e-12, "{here} and {there}");
        assert!(outcome.residual <= 1e-12);
    }
}

#[test]
fn a_mirror_image_slips_the_other_way() {
    for case in cases() {
        let n = case.rows.len();
        let sign = |row: usize| if row % 2 == 1 { -1.0 } else { 1.0 };
        let mirrored = Case {
            delassus: (0..n * n)
                .map(|entry| case.delassus[entry] * sign(entry / n) * sign(entry % n))
                .collect(),
            free: (0..n).map(|row| case.free[row] * sign(row)).collect(),
            rows: case.rows.clone(),
        };
        let (multipliers, status, _) = case.solve();
        let (mirrored_multipliers, mirrored_status, _) = mirrored.solve();
        let back: Vec<f64> = (0..n)
            .map(|row| mirrored_multipliers[row] * sign(row))
            .collect();
        let size = multipliers
            .iter()
            .fold(1.0_f64, |size, p| size.max(p.abs()));
        assert_close(&multipliers, &back, 1e-11 * size);
        let swapped = mirrored_status.iter().map(|status| match status {
            Status::SlipPositive => Status::SlipNegative,
            Status::SlipNegative => Status::SlipPositive,
            other => *other,
        });
        assert!(swapped.eq(status.iter().copied()));
    }
}

#[test]
fn a_wrong_warm_start_leads_to_the_same_answer() {
    let mut solver = Solver::new();
    for (seed, case) in cases().enumerate() {
        let (multipliers, status, _) = case.solve();
        let mut numbers = Numbers(seed as u64);
        let n = case.rows.len();
        let mut guess: Vec<f64> = (0..n).map(|_| 10.0 * numbers.signed()).collect();
        guess[0] = f64::NAN;
        let all = [
            Status::Open,
            Status::Stick,
            Status::SlipPositive,
            Status::SlipNegative,
        ];
        let mut guessed: Vec<Status> = (0..n)
            .map(|_| all[(numbers.unit() * 4.0) as usize])
            .collect();
        solver
            .solve(&case.problem(), &mut guess, &mut guessed)
            .expect("the data is finite");
        let size = multipliers
            .iter()
            .fold(1.0_f64, |size, p| size.max(p.abs()));
        assert_close(&guess, &multipliers, 1e-11 * size);
        assert_eq!(guessed, status, "seed {seed}");
    }
}

#[test]
fn it_does_not_matter_how_much_of_a_contact_has_acted_already() {
    for (seed, case) in cases().enumerate() {
        let n = case.rows.len();
        let (whole, whole_status, _) = case.solve();
        let mut numbers = Numbers(seed as u64);
        let size = whole.iter().fold(1.0_f64, |size, p| size.max(p.abs()));
        let acted: Vec<f64> = (0..n).map(|_| size * numbers.signed()).collect();
        let free = case.velocities(&acted);
        let problem = Problem {
            delassus: &case.delassus,
            free: &free,
            rows: &case.rows,
            acted: &acted,
        };
        for method in [Method::ActiveSet, Method::GaussSeidel] {
            let mut solver = Solver::new();
            solver.set_first(method);
            let (mut rest, mut status) = (vec![0.0; n], vec![Status::Open; n]);
            let outcome = solver
                .solve(&problem, &mut rest, &mut status)
                .expect("the data of the case is finite");
            let residual = outcome.residual;
            assert!(residual <= 1e-10, "seed {seed}, {method:?}: {residual:e}");
            assert_eq!(status, whole_status, "seed {seed}, {method:?}");
            for (row, (rest, acted)) in rest.iter().zip(&acted).enumerate() {
                let difference = (rest + acted - whole[row]).abs();
                assert!(
                    difference <= 1e-8 * size,
                    "seed {seed}, {method:?}, row {row}: {difference:e}"
                );
            }
        }
    }
}

/// A ball in a wedge of two flexible sides, both alike: normal and tangent of one and of the other, the tangents mirrors of each other.
fn wedge(numbers: &mut Numbers) -> [f64; 16] {
    let mut between = |low: f64, high: f64| low + (high - low) * numbers.unit();
    let slope = between(0.01, 0.9);
    let height = (1.0 - slope * slope).sqrt();
    let sides = [
        ([slope, height], 0.0),
        ([height, -slope], 1.0),
        ([-slope, height], 0.0),
        ([-height, -slope], -1.0),
    ];
    let (inertia, size) = (between(0.3, 1.0), 10.0_f64.powf(between(-2.0, 1.0)));
    let (soft, stiff, turn) = (between(0.01, 1.0), between(0.01, 1.0), between(0.0, 3.0));
    let (sin, cos) = turn.sin_cos();
    let both = (soft - stiff) * sin * cos;
    let own = [
        [soft * cos * cos + stiff * sin * sin, both],
        [both, soft * sin * sin + stiff * cos * cos],
    ];
    let mut delassus = [0.0; 16];
    for (i, (along, turned)) in sides.iter().enumerate() {
        for (j, (other, turns)) in sides.iter().enumerate() {
            let rigid = along[0] * other[0] + along[1] * other[1] + turned * turns / inertia;
            let yielded = if i / 2 == j / 2 {
                size * own[i % 2][j % 2]
            } else {
                0.0
            };
            delassus[4 * i + j] = rigid + yielded;
        }
    }
    delassus
}

/// Coulomb's law may have others, in which the ball sticks to one side and slides on the other.
#[test]
fn what_is_its_own_mirror_image_gets_an_answer_that_is_too() {
    let mut numbers = Numbers(7);
    for case in 0..2000 {
        let delassus = wedge(&mut numbers);
        let (sin, cos) = (6.3 * numbers.unit()).sin_cos();
        let normal = numbers.unit();
        let friction = 0.5 * normal * numbers.signed();
        let acted = match case % 2 {
            0 => [0.0; 4],
            _ => [normal, friction, normal, friction],
        };
        let rows = [0, 2].map(|normal| RowKind::Friction {
            normal,
            coefficient: 0.5,
        });
        let problem = Problem {
            delassus: &delassus,
            free: &[cos, sin, cos, sin],
            rows: &[RowKind::Unilateral, rows[0], RowKind::Unilateral, rows[1]],
            acted: &acted,
        };
        let (open, stick) = (Status::Open, Status::Stick);
        let slides = [Status::SlipPositive, Status::SlipNegative].map(|slip| [stick, slip]);
        for [normal, friction] in [[open, open], [stick, stick], slides[0], slides[1]] {
            let mut status = [normal, friction, normal, friction];
            let mut p = [0.0; 4];
            let outcome = Solver::new()
                .solve(&problem, &mut p, &mut status)
                .expect("the data is finite");
            assert!(outcome.residual <= 1e-10, "case {case}: {outcome:?}");
            let size = p.iter().fold(1.0_f64, |size, p| size.max(p.abs()));
            let apart = (p[0] - p[2]).abs().max((p[1] - p[3]).abs());
            assert!(apart <= 1e-8 * size, "case {case}: {p:?}, {outcome:?}");
        }
    }
}
