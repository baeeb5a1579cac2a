//! Bodies that are thrown, struck and put elsewhere between steps.

use crate::support::*;
use foil2d::body::FlexBodyError;

/// A block of 1 m × 0.6 m that has been struck and vibrates as it flies and turns, of either kind.
fn flying(is_large: bool) -> Result<(Scene, FlexBodyHandle), Box<dyn std::error::Error>> {
    let mut scene = Scene::without_gravity();
    let block = FlexBodyBuilder::rectangle([1.0, 0.6], [6, 4]).material(elastic(1e6, 1000.0, 0.0));
    let block = match is_large {
        true => block,
        false => block.small_strain(),
    };
    let block = scene.insert(block.linvel([1.0, 0.5]).angvel(2.0).rotation(0.3))?;
    scene.flex_bodies[block].apply_impulse_at_node(0, [40.0, -70.0])?;
    scene.steps(5)?;
    Ok((scene, block))
}

/// Turned by `angle` about the origin.
fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * x - sin * y, sin * x + cos * y]
}

#[test]
fn linear_and_angular_velocity_are_set_apart_from_each_other_and_from_vibrations() -> Outcome {
    for is_large in [true, false] {
        let (mut scene, block) = flying(is_large)?;
        let body = &mut scene.flex_bodies[block];
        let (spin, rate) = (body.angvel(), body.state().rate.clone());
        let largest = rate
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        assert!(
            largest > 1e-2,
            "it vibrates by {largest} m/s, large {is_large}"
        );
        body.set_linvel([-3.0, 4.0])?;
        assert!(is_near(&body.linvel(), &[-3.0, 4.0], 1e-12));
        assert!((body.angvel() - spin).abs() < 1e-12);
        body.set_angvel(-5.0)?;
        assert!(is_near(&body.linvel(), &[-3.0, 4.0], 1e-12));
        assert!((body.angvel() + 5.0).abs() < 1e-12);
        // The frame of a deformed body turns as its angular momentum about the places of the undeformed one tells.
        assert!(is_near(&body.state().rate, &rate, 0.1), "vibrations stay");
        scene.steps(10)?;
        assert!(is_near(
            &scene.flex_bodies[block].linvel(),
            &[-3.0, 4.0],
            1e-9
        ));
    }
    Ok(())
}

#[test]
fn impulses_change_both_momenta_by_what_they_are() -> Outcome {
    let origin = [0.3, -0.2];
    for is_large in [true, false] {
        let (mut scene, block) = flying(is_large)?;
        let body = &mut scene.flex_bodies[block];
        let moment =
            |[x, y]: [f64; 2], [px, py]: [f64; 2]| (x - origin[0]) * py - (y - origin[1]) * px;
        let [px, py] = body.momentum();
        let about = body.angular_momentum(origin);
        let centre = body.centre_of_mass();
        body.apply_impulse([20.0, -10.0])?;
        body.apply_impulse_at_point([-5.0, 30.0], [2.0, 1.0])?;
        body.apply_torque_impulse(7.0)?;
        assert!(is_near(&body.momentum(), &[px + 15.0, py + 20.0], 1e-9));
        let expected =
            about + moment(centre, [20.0, -10.0]) + moment([2.0, 1.0], [-5.0, 30.0]) + 7.0;
        assert!((body.angular_momentum(origin) - expected).abs() < 1e-9);
    }
    Ok(())
}

#[test]
fn a_body_put_elsewhere_goes_on_there_as_it_would_have_where_it_was() -> Outcome {
    for is_large in [true, false] {
        let [(mut here, block), (mut there, other)] = [flying(is_large)?, flying(is_large)?];
        let body = &here.flex_bodies[block];
        let (centre, angle) = (body.centre_of_mass(), body.angle());
        let (linvel, spin) = (body.linvel(), body.angvel());
        here.flex_bodies
            .set_position(block, centre, angle, &mut here.world)?;
        let (new, turn) = ([7.0, -3.0], 2.2);
        there
            .flex_bodies
            .set_position(other, new, angle + turn, &mut there.world)?;
        let body = &there.flex_bodies[other];
        assert!(is_near(&body.centre_of_mass(), &new, 1e-12));
        assert!((body.angle() - angle - turn).abs() < 1e-12);
        assert!(is_near(&body.linvel(), &linvel, 1e-12) && (body.angvel() - spin).abs() < 1e-12);
        // What a body of large strain damps depends a little on how old its factor is, which its axes have a say in.
        let later = if is_large { 1e-5 } else { 1e-8 };
        for (n, tolerance) in [(1, 1e-12), (29, later)] {
            here.steps(n)?;
            there.steps(n)?;
            let (one, two) = (&here.flex_bodies[block], &there.flex_bodies[other]);
            let [from, to] = [one, two].map(FlexBody::centre_of_mass);
            let mut off = 0.0_f64;
            for node in 0..one.n_nodes() {
                let [a, b] = [one.position(node), two.position(node)];
                let arm = turned([a[0] - from[0], a[1] - from[1]], turn);
                off = off.max((to[0] + arm[0] - b[0]).hypot(to[1] + arm[1] - b[1]));
            }
            assert!(off < tolerance, "{off:e} m, large strain: {is_large}");
        }
    }
    Ok(())
}

#[test]
fn what_rested_on_a_body_put_elsewhere_falls_and_the_body_rests_where_it_was_put() -> Outcome {
    for is_large in [true, false] {
        let mut scene = Scene::with_floor();
        let block = match is_large {
            true => square(),
            false => square().small_strain(),
        };
        let block = scene.insert(block)?;
        let load = scene.insert_box(0.2, [0.5, 1.2], 500.0);
        scene.steps(400)?;
        assert!(scene.flex_bodies[block].is_sleeping(&scene.world.bodies));
        assert!(scene.world.bodies[load].is_sleeping());
        scene
            .flex_bodies
            .set_position(block, [5.5, 0.6], 0.0, &mut scene.world)?;
        // Rapier's queries see it after the next step.
        scene.step()?;
        assert!(!scene.flex_bodies[block].is_sleeping(&scene.world.bodies));
        assert!(
            scene
                .look_down(5.5)
                .is_some_and(|(_, top)| (top - 1.1).abs() < 0.05)
        );
        scene.steps(120)?;
        assert!(
            (scene.height(load) - 0.2).abs() < 0.02,
            "{}",
            scene.height(load)
        );
        let body = &scene.flex_bodies[block];
        let [x, y] = body.total_contact_force();
        let weight = GRAVITY * body.mass();
        assert!(
            x.abs() < 1e-2 * weight && (y - weight).abs() < 1e-2 * weight,
            "{x} {y}"
        );
    }
    Ok(())
}

#[test]
fn what_a_body_is_put_into_is_told_and_parts() -> Outcome {
    let mut scene = Scene::with_floor();
    let block = scene.insert(square())?;
    scene.steps(5)?;
    assert!(scene.step()?.insertion_notes().is_empty());
    scene
        .flex_bodies
        .set_position(block, [0.5, 0.4], 0.0, &mut scene.world)?;
    assert_eq!(scene.step()?.insertion_notes().len(), 1);
    scene.steps(120)?;
    assert!(scene.flex_bodies[block].centre_of_mass()[1] > 0.49);
    Ok(())
}

#[test]
fn what_cannot_be_steered_is_refused_and_nothing_changes() -> Outcome {
    let (mut scene, block) = flying(true)?;
    let pinned = scene.insert(square().translation([9.0, 0.0]).pin(0, Pin::both()))?;
    let before = scene.bits();
    let Scene {
        world, flex_bodies, ..
    } = &mut scene;
    let body = &mut flex_bodies[block];
    assert!(body.set_linvel([f64::NAN, 0.0]).is_err());
    assert!(body.set_angvel(1e30).is_err());
    assert!(body.apply_impulse([f64::INFINITY, 0.0]).is_err());
    assert!(
        body.apply_impulse_at_point([1.0, 0.0], [f64::NAN, 0.0])
            .is_err()
    );
    assert!(body.apply_torque_impulse(f64::NAN).is_err());
    assert!(body.apply_impulse_at_node(0, [f64::NAN, 0.0]).is_err());
    assert!(body.apply_impulse_at_node(10_000, [1.0, 0.0]).is_err());
    let far = flex_bodies.set_position(block, [1e30, 0.0], 0.0, world);
    assert_eq!(far, Err(FlexBodyError::NotFinite("the position")));
    assert!(
        flex_bodies
            .set_position(block, [0.0, 0.0], f64::NAN, world)
            .is_err()
    );
    let held = flex_bodies.set_position(pinned, [0.0, 0.0], 0.0, world);
    assert_eq!(held, Err(FlexBodyError::Pinned(pinned)));
    let foreign = flex_bodies.set_position(block, [0.0, 0.0], 0.0, &mut PhysicsWorld::new());
    assert_eq!(foreign, Err(FlexBodyError::NoCarrier(block)));
    assert_eq!(scene.bits(), before);
    Ok(())
}

/// A cantilever of 2 m × 0.2 m along x, clamped at `x = 0`, that has come to rest under its weight.
fn sagging(is_large: bool) -> Result<(Scene, FlexBodyHandle), Box<dyn std::error::Error>> {
    let mut scene = Scene::default();
    let beam = FlexBodyBuilder::rectangle([2.0, 0.2], [20, 2])
        .material(elastic(1e8, 1000.0, 3e-2))
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    let beam = scene.insert(if is_large { beam } else { beam.small_strain() })?;
    scene.steps(600)?;
    Ok((scene, beam))
}

#[test]
fn a_body_of_another_material_or_thickness_comes_to_rest_as_one_built_so() -> Outcome {
    // The tip of the lower edge.
    let tip = 20;
    for is_large in [true, false] {
        let (mut scene, beam) = sagging(is_large)?;
        let before = scene.flex_bodies[beam].displacement(tip)[1];
        let elastic_energy = scene.flex_bodies[beam].energy().elastic;
        let softer = elastic(5e7, 1000.0, 3e-2);
        scene.flex_bodies[beam].set_material(softer)?;
        let found = scene.flex_bodies[beam].energy().elastic;
        assert!((found - 0.5 * elastic_energy).abs() < 1e-6 * elastic_energy);
        scene.steps(600)?;
        let after = scene.flex_bodies[beam].displacement(tip)[1];
        assert!((after / before - 2.0).abs() < 0.01, "{before} {after} m");
        // Twice as thick it weighs twice as much, and sags as before.
        scene.flex_bodies[beam].set_thickness(2.0)?;
        scene.steps(600)?;
        let body = &scene.flex_bodies[beam];
        assert!((body.displacement(tip)[1] - after).abs() < 1e-6);
        assert!((body.mass() - 800.0).abs() < 1e-9);
        let weight = GRAVITY * body.mass();
        assert!((body.total_reaction()[1] - weight).abs() < 1e-5 * weight);
    }
    Ok(())
}

#[test]
fn what_a_body_cannot_be_made_of_is_refused_and_nothing_changes() -> Outcome {
    let (mut scene, beam) = sagging(true)?;
    let before = scene.bits();
    let body = &mut scene.flex_bodies[beam];
    assert!(body.set_material(elastic(-1.0, 1000.0, 0.0)).is_err());
    assert!(body.set_material(elastic(1e8, f64::NAN, 0.0)).is_err());
    assert!(body.set_thickness(0.0).is_err());
    assert!(body.set_thickness(1e300).is_err());
    assert_eq!(scene.bits(), before);
    let body = &scene.flex_bodies[beam];
    assert!((body.mass() - 400.0).abs() < 1e-9 && body.model().thickness() == 1.0);
    Ok(())
}

#[test]
fn what_overloads_a_body_is_forgotten_with_it() -> Outcome {
    let (mut scene, block) = flying(true)?;
    let body = &mut scene.flex_bodies[block];
    body.apply_impulse_at_node(0, [1e300, 0.0])?;
    assert_eq!(body.nodal_impulses()[0], 1e300);
    scene.step()?;
    let body = &scene.flex_bodies[block];
    assert!(body.is_quarantined() && body.nodal_impulses().iter().all(|j| *j == 0.0));
    let PhysicsWorld {
        bodies, colliders, ..
    } = &mut scene.world;
    scene.flex_bodies.reinstate(block, bodies, colliders)?;
    scene.steps(3)?;
    assert!(!scene.flex_bodies[block].is_quarantined());
    Ok(())
}
