//! What is changed between steps: types, places, shapes; what comes and goes.

use crate::common::*;
use crate::support::*;

fn a_body_made_fixed_stops_and_made_dynamic_falls(stage: &mut Stage) -> Verdict {
    let body = stage.dynamic(0.0, 0.0, square(0.2));
    stage.steps(10);
    stage.world.bodies[body].set_body_type(RigidBodyType::Fixed, true);
    stage.steps(30);
    let held = stage.at(body)[1];
    stage.steps(30);
    let still = stage.at(body)[1];
    stage.world.bodies[body].set_linvel(vec2(0.0, 0.0), true);
    stage.world.bodies[body].set_body_type(RigidBodyType::Dynamic, true);
    stage.steps(60);
    let fallen = still - stage.at(body)[1];
    all([
        is_near(still, held, 1e-6),
        verdict(fallen > 0.4 * G, format!("fell {fallen} m")),
    ])
}

fn a_disabled_body_is_not_there(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let body = stage.dynamic(0.0, 0.2, square(0.2));
    let other = stage.dynamic(0.0, 0.6, square(0.2));
    stage.steps(30);
    stage.world.bodies[body].set_enabled(false);
    stage.steps(60);
    let fallen = stage.at(other)[1];
    let before = stage.at(body);
    stage.world.bodies[other].set_translation(vec2(5.0, 0.2), true);
    stage.world.bodies[body].set_enabled(true);
    stage.world.bodies[body].set_linvel(vec2(1.0, 0.0), true);
    stage.steps(10);
    all([
        is_near(fallen, 0.2, 0.01),
        verdict(stage.at(body)[0] > before[0] + 0.02, "moves again"),
    ])
}

fn a_teleported_body_is_there_at_once(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let body = stage.dynamic(0.0, 0.2, square(0.2));
    stage.steps(60);
    stage.world.bodies[body].set_translation(vec2(10.0, 3.0), true);
    stage.step();
    let there = stage.at(body);
    stage.steps(120);
    all([
        is_near(there[0], 10.0, 1e-3),
        is_near(there[1], 3.0, 0.05),
        is_near(stage.at(body)[1], 0.2, 0.01),
    ])
}

fn a_body_without_its_support_falls(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let support = stage.dynamic(0.0, 0.2, square(0.2));
    let body = stage.dynamic(0.0, 0.6, square(0.2));
    stage.steps(180);
    stage.world.remove_body(support);
    stage.steps(60);
    is_near(stage.at(body)[1], 0.2, 0.01)
}

fn a_removed_floor_carries_no_more(stage: &mut Stage) -> Verdict {
    let floor = stage.floor(0.5);
    let body = stage.dynamic(0.0, 0.2, square(0.2));
    stage.steps(180);
    stage.world.remove_collider(floor);
    stage.steps(60);
    is_near(stage.at(body)[1], 0.2 - 0.5 * G, 0.3)
}

fn a_new_shape_counts_at_once(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let body = stage.dynamic(0.0, 1.0, square(0.2));
    stage.steps(5);
    let collider = stage.world.bodies[body].colliders()[0];
    let larger = SharedShape::cuboid(real(0.3), real(0.3));
    stage.world.colliders[collider].set_shape(larger);
    stage.steps(120);
    is_near(stage.at(body)[1], 0.3, 0.015)
}

fn a_second_collider_adds_mass(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let body = stage.dynamic(0.0, 0.0, square(0.5).density(real(1.0)));
    stage.step();
    let second = square(0.5).density(real(1.0)).translation(vec2(1.0, 0.0));
    stage.world.insert_collider(second, Some(body));
    stage.step();
    let mass = f64::from(stage.world.bodies[body].mass());
    stage.world.bodies[body].apply_impulse(vec2(2.0, 0.0), true);
    stage.steps(2);
    all([
        is_near(mass, 2.0, 1e-5),
        is_near(stage.velocity(body)[0], 1.0, 1e-3),
    ])
}

fn a_collider_may_change_its_parent(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let one = stage.dynamic(0.0, 0.0, square(0.2));
    let other = stage.dynamic(5.0, 0.0, square(0.2));
    stage.step();
    let collider = stage.world.bodies[one].colliders()[0];
    let world = &mut stage.world;
    world
        .colliders
        .set_parent(collider, Some(other), &mut world.bodies);
    stage.step();
    let n = stage.world.bodies[other].colliders().len();
    let mass = f64::from(stage.world.bodies[other].mass());
    all([
        verdict(n == 2, format!("{n} colliders")),
        is_near(mass, 0.32, 1e-3),
    ])
}

fn a_wall_that_moves_pushes_out_what_it_meets(stage: &mut Stage) -> Verdict {
    stage.floor(0.0);
    let wall = RigidBodyBuilder::fixed().translation(vec2(-2.0, 0.5));
    let (wall, _) = stage.world.insert(wall, square(0.5));
    // Awake: rapier lets a sleeper lie where a wall is put into it.
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(0.0, 0.2))
        .can_sleep(false);
    let body = stage.add(body, square(0.2).friction(real(0.0)));
    stage.steps(60);
    stage.world.bodies[wall].set_translation(vec2(-0.65, 0.5), true);
    stage.steps(120);
    let x = stage.at(body)[0];
    verdict(x > 0.03, format!("x = {x}"))
}

fn toggling_types_and_presence_keeps_all_finite(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let bodies: Vec<_> = (0..6)
        .map(|index| {
            stage.dynamic(
                0.3 * f64::from(index % 3),
                0.3 + 0.5 * f64::from(index / 3),
                square(0.2),
            )
        })
        .collect();
    let types = [
        RigidBodyType::Fixed,
        RigidBodyType::KinematicVelocityBased,
        RigidBodyType::Dynamic,
    ];
    for round in 0..60 {
        let body = bodies[round % bodies.len()];
        if round % 2 == 0 {
            stage.world.bodies[body].set_body_type(types[round / 2 % 3], true);
        } else {
            let is_enabled = stage.world.bodies[body].is_enabled();
            stage.world.bodies[body].set_enabled(!is_enabled);
        }
        stage.steps(2);
    }
    let farthest = bodies
        .iter()
        .map(|&body| stage.at(body)[0].hypot(stage.at(body)[1]))
        .fold(0.0, f64::max);
    verdict(farthest < 20.0, format!("at most {farthest} m away"))
}

behaviours!(
    a_body_made_fixed_stops_and_made_dynamic_falls
    a_disabled_body_is_not_there
    a_teleported_body_is_there_at_once
    a_body_without_its_support_falls
    a_removed_floor_carries_no_more
    a_new_shape_counts_at_once
    a_second_collider_adds_mass
    a_collider_may_change_its_parent
    a_wall_that_moves_pushes_out_what_it_meets
    toggling_types_and_presence_keeps_all_finite
);
