//! Step lengths: none, changing, and the split form of the step.

use crate::support::*;
use foil2d::body::FlexBodyError;
use foil2d::coupling::RapierSets;

#[test]
fn a_step_of_no_length_moves_nothing_and_the_next_one_goes_on() -> Outcome {
    let mut scene = Scene::with_floor();
    let block = scene.insert(square().translation([0.0, 5.0]))?;
    let crate_body = scene.insert_box(0.3, [3.0, 5.0], 100.0);
    let dt = scene.dt();
    scene.set_dt(0.0);
    scene.steps(3)?;
    scene.set_dt(dt);
    for _ in 0..30 {
        scene.step()?;
        let before = scene.bits();
        scene.set_dt(0.0);
        let report = scene.step()?;
        assert!(report.contacts().is_empty());
        assert_eq!(before, scene.bits());
        scene.set_dt(dt);
    }
    // The trapezoidal rule is exact for constant acceleration; rapier's rule, with its substeps, is of first order.
    let t = 30.0 * dt;
    let fallen = 5.5 - scene.flex_bodies[block].centre_of_mass()[1];
    assert!((fallen - 0.5 * GRAVITY * t * t).abs() < 1e-5, "{fallen} m");
    let fallen = 5.0 - scene.height(crate_body);
    assert!((fallen - 0.5 * GRAVITY * t * t).abs() < GRAVITY * t * dt);
    Ok(())
}

#[test]
fn queries_work_after_a_step_of_no_length() -> Outcome {
    let mut scene = Scene::with_floor();
    let block = scene.insert(square().translation([0.0, 0.001]))?;
    scene.steps(10)?;
    let ball = ColliderBuilder::ball(0.5).translation(vec2(4.0, 3.0));
    let ball = scene.world.insert_collider(ball, None);
    scene.set_dt(0.0);
    scene.step()?;
    let surface = scene.flex_bodies[block].collider_handle();
    assert_eq!(scene.look_down(0.4).map(|hit| hit.0), Some(surface));
    assert_eq!(scene.look_down(4.0).map(|hit| hit.0), Some(ball));
    Ok(())
}

#[test]
fn every_new_step_length_costs_one_factorization_a_body_and_none_after_it() -> Outcome {
    let mut scene = Scene::with_floor();
    scene.insert(square().small_strain().translation([0.0, 0.001]))?;
    scene.insert(square().small_strain().translation([3.0, 0.001]))?;
    for (index, dt) in [1.0 / 60.0, 1.0 / 240.0, 1.0 / 1000.0, 1.0 / 30.0]
        .into_iter()
        .enumerate()
    {
        scene.set_dt(dt);
        let counts: Vec<u64> = (0..20)
            .map(|_| Ok(scene.step()?.n_factorizations()))
            .collect::<Result<_, StepError>>()?;
        assert_eq!(counts[0], 2, "step length {index}");
        assert!(counts[1..].iter().all(|&count| count == 0), "{counts:?}");
    }
    // A step of no length between two others needs no factor and spoils none.
    let dt = scene.dt();
    scene.set_dt(0.0);
    assert_eq!(scene.step()?.n_factorizations(), 0);
    scene.set_dt(dt);
    assert_eq!(scene.step()?.n_factorizations(), 0);
    Ok(())
}

#[test]
fn one_factorization_serves_for_ever_in_contact_and_in_rotation() -> Outcome {
    let mut scene = Scene::with_floor();
    scene.insert(square().small_strain().translation([0.0, 0.5]))?;
    let spinning = square().translation([5.0, 30.0]).angvel(4.0);
    scene.insert(spinning.small_strain())?;
    scene.insert(beam().small_strain().translation([10.0, 1.0]))?;
    let mut total = 0;
    for _ in 0..120 {
        total += scene.step()?.n_factorizations();
    }
    assert_eq!(total, 3);
    Ok(())
}

#[test]
fn a_changing_step_length_keeps_a_resting_block_at_rest_under_its_weight() -> Outcome {
    let mut scene = Scene::with_floor();
    let block = scene.insert(square().translation([0.0, 0.001]))?;
    scene.steps(240)?;
    let weight = GRAVITY * scene.flex_bodies[block].mass();
    let height = scene.flex_bodies[block].centre_of_mass()[1];
    for step in 0..200 {
        scene.set_dt([1.0 / 60.0, 1.0 / 240.0, 1.0 / 30.0, 1.0 / 100.0][step % 4]);
        scene.step()?;
        let body = &scene.flex_bodies[block];
        let force = body.total_contact_force()[1];
        // At rest no inertia depends on the step: what is left is what 4 s of damping left of the fall.
        assert!(
            (force / weight - 1.0).abs() < 1e-3,
            "step {step}: {force} N"
        );
        assert!((body.centre_of_mass()[1] - height).abs() < 1e-6);
    }
    Ok(())
}

/// Two bodies and two boxes, of which one of each goes after 45 steps.
fn falling() -> Result<(Scene, FlexBodyHandle), BuildError> {
    let mut scene = Scene::with_floor();
    scene.insert(beam())?;
    let upper = scene.insert(square().translation([0.1, 2.5]).rotation(0.4))?;
    scene.insert_box(0.2, [-1.0, 1.6], 500.0);
    scene.insert_box(0.2, [6.0, 0.6], 500.0);
    Ok((scene, upper))
}

#[test]
fn the_split_form_steps_and_removes_as_the_world_does() -> Outcome {
    let ((mut whole, upper), (mut split, split_upper)) = (falling()?, falling()?);
    for step in 0..90 {
        let world = &mut split.world;
        if step == 45 {
            whole.flex_bodies.remove(upper, &mut whole.world)?;
            let removed = split.flex_bodies.remove_with_sets(
                split_upper,
                &mut world.islands,
                &mut world.bodies,
                &mut world.colliders,
                &mut world.impulse_joints,
                &mut world.multibody_joints,
                &mut world.soft_bodies,
            )?;
            assert!(!world.bodies.contains(removed.rigid_body_handle()));
            assert!(split.flex_bodies.get(split_upper).is_none());
        }
        let expected = whole.step()?.clone();
        let report = split.flex.step_split(
            &mut split.flex_bodies,
            &mut world.physics_pipeline,
            world.gravity,
            &world.integration_parameters,
            &mut world.islands,
            &mut world.broad_phase,
            &mut world.narrow_phase,
            &mut world.bodies,
            &mut world.colliders,
            &mut world.impulse_joints,
            &mut world.multibody_joints,
            &mut world.soft_bodies,
            &mut world.ccd_solver,
            &(),
            &(),
        )?;
        assert_eq!(expected.contacts().len(), report.contacts().len());
        assert_eq!(expected.energy(), report.energy());
        assert_eq!(whole.bits(), split.bits(), "step {step}");
    }
    Ok(())
}

#[test]
fn a_body_is_removed_from_no_sets_but_its_own() -> Outcome {
    let ((mut one, upper), (mut other, _)) = (falling()?, falling()?);
    one.step()?;
    let world = &mut other.world;
    world.bodies.iter_mut().for_each(|(_, body)| {
        body.set_translation(vec2(1.0, 1.0), false);
    });
    let refused = one.flex_bodies.remove_with_sets(
        upper,
        &mut world.islands,
        &mut world.bodies,
        &mut world.colliders,
        &mut world.impulse_joints,
        &mut world.multibody_joints,
        &mut world.soft_bodies,
    );
    assert_eq!(refused.err(), Some(FlexBodyError::NoCarrier(upper)));
    assert_eq!(world.bodies.len(), 4);
    one.step()?;
    Ok(())
}

#[test]
fn parameters_set_in_place_are_those_of_the_builder() -> Outcome {
    let ((mut built, _), (mut set, _)) = (falling()?, falling()?);
    built.flex = FlexPipeline::new()
        .with_integrator(Beta2::trapezoidal())
        .with_impact(ImpactTreatment::Projected)
        .with_restitution_threshold(0.1);
    let flex = &mut set.flex;
    flex.parameters.integrator = Beta2::trapezoidal();
    flex.parameters.impact = ImpactTreatment::Projected;
    flex.parameters.restitution_threshold = 0.1;
    assert_eq!(built.flex.parameters, set.flex.parameters);
    for step in 0..60 {
        built.step()?;
        set.step()?;
        assert_eq!(built.bits(), set.bits(), "step {step}");
    }
    Ok(())
}

#[test]
fn parameters_out_of_range_are_refused_by_name_and_leave_no_trace() -> Outcome {
    let (mut scene, _) = falling()?;
    scene.step()?;
    let before = scene.bits();
    let sound = scene.flex.parameters;
    type Spoil = fn(&mut FlexParameters);
    let spoils: [(&str, Spoil); 3] = [
        ("max_newton", |all| all.max_newton = 0),
        ("restitution_threshold", |all| {
            all.restitution_threshold = f64::NAN;
        }),
        ("restitution_threshold", |all| {
            all.restitution_threshold = -1.0;
        }),
    ];
    for (culprit, spoil) in spoils {
        spoil(&mut scene.flex.parameters);
        let error = scene.step().map(|_| ()).expect_err(culprit);
        assert!(matches!(error, StepError::Parameter { name, .. } if name == culprit));
        assert_eq!(before, scene.bits());
        scene.flex.parameters = sound;
    }
    scene.step()?;
    Ok(())
}

#[test]
fn the_split_form_steps_as_the_world_does() -> Outcome {
    let scene = || -> Result<Scene, BuildError> {
        let mut scene = Scene::with_floor();
        scene.insert(beam())?;
        scene.insert(square().translation([0.1, 2.5]).rotation(0.4))?;
        scene.insert_box(0.2, [-1.0, 1.6], 500.0);
        scene.insert_box(0.2, [6.0, 0.6], 500.0);
        Ok(scene)
    };
    let (mut whole, mut split) = (scene()?, scene()?);
    for step in 0..90 {
        let expected = whole.step()?.clone();
        let world = &mut split.world;
        let sets = RapierSets {
            physics_pipeline: &mut world.physics_pipeline,
            gravity: world.gravity,
            integration_parameters: &world.integration_parameters,
            islands: &mut world.islands,
            broad_phase: &mut world.broad_phase,
            narrow_phase: &mut world.narrow_phase,
            bodies: &mut world.bodies,
            colliders: &mut world.colliders,
            impulse_joints: &mut world.impulse_joints,
            multibody_joints: &mut world.multibody_joints,
            soft_bodies: &mut world.soft_bodies,
            ccd_solver: &mut world.ccd_solver,
            hooks: &(),
            events: &(),
        };
        let report = split.flex.step_sets(sets, &mut split.flex_bodies)?;
        assert_eq!(expected.contacts().len(), report.contacts().len());
        assert_eq!(expected.energy(), report.energy());
        assert_eq!(whole.bits(), split.bits(), "step {step}");
    }
    Ok(())
}
