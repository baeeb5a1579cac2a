//! Factors that are corrected where few weights have changed, and the warm start that makes it possible.

use super::piles::pile;
use super::soft::soft_block;
use super::*;
use crate::linalg::cone::system::System;
use crate::math::sin_cos;

/// `[nn, nt, tt]` of a row on one of its pieces, by number.
fn piece(row: &ConeRow, which: usize) -> [f64; 3] {
    let (mu, weight) = (row.friction(), 100.0 / row.scale[0]);
    match which % 4 {
        0 => [0.0; 3],
        1 => [weight, 0.0, weight],
        2 => [weight, mu * weight, mu * mu * weight],
        _ => [weight, -mu * weight, mu * mu * weight],
    }
}

fn prepared(problem: &ConeProblem) -> System {
    let mut system = System::default();
    assert_eq!(system.prepare(problem, None), Ok(()));
    system
}

/// Rows change their pieces one after the other, some of them back again; a factor of its own answers every time.
#[test]
fn a_corrected_factor_answers_like_a_new_one() -> Result<(), Box<dyn std::error::Error>> {
    let scene = pile(5, 5, |_| 1.0, 0.01);
    let problem = scene.problem();
    let mut weights: Vec<[f64; 3]> = problem
        .rows
        .iter()
        .enumerate()
        .map(|(index, row)| piece(row, index))
        .collect();
    let mut system = prepared(&problem);
    system.factorize(&problem, &weights)?;
    let load: Vec<f64> = (0..problem.load.len())
        .map(|dof| sin_cos(dof as f64).0)
        .collect();
    let changes = [(3, 1), (10, 2), (3, 0), (17, 1), (10, 3), (3, 3), (17, 1)];
    for (index, which) in changes {
        weights[index] = piece(&problem.rows[index], which);
        let mut corrected = load.clone();
        assert!(system.solve_changed(&weights, &mut corrected));
        let mut fresh = prepared(&problem);
        fresh.factorize(&problem, &weights)?;
        let mut expected = load.clone();
        fresh.solve(&mut expected);
        let largest = expected
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        for (x, y) in corrected.iter().zip(&expected) {
            assert!((x - y).abs() < 1e-9 * largest, "{x} is not {y}");
        }
    }
    assert_eq!(system.n_factorizations, 1);
    Ok(())
}

/// More than a few rows are worth a factor; then nothing is touched.
#[test]
fn a_factor_of_other_rows_is_not_corrected() -> Result<(), Box<dyn std::error::Error>> {
    let scene = pile(5, 5, |_| 1.0, 0.01);
    let problem = scene.problem();
    let all = |which| {
        problem
            .rows
            .iter()
            .map(|row| piece(row, which))
            .collect::<Vec<_>>()
    };
    let mut system = prepared(&problem);
    let mut x = vec![1.0; problem.load.len()];
    assert!(!system.solve_changed(&all(0), &mut x));
    system.factorize(&problem, &all(0))?;
    assert!(!system.solve_changed(&all(1), &mut x));
    assert!(x.iter().all(|&x| x == 1.0));
    Ok(())
}

/// Where rows touch some nodes of many, the factor is that of a system that knows nothing yet: also after rows have come and gone, and after the
/// matrix has changed where no row touches it.
#[test]
fn only_what_rows_touch_is_made_anew() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = soft_block([8, 6], 0.3, 0.5);
    let inner = scene.matrix.n_nodes() - 1;
    let mut system = System::default();
    for round in 0..6 {
        // the rows of the round before, so that nothing else tells of it
        if round == 5 {
            scene.matrix.add_diagonal(inner, [0.5, 0.25]);
        }
        let mut part = scene.clone();
        part.rows.truncate(scene.rows.len() - round / 2);
        part.entries.truncate(part.rows.len());
        let problem = part.problem();
        assert!(problem.entries.iter().all(|one| one.node < 8));
        system.prepare(&problem, None)?;
        for shift in 0..3 {
            let piece_of = |(index, row)| piece(row, index + shift + round);
            let weights: Vec<[f64; 3]> = problem.rows.iter().enumerate().map(piece_of).collect();
            system.factorize(&problem, &weights)?;
            let mut fresh = prepared(&problem);
            fresh.factorize(&problem, &weights)?;
            let load: Vec<f64> = (0..problem.load.len())
                .map(|dof| sin_cos(dof as f64).0)
                .collect();
            let (mut x, mut y) = (load.clone(), load);
            system.solve(&mut x);
            fresh.solve(&mut y);
            let largest = y.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            // the patterns of both may differ, and with them the order of additions
            let is_same = |(x, y): (&f64, &f64)| (x - y).abs() < 1e-11 * largest;
            assert!(x.iter().zip(&y).all(is_same), "round {round}, {shift}");
        }
    }
    Ok(())
}

/// A weight so large that the rest is lost beside it cannot be taken out again: told, and nothing is changed.
#[test]
fn what_leaves_nothing_of_a_direction_is_not_corrected() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = Scene::bodies(&[[1.0, 1.0]]);
    scene.row(
        ConeLaw::Bilateral,
        [0.0; 2],
        [1.0; 2],
        &[(0, [1.0, 0.0], [0.0; 2])],
    );
    let problem = scene.problem();
    let mut system = prepared(&problem);
    system.factorize(&problem, &[[1e18, 0.0, 0.0]])?;
    let mut x = vec![1.0; 4];
    assert!(!system.solve_changed(&[[0.0; 3]], &mut x));
    assert_eq!(x, [1.0; 4]);
    Ok(())
}

/// An open contact whose dilation is more than it slides overlaps unseen by its law, and numbers that are none miss nothing: neither is an answer.
#[test]
fn hidden_overlaps_and_no_numbers_are_no_answers() {
    let mut scene = Scene::bodies(&[[2.0, 0.3]]);
    let grips = Scene::grips(0, 1.0, [0.0, 1.0], [0.0, -0.5]);
    scene.row(
        ConeLaw::Contact { friction: 0.5 },
        [-0.3, 0.4],
        [0.5; 2],
        &grips,
    );
    let problem = scene.problem();
    let settings = ConeSettings::default();
    let mut reduced = Reduced::default();
    reduced.restate(&problem);
    let judge = |a: &[f64], slip: f64| {
        let mut status = [ConeStatus::Open];
        reduced.measure(&problem, a, &[[0.0; 2]], &[slip], &settings, &mut status)
    };
    // 0.5 (1.2 - 0.4) hides 0.3
    let hidden = judge(&[0.0; 4], 1.2);
    assert!(hidden.residual == 0.0 && (hidden.dilation - 0.3).abs() < 1e-15);
    assert!(!hidden.is_within(&settings, 0.0));
    assert!(!judge(&[f64::NAN; 4], 0.4).is_within(&settings, 0.0));
    let apart = judge(&[0.0, 0.3, 0.0, 0.0], 0.4);
    assert!(apart.is_within(&settings, 0.0), "{apart:?}");
}

/// A body that flies past another one, near and without a force, is solved before it is begun.
#[test]
fn an_open_contact_that_slides_costs_nothing() {
    let mut scene = Scene::bodies(&[[2.0, 0.3]]);
    let grips = Scene::grips(0, 1.0, [0.0, 1.0], [0.0, -0.5]);
    let law = ConeLaw::Contact { friction: 0.5 };
    scene.row(law, [1.0, -130.0], [0.5; 2], &grips);
    let answer = solve(&scene);
    assert!(answer.outcome.is_solved);
    assert_eq!(answer.outcome.n_factorizations, 0);
    assert_eq!(answer.p, [[0.0; 2]]);
}

/// One row of many that is off lets the others be off by its share in the mean of squares, not by its own.
#[test]
fn what_is_good_enough_goes_by_the_mean_of_what_the_start_misses() {
    let n = 400;
    let mut scene = Scene::bodies(&vec![[2.0, 1.0]; n]);
    for body in 0..n {
        let grips = Scene::grips(body, 1.0, [0.0, 1.0], [0.0; 2]);
        let law = ConeLaw::Contact { friction: 0.5 };
        scene.row(law, [0.0; 2], [0.0; 2], &grips);
        scene.load[4 * body + 1] = -3.0;
    }
    scene.estimate();
    let mut solver = ConeSolver::new(ConeSettings {
        gap_tolerance: 1.0,
        tolerance: 1e-3,
        ..ConeSettings::default()
    });
    // All at rest but for the first, whose force is off by 0.2: its gap changes by that over its mass, and its force by all of it.
    let mut start = vec![[3.0, 0.0]; n];
    start[0] = [2.8, 0.0];
    solve_with(&mut solver, &scene, &start, &vec![0.0; n]);
    let mean = 0.1 / (n as f64).sqrt();
    let enough = SETTLING.get() * mean;
    assert!((solver.reduced.enough - enough).abs() < 1e-12 * mean);
    let goal = SETTLING.get() * (0.2 / 3.0) / (n as f64).sqrt();
    assert!((solver.reduced.goal - goal).abs() < 1e-12 * goal);
}
