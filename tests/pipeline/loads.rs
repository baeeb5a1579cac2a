//! Pins, supports, forces, gravity and velocities.

use crate::support::*;

/// A cantilever of 2 m × 0.4 m × 0.1 m along x, clamped at `x = 0`, 80 kg.
fn cantilever() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([2.0, 0.4], [16, 4])
        .material(elastic(1e7, 1000.0, 2e-2))
        .thickness(0.1)
        .pin_where(|[x, _]| x == 0.0, Pin::both())
        .can_sleep(false)
}

#[test]
fn supports_of_a_clamped_beam_carry_its_weight_and_its_moment() -> Outcome {
    let mut scene = Scene::default();
    let beam = scene.insert(cantilever())?;
    scene.steps(1200)?;
    let body = &scene.flex_bodies[beam];
    let weight = GRAVITY * body.mass();
    assert!((body.mass() - 80.0).abs() < 1e-9);
    let [x, y] = body.total_reaction();
    // At rest only what 20 s of damping left; gravity is rapier's 9.81, rounded.
    let tolerance = 1e-6 * weight;
    assert!(
        x.abs() < tolerance && (y - weight).abs() < tolerance,
        "{x} {y}"
    );
    // The moment balances the weight at the deformed centre of mass.
    let moment = body.reaction_moment([0.0, 0.0]);
    let expected = weight * body.centre_of_mass()[0];
    assert!(
        (moment - expected).abs() < tolerance,
        "{moment} not {expected}"
    );
    assert!((expected / weight - 1.0).abs() < 0.01);
    assert!(body.total_contact_force() == [0.0; 2]);
    Ok(())
}

#[test]
fn a_tip_force_adds_itself_and_its_lever_to_the_supports() -> Outcome {
    let mut scene = Scene::without_gravity();
    let beam = scene.insert(cantilever().small_strain())?;
    // Node 16 is the lower right corner.
    let tip = 16;
    scene.flex_bodies[beam].set_nodal_force(tip, [30.0, -50.0])?;
    scene.steps(1200)?;
    let body = &scene.flex_bodies[beam];
    let [x, y] = body.total_reaction();
    assert!(
        (x + 30.0).abs() < 1e-4 && (y - 50.0).abs() < 1e-4,
        "{x} {y}"
    );
    // The clamped body's theory is of first order: equilibrium holds where it was built.
    let moment = body.reaction_moment([0.0, 0.0]);
    assert!((moment - 100.0).abs() < 1e-4, "{moment} N m");
    // Timoshenko: F L³/3EI + F L/κGA down, and M L²/2EI up, for the pull acts 0.2 m below the axis.
    let deflection = body.displacement(tip)[1];
    let (bending, shear) = (1e7 * 0.1 * 0.4f64.powi(3) / 12.0, 1e7 / 2.6 * 0.04 / 1.2);
    let down = 50.0 * (8.0 / (3.0 * bending) + 2.0 / shear);
    let up = 30.0 * 0.2 * 4.0 / (2.0 * bending);
    assert!(
        (deflection / (up - down) - 1.0).abs() < 0.02,
        "{deflection} not {}",
        up - down
    );
    // Setting the force again replaces it.
    scene.flex_bodies[beam].set_nodal_force(tip, [0.0, 0.0])?;
    scene.steps(1200)?;
    let body = &scene.flex_bodies[beam];
    assert!(body.displacement(tip)[1].abs() < 1e-6);
    assert!(body.total_reaction()[1].abs() < 1e-4);
    Ok(())
}

#[test]
fn nodal_forces_of_the_builder_add_up_and_accelerate_a_free_body() -> Outcome {
    let mut scene = Scene::without_gravity();
    let pushed = scene.insert(
        square()
            .nodal_force(0, [100.0, 0.0])
            .nodal_force(0, [50.0, 0.0])
            .nodal_force(20, [150.0, 0.0]),
    )?;
    let t = {
        scene.steps(60)?;
        60.0 * scene.dt()
    };
    let body = &scene.flex_bodies[pushed];
    // Opposite corners of one side: no torque, a = 300 N / 1000 kg, to the round-off of 60 steps.
    let [vx, vy] = body.linvel();
    assert!((vx - 0.3 * t).abs() < 1e-9 && vy.abs() < 1e-9, "{vx} {vy}");
    let [x, _] = body.centre_of_mass();
    assert!((x - 0.5 - 0.15 * t * t).abs() < 1e-9, "{x}");
    assert!(body.angle().abs() < 1e-6, "{}", body.angle());
    Ok(())
}

#[test]
fn gravity_scale_and_body_force_accelerate_by_what_they_say() -> Outcome {
    let mut scene = Scene::default();
    let cases = [
        (scene.insert(square())?, -1.0),
        (
            scene.insert(square().translation([3.0, 0.0]).gravity_scale(0.0))?,
            0.0,
        ),
        (
            scene.insert(square().translation([6.0, 0.0]).gravity_scale(0.5))?,
            -0.5,
        ),
        (
            scene.insert(square().translation([9.0, 0.0]).gravity_scale(-2.0))?,
            2.0,
        ),
        (
            scene.insert(
                square()
                    .translation([12.0, 0.0])
                    .body_force([0.0, 2.0 * 9.81]),
            )?,
            1.0,
        ),
    ];
    let late = scene.insert(square().translation([15.0, 0.0]))?;
    scene.flex_bodies[late].set_gravity_scale(0.0)?;
    scene.flex_bodies[late].set_body_force([9.81, 0.0])?;
    scene.steps(60)?;
    let t = 60.0 * scene.dt();
    for (handle, factor) in cases {
        let y = scene.flex_bodies[handle].centre_of_mass()[1] - 0.5;
        // Rapier's gravity is rounded: 9.81 in f32 is off by 3e-8.
        let expected = 0.5 * factor * GRAVITY * t * t;
        assert!((y - expected).abs() < 1e-5, "{factor}: {y} not {expected}");
    }
    let [x, y] = scene.flex_bodies[late].centre_of_mass();
    assert!((x - 15.5 - 0.5 * GRAVITY * t * t).abs() < 1e-9 && (y - 0.5).abs() < 1e-12);
    Ok(())
}

#[test]
fn velocities_set_at_run_time_move_the_body_as_they_say() -> Outcome {
    let mut scene = Scene::without_gravity();
    let body = scene.insert(square())?;
    scene.steps(5)?;
    // A translation of (2, -1) m/s and a spin of 0.5 rad/s about the centre.
    let velocities: Vec<f64> = scene.flex_bodies[body]
        .positions()
        .chunks_exact(2)
        .flat_map(|at| [2.0 - 0.5 * (at[1] - 0.5), -1.0 + 0.5 * (at[0] - 0.5)])
        .collect();
    scene.flex_bodies[body].set_velocities(&velocities)?;
    assert_eq!(scene.flex_bodies[body].velocities(), &velocities[..]);
    scene.steps(60)?;
    let t = 60.0 * scene.dt();
    let moved = &scene.flex_bodies[body];
    let [x, y] = moved.centre_of_mass();
    assert!((x - 0.5 - 2.0 * t).abs() < 1e-9 && (y - 0.5 + t).abs() < 1e-9);
    // The spin stretches the square by ρω²L²/E of 1e-4; angular momentum holds it to that.
    assert!(
        (moved.angle() - 0.5 * t).abs() < 2e-4 * t,
        "{}",
        moved.angle()
    );
    // Pinned directions stay at rest.
    let held = scene.insert(cantilever().translation([10.0, 0.0]))?;
    let n = 2 * scene.flex_bodies[held].n_nodes();
    scene.flex_bodies[held].set_velocities(&vec![1.0; n])?;
    assert_eq!(scene.flex_bodies[held].velocity(0), [0.0; 2]);
    assert_eq!(scene.flex_bodies[held].velocity(16), [1.0; 2]);
    scene.step()?;
    assert_eq!(scene.flex_bodies[held].displacement(0), [0.0; 2]);
    Ok(())
}

#[test]
fn a_prescribed_displacement_stretches_a_bar_by_hookes_law() -> Outcome {
    let mut scene = Scene::without_gravity();
    // ν = 0, so that clamped ends do not disturb the uniform strain.
    let (young, length, area) = (1e6, 2.0, 0.02);
    let bar = scene.insert(
        FlexBodyBuilder::rectangle([length, 0.2], [10, 2])
            .small_strain()
            .material(
                LinearElastic::plane_stress(young, 0.0)
                    .density(1000.0)
                    .rayleigh(2e-2),
            )
            .can_sleep(false)
            .thickness(0.1)
            .pin_where(|[x, _]| x == 0.0, Pin::both())
            .pin_where(|[x, _]| x == 2.0, Pin::x()),
    )?;
    let pulled: Vec<usize> = [10, 21, 32].to_vec();
    let stretch = 0.01;
    for step in 1..=60 {
        let now = stretch * f64::from(step) / 60.0;
        for &node in &pulled {
            // The y direction is not pinned there: its value is ignored.
            scene.flex_bodies[bar].set_pin_displacement(node, [now, 77.0])?;
        }
        scene.step()?;
        let body = &scene.flex_bodies[bar];
        for &node in &pulled {
            let [x, y] = body.displacement(node);
            assert!((x - now).abs() < 1e-14 && y.abs() < 1e-3, "{x} {y}");
        }
    }
    scene.steps(1200)?;
    let body = &scene.flex_bodies[bar];
    let force: f64 = pulled.iter().map(|&node| body.reaction(node)[0]).sum();
    let expected = young * area * stretch / length;
    assert!(
        (force / expected - 1.0).abs() < 1e-9,
        "{force} not {expected}"
    );
    let total = body.total_reaction();
    assert!(total[0].abs() < 1e-9 * expected && total[1].abs() < 1e-9 * expected);
    let energy = body.energy();
    assert!((energy.elastic / (0.5 * expected * stretch) - 1.0).abs() < 1e-9);
    Ok(())
}

#[test]
fn a_hinge_that_is_moved_takes_its_body_along() -> Outcome {
    let mut scene = Scene::default();
    let pendulum = scene.insert(
        FlexBodyBuilder::rectangle([0.2, 1.0], [2, 8])
            .material(rubber())
            .pin(25, Pin::both()),
    )?;
    scene.steps(10)?;
    for step in 1..=240 {
        let x = 0.5 * (1.0 - (std::f64::consts::PI * f64::from(step) / 240.0).cos());
        scene.flex_bodies[pendulum].set_pin_displacement(25, [x, 0.1 * x])?;
        scene.step()?;
        let [dx, dy] = scene.flex_bodies[pendulum].displacement(25);
        assert!((dx - x).abs() < 1e-12 && (dy - 0.1 * x).abs() < 1e-12);
    }
    let body = &scene.flex_bodies[pendulum];
    let [x, y] = body.centre_of_mass();
    // It hangs about half a metre below the hinge and swings by less than a right angle.
    let [hinge_x, hinge_y] = body.position(25);
    let arm = (x - hinge_x).hypot(y - hinge_y);
    assert!(
        (arm - 0.5).abs() < 0.02 && y < hinge_y,
        "{arm} m, {y} under {hinge_y}"
    );
    Ok(())
}

#[test]
fn user_data_travels_with_the_body() -> Outcome {
    let mut scene = Scene::default();
    let body = scene.insert(square().user_data(42))?;
    assert_eq!(scene.flex_bodies[body].user_data, 42);
    scene.flex_bodies[body].user_data = u128::MAX;
    scene.steps(3)?;
    assert_eq!(scene.flex_bodies[body].user_data, u128::MAX);
    let removed = scene.flex_bodies.remove(body, &mut scene.world)?;
    assert_eq!(removed.user_data, u128::MAX);
    Ok(())
}
