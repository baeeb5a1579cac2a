//! Contacts: friction and restitution rules, groups, shapes, fast bodies, kinematic ones.

use crate::common::*;
use crate::support::*;

/// Upward speed after a ball of 0.2 m has hit the floor at 5 m/s.
fn rebound(stage: &mut Stage, floor: ColliderBuilder, ball: ColliderBuilder, x: f64) -> f64 {
    stage.fixed(floor.translation(vec2(x, -0.5)));
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(x, 0.5))
        .linvel(vec2(0.0, -5.0));
    let body = stage.add(body, ball);
    let mut fastest = f64::NEG_INFINITY;
    for _ in 0..20 {
        stage.step();
        fastest = fastest.max(stage.velocity(body)[1]);
    }
    fastest
}

fn restitution_rules_combine(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let rules = [
        (CoefficientCombineRule::Average, 0.6),
        (CoefficientCombineRule::Min, 0.4),
        (CoefficientCombineRule::Multiply, 0.32),
        (CoefficientCombineRule::Max, 0.8),
    ];
    let mut slot = 0.0;
    all(rules.map(|(rule, expected)| {
        let floor = ColliderBuilder::cuboid(real(1.0), real(0.5))
            .restitution(real(0.4))
            .restitution_combine_rule(rule);
        let ball = ColliderBuilder::ball(real(0.2)).restitution(real(0.8));
        slot += 5.0;
        is_near(rebound(stage, floor, ball, slot), 5.0 * expected, 0.05)
    }))
}

fn friction_rules_combine(stage: &mut Stage) -> Verdict {
    let rules = [
        (CoefficientCombineRule::Average, 0.3),
        (CoefficientCombineRule::Min, 0.1),
        (CoefficientCombineRule::Multiply, 0.05),
        (CoefficientCombineRule::Max, 0.5),
    ];
    let mut slot = 0.0;
    all(rules.map(|(rule, expected)| {
        slot -= 20.0;
        let floor = ColliderBuilder::cuboid(real(8.0), real(0.5))
            .translation(vec2(slot, -0.5))
            .friction(real(0.1))
            .friction_combine_rule(rule);
        stage.fixed(floor);
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(slot, 0.1))
            .linvel(vec2(3.0, 0.0));
        let shape = ColliderBuilder::cuboid(real(0.4), real(0.1)).friction(real(0.5));
        let body = stage.add(body, shape);
        stage.steps(30);
        is_near(stage.velocity(body)[0], 3.0 - 0.5 * expected * G, 0.1)
    }))
}

fn a_slope_holds_what_its_friction_allows(stage: &mut Stage) -> Verdict {
    // tan 20° = 0.364.
    let angle = 20.0f64.to_radians();
    let down = |stage: &mut Stage, friction: f64| {
        let slope = ColliderBuilder::cuboid(real(20.0), real(0.5))
            .rotation(real(angle))
            .translation(vec2(0.5 * angle.sin(), -0.5 * angle.cos()))
            .friction(real(friction));
        let slope = stage.fixed(slope);
        let at = [-0.2 * angle.sin(), 0.2 * angle.cos()];
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(at[0], at[1]))
            .rotation(real(angle));
        let body = stage.add(body, square(0.2).friction(real(friction)));
        stage.steps(60);
        let [x, y] = stage.at(body);
        let world = &mut stage.world;
        world.remove_collider(slope);
        world.remove_body(body);
        (x - at[0]).hypot(y - at[1])
    };
    let slides = 0.5 * G * (angle.sin() - 0.2 * angle.cos());
    all([
        is_near(down(stage, 0.2), slides, 0.1),
        is_near(down(stage, 0.5), 0.0, 0.01),
    ])
}

fn a_large_prediction_distance_keeps_restitution(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let parameters = &mut stage.world.integration_parameters;
    parameters.normalized_prediction_distance = real(0.5);
    let floor = ColliderBuilder::cuboid(real(1.0), real(0.5)).restitution(real(1.0));
    let ball = ColliderBuilder::ball(real(0.2)).restitution(real(1.0));
    is_near(rebound(stage, floor, ball, 0.0), 5.0, 0.1)
}

fn group(own: Group, others: Group) -> InteractionGroups {
    InteractionGroups::new(own, others, InteractionTestMode::And)
}

fn collision_groups_keep_apart(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let bodies = [Group::GROUP_1, Group::GROUP_2].map(|own| {
        let shape = square(0.2).collision_groups(group(own, !(Group::GROUP_1 | Group::GROUP_2)));
        stage.dynamic(0.0, 0.2, shape)
    });
    stage.steps(60);
    let [a, b] = bodies.map(|body| stage.at(body));
    all([
        is_near((a[0] - b[0]).hypot(a[1] - b[1]), 0.0, 1e-3),
        is_near(a[1], 0.2, 0.01),
    ])
}

fn solver_groups_let_through(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let shape = square(0.2).solver_groups(InteractionGroups::none());
    let ghost = stage.dynamic(0.0, 0.5, shape);
    stage.steps(60);
    verdict(stage.at(ghost)[1] < -2.0, format!("{:?}", stage.at(ghost)))
}

fn a_changed_group_counts_at_once(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let body = stage.dynamic(0.0, 0.2, square(0.2));
    stage.steps(30);
    let collider = stage.world.bodies[body].colliders()[0];
    stage.world.colliders[collider].set_collision_groups(InteractionGroups::none());
    stage.world.bodies[body].wake_up(true);
    stage.steps(30);
    verdict(stage.at(body)[1] < -0.5, format!("{:?}", stage.at(body)))
}

fn a_bullet_does_not_tunnel(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    stage.fixed(ColliderBuilder::cuboid(real(0.02), real(5.0)).translation(vec2(5.0, 0.0)));
    let bullet = RigidBodyBuilder::dynamic()
        .linvel(vec2(200.0, 0.0))
        .ccd_enabled(true);
    let bullet = stage.add(bullet, ColliderBuilder::ball(real(0.05)));
    stage.steps(30);
    let x = stage.at(bullet)[0];
    verdict(x < 5.0, format!("x = {x}"))
}

fn a_bullet_hits_a_thin_dynamic_body(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let plate = ColliderBuilder::cuboid(real(0.02), real(1.0)).density(real(50.0));
    let plate = stage.dynamic(5.0, 0.0, plate);
    let bullet = RigidBodyBuilder::dynamic()
        .linvel(vec2(200.0, 0.0))
        .ccd_enabled(true);
    let bullet = stage.add(bullet, ColliderBuilder::ball(real(0.05)));
    stage.steps(30);
    let (x, wall) = (stage.at(bullet)[0], stage.at(plate)[0]);
    all([
        verdict(x < wall, format!("{x} before {wall}")),
        verdict(stage.velocity(plate)[0] > 0.1, "it is pushed"),
    ])
}

fn a_fast_body_on_a_floor_slides_on(stage: &mut Stage) -> Verdict {
    stage.floor(0.0);
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(-5.0, 0.19))
        .linvel(vec2(50.0, 0.0));
    let body = stage.add(body, ColliderBuilder::ball(real(0.2)).friction(real(0.0)));
    stage.steps(30);
    let x = stage.at(body)[0];
    verdict(x > 10.0, format!("x = {x}"))
}

fn a_box_slides_over_the_joints_of_a_polyline(stage: &mut Stage) -> Verdict {
    // Oriented: what is on the right of a segment is solid, so the points run to the left.
    let points = (-2..=38).rev().map(|i| vec2(f64::from(i), 0.0)).collect();
    stage.fixed(ColliderBuilder::oriented_polyline(points, None).friction(real(0.0)));
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(0.0, 0.21))
        .lock_rotations();
    let body = stage.add(body, square(0.2).friction(real(0.0)));
    stage.steps(30);
    let (mut highest, mut lowest, mut slowest) = (0.0f64, 1.0f64, f64::INFINITY);
    let mut last = stage.at(body)[0];
    for _ in 0..300 {
        let falling = stage.world.bodies[body].linvel().y;
        let push = Vector::new(real(2.0), falling);
        stage.world.bodies[body].set_linvel(push, true);
        stage.step();
        let [x, y] = stage.at(body);
        (highest, lowest) = (highest.max(y), lowest.min(y));
        slowest = slowest.min((x - last) / DT);
        last = x;
    }
    all([
        verdict(
            slowest > 1.5,
            format!("never slower than {slowest} m/s, to {last} m"),
        ),
        is_near(highest, 0.2, 0.05),
        is_near(lowest, 0.2, 0.05),
    ])
}

fn a_ball_rolls_over_a_heightfield(stage: &mut Stage) -> Verdict {
    let heights = vec![real(0.0); 21];
    stage.fixed(ColliderBuilder::heightfield(heights, vec2(20.0, 1.0)));
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(-8.0, 0.25))
        .linvel(vec2(4.0, 0.0));
    let body = stage.add(body, ColliderBuilder::ball(real(0.25)).friction(real(0.5)));
    stage.steps(120);
    all([
        is_near(stage.at(body)[1], 0.25, 0.02),
        // It rolls: rapier loses some of the way at the joints of the field.
        is_near(stage.spin(body), -stage.velocity(body)[0] / 0.25, 0.5),
        verdict(stage.velocity(body)[0] > 2.0, "it goes on"),
    ])
}

fn a_compound_shape_rests_on_its_parts(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let parts = [-0.5, 0.5].map(|x| {
        (
            Pose::translation(real(x), real(0.0)),
            SharedShape::ball(real(0.2)),
        )
    });
    let body = stage.dynamic(0.0, 0.4, ColliderBuilder::compound(parts.to_vec()));
    stage.steps(120);
    all([
        is_near(stage.at(body)[1], 0.2, 0.01),
        is_near(stage.angle(body), 0.0, 0.02),
    ])
}

fn a_contact_skin_keeps_a_distance(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let body = stage.dynamic(0.0, 0.3, square(0.2).contact_skin(real(0.05)));
    stage.steps(120);
    is_near(stage.at(body)[1], 0.25, 0.01)
}

fn a_stack_stands(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let boxes: Vec<_> = (0..5)
        .map(|level| stage.dynamic(0.0, 0.2 + 0.4 * f64::from(level), square(0.2)))
        .collect();
    stage.steps(240);
    let [x, y] = stage.at(boxes[4]);
    all([is_near(x, 0.0, 0.01), is_near(y, 1.8, 0.02)])
}

fn a_stack_stands_on_a_large_ground(stage: &mut Stage) -> Verdict {
    let ground = ColliderBuilder::cuboid(real(1e4), real(10.0)).translation(vec2(0.0, -10.0));
    stage.fixed(ground);
    let boxes: Vec<_> = (0..3)
        .map(|level| stage.dynamic(0.0, 0.5 + f64::from(level), square(0.5)))
        .collect();
    stage.steps(240);
    let [x, y] = stage.at(boxes[2]);
    all([is_near(x, 0.0, 0.02), is_near(y, 2.5, 0.03)])
}

fn a_kinematic_body_pushes(stage: &mut Stage) -> Verdict {
    stage.floor(0.0);
    let positions = [true, false].map(|is_position_based| {
        let side = if is_position_based { 10.0 } else { -10.0 };
        let pusher = if is_position_based {
            RigidBodyBuilder::kinematic_position_based()
        } else {
            RigidBodyBuilder::kinematic_velocity_based()
        };
        let pusher = pusher.translation(vec2(side - 0.5, 0.3));
        let (pusher, _) = stage.world.insert(pusher, square(0.2));
        let body = stage.dynamic(side, 0.2, square(0.2).friction(real(0.0)));
        for step in 1..=60 {
            let moved = f64::from(step) / 60.0;
            let pusher = &mut stage.world.bodies[pusher];
            if is_position_based {
                pusher.set_next_kinematic_translation(vec2(side - 0.5 + moved, 0.3));
            } else {
                pusher.set_linvel(vec2(1.0, 0.0), true);
            }
            stage.step();
        }
        stage.at(body)[0] - stage.at(pusher)[0]
    });
    verdict(
        positions.iter().all(|&apart| apart > 0.38),
        format!("apart by {positions:?} m"),
    )
}

fn a_moving_platform_carries(stage: &mut Stage) -> Verdict {
    let platform = RigidBodyBuilder::kinematic_velocity_based().linvel(vec2(1.0, 0.0));
    let shape = ColliderBuilder::cuboid(real(3.0), real(0.1)).friction(real(1.0));
    stage.world.insert(platform, shape);
    let body = stage.dynamic(0.0, 0.3, square(0.2).friction(real(1.0)));
    stage.steps(120);
    is_near(stage.velocity(body)[0], 1.0, 0.02)
}

behaviours!(
    restitution_rules_combine
    friction_rules_combine
    a_slope_holds_what_its_friction_allows
    a_large_prediction_distance_keeps_restitution
    collision_groups_keep_apart
    solver_groups_let_through
    a_changed_group_counts_at_once
    a_bullet_does_not_tunnel
    a_bullet_hits_a_thin_dynamic_body
    a_fast_body_on_a_floor_slides_on
    a_box_slides_over_the_joints_of_a_polyline
    a_ball_rolls_over_a_heightfield
    a_compound_shape_rests_on_its_parts
    a_contact_skin_keeps_a_distance
    a_stack_stands
    a_stack_stands_on_a_large_ground
    a_kinematic_body_pushes
    a_moving_platform_carries
);
