//! Random scenes, against enumeration and against the laws.

use super::*;
use crate::math::sin_cos;

/// A few bodies with contacts of random place and direction, on the ground and with each other.
fn random_contacts(
    random: &mut Random,
    n_bodies: usize,
    n_contacts: usize,
    friction: f64,
) -> Scene {
    let masses: Vec<[f64; 2]> = (0..n_bodies)
        .map(|_| [random.within(0.5, 2.0), random.within(0.2, 1.0)])
        .collect();
    let mut scene = Scene::bodies(&masses);
    for body in 0..n_bodies {
        for dof in 4 * body..4 * body + 3 {
            scene.load[dof] = random.within(-3.0, 3.0);
        }
        scene.load[4 * body + 1] -= 6.0;
    }
    for contact in 0..n_contacts {
        let body = contact % n_bodies;
        let turn = random.within(-0.6, 0.6);
        let normal: [f64; 2] = sin_cos(turn).into();
        let mut grips = Scene::grips(
            body,
            1.0,
            normal,
            [random.within(-1.0, 1.0), random.within(-1.0, -0.3)],
        )
        .to_vec();
        let other = (random.next() * (n_bodies + 1) as f64) as usize;
        if other < body {
            grips.extend(Scene::grips(
                other,
                -1.0,
                normal,
                [random.within(-1.0, 1.0), random.within(0.3, 1.0)],
            ));
        }
        let free = [random.within(-0.5, 1.0), random.within(-1.0, 1.0)];
        scene.row(ConeLaw::Contact { friction }, free, [1.0; 2], &grips);
    }
    scene.estimate();
    scene
}

/// Solves for one choice of statuses (0 open, 1 stick, 2 and 3 slip) by dense elimination, if it can be.
fn solve_statuses(scene: &Scene, choice: &[usize]) -> Option<Vec<[f64; 2]>> {
    let n = choice.len();
    let unit = |index: usize| -> Answer {
        let mut p = vec![[0.0; 2]; n];
        if index < 2 * n {
            p[index / 2][index % 2] = 1.0;
        }
        let mut a = if index < 2 * n {
            vec![0.0; scene.load.len()]
        } else {
            scene.load.clone()
        };
        for (row, p) in scene.rows.iter().zip(&p) {
            scene.problem().push(row, 1.0, *p, &mut a);
        }
        for (dof, a) in a.iter_mut().enumerate() {
            *a /= scene
                .matrix
                .block(dof / 2, dof / 2)
                .map_or(1.0, |block| block[3 * (dof % 2)]);
        }
        Answer {
            p: vec![[0.0; 2]; n],
            slip: Vec::new(),
            a,
            outcome: ConeOutcome::default(),
        }
    };
    let free: Vec<[f64; 2]> = {
        let answer = unit(2 * n);
        (0..n).map(|row| motion(scene, &answer, row)).collect()
    };
    let mut system = nalgebra::DMatrix::zeros(2 * n, 2 * n);
    let mut right = nalgebra::DVector::zeros(2 * n);
    for row in 0..n {
        let mu = scene.rows[row].friction();
        let is_open = choice[row] == 0;
        let slips = [0.0, 0.0, 1.0, -1.0][choice[row]];
        if is_open {
            system[(2 * row, 2 * row)] = 1.0;
            system[(2 * row + 1, 2 * row + 1)] = 1.0;
            continue;
        }
        for column in 0..2 * n {
            let answer = unit(column);
            let w = motion(scene, &answer, row)
                .iter()
                .zip(scene.rows[row].free)
                .map(|(w, free)| w - free)
                .collect::<Vec<_>>();
            system[(2 * row, column)] = w[0];
            if choice[row] == 1 {
                system[(2 * row + 1, column)] = w[1];
            }
        }
        right[2 * row] = -free[row][0];
        if choice[row] == 1 {
            right[2 * row + 1] = -free[row][1];
        } else {
            system[(2 * row + 1, 2 * row + 1)] = 1.0;
            system[(2 * row + 1, 2 * row)] = -slips * mu;
        }
    }
    let solution = system.lu().solve(&right)?;
    Some(
        (0..n)
            .map(|row| [solution[2 * row], solution[2 * row + 1]])
            .collect(),
    )
}

#[test]
fn small_problems_give_an_answer_that_enumeration_gives_too() {
    let mut random = Random(7);
    let (mut n_found, mut n_slipping) = (0, 0);
    for _ in 0..60 {
        let n = 2 + (random.next() * 2.0) as usize;
        let scene = random_contacts(&mut random, 3, n, 0.4);
        let answer = solve(&scene);
        assert!(answer.outcome.is_solved, "{:?}", answer.outcome);
        let mut nearest = f64::INFINITY;
        for code in 0..4usize.pow(n as u32) {
            let choice: Vec<usize> = (0..n)
                .map(|row| code / 4usize.pow(row as u32) % 4)
                .collect();
            let Some(p) = solve_statuses(&scene, &choice) else {
                continue;
            };
            let distance = p
                .iter()
                .zip(&answer.p)
                .flat_map(|(p, q)| [(p[0] - q[0]).abs(), (p[1] - q[1]).abs()])
                .fold(0.0, f64::max);
            if distance < nearest {
                nearest = distance;
                n_slipping += usize::from(choice.iter().any(|&status| status > 1));
            }
        }
        assert!(violation(&scene, &answer).0 < 1e-7);
        n_found += usize::from(nearest < 1e-7);
    }
    assert_eq!(n_found, 60);
    assert!(
        n_slipping > 20,
        "{n_slipping} of the problems slip somewhere"
    );
}

#[test]
fn random_problems_obey_the_laws() {
    let mut counts = [0; 3];
    let (mut work, mut worst_solved) = (0, 0.0_f64);
    for seed in 0..500 {
        let mut random = Random(1000 + seed);
        let n_bodies = 2 + (random.next() * 6.0) as usize;
        let friction = [0.0, 0.2, 0.5, 1.0][seed as usize % 4];
        let mut scene = random_contacts(&mut random, n_bodies, 2 * n_bodies, friction);
        for body in 0..n_bodies {
            // a joint to the next body, a motor and a stop
            if seed % 3 == 0 && body + 1 < n_bodies && body % 3 == 0 {
                for axis in [[1.0, 0.0], [0.0, 1.0]] {
                    let mut grips = Scene::grips(body, 1.0, axis, [0.7, 0.1]).to_vec();
                    grips.extend(Scene::grips(body + 1, -1.0, axis, [-0.7, 0.2]));
                    scene.row(
                        ConeLaw::Bilateral,
                        [random.within(-0.01, 0.01), 0.0],
                        [1.0; 2],
                        &grips,
                    );
                }
                scene.row(
                    ConeLaw::Box {
                        low: -0.4,
                        high: 0.8,
                    },
                    [random.within(-1.0, 1.0), 0.0],
                    [1.0; 2],
                    &[(2 * body + 1, [1.0, 0.0], [0.0; 2])],
                );
                scene.row(
                    ConeLaw::Unilateral,
                    [random.within(-0.5, 0.5), 0.0],
                    [1.0; 2],
                    &[(2 * body, [0.6, 0.8], [0.0; 2])],
                );
            }
        }
        scene.estimate();
        let answer = solve(&scene);
        let (violated, missing) = violation(&scene, &answer);
        assert!(missing < 1e-12, "seed {seed}: balance {missing:e}");
        assert!(answer.p.iter().flatten().all(|p| p.is_finite()));
        counts[0] += usize::from(answer.outcome.is_solved);
        counts[1] += usize::from(violated < 1e-7);
        counts[2] += usize::from(answer.outcome.used_interior_point);
        if answer.outcome.is_solved {
            worst_solved = worst_solved.max(violated);
        }
        work += answer.outcome.n_factorizations;
    }
    // random normals wedge bodies: some have no answer, or several, between which slips wander
    assert!(counts[0] >= 495 && counts[1] >= 495, "{counts:?}");
    assert!(worst_solved < 1e-7, "{worst_solved:e}");
    assert!(
        work < 9000,
        "{work} factorizations, {} with the interior point",
        counts[2]
    );
}

#[test]
fn units_do_not_matter() {
    // masses in milligrams, lengths in millimetres: forces and slips scale, nothing else happens
    let (mass, length) = (1e6, 1e-3);
    for seed in 0..20 {
        let scene = random_contacts(&mut Random(seed), 3, 4, 0.3);
        let mut scaled = scene.clone();
        scaled.matrix.assign_scaled(mass, &scene.matrix);
        scaled
            .load
            .iter_mut()
            .for_each(|load| *load *= mass * length);
        for row in &mut scaled.rows {
            row.free = row.free.map(|free| free * length);
            row.scale = row.scale.map(|scale| scale / mass);
        }
        let (one, other) = (solve(&scene), solve(&scaled));
        assert!(one.outcome.is_solved == other.outcome.is_solved);
        for (p, q) in one.a.iter().zip(&other.a) {
            assert!(
                (p - q / length).abs() < 1e-6,
                "seed {seed}: {p} {}",
                q / length
            );
        }
    }
}
