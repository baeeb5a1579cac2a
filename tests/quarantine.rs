//! One sick body does not stop the world: it leaves, and everything else goes on.

mod common;

use common::{Scene, real, sick_flexible, sick_rigid, soft_block, vec2};
use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;

/// A block of 1 m with its lower left corner at `[x, y]`.
fn block(x: f64, y: f64) -> FlexBodyBuilder {
    soft_block(2e-3).translation([x, y])
}

fn overload(scene: &mut Scene, body: FlexBodyHandle) {
    scene.bodies[body]
        .set_nodal_force(5, [f64::MAX, 0.0])
        .expect("a finite force");
}

fn assert_all_finite(scene: &Scene) {
    assert_eq!(sick_flexible(&scene.bodies), None);
    assert_eq!(sick_rigid(&scene.world), None);
}

#[test]
fn what_is_overloaded_is_sick_though_pins_and_contacts_hold_it() {
    for is_pinned in [false, true] {
        for is_large in [false, true] {
            let mut scene = Scene::new(1.0 / 60.0);
            scene.ground(0.5);
            let sick = block(0.0, 0.0);
            let sick = match is_large {
                true => sick.large_strain(),
                false => sick.small_strain(),
            };
            let sick = scene.flexible(match is_pinned {
                true => sick.pin_where(|[_, y]| y < 1e-9, Pin::both()),
                false => sick,
            });
            let ball = RigidBodyBuilder::dynamic().translation(vec2(0.5, 1.25));
            scene.rigid(ball, ColliderBuilder::ball(real(0.25)).density(real(500.0)));
            scene.steps(10);
            let top = scene.body(sick).n_nodes() - 2;
            scene.bodies[sick]
                .set_nodal_force(top, [f64::MAX, 0.0])
                .expect("a finite force");
            scene.try_step().expect("the world goes on");
            let gone = scene.report().quarantined_flex_bodies();
            assert_eq!(gone, [sick], "pinned {is_pinned}, large {is_large}");
            assert_all_finite(&scene);
        }
    }
}

#[test]
fn what_rested_on_a_sick_body_falls_and_what_is_far_away_moves_as_if_nothing_had_been() {
    let mut scenes = [Scene::new(1.0 / 60.0), Scene::new(1.0 / 60.0)];
    let mut handles = Vec::new();
    for scene in &mut scenes {
        scene.ground(0.5);
        let sick = scene.flexible(block(0.0, 0.0));
        let upper = scene.flexible(block(0.0, 1.0));
        let far = scene.flexible(block(10.0, 0.5));
        let ball = RigidBodyBuilder::dynamic().translation(vec2(0.5, 2.26));
        let (ball, _) = scene.rigid(ball, ColliderBuilder::ball(real(0.25)).density(real(500.0)));
        scene.steps(30);
        handles = vec![(sick, upper, far, ball)];
    }
    let (sick, upper, far, ball) = handles[0];
    let [well, ill] = &mut scenes;
    let handle = |scene: &Scene, like: FlexBodyHandle| {
        let index = like.into_raw_parts().0;
        scene.bodies.at_index(index).expect("a body of the scene").0
    };
    let (sick, upper, far) = (handle(ill, sick), handle(ill, upper), handle(ill, far));
    overload(ill, sick);
    ill.step();
    well.step();
    assert_eq!(ill.report().quarantined_flex_bodies(), [sick]);
    for _ in 0..90 {
        // The soft block lands at 4 m/s with the ball on it, which may cost a linearised step.
        ill.try_step().expect("the world goes on");
        well.step();
        assert_all_finite(ill);
    }
    let y = ill.body(upper).centre_of_mass()[1];
    assert!(
        (y - 0.5).abs() < 0.1,
        "the upper block lies on the ground: {y} m"
    );
    let y = f64::from(ill.world.bodies[ball].translation().y);
    // Light on heavy, it is flung up by the block's rebound, but it has not gone through.
    assert!(y > 1.0, "the ball is above it: {y} m");
    let far_well = handle(well, far);
    // Another island: the same numbers, whatever happens elsewhere, but for rapier's rounding of nothing.
    assert_eq!(ill.body(far).positions(), well.body(far_well).positions());
}

#[test]
fn a_sick_body_can_be_mended_or_removed_and_is_met_by_no_query_meanwhile() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let sick = scene.flexible(block(0.0, 0.0));
    scene.steps(240);
    let before = scene.body(sick).centre_of_mass();
    overload(&mut scene, sick);
    scene.step();
    assert!(scene.body(sick).is_quarantined());
    let look = |scene: &Scene| {
        let ray = Ray::new(vec2(0.5, 5.0), vec2(0.0, -1.0));
        let hit = scene
            .world
            .cast_ray(&ray, 10.0, true, QueryFilter::default());
        hit.map(|(handle, _)| handle)
    };
    let surface = scene.body(sick).collider_handle();
    assert_ne!(look(&scene), Some(surface), "only the ground is there");
    // Unmended, it leaves again.
    let back = |scene: &mut Scene| {
        let world = &mut scene.world;
        scene
            .bodies
            .reinstate(sick, &mut world.bodies, &mut world.colliders)
            .expect("a handle of this set");
    };
    back(&mut scene);
    scene.step();
    assert_eq!(scene.report().quarantined_flex_bodies(), [sick]);
    scene.bodies[sick]
        .set_nodal_force(5, [0.0; 2])
        .expect("a finite force");
    back(&mut scene);
    scene.steps(60);
    let after = scene.body(sick).centre_of_mass();
    // It rests where it rested: a sag of 5 mm under its own weight, and what is left of its ringing.
    assert!((after[1] - before[1]).abs() < 1e-4, "{before:?} {after:?}");
    assert_eq!(look(&scene), Some(surface), "it is back");
    let weight = 9.8125 * scene.body(sick).mass();
    let force = scene.body(sick).total_contact_force()[1];
    assert!(
        (force / weight - 1.0).abs() < 1e-3,
        "{force} N of {weight} N"
    );
    overload(&mut scene, sick);
    scene.step();
    scene
        .bodies
        .remove(sick, &mut scene.world)
        .expect("a sick body can be removed");
    scene.steps(2);
}

#[test]
fn what_is_attached_to_a_sick_body_is_let_go_and_what_it_is_attached_to_goes_on() {
    let mut scene = Scene::new(1.0 / 60.0);
    let sick = scene.flexible(block(0.0, 5.0));
    let hanging = scene.flexible(block(0.0, 4.0));
    let builders = [
        AttachmentBuilder::pin(sick).node(22).to_world(),
        AttachmentBuilder::pin(hanging).node(22).to_flexible(sick),
    ];
    for builder in builders {
        let made = scene.bodies.attach(builder, &scene.world.bodies);
        made.expect("the node is there");
    }
    scene.steps(10);
    overload(&mut scene, sick);
    let before = scene.body(hanging).linvel()[1];
    for _ in 0..30 {
        scene.step();
        assert_all_finite(&scene);
    }
    // Half a second of free fall.
    let gained = scene.body(hanging).linvel()[1] - before;
    assert!((gained + 0.5 * 9.8125).abs() < 0.2, "{gained} m/s");
}

#[test]
fn a_carrier_given_no_number_is_put_right_and_its_body_leaves() {
    type Spoil = fn(&mut RigidBody, Real);
    let spoils: [(&str, Spoil); 3] = [
        ("translation", |carrier, bad| {
            carrier.set_translation(Vector::new(bad, 0.0), true)
        }),
        ("linvel", |carrier, bad| {
            carrier.set_linvel(Vector::new(0.0, bad), true)
        }),
        ("angvel", |carrier, bad| carrier.set_angvel(bad, true)),
    ];
    for (name, spoil) in spoils {
        for bad in [Real::NAN, Real::INFINITY] {
            let mut scene = Scene::new(1.0 / 60.0);
            scene.ground(0.5);
            let sick = scene.flexible(block(0.0, 0.0));
            let well = scene.flexible(block(1.5, 0.01));
            scene.steps(5);
            let carrier = scene.body(sick).rigid_body_handle();
            spoil(&mut scene.world.bodies[carrier], bad);
            scene.step();
            assert_eq!(scene.report().quarantined_flex_bodies(), [sick], "{name}");
            scene.steps(60);
            assert_all_finite(&scene);
            let y = scene.body(well).centre_of_mass()[1];
            assert!(
                (y - 0.5).abs() < 0.01,
                "{name}: the other block is at {y} m"
            );
            let world = &mut scene.world;
            scene
                .bodies
                .reinstate(sick, &mut world.bodies, &mut world.colliders)
                .expect("a handle of this set");
            scene.steps(60);
            assert!(scene.report().quarantined_flex_bodies().is_empty());
            let y = scene.body(sick).centre_of_mass()[1];
            assert!(
                (y - 0.5).abs() < 0.01,
                "{name}: the mended block is at {y} m"
            );
        }
    }
}

/// Rapier 0.36 panics when a body goes between a step without length, with which a world begins, and its first full one.
#[test]
fn bodies_that_go_before_the_first_full_step_leave_a_world_that_goes_on() {
    type Spoil = fn(&mut Scene, FlexBodyHandle, RigidBodyHandle);
    let spoils: [(&str, Spoil); 3] = [
        ("overloaded", |scene, sick, _| {
            overload(scene, sick);
            scene.step();
            assert_eq!(scene.report().quarantined_flex_bodies(), [sick]);
        }),
        ("a step of no length", |scene, sick, _| {
            let dt = std::mem::take(&mut scene.world.integration_parameters.dt);
            scene.step();
            scene.world.integration_parameters.dt = dt;
            scene.bodies.remove(sick, &mut scene.world).expect("a body");
        }),
        ("a refused step", |scene, _, lower| {
            scene.world.bodies[lower].add_force(vec2(f64::NAN, 0.0), true);
            scene.try_step().expect_err("a force that is no number");
            scene.world.remove_body(lower);
        }),
    ];
    // Which body of a joint comes first decides which of rapier's islands remains.
    let joints = [None, Some(false), Some(true)];
    for ((name, spoil), joint) in spoils
        .into_iter()
        .flat_map(|it| joints.map(|joint| (it, joint)))
    {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.ground(0.5);
        let sick = scene.flexible(block(0.0, 0.001));
        let mut ball = |y| {
            let body = RigidBodyBuilder::dynamic().translation(vec2(0.5, y));
            scene
                .rigid(body, ColliderBuilder::ball(real(0.25)).density(real(500.0)))
                .0
        };
        let (lower, upper) = (ball(1.252), ball(30.0));
        if let Some(is_turned) = joint {
            let other = ball(31.0);
            let rod = RopeJointBuilder::new(2.0).build();
            let [one, two] = if is_turned {
                [other, upper]
            } else {
                [upper, other]
            };
            scene.world.insert_impulse_joint(one, two, rod);
        }
        spoil(&mut scene, sick, lower);
        for _ in 0..60 {
            scene
                .try_step()
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_all_finite(&scene);
        }
    }
}
