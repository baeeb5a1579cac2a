//! Groups, types, sensors and skins of flexible bodies.

use crate::support::*;

fn group(own: Group, others: Group) -> InteractionGroups {
    InteractionGroups::new(own, others, InteractionTestMode::And)
}

/// Lowest point of a body (m).
fn bottom(body: &FlexBody) -> f64 {
    let heights = body.positions().iter().skip(1).step_by(2);
    heights.fold(f64::INFINITY, |low, y| low.min(*y))
}

/// How far a body fell in `n` steps from rest, if nothing held it (m): the trapezoidal rule is exact.
fn fallen(n: f64) -> f64 {
    0.5 * G * (n * DT).powi(2)
}

#[test]
fn groups_set_between_steps_count_from_the_next_step_on() {
    // Both kinds of groups, on the body and on rapier's collider.
    type Set = fn(&mut Scene, FlexBodyHandle, InteractionGroups);
    let ways: [(&str, Set, bool); 4] = [
        (
            "collision groups of the body",
            |scene, body, groups| scene.bodies[body].set_collision_groups(groups),
            false,
        ),
        (
            "solver groups of the body",
            |scene, body, groups| scene.bodies[body].set_solver_groups(groups),
            true,
        ),
        (
            "collision groups of the collider",
            |scene, body, groups| {
                let surface = scene.body(body).collider_handle();
                scene.world.colliders[surface].set_collision_groups(groups);
            },
            false,
        ),
        (
            "solver groups of the collider",
            |scene, body, groups| {
                let surface = scene.body(body).collider_handle();
                scene.world.colliders[surface].set_solver_groups(groups);
            },
            true,
        ),
    ];
    for (name, set, is_reported) in ways {
        let mut scene = Scene::new(DT);
        scene.ground(0.5);
        // What sleeps learns of settings made on a collider a step later, from rapier.
        let body = scene.flexible(block().can_sleep(false));
        let listener = Listener::default();
        for _ in 0..120 {
            scene.hear(&listener);
        }
        let rest = bottom(scene.body(body));
        assert!(rest > -1e-3, "{name}: {rest}");
        set(&mut scene, body, group(Group::GROUP_2, Group::GROUP_2));
        let fixed = ColliderSet::iter(&scene.world.colliders)
            .map(|(handle, _)| handle)
            .next();
        let floor = fixed.expect("the floor");
        scene.world.colliders[floor].set_collision_groups(InteractionGroups::all());
        if is_reported {
            scene.world.colliders[floor].set_solver_groups(group(Group::GROUP_1, Group::GROUP_1));
        } else {
            scene.world.colliders[floor]
                .set_collision_groups(group(Group::GROUP_1, Group::GROUP_1));
        }
        let start = scene.body(body).centre_of_mass()[1];
        let mut n_stops = 0;
        for _ in 0..30 {
            let heard = scene.hear(&listener);
            assert!(heard.forces.is_empty(), "{name}: {:?}", heard.forces);
            n_stops += heard
                .collisions
                .iter()
                .filter(|event| event.stopped())
                .count();
        }
        let fell = start - scene.body(body).centre_of_mass()[1];
        // Its sag of a millimetre or two is let go as well.
        assert!((fell - fallen(30.0)).abs() < 5e-3, "{name}: {fell} m");
        // What is not pushed is still reported while it crosses the floor, as in rapier.
        assert_eq!(n_stops, usize::from(!is_reported), "{name}");
    }
}

#[test]
fn a_body_whose_collision_types_leave_out_fixed_bodies_falls_through_the_floor_but_not_a_rigid_box()
{
    let mut scene = Scene::new(DT);
    let types = ActiveCollisionTypes::DYNAMIC_DYNAMIC;
    let floor = |x: f64| ColliderBuilder::cuboid(5.0, 0.5).translation(vec2(x, -0.5));
    // Rapier asks both colliders, and one is enough.
    scene.fixed(floor(0.0));
    scene.fixed(floor(20.0).active_collision_types(ActiveCollisionTypes::empty()));
    let ghost = scene.flexible(
        block()
            .active_collision_types(types)
            .translation([20.0, 0.001]),
    );
    let solid = scene.flexible(block().translation([0.0, 0.001]));
    scene.steps(60);
    let y = |scene: &Scene, handle| scene.body(handle).centre_of_mass()[1];
    assert!((0.501 - y(&scene, ghost) - fallen(60.0)).abs() < 1e-4);
    assert!(y(&scene, solid) > 0.45);
    // Changed at run time, it catches the floor's side no more than it should: far below, it just falls.
    let at = RigidBodyBuilder::dynamic().translation(vec2(20.5, y(&scene, ghost) + 0.75));
    let velocity = vec2(0.0, scene.body(ghost).linvel()[1]);
    let shape = ColliderBuilder::cuboid(0.2, 0.2).active_events(ALL);
    scene.rigid(at.linvel(velocity - vec2(0.0, 1.0)), shape);
    let mut n_claimed = 0;
    for _ in 0..30 {
        n_claimed = n_claimed.max(scene.step().n_claimed());
    }
    assert_eq!(n_claimed, 1, "a dynamic box meets it");
}

#[test]
fn a_flexible_sensor_reports_and_does_not_push() {
    let mut scene = Scene::new(DT);
    let gate = FlexBodyBuilder::rectangle([4.0, 0.5], [16, 2])
        .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0))
        .pin_where(|_| true, Pin::both())
        .sensor(true)
        .active_events(ALL);
    let gate = scene.flexible(gate.translation([-2.0, 0.0]));
    let at = RigidBodyBuilder::dynamic().translation(vec2(-1.0, 1.0));
    let (ball, ball_shape) = scene.rigid(at, ColliderBuilder::ball(0.3));
    let other = scene.flexible(
        block()
            .active_events(ActiveEvents::empty())
            .translation([0.5, 0.8]),
    );
    let listener = Listener::default();
    let mut touching = Touching::default();
    for step in 0..60 {
        let heard = scene.hear(&listener);
        assert!(heard.forces.is_empty() && scene.report().contacts().is_empty());
        assert!(heard.collisions.iter().all(|event| event.sensor()));
        touching.take(&heard.collisions, &format!("step {step}"));
    }
    assert_eq!(
        (touching.n_starts, touching.n_stops),
        (2, 2),
        "the ball and the block pass"
    );
    let fell = 1.0 - f64::from(scene.world.bodies[ball].translation().y);
    // Rapier's own free fall is first order in the step: half of g t dt more.
    assert!((fell - fallen(60.0)).abs() < 0.5 * G * DT * 1.1, "{fell} m");
    let fell = 1.3 - scene.body(other).centre_of_mass()[1];
    assert!((fell - fallen(60.0)).abs() < 1e-5, "{fell} m");
    // A sensor that is made solid holds what comes next.
    scene.bodies[gate].set_sensor(false);
    scene.world.bodies[ball].set_translation(vec2(-1.0, 1.0), true);
    scene.world.bodies[ball].set_linvel(Vector::ZERO, true);
    for _ in 0..60 {
        let heard = scene.hear(&listener);
        touching.take(&heard.collisions, "solid");
    }
    let surface = scene.body(gate).collider_handle();
    assert!(touching.is_touching(pair(surface, ball_shape)));
    let height = f64::from(scene.world.bodies[ball].translation().y);
    assert!((height - 0.8).abs() < 0.01, "{height} m");
}

#[test]
fn contact_skins_keep_surfaces_apart_by_their_sum() {
    for [own, others] in [[0.0, 0.05], [0.03, 0.0], [0.02, 0.05]] {
        let mut scene = Scene::new(DT);
        let floor = ColliderBuilder::cuboid(50.0, 0.5).translation(vec2(0.0, -0.5));
        scene.fixed(floor.contact_skin(real(others)));
        let slab = scene.flexible(block().contact_skin(own).translation([0.0, 0.1]));
        scene.steps(180);
        let low = bottom(scene.body(slab));
        assert!(
            (low - own - others).abs() < 1e-5,
            "{low} m for {own} and {others}"
        );
        // A rigid box on the slab, then one on that box: flexible with rigid, and rigid with rigid.
        let shape = || ColliderBuilder::cuboid(0.2, 0.2).density(100.0);
        let at = |y: f64| RigidBodyBuilder::dynamic().translation(vec2(0.5, y));
        let (_, _) = scene.rigid(at(1.6), shape().contact_skin(real(others)));
        let (top, _) = scene.rigid(at(2.2), shape().contact_skin(real(own)));
        scene.steps(240);
        let y = f64::from(scene.world.bodies[top].translation().y);
        let surface = scene.body(slab).position(22)[1];
        let gaps = y - 0.6 - surface;
        let expected = 2.0 * (own + others);
        assert!((gaps - expected).abs() < 1e-4, "{gaps} m, not {expected}");
    }
}

#[test]
fn settings_changed_at_run_time_count_and_wrong_ones_are_refused() {
    let mut scene = Scene::new(DT);
    scene.ground(0.5);
    let sliding = scene.flexible(block().linvel([3.0, 0.0]));
    scene.steps(20);
    let surface = scene.body(sliding).collider_handle();
    // What the user sets on rapier's collider stays when something else is changed on the body.
    scene.world.colliders[surface].set_restitution(0.25);
    let settings = *scene.body(sliding).contact_settings();
    let smooth = foil2d::body::ContactSettings {
        friction: 0.0,
        friction_combine_rule: CoefficientCombineRule::Min,
        ..settings
    };
    scene.bodies[sliding]
        .set_contact_settings(smooth)
        .expect("they are right");
    scene.step();
    let speed = scene.body(sliding).linvel()[0];
    scene.steps(30);
    let kept = scene.body(sliding).linvel()[0];
    // The friction of the last step acts on for half a step: 0.04 m/s.
    assert!(
        (kept - speed).abs() < 1e-3 + 0.25 * G * DT,
        "{kept} of {speed} m/s"
    );
    assert_eq!(scene.world.colliders[surface].restitution(), 0.25);
    for wrong in [-0.1, f64::NAN, 1e300] {
        let settings = foil2d::body::ContactSettings {
            friction: wrong,
            ..settings
        };
        let refused = scene.bodies[sliding].set_contact_settings(settings);
        assert!(refused.is_err(), "{wrong}");
        assert_eq!(scene.body(sliding).contact_settings(), &smooth);
    }
}
