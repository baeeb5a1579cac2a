//! Joints of every kind, their limits and motors, and what is done to them between steps.

use crate::common::*;
use crate::support::*;

/// A fixed body at the origin and a box of 1 kg at a place; ties and joints are the caller's.
fn pair(stage: &mut Stage, x: f64, y: f64) -> [RigidBodyHandle; 2] {
    let base = stage.world.insert_body(RigidBodyBuilder::fixed());
    let shape = square(0.1).density(real(25.0));
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(x, y))
        .can_sleep(false);
    [base, stage.add(body, shape)]
}

fn a_fixed_joint_holds(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 1.0, 0.0);
    let weld = FixedJointBuilder::new().local_anchor1(vec2(1.0, 0.0));
    stage.join(base, body, weld);
    stage.steps(120);
    let [x, y] = stage.at(body);
    all([
        is_near((x - 1.0).hypot(y), 0.0, 5e-3),
        is_near(stage.angle(body), 0.0, 5e-3),
    ])
}

/// How far a body comes off the circle of 1 m in two seconds, and how low it comes (m).
fn swing(stage: &mut Stage, body: RigidBodyHandle) -> [f64; 2] {
    let (mut longest, mut lowest) = (0.0f64, 0.0f64);
    for _ in 0..120 {
        stage.step();
        let [x, y] = stage.at(body);
        longest = longest.max((x.hypot(y) - 1.0).abs());
        lowest = lowest.min(y);
    }
    [longest, lowest]
}

fn a_hinge_keeps_its_length_and_swings(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 1.0, 0.0);
    let hinge = RevoluteJointBuilder::new().local_anchor2(vec2(-1.0, 0.0));
    stage.join(base, body, hinge);
    let [longest, lowest] = swing(stage, body);
    all([is_near(longest, 0.0, 5e-3), is_near(lowest, -1.0, 0.02)])
}

fn a_slider_moves_along_its_axis_only(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 0.0, 0.0);
    stage.join(base, body, PrismaticJointBuilder::new(vec2(0.6, -0.8)));
    stage.steps(60);
    let [x, y] = stage.at(body);
    // g sin over one second, half a step more with rapier.
    all([
        is_near(0.8 * x + 0.6 * y, 0.0, 5e-3),
        is_near(0.6 * x - 0.8 * y, 0.5 * 0.8 * G, 0.1),
        is_near(stage.angle(body), 0.0, 5e-3),
    ])
}

fn limits_stop_a_slider(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 0.0, 0.0);
    let joint = PrismaticJointBuilder::new(vec2(0.0, 1.0)).limits([real(-0.5), real(0.5)]);
    stage.join(base, body, joint);
    stage.steps(180);
    is_near(stage.at(body)[1], -0.5, 0.01)
}

fn limits_stop_a_hinge(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 1.0, 0.0);
    let joint = RevoluteJointBuilder::new()
        .local_anchor2(vec2(-1.0, 0.0))
        .limits([real(-0.5), real(0.5)]);
    stage.join(base, body, joint);
    stage.steps(180);
    is_near(stage.angle(body), -0.5, 0.02)
}

fn a_motor_drives_a_hinge_to_its_limits(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let reached = [-0.8, 1.2].map(|limit: f64| {
        let [base, body] = pair(stage, 1.0, 0.0);
        let groups = InteractionGroups::none();
        let collider = stage.world.bodies[body].colliders()[0];
        stage.world.colliders[collider].set_collision_groups(groups);
        let joint = RevoluteJointBuilder::new()
            .local_anchor2(vec2(-1.0, 0.0))
            .limits([real(-0.8), real(1.2)])
            .motor_velocity(real(2.0 * limit.signum()), real(1e4));
        stage.join(base, body, joint);
        stage.steps(180);
        is_near(stage.angle(body), limit, 0.05)
    });
    all(reached)
}

fn a_rope_ends(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 0.0, -0.5);
    stage.join(base, body, RopeJointBuilder::new(real(1.0)));
    let mut farthest = 0.0f64;
    for _ in 0..120 {
        stage.step();
        let [x, y] = stage.at(body);
        farthest = farthest.max(x.hypot(y));
    }
    // Rapier lets a rope give while it takes up the fall.
    all([
        is_near(farthest, 1.0, 0.06),
        is_near(stage.at(body)[1], -1.0, 0.02),
    ])
}

fn a_spring_carries_the_weight(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 0.0, -1.0);
    let spring = SpringJointBuilder::new(real(1.0), real(100.0), real(20.0))
        .spring_model(MotorModel::ForceBased);
    stage.join(base, body, spring);
    stage.steps(300);
    is_near(stage.at(body)[1], -1.0 - G / 100.0, 5e-3)
}

fn a_pin_slides_and_turns_in_its_slot(stage: &mut Stage) -> Verdict {
    let base = stage.world.insert_body(RigidBodyBuilder::fixed());
    let body = RigidBodyBuilder::dynamic()
        .linvel(vec2(1.0, 0.0))
        .angvel(real(2.0))
        .can_sleep(false);
    let body = stage.add(body, square(0.1));
    stage.join(base, body, PinSlotJointBuilder::new(vec2(1.0, 0.0)));
    stage.steps(60);
    let [x, y] = stage.at(body);
    all([
        is_near(y, 0.0, 1e-3),
        is_near(x, 1.0, 0.05),
        is_near(stage.spin(body), 2.0, 0.1),
    ])
}

fn a_generic_joint_locks_the_turn_alone(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 0.0, 0.0);
    stage.join(base, body, GenericJointBuilder::new(JointAxesMask::ANG_X));
    stage.world.bodies[body].apply_torque_impulse(real(0.1), true);
    stage.steps(60);
    all([
        is_near(stage.angle(body), 0.0, 5e-3),
        is_near(stage.at(body)[1], -0.5 * G, 0.1),
    ])
}

fn a_motor_reaches_its_speed(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let [base, body] = pair(stage, 0.0, 0.0);
    let joint = RevoluteJointBuilder::new().motor_velocity(real(3.0), real(10.0));
    stage.join(base, body, joint);
    stage.steps(120);
    is_near(stage.spin(body), 3.0, 0.01)
}

fn a_motor_reaches_its_position(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let [base, body] = pair(stage, 0.0, 0.0);
    let joint = PrismaticJointBuilder::new(vec2(1.0, 0.0)).motor_position(
        real(0.7),
        real(60.0),
        real(15.0),
    );
    stage.join(base, body, joint);
    stage.steps(240);
    is_near(stage.at(body)[0], 0.7, 1e-2)
}

fn a_motor_too_weak_does_not_lift(stage: &mut Stage) -> Verdict {
    let lifts = [0.9, 1.2].map(|share| {
        let [base, body] = pair(stage, 0.0, 0.0);
        let joint = PrismaticJointBuilder::new(vec2(0.0, 1.0))
            .motor_velocity(real(1.0), real(1000.0))
            .motor_max_force(real(share * G));
        stage.join(base, body, joint);
        stage.steps(60);
        stage.at(body)[1]
    });
    verdict(lifts[0] < -0.2 && lifts[1] > 0.2, format!("{lifts:?}"))
}

fn joined_bodies_touch_only_if_the_joint_allows(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let apart = [false, true].map(|touch| {
        let y = if touch { 10.0 } else { 0.0 };
        let one = stage.dynamic(-0.15, y, square(0.2));
        let other = stage.dynamic(0.15, y, square(0.2));
        let joint = RopeJointBuilder::new(real(5.0)).contacts_enabled(touch);
        stage.join(one, other, joint);
        stage.steps(60);
        stage.at(other)[0] - stage.at(one)[0]
    });
    all([is_near(apart[0], 0.3, 1e-3), is_near(apart[1], 0.4, 0.02)])
}

fn one_of_two_joints_is_enough_to_forbid_contacts(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let apart = [true, false].map(|first| {
        let y = if first { 10.0 } else { 0.0 };
        let one = stage.dynamic(-0.15, y, square(0.2));
        let other = stage.dynamic(0.15, y, square(0.2));
        for touch in [first, !first] {
            let joint = RopeJointBuilder::new(real(5.0)).contacts_enabled(touch);
            stage.join(one, other, joint);
        }
        stage.steps(60);
        is_near(stage.at(other)[0] - stage.at(one)[0], 0.3, 1e-3)
    });
    all(apart)
}

fn a_removed_joint_holds_no_more(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 0.0, -1.0);
    let rope = stage.join(base, body, RopeJointBuilder::new(real(1.0)));
    stage.steps(60);
    let hanging = stage.at(body)[1];
    stage.world.impulse_joints.remove(rope, true);
    stage.steps(60);
    all([
        is_near(hanging, -1.0, 0.02),
        is_near(stage.at(body)[1], hanging - 0.5 * G, 0.2),
    ])
}

fn a_joint_that_is_changed_acts_anew(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 0.0, 0.0);
    let joint = PrismaticJointBuilder::new(vec2(0.0, 1.0)).limits([real(-0.5), real(0.5)]);
    let joint = stage.join(base, body, joint);
    stage.steps(120);
    let first = stage.at(body)[1];
    let data = stage.world.impulse_joints.get_mut(joint, true);
    let data = &mut data.expect("the joint is there").data;
    data.set_limits(JointAxis::LinX, [real(-1.0), real(0.5)]);
    stage.steps(120);
    all([
        is_near(first, -0.5, 0.01),
        is_near(stage.at(body)[1], -1.0, 0.01),
    ])
}

fn a_joint_that_is_disabled_lets_go(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 0.0, -1.0);
    let rope = stage.join(base, body, RopeJointBuilder::new(real(1.0)));
    stage.steps(30);
    let joint = stage.world.impulse_joints.get_mut(rope, true);
    joint.expect("the joint is there").data.set_enabled(false);
    stage.steps(60);
    is_near(stage.at(body)[1], -1.0 - 0.5 * G, 0.2)
}

fn a_fixed_anchor_that_is_moved_takes_the_body_along(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 0.0, -1.0);
    let weld = FixedJointBuilder::new().local_anchor1(vec2(0.0, -1.0));
    stage.join(base, body, weld);
    stage.steps(30);
    stage.world.bodies[base].set_translation(vec2(0.3, 0.0), true);
    stage.steps(120);
    let [x, y] = stage.at(body);
    all([is_near(x, 0.3, 0.01), is_near(y, -1.0, 0.01)])
}

fn a_jointed_body_may_become_fixed(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 1.0, 0.0);
    let hinge = RevoluteJointBuilder::new().local_anchor2(vec2(-1.0, 0.0));
    stage.join(base, body, hinge);
    stage.steps(10);
    stage.world.bodies[body].set_body_type(RigidBodyType::Fixed, true);
    stage.step();
    let before = stage.at(body);
    stage.steps(60);
    verdict(stage.at(body) == before, format!("{before:?}"))
}

fn a_chain_hangs_together(stage: &mut Stage) -> Verdict {
    let mut last = stage.world.insert_body(RigidBodyBuilder::fixed());
    let mut links = Vec::new();
    for index in 0..10 {
        let body = RigidBodyBuilder::dynamic().translation(vec2(0.1 + 0.2 * f64::from(index), 0.0));
        let link = stage.add(body, ColliderBuilder::cuboid(real(0.08), real(0.02)));
        let near = if index == 0 { 0.0 } else { 0.1 };
        let hinge = RevoluteJointBuilder::new()
            .local_anchor1(vec2(near, 0.0))
            .local_anchor2(vec2(-0.1, 0.0))
            .contacts_enabled(false);
        stage.join(last, link, hinge);
        links.push(link);
        last = link;
    }
    let mut longest = 0.0f64;
    for _ in 0..180 {
        stage.step();
        let [x, y] = stage.at(last);
        longest = longest.max(x.hypot(y));
    }
    // 1.9 m to the middle of the last link.
    verdict(longest < 1.95, format!("reaches {longest} m of 1.9"))
}

fn a_multibody_hinge_swings(stage: &mut Stage) -> Verdict {
    let [base, body] = pair(stage, 1.0, 0.0);
    let hinge = RevoluteJointBuilder::new().local_anchor2(vec2(-1.0, 0.0));
    stage.world.multibody_joints.insert(base, body, hinge, true);
    let [longest, lowest] = swing(stage, body);
    // Rapier brakes what turns in a multibody.
    all([is_near(longest, 0.0, 1e-3), is_near(lowest, -1.0, 0.02)])
}

behaviours!(
    a_fixed_joint_holds
    a_hinge_keeps_its_length_and_swings
    a_slider_moves_along_its_axis_only
    limits_stop_a_slider
    limits_stop_a_hinge
    a_motor_drives_a_hinge_to_its_limits
    a_rope_ends
    a_spring_carries_the_weight
    a_pin_slides_and_turns_in_its_slot
    a_generic_joint_locks_the_turn_alone
    a_motor_reaches_its_speed
    a_motor_reaches_its_position
    a_motor_too_weak_does_not_lift
    joined_bodies_touch_only_if_the_joint_allows
    one_of_two_joints_is_enough_to_forbid_contacts
    a_removed_joint_holds_no_more
    a_joint_that_is_changed_acts_anew
    a_joint_that_is_disabled_lets_go
    a_fixed_anchor_that_is_moved_takes_the_body_along
    a_jointed_body_may_become_fixed
    a_chain_hangs_together
    a_multibody_hinge_swings
);
