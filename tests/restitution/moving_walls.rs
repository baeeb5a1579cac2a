//! Seen from a wall that moves evenly, all is as at a wall at rest: rebounds, forces, and what is lost.

use super::SPEED;
use super::common::*;

const WALLS: [f64; 6] = [-10.0, -2.0, 0.2, 1.9, 2.0, 10.0];

/// A floor whose upper face is at `y = 0`, and which moves up at `speed`.
fn floor_at(scene: &mut Scene, speed: f64, collider: Option<ColliderBuilder>) -> RigidBodyHandle {
    let floor = RigidBodyBuilder::kinematic_velocity_based()
        .translation(vec2(0.0, -0.5))
        .linvel(vec2(0.0, speed));
    match collider {
        Some(collider) => scene.rigid(floor, collider).0,
        None => scene.world.insert_body(floor),
    }
}

fn of_strain(builder: FlexBodyBuilder, is_large: bool) -> FlexBodyBuilder {
    match is_large {
        true => builder.large_strain(),
        false => builder.small_strain(),
    }
}

/// How fast a stiff block leaves a floor, over its approach.
fn of_a_block(e: f64, is_large: bool, wall: f64, rate: f64) -> f64 {
    let mut scene = Scene::in_free_space(1.0 / rate);
    let collider = ColliderBuilder::cuboid(5.0, 0.5).friction(0.0);
    floor_at(&mut scene, wall, Some(collider.restitution(real(e))));
    let block = FlexBodyBuilder::rectangle([0.2, 0.2], [4, 4])
        .material(LinearElastic::plane_stress(1e9, 0.3).density(1000.0))
        .friction(0.0)
        .restitution(e)
        .translation([-0.1, 0.03])
        .linvel([0.0, wall - SPEED]);
    let block = scene.flexible(of_strain(block, is_large));
    scene.steps((0.1 * rate) as usize);
    (scene.body(block).linvel()[1] - wall) / SPEED
}

/// The same of a ball that hits a stiff block which is welded to the moving body.
fn of_a_ball(e: f64, is_large: bool, wall: f64, rate: f64) -> f64 {
    let mut scene = Scene::in_free_space(1.0 / rate);
    let carrier = floor_at(&mut scene, wall, None);
    let block = FlexBodyBuilder::rectangle([0.4, 0.2], [6, 4])
        .material(LinearElastic::plane_stress(1e10, 0.3).density(8000.0))
        .friction(0.0)
        .restitution(e)
        .translation([-0.2, -0.2])
        .linvel([0.0, wall]);
    let block = scene.flexible(of_strain(block, is_large));
    let weld = AttachmentBuilder::weld(block).where_(|[_, y]| y < 1e-9);
    scene
        .bodies
        .attach(weld.to_rigid_body(carrier), &scene.world.bodies)
        .expect("a weld of the lower face");
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(0.0, 0.13))
            .linvel(vec2(0.0, wall - SPEED)),
        ColliderBuilder::ball(0.1)
            .mass(1.0)
            .friction(0.0)
            .restitution(real(e)),
    );
    scene.steps((0.1 * rate) as usize);
    (f64::from(scene.world.bodies[ball].linvel().y) - wall) / SPEED
}

#[test]
fn what_hits_a_moving_wall_rebounds_as_from_one_at_rest() {
    let mut findings = Findings::default();
    for (rate, is_large, e) in [60.0, 240.0]
        .iter()
        .flat_map(|&rate| [(rate, true), (rate, false)])
        .flat_map(|(rate, is_large)| [(rate, is_large, 1.0), (rate, is_large, 0.5)])
    {
        for (name, rebound) in [
            ("block", of_a_block as fn(f64, bool, f64, f64) -> f64),
            ("ball on a welded block", of_a_ball),
        ] {
            let at_rest = rebound(e, is_large, 0.0, rate);
            findings.check((at_rest - e).abs() < 6e-3, || {
                format!("{name}, e {e}, large {is_large}, 1/{rate} s, at rest: {at_rest}")
            });
            for wall in WALLS {
                let found = rebound(e, is_large, wall, rate);
                findings.check((found - at_rest).abs() < 5e-4, || {
                    format!("{name}, e {e}, large {is_large}, 1/{rate} s, {wall} m/s: {found} for {at_rest}")
                });
            }
        }
    }
    findings.report();
}

/// What a block that lands on a lift loses, and the most it presses with; the books tell all that it loses.
fn of_a_lift(young: f64, is_large: bool, lift: f64) -> [f64; 2] {
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let collider = ColliderBuilder::cuboid(50.0, 0.5).friction(0.5);
    floor_at(&mut scene, lift, Some(collider));
    let block = FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4])
        .material(LinearElastic::plane_stress(young, 0.3).density(1000.0))
        .friction(0.5)
        .translation([-0.2, 0.02])
        .linvel([0.0, lift - 3.0]);
    let block = scene.flexible(of_strain(block, is_large));
    let seen = |scene: &Scene| {
        let body = scene.body(block);
        let energy = body.energy();
        let momentum = body.momentum()[1];
        energy.kinetic + energy.elastic + lift * (0.5 * body.mass() * lift - momentum)
    };
    let start = seen(&scene);
    let (mut most, mut told) = (0.0f64, 0.0);
    for _ in 0..20 {
        scene.step();
        let force: f64 = scene
            .report()
            .contacts()
            .iter()
            .map(|one| one.normal_force)
            .sum();
        most = most.max(force);
        told = scene.report().energy().dissipated;
    }
    let lost = start - seen(&scene);
    assert!(
        (told - lost).abs() < 2e-3 * start,
        "E {young:e}, large {is_large}, {lift} m/s: {told} J told, {lost} J lost"
    );
    [lost, most]
}

#[test]
fn what_lands_on_a_lift_loses_what_it_loses_on_the_ground() {
    for (young, is_large) in [(1e7, true), (1e7, false), (1e6, true), (1e6, false)] {
        let expected = of_a_lift(young, is_large, 0.0);
        assert!(expected[0] > 1.0);
        for lift in WALLS {
            let found = of_a_lift(young, is_large, lift);
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found / expected - 1.0).abs() < 2e-2,
                    "E {young:e}, large {is_large}, {lift} m/s: {found} for {expected}"
                );
            }
        }
    }
}
