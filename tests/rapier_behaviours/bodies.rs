//! Properties of a rigid body: gravity, damping, axes, mass, forces, speed.

use crate::common::*;
use crate::support::*;

fn gravity_scale_scales_gravity(stage: &mut Stage) -> Verdict {
    let scales = [0.0, 1.0, 2.0, -1.0];
    let bodies: Vec<_> = scales
        .iter()
        .enumerate()
        .map(|(index, &scale)| {
            let body = RigidBodyBuilder::dynamic()
                .translation(vec2(3.0 * index as f64, 0.0))
                .gravity_scale(real(scale));
            stage.add(body, square(0.2))
        })
        .collect();
    stage.steps(60);
    let off = |index: usize| {
        // After one second; rapier counts half a step more.
        is_near(stage.at(bodies[index])[1], -scales[index] * 0.5 * G, 0.2)
    };
    all([off(0), off(1), off(2), off(3)])
}

fn linear_damping_slows(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let body = RigidBodyBuilder::dynamic()
        .linvel(vec2(10.0, 0.0))
        .linear_damping(real(2.0));
    let body = stage.add(body, square(0.2));
    stage.steps(60);
    // e⁻²; a step of first order is off by some 4 %.
    is_near(stage.velocity(body)[0], 10.0 * (-2.0f64).exp(), 0.1)
}

fn angular_damping_slows(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let body = RigidBodyBuilder::dynamic()
        .angvel(real(10.0))
        .angular_damping(real(2.0));
    let body = stage.add(body, square(0.2));
    stage.steps(60);
    is_near(stage.spin(body), 10.0 * (-2.0f64).exp(), 0.1)
}

fn locked_translations_stay(stage: &mut Stage) -> Verdict {
    let body = RigidBodyBuilder::dynamic()
        .lock_translations()
        .angvel(real(1.0));
    let body = stage.add(body, square(0.2));
    stage.steps(60);
    let [x, y] = stage.at(body);
    all([
        is_near(x.hypot(y), 0.0, 1e-6),
        is_near(stage.angle(body), 1.0, 0.01),
    ])
}

fn locked_rotations_do_not_turn(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let body = stage.add(RigidBodyBuilder::dynamic().lock_rotations(), square(0.2));
    let at = vec2(0.0, 0.2);
    stage.world.bodies[body].apply_impulse_at_point(vec2(0.16, 0.0), at, true);
    stage.steps(60);
    all([
        is_near(stage.angle(body), 0.0, 1e-6),
        is_near(stage.velocity(body)[0], 1.0, 1e-3),
    ])
}

fn one_enabled_axis_is_followed(stage: &mut Stage) -> Verdict {
    let body = RigidBodyBuilder::dynamic()
        .enabled_translations(true, false)
        .linvel(vec2(1.0, 0.0));
    let body = stage.add(body, square(0.2));
    stage.steps(60);
    let [x, y] = stage.at(body);
    all([is_near(x, 1.0, 1e-3), is_near(y, 0.0, 1e-6)])
}

fn additional_mass_counts(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let body = RigidBodyBuilder::dynamic().additional_mass(real(3.0));
    let shape = square(0.5).density(real(1.0));
    let body = stage.add(body, shape);
    stage.step();
    stage.world.bodies[body].apply_impulse(vec2(8.0, 0.0), true);
    stage.steps(2);
    is_near(stage.velocity(body)[0], 2.0, 1e-3)
}

fn the_centre_of_mass_is_that_of_the_colliders(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let shape = square(0.2).translation(vec2(1.0, 0.0));
    let body = stage.add(RigidBodyBuilder::dynamic().angvel(real(2.0)), shape);
    stage.steps(60);
    let centre = stage.world.bodies[body].center_of_mass();
    let [x, y] = stage.at(body);
    // The body's origin goes round the centre of mass, which stays.
    let reach = (x - 1.0).hypot(y);
    all([
        is_near(f64::from(centre.x), 1.0, 1e-4),
        is_near(reach, 1.0, 1e-3),
        is_near(stage.angle(body), 2.0, 0.01),
    ])
}

fn a_user_force_acts_until_it_is_reset(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let shape = square(0.5).density(real(2.0));
    let body = stage.add(RigidBodyBuilder::dynamic(), shape);
    stage.world.bodies[body].add_force(vec2(4.0, 0.0), true);
    stage.steps(60);
    let pushed = stage.velocity(body)[0];
    stage.world.bodies[body].reset_forces(true);
    stage.steps(60);
    all([
        is_near(pushed, 2.0, 0.01),
        is_near(stage.velocity(body)[0], pushed, 1e-3),
    ])
}

fn a_user_torque_turns(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    // A square of 1 m and 6 kg: 1 kg m².
    let shape = square(0.5).density(real(6.0));
    let body = stage.add(RigidBodyBuilder::dynamic(), shape);
    stage.world.bodies[body].add_torque(real(0.5), true);
    stage.steps(60);
    is_near(stage.spin(body), 0.5, 0.01)
}

fn an_impulse_off_centre_turns_and_moves(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let shape = square(0.5).density(real(6.0));
    let body = stage.add(RigidBodyBuilder::dynamic(), shape);
    stage.step();
    stage.world.bodies[body].apply_impulse_at_point(vec2(6.0, 0.0), vec2(0.0, -0.5), true);
    stage.steps(2);
    all([
        is_near(stage.velocity(body)[0], 1.0, 1e-3),
        is_near(stage.spin(body), 3.0, 1e-2),
    ])
}

fn the_linear_speed_is_capped(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let cap = f64::from(stage.world.integration_parameters.max_linear_velocity());
    let body = RigidBodyBuilder::dynamic().linvel(vec2(10_000.0, 0.0));
    let body = stage.add(body, square(0.2));
    stage.step();
    is_near(stage.velocity(body)[0], cap, 1.0)
}

fn the_angular_speed_is_capped(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let body = stage.add(RigidBodyBuilder::dynamic().angvel(real(500.0)), square(0.2));
    stage.step();
    is_near(stage.spin(body), 0.25 * std::f64::consts::PI / DT, 2.0)
}

fn fast_rotation_is_kept_where_it_is_allowed(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let body = RigidBodyBuilder::dynamic()
        .angvel(real(500.0))
        .allow_fast_rotation(true);
    let body = stage.add(body, square(0.2));
    stage.steps(10);
    is_near(stage.spin(body), 500.0, 1.0)
}

fn a_dominant_body_does_not_feel_the_other(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let dominant = RigidBodyBuilder::dynamic()
        .dominance_group(10)
        .linvel(vec2(1.0, 0.0));
    let dominant = stage.add(dominant, square(0.2).friction(real(0.0)));
    let heavy = square(0.2).density(real(100.0)).friction(real(0.0));
    let heavy = stage.dynamic(0.6, 0.0, heavy);
    stage.steps(60);
    all([
        is_near(stage.velocity(dominant)[0], 1.0, 1e-3),
        verdict(
            stage.at(heavy)[0] > 1.0,
            format!("pushed to {}", stage.at(heavy)[0]),
        ),
    ])
}

fn several_colliders_are_one_body(stage: &mut Stage) -> Verdict {
    // A table on two legs.
    stage.floor(0.5);
    let leg = |x: f64| {
        ColliderBuilder::cuboid(real(0.1), real(0.3))
            .translation(vec2(x, -0.3))
            .density(real(10.0))
    };
    let top = ColliderBuilder::cuboid(real(1.0), real(0.1)).translation(vec2(0.0, 0.1));
    let table = stage.dynamic(0.0, 0.61, top.density(real(10.0)));
    for x in [-0.9, 0.9] {
        stage.world.insert_collider(leg(x), Some(table));
    }
    let load = stage.dynamic(0.0, 1.0, square(0.15).density(real(10.0)));
    stage.steps(120);
    all([
        is_near(stage.at(table)[1], 0.6, 0.01),
        is_near(stage.at(load)[1], 0.95, 0.015),
        is_near(stage.angle(table), 0.0, 0.01),
    ])
}

fn a_step_without_length_moves_nothing(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let body = stage.dynamic(0.0, 1.0, square(0.2));
    stage.steps(10);
    let (before, speed) = (stage.at(body), stage.velocity(body));
    stage.world.integration_parameters.dt = real(0.0);
    stage.steps(3);
    let after = (stage.at(body), stage.velocity(body));
    stage.world.integration_parameters.dt = real(DT);
    stage.steps(120);
    all([
        verdict(
            after == (before, speed),
            format!("{before:?} {:?}", after.0),
        ),
        is_near(stage.at(body)[1], 0.2, 0.01),
    ])
}

behaviours!(
    gravity_scale_scales_gravity
    linear_damping_slows
    angular_damping_slows
    locked_translations_stay
    locked_rotations_do_not_turn
    one_enabled_axis_is_followed
    additional_mass_counts
    the_centre_of_mass_is_that_of_the_colliders
    a_user_force_acts_until_it_is_reset
    a_user_torque_turns
    an_impulse_off_centre_turns_and_moves
    the_linear_speed_is_capped
    the_angular_speed_is_capped
    fast_rotation_is_kept_where_it_is_allowed
    a_dominant_body_does_not_feel_the_other
    several_colliders_are_one_body
    a_step_without_length_moves_nothing
);
