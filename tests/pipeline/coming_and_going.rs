//! Bodies and shapes that come, change and go between steps.

use crate::support::*;
use foil2d::body::FlexBodyError;
use foil2d::pipeline::{InsertionNote, Participant};

#[test]
fn bodies_come_and_go_at_run_time_and_their_handles_go_stale() -> Outcome {
    let mut scene = Scene::with_floor();
    let first = scene.insert(square().translation([0.0, 0.001]))?;
    scene.steps(60)?;
    let second = scene.insert(square().translation([0.0, 1.05]))?;
    assert_eq!(scene.flex_bodies.len(), 2);
    scene.steps(120)?;
    let [low, high] = [first, second].map(|body| scene.flex_bodies[body].centre_of_mass()[1]);
    assert!(high - low > 0.9, "the second rests on the first");
    let (n_bodies, n_colliders) = (scene.world.bodies.len(), scene.world.colliders.len());
    let carrier = scene.flex_bodies[first].rigid_body_handle();
    let surface = scene.flex_bodies[first].collider_handle();
    let body = scene.flex_bodies.remove(first, &mut scene.world)?;
    assert!((body.mass() - 1000.0).abs() < 1e-9, "it is handed out");
    assert!(!scene.world.bodies.contains(carrier));
    assert!(!scene.world.colliders.contains(surface));
    assert_eq!(scene.world.bodies.len(), n_bodies - 1);
    assert_eq!(scene.world.colliders.len(), n_colliders - 1);
    assert_eq!(
        scene.flex_bodies.try_get(first).err(),
        Some(FlexBodyError::Stale(first))
    );
    assert_eq!(scene.flex_bodies.len(), 1);
    // The second falls onto the floor and carries nothing but itself.
    scene.steps(240)?;
    let body = &scene.flex_bodies[second];
    assert!((body.centre_of_mass()[1] - 0.5).abs() < 0.02);
    let force = body.total_contact_force()[1];
    assert!((force / (GRAVITY * 1000.0) - 1.0).abs() < 1e-3, "{force} N");
    // A new body takes the vacant slot, with another handle and none of the old contacts.
    let third = scene.insert(square().translation([5.0, 3.0]))?;
    assert_eq!(third.into_raw_parts().0, first.into_raw_parts().0);
    assert_ne!(third, first);
    scene.step()?;
    assert_eq!(scene.flex_bodies[third].total_contact_force(), [0.0; 2]);
    Ok(())
}

#[test]
fn removing_a_rigid_body_in_contact_frees_the_beam_under_it() -> Outcome {
    let mut scene = Scene::default();
    let beam = scene.insert(beam().can_sleep(false))?;
    scene.steps(240)?;
    let own = scene.flex_bodies[beam].position(12)[1];
    let crate_body = scene.insert_box(0.25, [0.0, 1.55], 1000.0);
    scene.steps(360)?;
    assert_eq!(scene.flex.report().n_claimed(), 1);
    let loaded = scene.flex_bodies[beam].position(12)[1];
    assert!(
        loaded < own - 1e-4,
        "{loaded} m under load, {own} m without"
    );
    scene.world.remove_body(crate_body);
    scene.step()?;
    assert_eq!(scene.flex.report().n_claimed(), 0);
    assert!(scene.flex.report().contacts().is_empty());
    scene.steps(480)?;
    let freed = scene.flex_bodies[beam].position(12)[1];
    assert!((freed - own).abs() < 1e-6, "{freed} m, was {own} m");
    Ok(())
}

#[test]
fn a_box_in_contact_may_change_its_shape_or_lose_its_collider() -> Outcome {
    let mut scene = Scene::default();
    scene.insert(beam())?;
    let crate_body = scene.insert_box(0.25, [0.0, 1.551], 300.0);
    // Mass of its own, so that it falls without a collider too.
    scene.world.bodies[crate_body].set_additional_mass(50.0, true);
    scene.steps(60)?;
    let collider = scene.world.bodies[crate_body].colliders()[0];
    let twelve: Vec<Vector> = (0..12)
        .map(|corner| {
            let (sin, cos) = (0.3 + f64::from(corner) * std::f64::consts::FRAC_PI_6).sin_cos();
            vec2(0.25 * cos, 0.25 * sin)
        })
        .collect();
    let shapes = [
        SharedShape::convex_hull(&twelve).ok_or("a dodecagon")?,
        SharedShape::triangle(vec2(-0.25, -0.25), vec2(0.25, -0.25), vec2(0.0, 0.2)),
        SharedShape::ball(0.25),
        SharedShape::capsule_x(0.1, 0.2),
        SharedShape::round_cuboid(0.2, 0.2, 0.05),
    ];
    for shape in shapes {
        scene.world.colliders[collider].set_shape(shape);
        for _ in 0..30 {
            scene.step()?;
            assert!(scene.height(crate_body).is_finite());
        }
        assert!(scene.height(crate_body) > 1.2, "the beam still carries it");
    }
    scene.world.remove_collider(collider);
    scene.steps(120)?;
    assert!(scene.height(crate_body) < 1.0, "nothing holds it any more");
    Ok(())
}

#[test]
fn sleeping_boxes_wake_when_a_flexible_body_touches_them_and_not_before() -> Outcome {
    let mut scene = Scene::with_floor();
    let crates = [0.5, 3.0].map(|x| scene.insert_box(0.25, [x, 0.25], 500.0));
    scene.steps(300)?;
    let sleeps = |scene: &Scene| crates.map(|handle| scene.world.bodies[handle].is_sleeping());
    assert_eq!(sleeps(&scene), [true, true]);
    // One metre of fall takes 0.45 s.
    let block = scene.insert(square().translation([0.05, 1.5]))?;
    scene.steps(12)?;
    assert_eq!(sleeps(&scene), [true, true], "nothing touches them yet");
    scene.steps(48)?;
    assert_eq!(sleeps(&scene), [false, true]);
    scene.steps(240)?;
    // The block rests on the box and on nothing else, or fell beside it: the box bears what it bears.
    let bottom = scene.flex_bodies[block]
        .positions()
        .chunks_exact(2)
        .map(|at| at[1])
        .fold(f64::INFINITY, f64::min);
    assert!(bottom > -1e-6, "{bottom} m");
    Ok(())
}

/// What a user most likely did not mean is told once, in the first step, whatever the order of insertion; the step is taken.
#[test]
fn overlaps_and_pins_that_choose_nothing_are_told_in_the_first_step() -> Outcome {
    let small = || FlexBodyBuilder::rectangle([0.2, 0.2], [2, 2]).material(rubber());
    for rigid_first in [false, true] {
        let mut scene = Scene::with_floor();
        let mut rigid = None;
        if rigid_first {
            rigid = Some(scene.insert_box(0.3, [10.5, 5.9], 100.0));
        }
        let outer = scene.insert(square().translation([0.0, 5.0]))?;
        // Wholly inside: no surfaces cross.
        let inner = scene.insert(small().translation([0.4, 5.4]))?;
        let crossed = scene.insert(square().translation([5.0, 5.0]))?;
        let crossing = scene.insert(square().translation([5.8, 5.1]))?;
        let pierced = scene.insert(square().translation([10.0, 5.0]))?;
        // Flush neighbours and a floor that is touched: nothing is wrong with them.
        scene.insert(square().translation([20.0, 0.0]))?;
        scene.insert(square().translation([20.0, 1.0]))?;
        scene.insert(square().translation([21.0, 0.0]).rotation(0.0))?;
        let loose = scene.insert(
            small()
                .pin_where(|[x, _]| x == 0.4, Pin::both())
                .translation([30.0, 5.0]),
        )?;
        let sunk = scene.insert(square().translation([40.0, -0.2]))?;
        let rigid = rigid.unwrap_or_else(|| scene.insert_box(0.3, [10.5, 5.9], 100.0));
        let rigid = scene.world.bodies[rigid].colliders()[0];
        let floor = scene
            .world
            .colliders
            .iter()
            .find(|(_, one)| one.parent().is_none());
        let floor = floor.expect("the floor").0;
        let notes = scene.step()?.insertion_notes().to_vec();
        let overlaps = |one: FlexBodyHandle, with: Participant| {
            notes.iter().any(|note| {
                let InsertionNote::Overlap { body, with: found } = *note else {
                    return false;
                };
                (body, found) == (one, with)
                    || (Participant::Flex(body), found) == (with, Participant::Flex(one))
            })
        };
        assert!(overlaps(outer, Participant::Flex(inner)), "{notes:?}");
        assert!(overlaps(crossed, Participant::Flex(crossing)), "{notes:?}");
        assert!(overlaps(pierced, Participant::Rigid(rigid)), "{notes:?}");
        assert!(overlaps(sunk, Participant::Rigid(floor)), "{notes:?}");
        let idle = InsertionNote::NothingPinned {
            body: loose,
            n_calls: 1,
        };
        assert!(notes.contains(&idle), "{notes:?}");
        assert!(idle.to_string().contains("pin_where"));
        assert_eq!(notes.len(), 5, "{notes:?}");
        assert!(scene.step()?.insertion_notes().is_empty(), "told once");
    }
    Ok(())
}

/// A half-space is where its body puts it, below the body or not: parry tells another depth of its own.
#[test]
fn a_half_space_anywhere_is_overlapped_by_what_is_in_it() -> Outcome {
    for (turn, at) in [(0.0, [0.0, -0.7]), (0.0, [3.0, 5.0]), (0.6, [-2.0, 1.0])] {
        for depth in [-0.3, -0.001, 0.05, 0.2] {
            let mut scene = Scene::without_gravity();
            let (sin, cos) = f64::sin_cos(turn);
            let body = RigidBodyBuilder::fixed()
                .translation(vec2(at[0], at[1]))
                .rotation(turn as Real);
            let plane = ColliderBuilder::new(SharedShape::halfspace(vec2(0.0, 1.0)));
            scene.world.insert(body, plane);
            // The lower left corner goes below the plane, two metres along it.
            let corner = [2.0, -depth];
            let [x, y] = [
                cos * corner[0] - sin * corner[1],
                sin * corner[0] + cos * corner[1],
            ];
            let block = square().rotation(turn).translation([at[0] + x, at[1] + y]);
            scene.insert(block)?;
            let report = scene.step()?;
            let is_told = !report.insertion_notes().is_empty();
            assert_eq!(
                is_told,
                depth > 0.0,
                "turned {turn}, at {at:?}, {depth} m deep"
            );
            let told = report.gap_violation();
            assert!(told <= depth.max(0.0) + 1e-6, "{told} m of {depth} m");
            assert!(depth < 0.0 || told > 0.5 * depth, "{told} m of {depth} m");
        }
    }
    Ok(())
}

/// Rapier stops a body that is disabled, and nothing meets it: so it is for a flexible one by its carrier, and it goes on as it was when it is enabled.
#[test]
fn a_body_whose_carrier_is_disabled_stops_and_goes_on_when_it_is_enabled() -> Outcome {
    for is_large in [true, false] {
        let mut scene = Scene::with_floor();
        let lower = square().translation([0.0, 0.001]);
        let upper = square().translation([0.0, 1.5]);
        let [lower, upper] = [lower, upper].map(|body| match is_large {
            true => body.large_strain(),
            false => body.small_strain(),
        });
        let (lower, upper) = (scene.insert(lower)?, scene.insert(upper)?);
        scene.steps(10)?;
        let carrier = scene.flex_bodies[lower].rigid_body_handle();
        let upper_carrier = scene.flex_bodies[upper].rigid_body_handle();
        scene.world.bodies[upper_carrier].set_enabled(false);
        let (at, velocity) = {
            let body = &scene.flex_bodies[upper];
            (body.centre_of_mass(), body.linvel())
        };
        assert!(velocity[1] < -0.1, "it falls: {velocity:?}");
        scene.steps(60)?;
        assert_eq!(scene.flex_bodies[upper].centre_of_mass(), at);
        scene.world.bodies[upper_carrier].set_enabled(true);
        scene.world.bodies[carrier].set_enabled(false);
        let centre = scene.flex_bodies[lower].centre_of_mass();
        scene.steps(60)?;
        // The lower one is not there for it: it falls through to the floor.
        let fallen = scene.flex_bodies[upper].centre_of_mass()[1];
        assert!(fallen < at[1] - 0.3, "{fallen} m");
        assert_eq!(scene.flex_bodies[lower].centre_of_mass(), centre);
        scene.steps(120)?;
        let rests = scene.flex_bodies[upper].centre_of_mass()[1];
        assert!((rests - 0.5).abs() < 0.02, "large {is_large}: {rests} m");
    }
    Ok(())
}

/// Disabled by its handle a body is out at once, what slept on it falls in the next step, and what it comes back into is told.
#[test]
fn a_body_is_disabled_and_enabled_by_its_handle() -> Outcome {
    for upper_is_flexible in [true, false] {
        let mut scene = Scene::with_floor();
        let lower = scene.insert(square())?;
        let upper = match upper_is_flexible {
            true => scene.insert(square().translation([0.0, 1.0]))?,
            false => {
                scene.insert_box(0.5, [0.5, 1.5], 1000.0);
                lower
            }
        };
        let mut n_steps = 0;
        while !scene.flex_bodies[lower].is_sleeping(&scene.world.bodies) {
            scene.steps(1)?;
            n_steps += 1;
            assert!(n_steps < 1200, "they never sleep");
        }
        let height = |scene: &Scene| match upper_is_flexible {
            true => scene.flex_bodies[upper].centre_of_mass()[1],
            false => {
                let boxes = scene.world.bodies.iter().map(|(_, body)| body);
                boxes.fold(0.0, |top: f64, body| {
                    top.max(f64::from(body.translation().y))
                })
            }
        };
        let before = height(&scene);
        let at = scene.flex_bodies[lower].centre_of_mass();
        let (flex_bodies, world) = (&mut scene.flex_bodies, &mut scene.world);
        flex_bodies.set_enabled(lower, false, world)?;
        flex_bodies.set_enabled(lower, false, world)?;
        assert!(!flex_bodies.is_enabled(lower, &world.bodies)?);
        scene.steps(1)?;
        let fallen = before - height(&scene);
        let expected = GRAVITY / 3600.0;
        assert!(
            (0.4..1.1).contains(&(fallen / expected)),
            "fallen by {fallen} of {expected} m in the first step, flexible {upper_is_flexible}"
        );
        scene.steps(180)?;
        assert!((height(&scene) - 0.5).abs() < 0.02, "on the floor");
        assert_eq!(scene.flex_bodies[lower].centre_of_mass(), at);
        let (flex_bodies, world) = (&mut scene.flex_bodies, &mut scene.world);
        flex_bodies.set_enabled(lower, true, world)?;
        assert!(flex_bodies.is_enabled(lower, &world.bodies)?);
        let report = scene.step()?;
        assert!(!report.insertion_notes().is_empty(), "it is in the other");
    }
    Ok(())
}

/// Rapier disables the joints that a body has when it is disabled, but not one that is put to it later, and panics.
#[test]
fn joints_put_to_disabled_bodies_wait_until_these_are_enabled() -> Outcome {
    for other_is_fixed in [true, false] {
        let mut scene = Scene::with_floor();
        scene.insert(square())?;
        let first = scene.insert_box(0.1, [4.0, 3.0], 100.0);
        let second = scene.insert_box(0.1, [5.0, 3.0], 100.0);
        // Rapier looks at all joints where half of the bodies or more are awake.
        for x in [7.0, 8.0, 9.0] {
            scene.insert_box(0.1, [x, 9.0], 100.0);
        }
        if other_is_fixed {
            scene.world.bodies[second].set_body_type(RigidBodyType::Fixed, true);
        } else {
            scene.world.bodies[second].set_enabled(false);
        }
        scene.world.bodies[first].set_enabled(false);
        scene.steps(2)?;
        let joint = FixedJointBuilder::new().local_anchor1(vec2(1.0, 0.0));
        scene
            .world
            .impulse_joints
            .insert(first, second, joint, true);
        scene.steps(2)?;
        assert!((scene.height(first) - 3.0).abs() < 1e-6);
        for body in [first, second] {
            scene.world.bodies[body].set_enabled(true);
        }
        scene.steps(30)?;
        let [one, other] = [first, second].map(|body| scene.world.bodies[body].translation());
        assert!((one - other).length() - 1.0 < 1e-2, "the joint holds");
        let has_fallen = scene.height(first) < 2.5;
        assert_eq!(has_fallen, !other_is_fixed);
    }
    Ok(())
}

/// What has come to where a body is while it was out of the world is told when it comes back.
#[test]
fn what_a_body_comes_back_into_is_told() -> Outcome {
    let mut scene = Scene::with_floor();
    let block = scene.insert(square())?;
    scene.steps(5)?;
    let carrier = scene.flex_bodies[block].rigid_body_handle();
    scene.world.bodies[carrier].set_enabled(false);
    scene.insert_box(0.2, [0.5, 0.3], 500.0);
    scene.steps(60)?;
    assert!(scene.step()?.insertion_notes().is_empty());
    scene.world.bodies[carrier].set_enabled(true);
    assert_eq!(scene.step()?.insertion_notes().len(), 1);
    assert!(scene.step()?.insertion_notes().is_empty(), "told once");
    Ok(())
}
