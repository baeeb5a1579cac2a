//! Chains that are as long as what they hang between is apart, or a little shorter.

use crate::common::*;
use foil2d::pipeline::Quality;

/// Planks from one post to the other, and half their length (m).
const N: usize = 8;
const HALF: f64 = 0.15;

/// Planks between posts that are farther apart than these are long, by `short` (m); a soft block and a ball over them.
fn bridge(short: f64) -> (Scene, Vec<RigidBodyHandle>, f64) {
    let mut scene = Scene::new(1.0 / 60.0);
    let end = HALF * N as f64 + 0.5 * short;
    let posts = [-end, end].map(|x| RigidBodyBuilder::fixed().translation(vec2(x, 1.0)));
    let [left, right] = posts.map(|post| scene.world.insert_body(post));
    let mut bodies = vec![left];
    for k in 0..N {
        let x = HALF * (2.0 * k as f64 + 1.0 - N as f64);
        let plank = RigidBodyBuilder::dynamic().translation(vec2(x, 1.0));
        let shape = ColliderBuilder::cuboid(real(0.14), real(0.03)).density(700.0);
        bodies.push(scene.world.insert(plank, shape.friction(0.6)).0);
    }
    bodies.push(right);
    for k in 0..=N {
        let [one, other] = anchors(k);
        let hinge = RevoluteJointBuilder::new().contacts_enabled(false);
        let hinge = hinge.local_anchor1(one).local_anchor2(other);
        scene
            .world
            .insert_impulse_joint(bodies[k], bodies[k + 1], hinge);
    }
    let block = FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4]).material(elastic(3e5, 1000.0, 1e-2));
    scene.flexible(block.friction(0.6).translation([-0.3, 1.2]));
    let ball = RigidBodyBuilder::dynamic().translation(vec2(0.4, 1.5));
    scene
        .world
        .insert(ball, ColliderBuilder::ball(0.15).density(800.0));
    (scene, bodies, end)
}

/// Where the `k`-th hinge is on the two bodies it joins.
fn anchors(k: usize) -> [Vector; 2] {
    [(k > 0, HALF), (k < N, -HALF)].map(|(is_plank, x)| vec2(if is_plank { x } else { 0.0 }, 0.0))
}

/// How far the ends at every hinge are apart, together (m).
fn openings(scene: &Scene, bodies: &[RigidBodyHandle]) -> f64 {
    let hinges = (0..=N).map(|k| {
        let [one, other] = anchors(k);
        let place = |body: usize, anchor| {
            let body = &scene.world.bodies[bodies[body]];
            body.position().transform_point(anchor)
        };
        f64::from((place(k, one) - place(k + 1, other)).length())
    });
    hinges.sum()
}

/// What could hold such a bridge straight are forces without bound: it sags by some hundredths of its length, or opens where it is too short, and is told so.
#[test]
fn a_bridge_that_is_just_too_short_hangs() {
    for short in [-0.01, -1e-3, -1e-4, 0.0, 1e-4, 1e-3, 0.01, 0.05] {
        let (mut scene, bodies, end) = bridge(short);
        let before = energy_of(&scene);
        let (mut n_passes, mut told) = (0, 0.0f64);
        for step in 0..300 {
            scene.try_step().expect("the input is right");
            let report = scene.report();
            let quality = report.quality();
            assert_ne!(quality, Quality::Unfinished, "{short} m, {step}");
            n_passes += report.n_newton();
            if step >= 240 {
                told = told.max(report.joint_violation());
            }
            let energy = energy_of(&scene);
            assert!(
                energy < 1.01 * before,
                "{short} m, {step}: {energy} J of {before}"
            );
        }
        assert!(n_passes < 300 * 8, "{short} m: {n_passes} passes");
        let middle = f64::from(scene.world.bodies[bodies[N / 2]].translation().y);
        let open = openings(&scene, &bodies);
        // A taut string with all its load in the middle would be there.
        let sag = ((HALF * N as f64 + 0.5 * open).powi(2) - end * end).max(0.0);
        println!("{short} m: {middle} m high, {open} m open, told {told} m");
        assert!(
            1.0 - middle < sag.sqrt() + 0.01 && middle < 1.0,
            "{short} m: {middle}"
        );
        assert!(
            open >= short && open < short.max(0.0) + 2e-3,
            "{short} m: {open} m open"
        );
        if short < -5e-4 {
            assert!(open < 1e-4 && told == 0.0, "{short} m: {open}, told {told}");
        }
        if short >= 1e-3 {
            assert!(told > short / N as f64 * 0.5, "{short} m: told {told} m");
        }
    }
}
