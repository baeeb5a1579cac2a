//! Collision events: one start and one stop per touch, in the step in which it happens.

use crate::support::*;

fn run(scene: &mut Scene, n: usize, touching: &mut Touching, listener: &Listener) {
    for step in 0..n {
        let heard = scene.hear(listener);
        touching.take(&heard.collisions, &format!("step {step}"));
    }
}

#[test]
fn a_block_that_lands_starts_once_and_stops_once_when_it_is_removed() {
    let mut scene = Scene::new(DT);
    let floor = scene.ground(0.5);
    let body = scene.flexible(block().translation([0.0, 0.2]));
    let surface = scene.body(body).collider_handle();
    let (listener, mut touching) = (Listener::default(), Touching::default());
    run(&mut scene, 240, &mut touching, &listener);
    assert_eq!((touching.n_starts, touching.n_stops), (1, 0));
    assert!(touching.is_touching(pair(floor, surface)));
    scene
        .bodies
        .remove(body, &mut scene.world)
        .expect("it is there");
    let heard = scene.hear(&listener);
    touching.take(&heard.collisions, "removal");
    assert_eq!((touching.n_starts, touching.n_stops), (1, 1));
    assert!(heard.collisions[0].removed());
    run(&mut scene, 10, &mut touching, &listener);
    assert_eq!((touching.n_starts, touching.n_stops), (1, 1));
}

#[test]
fn flexible_bodies_that_meet_and_part_start_once_and_stop_once() {
    let mut scene = Scene::in_free_space(DT);
    let one = scene.flexible(block().linvel([1.0, 0.0]).translation([-1.3, 0.0]));
    let other = scene.flexible(block().linvel([-1.0, 0.0]).translation([0.3, 0.1]));
    let names = [one, other].map(|handle| scene.body(handle).collider_handle());
    let (listener, mut touching) = (Listener::default(), Touching::default());
    let mut first_force = None;
    for step in 0..120 {
        let heard = scene.hear(&listener);
        touching.take(&heard.collisions, &format!("step {step}"));
        let is_touching = touching.is_touching(pair(names[0], names[1]));
        if !heard.forces.is_empty() {
            first_force.get_or_insert(step);
            assert!(is_touching, "step {step}: force without touch");
        }
    }
    assert!(first_force.is_some_and(|step| step > 10), "{first_force:?}");
    assert_eq!((touching.n_starts, touching.n_stops), (1, 1));
}

#[test]
fn rigid_bodies_of_a_claim_start_once_and_stop_once() {
    let mut scene = Scene::new(DT);
    scene.ground(0.5);
    scene.flexible(block().active_events(ActiveEvents::empty()));
    let (listener, mut touching) = (Listener::default(), Touching::default());
    run(&mut scene, 60, &mut touching, &listener);
    let shape = || {
        ColliderBuilder::cuboid(0.2, 0.2)
            .density(100.0)
            .active_events(ALL)
    };
    let at = |y: f64| RigidBodyBuilder::dynamic().translation(vec2(0.5, y));
    let (_, lower) = scene.rigid(at(1.21), shape());
    let (top, upper) = scene.rigid(at(1.7), shape());
    run(&mut scene, 240, &mut touching, &listener);
    // The lower box on the block, the upper on the lower.
    assert_eq!((touching.n_starts, touching.n_stops), (2, 0));
    assert!(touching.is_touching(pair(lower, upper)));
    scene.world.bodies[top].set_linvel(vec2(0.0, 3.0), true);
    run(&mut scene, 20, &mut touching, &listener);
    assert_eq!((touching.n_starts, touching.n_stops), (2, 1));
    assert!(!touching.is_touching(pair(lower, upper)));
    // It comes back; disabled, it goes for good.
    run(&mut scene, 120, &mut touching, &listener);
    assert_eq!((touching.n_starts, touching.n_stops), (3, 1));
    scene.world.bodies[top].set_enabled(false);
    run(&mut scene, 5, &mut touching, &listener);
    assert_eq!((touching.n_starts, touching.n_stops), (3, 2));
}

#[test]
fn a_slow_approach_starts_once_as_with_rapier_alone() {
    // At 0.15 m/s the gap shrinks by 2.5 mm a step, a little more than rapier predicts without velocities: its step without
    // length loses what its full step has found.
    for offset in [0.0, 0.6e-3, 1.2e-3, 1.8e-3, 2.4e-3] {
        let mut scene = Scene::in_free_space(DT);
        scene.fixed(ColliderBuilder::cuboid(5.0, 0.5).translation(vec2(0.0, -0.5)));
        scene.flexible(
            block()
                .small_strain()
                .active_events(ActiveEvents::empty())
                .translation([3.0, 0.0]),
        );
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(3.5, 1.23 + offset))
            .linvel(vec2(0.0, -0.15));
        let shape = ColliderBuilder::cuboid(0.2, 0.2).active_events(ALL);
        scene.rigid(body, shape);
        let (listener, mut touching) = (Listener::default(), Touching::default());
        run(&mut scene, 120, &mut touching, &listener);
        assert_eq!(touching.n_starts, 1, "{offset}");
        assert!(touching.n_stops <= 1, "{offset}");
    }
}

#[test]
fn a_fast_ball_that_bounces_within_steps_is_heard_each_time() {
    // A stiff block between two walls: rapier alone sees what is near when a step begins, and the block may be gone by then.
    let mut scene = Scene::in_free_space(DT);
    for x in [-4.0, 4.0] {
        scene.fixed(ColliderBuilder::cuboid(0.5, 5.0).translation(vec2(x, 0.0)));
    }
    let ball = FlexBodyBuilder::disc(0.3, 0.1)
        .material(LinearElastic::plane_stress(1e8, 0.3).density(1000.0))
        .restitution(1.0)
        .linvel([40.0, 0.0])
        .active_events(ALL);
    scene.flexible(ball);
    let (listener, mut touching) = (Listener::default(), Touching::default());
    let mut n_impacts = 0;
    let mut pressed = false;
    for step in 0..240 {
        let heard = scene.hear(&listener);
        touching.take(&heard.collisions, &format!("step {step}"));
        let presses = !heard.forces.is_empty();
        n_impacts += usize::from(presses && !pressed);
        pressed = presses;
    }
    assert!(n_impacts > 2, "{n_impacts}");
    assert!(
        touching.n_starts.abs_diff(n_impacts) <= 1,
        "{} of {n_impacts}",
        touching.n_starts
    );
    assert!(touching.n_starts - touching.n_stops <= 1);
}
