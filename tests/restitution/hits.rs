//! Impacts of rigid bodies within a step, at any time of it, against their closed forms.

use crate::common::*;

const RATES: [f64; 3] = [30.0, 60.0, 240.0];

/// A scene in which everything is solved with a ring around it, which touches nothing.
fn ringed(rate: f64) -> Scene {
    let mut scene = Scene::in_free_space(1.0 / rate);
    let ring = FlexBodyBuilder::annulus(8.0, 8.5, 0.8)
        .material(elastic(1e8, 20.0, 0.0))
        .pin_where(|_| true, Pin::both())
        .can_sleep(false);
    scene.flexible(ring);
    scene
}

/// Numbers from 0 to 1 that fill the interval evenly.
fn spread(n: usize) -> impl Iterator<Item = f64> {
    (0..n).map(|k| (0.5 + k as f64 * 0.618_033_988_75).fract())
}

fn velocity(scene: &Scene, body: RigidBodyHandle) -> [f64; 2] {
    let velocity = scene.world.bodies[body].linvel();
    [velocity.x, velocity.y].map(f64::from)
}

/// Balls without friction that meet beside their centres exchange the part of their velocities along the line between these where they meet, whenever
/// in the step that is, and nothing turns them.
#[test]
fn balls_that_meet_beside_their_centres_part_along_the_line_between_them() {
    let radius = 0.1;
    for rate in RATES {
        for e in [0.0, 0.5, 1.0] {
            for (place, phase) in spread(12).zip(spread(31).skip(12)) {
                let (beside, speed) = (0.3 * (place - 0.5), 2.0 + phase);
                let away = 0.3 + 0.1 * phase;
                let mut scene = ringed(rate);
                let ball = || {
                    ColliderBuilder::ball(real(radius))
                        .density(100.0)
                        .friction(0.0)
                        .restitution(real(e))
                };
                let moving = RigidBodyBuilder::dynamic()
                    .translation(vec2(-away, beside))
                    .linvel(vec2(speed, 0.0));
                let (one, _) = scene.rigid(moving, ball());
                let (other, _) = scene.rigid(RigidBodyBuilder::dynamic(), ball());
                scene.steps((0.45 / speed * rate) as usize + 1);
                let sin = beside / (2.0 * radius);
                let cos = (1.0 - sin * sin).sqrt();
                let given = 0.5 * (1.0 + e) * speed * cos;
                let expected = [
                    [speed - given * cos, given * sin],
                    [given * cos, -given * sin],
                ];
                let context = format!("e {e}, 1/{rate} s, {beside} m beside, {speed} m/s");
                for (body, expected) in [one, other].into_iter().zip(expected) {
                    let found = velocity(&scene, body);
                    let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
                    assert!(off < 2e-3 * speed, "{context}: {found:?}, not {expected:?}");
                    let spin = scene.world.bodies[body].angvel();
                    assert!(spin.abs() < 1e-6, "{context}: spins by {spin} rad/s");
                }
            }
        }
    }
}

/// Boxes that meet in any way leave with no more energy than they had, with friction, too, where Newton's law alone may give a sixth.
#[test]
fn boxes_that_rebound_gain_no_energy() {
    let mut limited = 0;
    for rate in [60.0, 240.0] {
        for friction in [0.0, 0.5] {
            let numbers: Vec<f64> = spread(400).collect();
            for chosen in numbers.chunks_exact(8) {
                let mut scene = ringed(rate);
                let face = |half: f64| {
                    ColliderBuilder::cuboid(real(half), 0.1)
                        .density(100.0)
                        .friction(real(friction))
                        .restitution(1.0)
                };
                let speed = 1.0 + 4.0 * chosen[0];
                let moving = RigidBodyBuilder::dynamic()
                    .translation(vec2(-0.5 - 0.2 * chosen[1], 0.4 * (chosen[2] - 0.5)))
                    .rotation(real(6.0 * chosen[3]))
                    .linvel(vec2(speed, 0.0))
                    .angvel(real(20.0 * (chosen[4] - 0.5)));
                let still = RigidBodyBuilder::dynamic().rotation(real(6.0 * chosen[5]));
                let boxes = [
                    scene.rigid(moving, face(0.05 + 0.1 * chosen[6])).0,
                    scene.rigid(still, face(0.1)).0,
                ];
                let energy = |scene: &Scene| {
                    let all = boxes.map(|body| kinetic_of(&scene.world.bodies[body]));
                    all.iter().sum::<f64>()
                };
                let brought = energy(&scene);
                scene.steps((0.7 / speed * rate) as usize + 1);
                let left = energy(&scene) / brought;
                let context = format!("friction {friction}, 1/{rate} s, {chosen:?}");
                assert!(left < 1.01, "{context}: {left}");
                limited += usize::from(friction > 0.0 && left > 0.999 && left < 1.0);
            }
        }
    }
    assert!(limited > 0, "no impact came near to gaining");
}

/// Friction turns a ball by its radius, whenever in the step it lands.
#[test]
fn friction_turns_a_ball_by_its_radius_whenever_it_lands() {
    let (radius, mass) = (0.1, 2.0);
    for rate in RATES {
        for phase in spread(8) {
            let mut scene = ringed(rate);
            let ground = ColliderBuilder::cuboid(3.0, 0.5).translation(vec2(0.0, -0.5));
            scene.fixed(ground.friction(0.1));
            let falling = RigidBodyBuilder::dynamic()
                .translation(vec2(0.0, 0.3 + 0.17 * phase))
                .linvel(vec2(3.0, -5.0));
            let ball = ColliderBuilder::ball(real(radius))
                .mass(real(mass))
                .friction(0.1);
            let (ball, _) = scene.rigid(falling, ball);
            scene.steps((0.1 * rate) as usize);
            let slowed = 3.0 - velocity(&scene, ball)[0];
            // A tenth of what stops it, of half the mass times the squared radius.
            assert!(
                (slowed - 0.5).abs() < 1e-5,
                "1/{rate} s, {phase}: {slowed} m/s"
            );
            let turned = -f64::from(scene.world.bodies[ball].angvel());
            let lever = 0.5 * radius * radius * turned / slowed;
            assert!(
                (lever / radius - 1.0).abs() < 1e-5,
                "1/{rate} s, {phase}: {lever} m"
            );
        }
    }
}

/// A ball that rebounds with all of its speed keeps its height.
#[test]
fn an_elastic_ball_keeps_its_height() {
    for rate in RATES {
        let mut scene = ringed(rate);
        scene.world.gravity = vec2(0.0, -G);
        let ground = ColliderBuilder::cuboid(3.0, 0.5).translation(vec2(0.0, -0.5));
        scene.fixed(ground.friction(0.0).restitution(1.0));
        let ball = ColliderBuilder::ball(0.1).density(100.0).friction(0.0);
        let dropped = RigidBodyBuilder::dynamic().translation(vec2(0.0, 1.1));
        let (ball, _) = scene.rigid(dropped, ball.restitution(1.0));
        let mut n_bounces = 0;
        let mut last = 0.0;
        for step in 0..(8.0 * rate) as usize {
            scene.step();
            let body = &scene.world.bodies[ball];
            let [height, speed] = [body.translation().y, body.linvel().y].map(f64::from);
            n_bounces += usize::from(last < 0.0 && speed > 0.0);
            last = speed;
            let energy = 0.5 * speed * speed + G * (height - 0.1);
            assert!(
                (energy / G - 1.0).abs() < 1e-3,
                "1/{rate} s, step {step}: {energy} J/kg"
            );
        }
        assert!(n_bounces >= 8, "1/{rate} s: {n_bounces} bounces");
    }
}
