//! What handlers are told, what hooks decide, what queries see.

use crate::common::*;
use crate::support::*;

fn a_collision_starts_and_stops(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let shape = square(0.2).active_events(ActiveEvents::COLLISION_EVENTS);
    let body = stage.dynamic(0.0, 0.5, shape);
    stage.steps(60);
    let landed = stage.heard.starts_and_stops();
    stage.world.bodies[body].set_translation(vec2(0.0, 50.0), true);
    stage.steps(2);
    let gone = stage.heard.starts_and_stops();
    all([
        verdict(landed.0 == landed.1 + 1, format!("{landed:?}")),
        verdict(gone.0 == gone.1, format!("{gone:?}")),
    ])
}

fn a_removed_body_stops_its_collision(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let shape = square(0.2).active_events(ActiveEvents::COLLISION_EVENTS);
    let body = stage.dynamic(0.0, 0.2, shape);
    stage.steps(30);
    let before = stage.heard.starts_and_stops();
    stage.world.remove_body(body);
    stage.steps(2);
    let after = stage.heard.starts_and_stops();
    verdict(
        before == (1, 0) && after == (1, 1),
        format!("{before:?}, then {after:?}"),
    )
}

/// Forces told of a box of 10 kg, 98 N at rest, that stands on the floor for so many steps.
fn forces_of_a_standing_box(stage: &mut Stage, threshold: f64, n_steps: usize) -> Vec<f64> {
    stage.floor(0.5);
    let shape = square(0.5)
        .density(real(10.0))
        .active_events(ActiveEvents::CONTACT_FORCE_EVENTS)
        .contact_force_event_threshold(real(threshold));
    stage.dynamic(0.0, 0.5, shape);
    stage.steps(n_steps);
    stage.heard.forces()
}

fn forces_above_the_threshold_are_told(stage: &mut Stage) -> Verdict {
    let told = forces_of_a_standing_box(stage, 50.0, 20);
    let last = told.last().copied().unwrap_or(0.0);
    is_near(last, 10.0 * G, 1.0)
}

fn forces_below_the_threshold_are_not_told(stage: &mut Stage) -> Verdict {
    let n = forces_of_a_standing_box(stage, 1000.0, 30).len();
    verdict(n == 0, format!("{n} events"))
}

fn a_sensor_tells_and_does_not_push(stage: &mut Stage) -> Verdict {
    let sensor = ColliderBuilder::cuboid(real(5.0), real(0.2))
        .sensor(true)
        .active_events(ActiveEvents::COLLISION_EVENTS);
    stage.fixed(sensor);
    let body = stage.dynamic(0.0, 2.0, square(0.2));
    stage.steps(60);
    let heard = stage.heard.starts_and_stops();
    all([
        verdict(heard == (1, 1), format!("{heard:?}")),
        is_near(stage.at(body)[1], 2.0 - 0.5 * G, 0.2),
    ])
}

fn a_fast_body_is_seen_by_a_thin_sensor(stage: &mut Stage) -> Verdict {
    stage.no_gravity();
    let sensor = ColliderBuilder::cuboid(real(0.02), real(5.0))
        .translation(vec2(5.0, 0.0))
        .sensor(true)
        .active_events(ActiveEvents::COLLISION_EVENTS);
    stage.fixed(sensor);
    let body = RigidBodyBuilder::dynamic()
        .linvel(vec2(200.0, 0.0))
        .ccd_enabled(true);
    stage.add(body, ColliderBuilder::ball(real(0.05)));
    stage.steps(10);
    let heard = stage.heard.starts_and_stops();
    verdict(heard == (1, 1), format!("{heard:?}"))
}

/// A platform that lets through from below.
struct OneWay(ColliderHandle);

impl PhysicsHooks for OneWay {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let up = if context.collider1 == self.0 {
            vec2(0.0, 1.0)
        } else {
            vec2(0.0, -1.0)
        };
        context.update_as_oneway_platform(up, real(0.1));
    }
}

fn a_one_way_platform_lets_through_from_below(stage: &mut Stage) -> Verdict {
    let shape = ColliderBuilder::cuboid(real(2.0), real(0.1))
        .active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS);
    let platform = stage.fixed(shape);
    let ball = RigidBodyBuilder::dynamic()
        .translation(vec2(0.0, -3.0))
        .linvel(vec2(0.0, 12.0));
    let ball = stage.add(ball, ColliderBuilder::ball(real(0.25)));
    let mut highest = f64::NEG_INFINITY;
    for _ in 0..300 {
        stage.step_with(&OneWay(platform));
        highest = highest.max(stage.at(ball)[1]);
    }
    all([
        verdict(highest > 1.0, format!("rises to {highest}")),
        is_near(stage.at(ball)[1], 0.35, 0.02),
    ])
}

/// Keeps one collider from touching anything.
struct Ghost(ColliderHandle);

impl PhysicsHooks for Ghost {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let is_ghost = context.collider1 == self.0 || context.collider2 == self.0;
        (!is_ghost).then_some(SolverFlags::default())
    }
}

fn a_hook_filters_pairs(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let shape = || square(0.2).active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS);
    let ghost = stage.dynamic(-2.0, 0.5, shape());
    let solid = stage.dynamic(2.0, 0.5, shape());
    let hooks = Ghost(stage.world.bodies[ghost].colliders()[0]);
    stage.steps_with(60, &hooks);
    all([
        verdict(stage.at(ghost)[1] < -2.0, format!("{:?}", stage.at(ghost))),
        is_near(stage.at(solid)[1], 0.2, 0.01),
    ])
}

/// A belt.
struct Belt;

impl PhysicsHooks for Belt {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let Some(rigid) = context.rigid_mut() else {
            return;
        };
        let along = if rigid.normal.y < 0.0 { 1.0 } else { -1.0 };
        for contact in rigid.solver_contacts.iter_mut() {
            contact.tangent_velocity = vec2(along, 0.0);
        }
    }
}

fn a_conveyor_set_by_the_hook_carries(stage: &mut Stage) -> Verdict {
    let shape = ColliderBuilder::cuboid(real(20.0), real(0.5))
        .translation(vec2(0.0, -0.5))
        .friction(real(1.0))
        .active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS);
    stage.fixed(shape);
    let body = stage.dynamic(0.0, 0.2, square(0.2).friction(real(1.0)));
    stage.steps_with(120, &Belt);
    let speed = stage.velocity(body)[0].abs();
    is_near(speed, 1.0, 0.1)
}

fn queries_see_bodies_where_they_are(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let body = stage.dynamic(0.0, 2.0, square(0.2));
    stage.steps(120);
    let collider = stage.world.bodies[body].colliders()[0];
    let filter = QueryFilter::default();
    let ray = Ray::new(vec2(0.0, 5.0), vec2(0.0, -1.0));
    let hit = stage.world.cast_ray(&ray, real(10.0), true, filter);
    let (seen, length) = hit.map_or((None, 0.0), |(handle, length)| {
        (Some(handle), f64::from(length))
    });
    all([
        verdict(seen == Some(collider), format!("{seen:?}")),
        is_near(5.0 - length, 0.4, 0.01),
    ])
}

fn the_narrow_phase_lists_who_touches(stage: &mut Stage) -> Verdict {
    let floor = stage.floor(0.5);
    let body = stage.dynamic(0.0, 0.2, square(0.2));
    stage.steps(30);
    let collider = stage.world.bodies[body].colliders()[0];
    let pair = stage.world.narrow_phase.contact_pair(floor, collider);
    let touches = pair.is_some_and(ContactPair::has_any_active_contact);
    verdict(touches, format!("touches: {touches}"))
}

fn a_broken_body_is_put_away_and_the_others_go_on(stage: &mut Stage) -> Verdict {
    stage.floor(0.5);
    let broken = stage.dynamic(-5.0, 1.0, square(0.2));
    let sound = stage.dynamic(5.0, 1.0, square(0.2));
    stage.step();
    stage.world.bodies[broken].set_translation(vec2(f64::NAN, 0.0), true);
    stage.steps(120);
    all([
        is_near(stage.at(sound)[1], 0.2, 0.01),
        verdict(
            !stage.world.bodies[broken].is_enabled(),
            "the broken one is disabled",
        ),
    ])
}

behaviours!(
    a_collision_starts_and_stops
    a_removed_body_stops_its_collision
    forces_above_the_threshold_are_told
    forces_below_the_threshold_are_not_told
    a_sensor_tells_and_does_not_push
    a_fast_body_is_seen_by_a_thin_sensor
    a_one_way_platform_lets_through_from_below
    a_hook_filters_pairs
    a_conveyor_set_by_the_hook_carries
    queries_see_bodies_where_they_are
    the_narrow_phase_lists_who_touches
    a_broken_body_is_put_away_and_the_others_go_on
);
