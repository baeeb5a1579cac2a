//! Newton's restitution where an impact is shorter than the step: rigid contacts in a claimed island, stiff bodies.

mod common;

#[path = "restitution/hits.rs"]
mod hits;
#[path = "restitution/moving_walls.rs"]
mod moving_walls;
#[path = "restitution/phases.rs"]
mod phases;
#[path = "restitution/spinning.rs"]
mod spinning;

use CoefficientCombineRule::{Average, Max, Min, Multiply};
use common::*;

const RATES: [f64; 2] = [60.0, 240.0];
const SPEED: f64 = 2.0;

/// A rigid ball hits a rigid box that a flexible slab carries, so that both are claimed: rebound over approach of the pair.
fn on_a_carried_box(e: [f64; 2], rules: [CoefficientCombineRule; 2], rate: f64) -> f64 {
    let mut scene = Scene::in_free_space(1.0 / rate);
    scene.flexible(
        FlexBodyBuilder::rectangle([2.0, 0.5], [16, 4])
            .material(LinearElastic::plane_stress(1e9, 0.3).density(1000.0))
            .pin_where(|[_, y]| y == 0.0, Pin::both()),
    );
    // So heavy that it stays.
    scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(1.013, 0.7)),
        ColliderBuilder::cuboid(0.3, 0.2)
            .density(1e9)
            .friction(0.0)
            .restitution(real(e[0]))
            .restitution_combine_rule(rules[0]),
    );
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(1.013, 1.3))
            .linvel(vec2(0.0, -SPEED)),
        ColliderBuilder::ball(0.1)
            .density(100.0)
            .friction(0.0)
            .restitution(real(e[1]))
            .restitution_combine_rule(rules[1]),
    );
    let mut is_claimed = false;
    for _ in 0..(0.5 * rate) as usize {
        scene.step();
        is_claimed |= scene.report().n_claimed() == 2;
    }
    assert!(is_claimed, "the ball was left to rapier");
    f64::from(scene.world.bodies[ball].linvel().y) / SPEED
}

#[test]
fn rigid_bodies_of_a_claimed_island_rebound_as_rapier_combines_them() {
    let cases = [
        ([0.0, 0.0], [Average, Average], 0.0),
        ([0.5, 0.5], [Average, Average], 0.5),
        ([1.0, 1.0], [Average, Average], 1.0),
        ([0.0, 1.0], [Average, Average], 0.5),
        ([0.0, 0.8], [Average, Max], 0.8),
        ([0.3, 0.8], [Average, Min], 0.3),
        ([0.5, 0.8], [Multiply, Average], 0.4),
    ];
    for rate in RATES {
        for (e, rules, wanted) in cases {
            let found = on_a_carried_box(e, rules, rate);
            // The box is 1e8 times heavier; velocities are f32.
            assert!(
                (found - wanted).abs() < 1e-6,
                "{e:?} {rules:?} dt 1/{rate}: {found}"
            );
        }
    }
}

#[test]
fn a_stiff_block_rebounds_from_the_ground_by_its_restitution() {
    for rate in RATES {
        for e in [0.0, 0.5, 1.0] {
            let mut scene = Scene::in_free_space(1.0 / rate);
            scene.fixed(
                ColliderBuilder::cuboid(5.0, 0.5)
                    .translation(vec2(0.0, -0.5))
                    .restitution(real(e)),
            );
            let block = scene.flexible(
                FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8])
                    .material(LinearElastic::plane_stress(2e11, 0.3).density(1000.0))
                    .translation([0.0, 0.3])
                    .linvel([0.0, -SPEED])
                    .friction(0.0)
                    .restitution(e),
            );
            scene.steps((0.4 * rate) as usize);
            let found = scene.body(block).linvel()[1] / SPEED;
            // ω dt = 93 of the squeezing mode at 1/240 s: its share of the mobility, 4 / (ω dt)², is 5e-4.
            assert!((found - e).abs() < 2e-3, "e {e}, dt 1/{rate}: {found}");
        }
    }
}

#[test]
fn a_ball_rebounds_from_a_stiff_slab_by_its_restitution() {
    for rate in RATES {
        for e in [0.0, 0.5, 1.0] {
            let mut scene = Scene::in_free_space(1.0 / rate);
            scene.flexible(
                FlexBodyBuilder::rectangle([2.0, 0.5], [16, 4])
                    .material(LinearElastic::plane_stress(2e11, 0.3).density(7800.0))
                    .pin_where(|[_, y]| y == 0.0, Pin::both())
                    .friction(0.0)
                    .restitution(e),
            );
            // Above a node, and between two.
            for x in [1.0, 1.04] {
                let (ball, _) = scene.rigid(
                    RigidBodyBuilder::dynamic()
                        .translation(vec2(x, 0.9))
                        .linvel(vec2(0.0, -SPEED)),
                    ColliderBuilder::ball(0.1)
                        .density(100.0)
                        .friction(0.0)
                        .restitution(real(e)),
                );
                scene.steps((0.4 * rate) as usize);
                let found = f64::from(scene.world.bodies[ball].linvel().y) / SPEED;
                assert!(
                    (found - e).abs() < 1e-3,
                    "e {e}, x {x}, dt 1/{rate}: {found}"
                );
                scene.world.remove_body(ball);
            }
        }
    }
}

#[test]
fn a_stiff_block_and_a_rigid_box_part_by_their_restitution() {
    for rate in RATES {
        for e in [0.0, 0.5, 1.0] {
            let mut scene = Scene::in_free_space(1.0 / rate);
            let block = scene.flexible(
                FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8])
                    .material(LinearElastic::plane_stress(2e11, 0.3).density(1000.0))
                    .linvel([1.0, 0.0])
                    .friction(0.0)
                    .restitution(e),
            );
            let (body, _) = scene.rigid(
                RigidBodyBuilder::dynamic()
                    .translation(vec2(2.0, 0.5))
                    .linvel(vec2(-1.0, 0.0)),
                ColliderBuilder::cuboid(0.5, 0.37)
                    .density(500.0)
                    .restitution(real(e)),
            );
            scene.steps((0.8 * rate) as usize);
            let after =
                f64::from(scene.world.bodies[body].linvel().x) - scene.body(block).linvel()[0];
            assert!(
                (after / 2.0 - e).abs() < 1e-3,
                "e {e}, dt 1/{rate}: {}",
                after / 2.0
            );
            let spin = scene
                .body(block)
                .angular_momentum(scene.body(block).centre_of_mass());
            assert!(
                spin.abs() < 1e-4,
                "a central impact makes the block spin by {spin:e} N m s"
            );
        }
    }
}

/// A rigid head of 80 kg with a steel strip of 60 kg welded to it falls on a rigid anvil at 5 m/s: energy that is left, of what it came with.
fn of_a_hammer(e: f64, rate: f64, is_large: bool) -> f64 {
    let mut scene = Scene::in_free_space(1.0 / rate);
    let handle = FlexBodyBuilder::rectangle([1.0, 0.06], [20, 2])
        .material(LinearElastic::plane_stress(2e11, 0.3).density(1000.0))
        .translation([0.1, -0.03])
        .linvel([0.0, -5.0]);
    let handle = scene.flexible(match is_large {
        true => handle.large_strain(),
        false => handle.small_strain(),
    });
    let elastic = ColliderBuilder::cuboid(real(0.1), real(0.1)).restitution(real(e));
    let (head, _) = scene.rigid(
        RigidBodyBuilder::dynamic().linvel(vec2(0.0, -5.0)),
        elastic.density(real(2000.0)),
    );
    let weld = AttachmentBuilder::weld(handle).where_(|[x, _]| x < 1e-9);
    scene
        .bodies
        .attach(weld.to_rigid_body(head), &scene.world.bodies)
        .expect("a weld of the handle's end");
    let anvil = ColliderBuilder::cuboid(real(0.3), real(0.1)).translation(vec2(-0.2, -0.6));
    scene.fixed(anvil.restitution(real(e)));
    let energy = |scene: &Scene| {
        let of_handle = scene.body(handle).energy();
        of_handle.kinetic + of_handle.elastic + kinetic_of(&scene.world.bodies[head])
    };
    let before = energy(&scene);
    for _ in 0..(0.5 * rate) as usize {
        scene.step();
        let now = energy(&scene) / before;
        assert!(now < 1.01, "e {e}, {rate} Hz, large {is_large}: {now}");
    }
    energy(&scene) / before
}

/// What is welded to a rigid body and stiffer than the step resolves is struck with it: the hammer rebounds as one piece, and loses as much as a rigid one.
#[test]
fn a_hammer_rebounds_as_one_piece() {
    // Momentum and angular momentum of the rigid hammer about its centre, with the blow at a corner of the head.
    let (head, handle): (f64, f64) = (80.0, 60.0);
    let mass = head + handle;
    let centre = 0.6 * handle / mass;
    let inertia = head * 0.04 / 6.0
        + handle * (1.0 + 0.0036) / 12.0
        + head * centre.powi(2)
        + handle * (0.6 - centre).powi(2);
    let arm = 0.1 - centre;
    let left = 1.0 - 1.0 / (1.0 + mass * arm * arm / inertia);
    for (rate, is_large) in [(30.0, true), (60.0, true), (60.0, false)] {
        let [plastic, elastic] = [0.0, 1.0].map(|e| of_a_hammer(e, rate, is_large));
        println!("{rate} Hz, large {is_large}: {plastic}, {elastic}; rigid {left}");
        assert!(
            (elastic - 1.0).abs() < 0.03,
            "{rate} Hz, large {is_large}: {elastic}"
        );
        assert!(
            (plastic - left).abs() < 0.02,
            "{rate} Hz, large {is_large}: {plastic} of {left}"
        );
    }
}
