//! Sleep and waking.

use crate::common::*;
use crate::support::*;

fn what_rests_sleeps(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let body = stage.dynamic(0.0, 0.25, square(0.2));
    stage.steps(300);
    verdict(
        stage.sleeps(body),
        format!("asleep: {}", stage.sleeps(body)),
    )
}

fn what_may_not_sleep_stays_awake(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(0.0, 0.2))
        .can_sleep(false);
    let body = stage.add(body, square(0.2));
    stage.steps(300);
    verdict(
        !stage.sleeps(body),
        format!("asleep: {}", stage.sleeps(body)),
    )
}

fn a_touch_wakes(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let body = stage.dynamic(0.0, 0.2, square(0.2));
    stage.steps(300);
    let before = stage.sleeps(body);
    stage.dynamic(0.0, 1.0, ColliderBuilder::ball(real(0.1)));
    let mut woke = false;
    for _ in 0..60 {
        stage.step();
        woke |= !stage.sleeps(body);
    }
    verdict(before && woke, format!("slept: {before}, woke: {woke}"))
}

fn an_impulse_wakes(stage: &mut Stage) -> Verdict {
    stage.floor(0.0);
    let body = stage.dynamic(0.0, 0.2, square(0.2).friction(real(0.0)));
    stage.steps(300);
    let before = stage.sleeps(body);
    let mass = stage.world.bodies[body].mass();
    stage.world.bodies[body].apply_impulse(vec2(1.0, 0.0) * mass, true);
    stage.steps(30);
    all([
        verdict(before, format!("slept: {before}")),
        is_near(stage.velocity(body)[0], 1.0, 0.05),
    ])
}

fn manual_sleep_is_honoured(stage: &mut Stage) -> Verdict {
    // Not tied: a joint to what is awake wakes.
    let body = RigidBodyBuilder::dynamic().translation(vec2(0.0, 5.0));
    let (body, _) = stage.world.insert(body, square(0.2));
    stage.steps(2);
    let before = stage.at(body);
    stage.world.bodies[body].sleep();
    stage.steps(30);
    let is_kept = (stage.at(body)[1] - before[1]).abs() < 0.01;
    verdict(is_kept, format!("{before:?}, then {:?}", stage.at(body)))
}

fn a_body_inserted_asleep_waits(stage: &mut Stage) -> Verdict {
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(0.0, 5.0))
        .sleeping(true);
    let (body, _) = stage.world.insert(body, square(0.2));
    stage.steps(30);
    is_near(stage.at(body)[1], 5.0, 1e-6)
}

fn a_joint_wakes_the_other_end(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let one = stage.dynamic(-0.5, 0.2, square(0.2));
    let other = stage.dynamic(0.5, 0.2, square(0.2));
    stage.join(one, other, RopeJointBuilder::new(real(1.0)));
    stage.steps(300);
    let slept = stage.sleeps(one) && stage.sleeps(other);
    stage.world.bodies[one].set_linvel(vec2(-1.0, 0.0), true);
    stage.step();
    let wakes = !stage.sleeps(other);
    verdict(slept && wakes, format!("slept: {slept}, woke: {wakes}"))
}

fn a_moved_support_wakes(stage: &mut Stage) -> Verdict {
    let floor = RigidBodyBuilder::fixed().translation(vec2(0.0, -0.5));
    let floor_shape = ColliderBuilder::cuboid(real(5.0), real(0.5));
    let (floor, _) = stage.world.insert(floor, floor_shape);
    let body = stage.dynamic(0.0, 0.2, square(0.2));
    stage.steps(300);
    let slept = stage.sleeps(body);
    stage.world.bodies[floor].set_translation(vec2(0.0, -2.5), true);
    stage.steps(120);
    all([
        verdict(slept, format!("slept: {slept}")),
        is_near(stage.at(body)[1], -1.8, 0.01),
    ])
}

behaviours!(
    what_rests_sleeps
    what_may_not_sleep_stays_awake
    a_touch_wakes
    an_impulse_wakes
    a_joint_wakes_the_other_end
    a_moved_support_wakes
    ; unclaimed
    a_body_inserted_asleep_waits
    manual_sleep_is_honoured
);
