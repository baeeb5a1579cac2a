//! Chains of ties, and ties that contradict each other.

use super::*;

/// Bodies in a line, each tied to the one before and the first to the world, in both directions.
fn chain(n_links: usize) -> Scene {
    let mut scene = Scene::bodies(&vec![[1.0, 0.1]; n_links]);
    for link in 0..n_links {
        scene.load[4 * link + 1] = -10.0;
        for axis in [[1.0, 0.0], [0.0, 1.0]] {
            let mut grips = Scene::grips(link, 1.0, axis, [0.0, 0.5]).to_vec();
            if link > 0 {
                grips.extend(Scene::grips(link - 1, -1.0, axis, [0.0, -0.5]));
            }
            scene.row(ConeLaw::Bilateral, [0.0; 2], [1.0; 2], &grips);
        }
    }
    scene.estimate();
    scene
}

#[test]
fn a_hanging_chain_carries_the_weight_below_every_joint() {
    let scene = chain(100);
    let answer = solve(&scene);
    assert!(
        answer.outcome.is_solved && answer.outcome.n_factorizations <= 3,
        "{:?}",
        answer.outcome
    );
    for link in 0..100 {
        let weight = 10.0 * (100 - link) as f64;
        // the softest mode of the chain magnifies a residual of 1e-9 a few thousand times
        assert!(
            (answer.p[2 * link + 1][0] - weight).abs() < 1e-2 && answer.p[2 * link][0].abs() < 1e-5
        );
    }
    assert!(answer.a.iter().all(|a| a.abs() < 1e-4));
}

#[test]
fn ties_that_contradict_each_other_end_in_a_compromise_and_say_so() {
    let mut scene = Scene::bodies(&[[1.0, 1.0]]);
    for free in [-1.0, 2.0] {
        scene.row(
            ConeLaw::Bilateral,
            [free, 0.0],
            [1.0; 2],
            &[(0, [1.0, 0.0], [0.0; 2])],
        );
    }
    scene.estimate();
    let answer = solve(&scene);
    assert!(!answer.outcome.is_solved && answer.outcome.residual > 0.0);
    // half way between the two
    assert!((answer.a[0] + 0.5).abs() < 1e-3, "{:?}", answer.a);
    assert!(answer.p.iter().flatten().all(|p| p.is_finite()));
    assert!(violation(&scene, &answer).1 < 1e-12);
}
