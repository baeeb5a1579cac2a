//! One body: blocks on planes, motors, springs in series, and data that states no problem.

use super::*;

/// A box of width 2 and height 1 on two points of the ground, pushed sideways.
fn block_on_plane(weight: f64, push: f64, friction: f64, heights: [f64; 2]) -> Scene {
    let mut scene = Scene::bodies(&[[2.0, 1.0]]);
    scene.load[0] = push;
    scene.load[1] = -weight;
    for (arm, height) in [-1.0, 1.0].into_iter().zip(heights) {
        // tangent of the upward normal points left
        let grips = Scene::grips(0, 1.0, [0.0, 1.0], [arm, -0.5]);
        scene.row(
            ConeLaw::Contact { friction },
            [height, 0.0],
            [1.0; 2],
            &grips,
        );
    }
    scene.estimate();
    scene
}

#[test]
fn a_block_sticks_with_the_push_shared_and_the_moment_balanced() {
    let scene = block_on_plane(10.0, 3.0, 0.5, [0.0; 2]);
    let answer = solve(&scene);
    assert!(answer.outcome.is_solved);
    // moment of the push about the ground: 3 × 0.5 = 2 × 1 × difference / 2
    assert!(
        (answer.p[0][0] - 4.25).abs() < 1e-8 && (answer.p[1][0] - 5.75).abs() < 1e-8,
        "{:?}",
        answer.p
    );
    assert!((answer.p[0][1] + answer.p[1][1] - 3.0).abs() < 1e-8);
    assert!(answer.a.iter().all(|a| a.abs() < 1e-8));
}

#[test]
fn a_block_slides_at_the_friction_left_over_and_without_a_gap() {
    let scene = block_on_plane(10.0, 7.0, 0.5, [0.0; 2]);
    let answer = solve(&scene);
    assert!(answer.outcome.is_solved, "{:?}", answer.outcome);
    assert!((answer.a[0] - 1.0).abs() < 1e-8, "(7 - 0.5 10) / 2");
    assert!((0..2).all(|row| motion(&scene, &answer, row)[0].abs() < 1e-8));
    let [p, q] = [answer.p[0], answer.p[1]];
    assert!((p[1] - 0.5 * p[0]).abs() < 1e-8 && (q[1] - 0.5 * q[0]).abs() < 1e-8);
}

#[test]
fn a_block_that_is_pulled_up_carries_nothing() {
    let answer = solve(&block_on_plane(-1.0, 2.0, 0.5, [0.0; 2]));
    assert_eq!(answer.p, [[0.0; 2]; 2]);
    assert!((answer.a[0] - 1.0).abs() < 1e-14 && (answer.a[1] - 0.5).abs() < 1e-14);
    assert_eq!(answer.outcome.n_factorizations, 0);
}

#[test]
fn a_block_tips_over_the_edge_that_it_is_pushed_to() {
    // the moment of the push exceeds that of the weight
    let scene = block_on_plane(1.0, 40.0, 100.0, [0.0; 2]);
    let answer = solve(&scene);
    assert_eq!(answer.p[0], [0.0; 2]);
    assert!(answer.p[1][0] > 0.0 && answer.a[2] < 0.0);
    assert!(violation(&scene, &answer).0 < 1e-8);
}

#[test]
fn without_friction_a_contact_is_a_stop() {
    let scene = block_on_plane(10.0, 4.0, 0.0, [0.0; 2]);
    let answer = solve(&scene);
    assert!((answer.a[0] - 2.0).abs() < 1e-10 && answer.a[1].abs() < 1e-8);
    assert!(answer.p.iter().all(|p| p[1] == 0.0));
}

#[test]
fn redundant_contacts_keep_what_they_carry() {
    let mut scene = Scene::bodies(&[[3.0, 1.0]]);
    scene.load[1] = -12.0;
    for k in 0..8 {
        scene.row(
            ConeLaw::Contact { friction: 0.6 },
            [0.0; 2],
            [1.0; 2],
            &Scene::grips(0, 1.0, [0.0, 1.0], [k as f64 - 3.5, -0.5]),
        );
    }
    scene.estimate();
    // any division that carries the weight without a moment is a solution, friction against itself included
    let carried = [
        [3.0, 0.4],
        [0.0, 0.0],
        [2.0, -0.3],
        [1.0, -0.1],
        [1.0, 0.0],
        [2.0, 0.5],
        [0.0, 0.0],
        [3.0, -0.5],
    ];
    let answer = solve_with(&mut ConeSolver::default(), &scene, &carried, &[0.0; 8]);
    assert!(answer.outcome.is_solved && answer.outcome.n_factorizations == 0);
    assert!(
        answer
            .p
            .iter()
            .zip(carried)
            .all(|(p, q)| (p[0] - q[0]).abs() + (p[1] - q[1]).abs() < 1e-12)
    );
}

#[test]
fn a_motor_pushes_up_to_its_bound() {
    // wanted: a = 5; what it takes: 10
    for (high, expected) in [(4.0, 4.0), (f64::INFINITY, 10.0), (0.0, 0.0)] {
        let mut scene = Scene::bodies(&[[2.0, 1.0]]);
        scene.row(
            ConeLaw::Box { low: -1.0, high },
            [-5.0, 0.0],
            [0.5; 2],
            &[(0, [1.0, 0.0], [0.0; 2])],
        );
        let answer = solve(&scene);
        assert!(
            (answer.p[0][0] - expected).abs() < 1e-8 && answer.outcome.is_solved,
            "{high}: {:?}",
            answer.p
        );
        assert!((answer.a[0] - expected / 2.0).abs() < 1e-8);
    }
}

#[test]
fn give_is_a_spring_in_series_and_acted_forces_count() {
    for acted in [0.0, 1.5] {
        let mut scene = Scene::bodies(&[[2.0, 1.0]]);
        scene.load[1] = -6.0 + acted;
        let row = scene.row(
            ConeLaw::Contact { friction: 0.5 },
            [-1.0, 0.2],
            [0.5; 2],
            &[(0, [0.0, 1.0], [1.0, 0.0])],
        );
        row.give = [0.25, 0.75];
        row.acted = [acted, 0.0];
        let answer = solve(&scene);
        // 0 = -1 + (p + load)/2 + p/4 and 0 = 0.2 + q/2 + 3 q/4
        let p = (1.0 - scene.load[1] / 2.0) / 0.75;
        assert!(
            (answer.p[0][0] - p).abs() < 1e-8 && (answer.p[0][1] + 0.16).abs() < 1e-8,
            "{:?} {p}",
            answer.p
        );
        assert!(violation(&scene, &answer).0 < 1e-8);
    }
    // what acted already may be taken back, but the whole never pulls
    let mut scene = block_on_plane(-1.0, 0.0, 0.5, [0.0; 2]);
    scene.rows.iter_mut().for_each(|row| row.acted = [2.0, 0.5]);
    let answer = solve(&scene);
    assert!(
        violation(&scene, &answer).0 < 1e-8 && answer.p.iter().all(|p| p[0] < 0.0 && p[0] >= -2.0)
    );
}

#[test]
fn data_that_states_no_problem_is_told_and_changes_nothing() {
    let scene = block_on_plane(10.0, 3.0, 0.5, [0.0; 2]);
    let spoil: [fn(&mut Scene); 8] = [
        |scene| scene.load[1] = f64::NAN,
        |scene| scene.rows[1].free[0] = f64::INFINITY,
        |scene| scene.rows[0].scale[1] = -1.0,
        |scene| scene.rows[1].local = 0.0,
        |scene| scene.rows[1].local = f64::NAN,
        |scene| scene.entries[2].node = 7,
        |scene| scene.rows[0].law = ConeLaw::Contact { friction: -0.1 },
        |scene| {
            scene.rows[0].law = ConeLaw::Box {
                low: 1.0,
                high: 2.0,
            }
        },
    ];
    for spoil in spoil {
        let mut bad = scene.clone();
        spoil(&mut bad);
        let (mut p, mut slip, mut a) = ([[1.0; 2]; 2], [2.0; 2], vec![3.0]);
        assert!(
            ConeSolver::default()
                .solve(&bad.problem(), &mut p, &mut slip, &mut a)
                .is_err()
        );
        assert_eq!((p, slip, a), ([[1.0; 2]; 2], [2.0; 2], vec![3.0]));
    }
    let outcome = ConeSolver::default().solve(
        &scene.problem(),
        &mut [[0.0; 2]; 1],
        &mut [0.0; 2],
        &mut Vec::new(),
    );
    assert!(matches!(
        outcome,
        Err(ConeError::Length {
            found: 1,
            expected: 2,
            ..
        })
    ));
}
