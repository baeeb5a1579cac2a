//! Loads, blows and changes of a body between steps bring the momentum that they are, whatever the steps.

use crate::support::*;

/// A free block of this Young's modulus (Pa) and kind, 600 kg, at rest in space.
fn block_in_space(
    young: f64,
    is_large: bool,
    integrator: Beta2,
) -> Result<(Scene, FlexBodyHandle), Box<dyn std::error::Error>> {
    let mut scene = Scene::without_gravity();
    scene.set_dt(1e-3);
    scene.flex = FlexPipeline::new().with_integrator(integrator);
    let block = FlexBodyBuilder::rectangle([1.0, 0.6], [6, 4]);
    let block = block.material(elastic(young, 1000.0, 1e-4));
    let block = scene.insert(match is_large {
        true => block,
        false => block.small_strain(),
    })?;
    scene.steps(2)?;
    Ok((scene, block))
}

/// Kinds of bodies and integrators.
fn kinds() -> Result<[(bool, Beta2); 4], Box<dyn std::error::Error>> {
    Ok([
        (true, Beta2::damped(0.9)?),
        (true, Beta2::trapezoidal()),
        (false, Beta2::damped(0.9)?),
        (false, Beta2::trapezoidal()),
    ])
}

#[test]
fn a_struck_node_takes_the_whole_impulse_whatever_the_steps() -> Outcome {
    for (is_large, integrator) in kinds()? {
        for (young, dt, size) in [
            (1e5, 1e-4, 1.0),
            (1e5, 1.0 / 60.0, 1.0),
            (1e6, 1.0 / 60.0, 1e3),
            (1e7, 1.0 / 60.0, 1.0),
            (1e9, 1e-3, 1.0),
        ] {
            let (mut scene, block) = block_in_space(young, is_large, integrator)?;
            scene.set_dt(dt);
            let body = &mut scene.flex_bodies[block];
            body.apply_impulse_at_node(0, [20.0 * size, -10.0 * size])?;
            body.apply_impulse_at_node(0, [10.0 * size, -20.0 * size])?;
            scene.step()?;
            for later in [0.25 * dt, dt, 2.0 * dt] {
                scene.set_dt(later);
                scene.step()?;
                let body = &scene.flex_bodies[block];
                let found = body.momentum();
                assert!(
                    is_near(&found, &[30.0 * size, -30.0 * size], 1e-7 * size),
                    "{young} Pa: {found:?}"
                );
                // It was struck at a corner, about which it has no angular momentum then.
                let about = body.angular_momentum([0.0, 0.0]);
                assert!(about.abs() < 0.2 * size * size, "{about}");
            }
            assert!(
                scene.flex_bodies[block].energy().elastic > 1e-4,
                "it is deformed"
            );
        }
    }
    Ok(())
}

#[test]
fn an_explicit_body_takes_the_whole_impulse_too() -> Outcome {
    let (mut scene, block) = block_in_space(1e6, false, Beta2::central_difference())?;
    scene.set_dt(1e-4);
    scene.flex_bodies[block].apply_impulse_at_node(0, [3.0, -3.0])?;
    scene.steps(5)?;
    assert!(is_near(
        &scene.flex_bodies[block].momentum(),
        &[3.0, -3.0],
        1e-9
    ));
    Ok(())
}

#[test]
fn loads_bring_their_momentum_while_they_act_whatever_the_steps() -> Outcome {
    let lengths = [1.0 / 60.0, 1.0 / 240.0, 1.0 / 90.0, 1.0 / 30.0, 1e-3];
    for (is_large, integrator) in kinds()? {
        for n_steps in [1, 5] {
            let (mut scene, block) = block_in_space(1e7, is_large, integrator)?;
            let mut passed = 0.0;
            for step in 0..n_steps + 4 {
                let acts = step < n_steps;
                let share = if acts { 1.0 } else { 0.0 };
                let body = &mut scene.flex_bodies[block];
                body.set_nodal_force(3, [share * 900.0, 0.0])?;
                body.set_body_force([0.0, share * 2.0])?;
                scene.world.gravity = vec2(share * -4.0, 0.0);
                scene.set_dt(lengths[step % lengths.len()]);
                scene.step()?;
                passed += share * scene.dt();
                let expected = [passed * (900.0 - 2400.0), passed * 1200.0];
                let found = scene.flex_bodies[block].momentum();
                // What has come is late by a part of the first step, until it is gone.
                let late = if acts && !is_large {
                    1500.0 * lengths[0]
                } else {
                    1e-7
                };
                assert!(
                    is_near(&found, &expected, late),
                    "{found:?}, not {expected:?}"
                );
            }
        }
    }
    Ok(())
}

/// Sets the material, the thickness and the place to what they are.
fn remake(scene: &mut Scene, block: FlexBodyHandle, young: f64) -> Outcome {
    let Scene {
        world, flex_bodies, ..
    } = scene;
    let body = &mut flex_bodies[block];
    body.set_material(elastic(young, 1000.0, 1e-4))?;
    body.set_thickness(1.0)?;
    let (centre, angle) = (body.centre_of_mass(), body.angle());
    flex_bodies.set_position(block, centre, angle, world)?;
    Ok(())
}

#[test]
fn a_body_made_anew_in_a_blow_keeps_the_momentum_of_both() -> Outcome {
    for is_large in [true, false] {
        for every in [1, 2] {
            let (mut scene, block) = block_in_space(1e6, is_large, Beta2::damped(0.9)?)?;
            let other = FlexBodyBuilder::rectangle([1.0, 0.6], [6, 4]).translation([1.05, 0.1]);
            let other = other
                .material(elastic(1e6, 1000.0, 1e-4))
                .linvel([-2.0, 0.0]);
            let other = scene.insert(match is_large {
                true => other,
                false => other.small_strain(),
            })?;
            scene.flex_bodies[block].set_linvel([4.0, 0.0])?;
            let mut is_met = false;
            for step in 0..60 {
                if step % every == 0 {
                    remake(&mut scene, block, 1e6)?;
                }
                scene.step()?;
                is_met |= scene.flex_bodies[block].total_contact_force()[0] < -1e3;
                let momenta = [block, other].map(|one| scene.flex_bodies[one].momentum());
                let sum = [momenta[0][0] + momenta[1][0], momenta[0][1] + momenta[1][1]];
                // The late part of the last force is still to come on either side, as much of it.
                let late = if is_large { 0.0 } else { 1e-7 * 3600.0 };
                assert!(
                    is_near(&sum, &[1200.0, 0.0], 1e-8 + late),
                    "{step}: {sum:?}"
                );
            }
            assert!(is_met);
        }
    }
    Ok(())
}

#[test]
fn a_body_made_anew_in_every_step_rests_with_its_weight() -> Outcome {
    for is_large in [true, false] {
        let mut scene = Scene::with_floor();
        let block = FlexBodyBuilder::rectangle([1.0, 0.6], [6, 4]).can_sleep(false);
        let block = block.material(elastic(1e7, 1000.0, 1e-4));
        let block = scene.insert(match is_large {
            true => block,
            false => block.small_strain(),
        })?;
        scene.steps(300)?;
        for step in 0..60 {
            remake(&mut scene, block, 1e7)?;
            scene.step()?;
            let body = &scene.flex_bodies[block];
            let share = body.total_contact_force()[1] / (GRAVITY * body.mass());
            assert!((share - 1.0).abs() < 1e-3, "{step}: {share} of the weight");
        }
    }
    Ok(())
}

/// Gravity grows with the mass, and what is still to come of a blow does not.
#[test]
fn a_body_that_grows_heavier_falls_as_before_and_feels_what_is_left_of_a_blow() -> Outcome {
    for is_large in [true, false] {
        for share in [2.0, 0.5] {
            let (mut scene, block) = block_in_space(1e7, is_large, Beta2::damped(0.9)?)?;
            scene.set_dt(1.0 / 60.0);
            scene.flex_bodies[block].apply_impulse_at_node(0, [60.0, 0.0])?;
            scene.step()?;
            let [come, _] = scene.flex_bodies[block].momentum();
            scene.flex_bodies[block].set_thickness(share)?;
            scene.steps(3)?;
            let [found, _] = scene.flex_bodies[block].momentum();
            let expected = share * come + (60.0 - come);
            assert!((found - expected).abs() < 1e-8, "{found} not {expected}");
        }
        let mut scene = Scene::default();
        let block = FlexBodyBuilder::rectangle([1.0, 0.6], [6, 4]).translation([0.0, 50.0]);
        let block = block.material(elastic(1e7, 1000.0, 1e-4));
        let block = scene.insert(match is_large {
            true => block,
            false => block.small_strain(),
        })?;
        let (gravity, mut time) = (f64::from(scene.world.gravity.y), 0.0);
        for step in 0..20 {
            match step {
                5 => scene.flex_bodies[block].set_thickness(2.0)?,
                10 => scene.flex_bodies[block].set_material(elastic(1e6, 300.0, 0.0))?,
                _ => {}
            }
            scene.step()?;
            time += scene.dt();
            let [_, velocity] = scene.flex_bodies[block].linvel();
            assert!(
                (velocity - gravity * time).abs() < 1e-9,
                "{step}: {velocity} m/s"
            );
        }
    }
    Ok(())
}
