//! Sleep of several: who wakes whom, and what is told of those that sleep.

mod common;

use common::*;
use foil2d::pipeline::Participant;

fn block(young: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([0.4, 0.2], [8, 4])
        .material(elastic(young, 3000.0, 3e-4))
        .friction(0.6)
}

/// Bodies that lie beside each other, too far off to touch and near enough to be looked at: each once woke the other for ever, asleep in turns.
#[test]
fn what_rests_beside_a_sleeper_lets_it_sleep() {
    for small in [true, false] {
        for gap in [0.01, 0.03, 0.04, 0.05, 0.08] {
            for later in [0.05, 0.2, 0.4] {
                let mut scene = Scene::new(1.0 / 60.0);
                scene.ground(0.6);
                let [one, other] = [0.0, 0.4 + gap].map(|x| {
                    let block = block(2e8).translation([x, 1e-3]);
                    scene.flexible(if small { block.small_strain() } else { block })
                });
                scene.steps(300);
                for body in [one, other] {
                    let body = scene.bodies.get_mut(body).expect("it is there");
                    body.wake_up();
                    scene.steps((later * 60.0) as usize);
                }
                scene.steps(90);
                for step in 0..60 {
                    scene.step();
                    let n = scene.report().n_asleep();
                    assert_eq!(n, 2, "{gap} m, {later} s, small {small}: {step}");
                }
            }
        }
    }
}

/// A blow wakes what a neighbour at rest has not woken.
#[test]
fn what_rests_beside_a_sleeper_hands_a_blow_on() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.6);
    let [one, other] = [0.0, 0.43].map(|x| scene.flexible(block(2e8).translation([x, 1e-3])));
    scene.steps(300);
    assert_eq!(scene.report().n_asleep(), 2);
    scene.bodies.get_mut(one).expect("it is there").wake_up();
    scene.steps(10);
    let ball = RigidBodyBuilder::dynamic()
        .translation(vec2(-0.4, 0.1))
        .linvel(vec2(20.0, 0.0));
    scene.rigid(ball, ColliderBuilder::ball(0.09).density(3000.0));
    let before = scene.body(other).centre_of_mass()[0];
    for _ in 0..60 {
        scene.step();
        let [one, other] = [one, other].map(|body| scene.body(body).centre_of_mass()[0]);
        assert!(other - one > 0.39, "{one} m and {other} m");
    }
    assert!(scene.body(other).centre_of_mass()[0] > before + 0.01);
}

/// One that sleeps far away; a box with a block on it, of which the box falls asleep first.
#[test]
fn contacts_of_what_falls_asleep_are_told_once() {
    for small in [true, false] {
        for dt in [1.0 / 60.0, 1.0 / 240.0] {
            let mut scene = Scene::new(dt);
            let ground = scene.ground(0.5);
            let body = |at: [f64; 2]| {
                let block = block(1e10).translation(at);
                if small { block.small_strain() } else { block }
            };
            scene.flexible(body([-10.0, 0.0]));
            scene.steps((4.0 / dt) as usize);
            let (rigid, shape) = scene.world.insert(
                RigidBodyBuilder::dynamic().translation(vec2(0.0, 0.2)),
                ColliderBuilder::cuboid(real(0.3), real(0.2))
                    .density(2000.0)
                    .friction(0.5),
            );
            let above = scene.flexible(body([-0.2, 0.4]));
            let flexible = G * scene.body(above).mass();
            let rigid = G * f64::from(scene.world.bodies[rigid].mass());
            for step in 0..(6.0 / dt) as usize {
                scene.step();
                if (step as f64) * dt < 1.0 {
                    continue;
                }
                for (who, expected) in [
                    (Participant::Rigid(ground), -2.0 * flexible - rigid),
                    (Participant::Flex(above), flexible),
                    (Participant::Rigid(shape), rigid),
                ] {
                    let told = scene.report().force_on(who)[1];
                    let is_right = (told / expected - 1.0).abs() < 0.01;
                    assert!(is_right, "{who:?} at {step}: {told} N for {expected} N");
                }
            }
            assert_eq!(scene.report().n_asleep(), 2, "small {small}, {dt} s");
        }
    }
}

/// Wind that is set in every step, and does not change.
#[test]
fn a_load_that_is_set_to_what_it_is_wakes_nobody() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.6);
    let handle = scene.flexible(block(1e7).translation([0.0, 1e-3]));
    let set = |scene: &mut Scene, wind: f64| {
        let body = scene.bodies.get_mut(handle).expect("it is there");
        body.set_nodal_force(3, [wind, 0.0]).expect("a force");
        body.set_body_force([0.1, 0.0]).expect("a force");
        body.set_gravity_scale(0.9).expect("a number");
        scene.step();
        scene.report().n_asleep()
    };
    for _ in 0..300 {
        set(&mut scene, 1.0);
    }
    assert_eq!(set(&mut scene, 1.0), 1);
    assert_eq!(set(&mut scene, 2.0), 0);
}

/// Balls between soft blocks, too far off to touch: at rest they let sleep what they lie beside, and what they claim in its sleep.
#[test]
fn balls_that_rest_between_sleepers_let_them_sleep() {
    for n_balls in [1, 3] {
        for (gap, later) in [(0.005, 0.1), (0.02, 0.3), (0.02, 0.45)] {
            let mut scene = Scene::new(1.0 / 60.0);
            scene.ground(0.6);
            let mut x = 0.0;
            let mut blocks = Vec::new();
            let mut balls = Vec::new();
            for _ in 0..3 {
                blocks.push(scene.flexible(block(2e8).translation([x, 1e-3])));
                x += 0.4 + gap;
                for _ in 0..n_balls {
                    let ball = RigidBodyBuilder::dynamic().translation(vec2(x + 0.08, 0.08));
                    let shape = ColliderBuilder::ball(0.08).density(500.0);
                    balls.push(scene.world.insert(ball, shape).0);
                    x += 0.161;
                }
                x += gap;
            }
            scene.steps(300);
            let what = format!("{n_balls} balls, {gap} m, {later} s");
            for who in 0..3 {
                let body = scene.bodies.get_mut(blocks[who]).expect("it is there");
                body.wake_up();
                scene.steps((later * 60.0) as usize);
                let ball = scene.world.bodies.get_mut(balls[who]).expect("a ball");
                ball.wake_up(true);
                scene.steps((later * 30.0) as usize);
            }
            scene.steps(90);
            for step in 0..60 {
                scene.step();
                assert_eq!(scene.report().n_asleep(), 3, "{what}: {step}");
                let mut all = balls.iter().map(|ball| &scene.world.bodies[*ball]);
                assert!(all.all(RigidBody::is_sleeping), "{what}: {step}");
            }
        }
    }
}

/// Two blocks on one floor, of which one keeps on being pushed: the other's contacts are told as it sleeps.
#[test]
fn contacts_of_a_sleeper_are_told_while_another_moves_on_its_floor() {
    let mut scene = Scene::new(1.0 / 60.0);
    let floor = scene.ground(0.6);
    let [pushed, sleeper] = [-2.0, 1.0].map(|x| scene.flexible(block(2e8).translation([x, 1e-3])));
    let weight = G * scene.body(sleeper).mass();
    for step in 0..400 {
        let push = 0.02 * G * f64::from(step % 2);
        let body = scene.bodies.get_mut(pushed).expect("it is there");
        body.set_body_force([push, 0.0]).expect("a push");
        scene.step();
        if step >= 300 {
            assert_eq!(scene.report().n_asleep(), 1, "{step}");
            let own = Participant::Flex(sleeper);
            let told = scene.report().contacts().iter().filter(|contact| {
                contact.contactor == own && contact.target == Participant::Rigid(floor)
            });
            let force: f64 = told.map(|contact| contact.normal_force).sum();
            assert!(
                (force / weight - 1.0).abs() < 1e-3,
                "{step}: {force} of {weight} N"
            );
        }
    }
}
