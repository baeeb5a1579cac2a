//! Contact force events: the force of our multipliers, with rapier's threshold and `started`.

use crate::support::*;

#[test]
fn the_force_events_of_a_resting_block_sum_up_to_its_weight() {
    let mut scene = Scene::new(DT);
    let floor = scene.ground(0.5);
    // Rapier tells of no forces between bodies that sleep.
    let body = scene.flexible(block().translation([0.0, 0.01]).can_sleep(false));
    let surface = scene.body(body).collider_handle();
    let listener = Listener::default();
    for _ in 0..300 {
        scene.hear(&listener);
    }
    let weight = G * scene.body(body).mass();
    let heard = scene.hear(&listener);
    assert_eq!(heard.forces.len(), 1, "one pair, one event");
    let event = heard.forces[0];
    assert_eq!(pair(event.collider1, event.collider2), pair(floor, surface));
    // Rapier's force points from the first collider to the second.
    let up = if event.collider1 == floor { 1.0 } else { -1.0 };
    let force = f64::from(event.total_force.y) * up;
    assert!((force / weight - 1.0).abs() < 1e-4, "{force} of {weight} N");
    let magnitude = f64::from(event.total_force_magnitude);
    assert!((magnitude / weight - 1.0).abs() < 1e-4, "{magnitude} N");
    // Five nodes carry it, none of them all.
    let largest = f64::from(event.max_force_magnitude);
    assert!(
        largest > 0.2 * weight && largest < 0.6 * weight,
        "{largest} N"
    );
    assert!((f64::from(event.max_force_direction.y) * up - 1.0).abs() < 1e-5);
    assert!(!event.started, "it has been above the threshold for long");
}

#[test]
fn every_pair_of_a_claimed_stack_reports_the_weight_above_it() {
    let mut scene = Scene::new(DT);
    scene.ground(0.5);
    let slab = scene.flexible(block());
    let mut weight_above = G * scene.body(slab).mass();
    let mut expected = Vec::new();
    let mut weights = Vec::new();
    for level in 0..3 {
        let at = RigidBodyBuilder::dynamic().translation(vec2(0.5, 1.2 + 0.4 * f64::from(level)));
        let shape = ColliderBuilder::cuboid(0.2, 0.2).density(500.0);
        let (body, _) = scene.rigid(at, shape.active_events(ALL));
        weights.push(G * scene.mass(body).max(80.0));
    }
    for weight in &weights {
        weight_above += weight;
    }
    for weight in std::iter::once(G * scene.body(slab).mass()).chain(weights) {
        expected.push(weight_above);
        weight_above -= weight;
    }
    let listener = Listener::default();
    for _ in 0..300 {
        scene.hear(&listener);
    }
    let mut found: Vec<f64> = (scene.hear(&listener).forces.iter())
        .map(|event| f64::from(event.total_force.length()))
        .collect();
    found.sort_by(|a, b| b.total_cmp(a));
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found / expected - 1.0).abs() < 1e-4,
            "{found} of {expected} N"
        );
    }
}

#[test]
fn an_event_comes_above_the_threshold_only_and_reads_as_started_once() {
    let mut scene = Scene::new(DT);
    scene.ground(0.5);
    let slab = scene.flexible(block().active_events(ActiveEvents::empty()));
    let listener = Listener::default();
    for _ in 0..120 {
        assert!(scene.hear(&listener).forces.is_empty(), "nobody listens");
    }
    // 157 N of weight, and a threshold above it.
    let at = RigidBodyBuilder::dynamic().translation(vec2(0.5, 1.2));
    let shape = ColliderBuilder::cuboid(0.2, 0.2).density(100.0);
    let shape = shape
        .active_events(ALL)
        .contact_force_event_threshold(300.0);
    let (body, _) = scene.rigid(at, shape);
    for step in 0..120 {
        let heard = scene.hear(&listener);
        // It drops by the sag of the slab, and lands with more than its weight.
        let is_quiet = heard.forces.is_empty() || step < 30;
        assert!(is_quiet, "step {step}: {:?}", heard.forces);
    }
    let press = |scene: &mut Scene, force: f64, expected: &[bool]| {
        let body = &mut scene.world.bodies[body];
        body.reset_forces(true);
        body.add_force(vec2(0.0, -force), true);
        let heard: Vec<bool> = expected
            .iter()
            .flat_map(|_| scene.hear(&listener).forces)
            .map(|event| event.started)
            .collect();
        heard
    };
    let expected = [true, false, false, false];
    assert_eq!(press(&mut scene, 500.0, &expected), expected);
    // Below it for a while, then above it again.
    assert_eq!(
        press(&mut scene, 0.0, &[false; 60])
            .iter()
            .filter(|&&started| started)
            .count(),
        0
    );
    assert_eq!(press(&mut scene, 500.0, &expected), expected);
    assert!(scene.body(slab).total_contact_force()[1] > 0.0);
}

#[test]
fn the_forces_of_an_impact_sum_up_to_the_change_of_momentum() {
    let mut scene = Scene::in_free_space(DT);
    let one = scene.flexible(block().linvel([2.0, 0.0]).translation([-1.1, 0.0]));
    scene.flexible(block().translation([0.1, 0.0]));
    let surface = scene.body(one).collider_handle();
    let before = scene.body(one).momentum()[0];
    let listener = Listener::default();
    let mut sum = 0.0;
    for _ in 0..120 {
        for event in scene.hear(&listener).forces {
            let sign = if event.collider1 == surface {
                -1.0
            } else {
                1.0
            };
            sum += sign * f64::from(event.total_force.x) * DT;
        }
    }
    let change = scene.body(one).momentum()[0] - before;
    assert!(change < -500.0, "they met: {change} N s");
    // Forces below zero, taken back at the end of an impact, are below the threshold of zero and not heard.
    assert!((sum / change - 1.0).abs() < 0.02, "{sum} of {change} N s");
}

#[test]
fn a_pair_that_rapier_takes_over_goes_on_and_does_not_start_again() {
    let mut scene = Scene::new(DT);
    scene.ground(0.5);
    // A rigid box on the floor, leaning on nothing; a flexible block on top of it claims it.
    let shape = ColliderBuilder::cuboid(0.5, 0.25)
        .density(500.0)
        .active_events(ALL);
    let at = RigidBodyBuilder::dynamic().translation(vec2(0.0, 0.25));
    let (_, surface) = scene.rigid(at, shape);
    let small = FlexBodyBuilder::rectangle([0.4, 0.2], [4, 2]).material(elastic(1e6, 500.0, 2e-2));
    let small = scene.flexible(small.translation([-0.2, 0.5]));
    let floor_of = |event: &&ContactForceEvent, surface| {
        let known = [event.collider1, event.collider2];
        known.contains(&surface)
    };
    let (listener, mut touching) = (Listener::default(), Touching::default());
    let mut started = 0;
    for step in 0..180 {
        if step == 90 {
            scene
                .bodies
                .remove(small, &mut scene.world)
                .expect("it is there");
        }
        let heard = scene.hear(&listener);
        touching.take(&heard.collisions, &format!("step {step}"));
        let own: Vec<_> = heard
            .forces
            .iter()
            .filter(|event| floor_of(event, surface))
            .collect();
        assert!(!own.is_empty(), "step {step}: the box rests on something");
        started += own.iter().filter(|event| event.started).count();
    }
    // Once on the floor, once under the block; the floor goes on when the block has gone.
    assert_eq!(started, 2);
    assert_eq!((touching.n_starts, touching.n_stops), (2, 1));
}
