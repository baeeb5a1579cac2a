//! Fast, thin, stiff and overlapping bodies: nothing passes through and nothing gains energy.

use crate::support::*;

#[test]
fn a_fast_rigid_ball_does_not_pass_through_a_thin_beam() -> Outcome {
    for speed in [20.0, 60.0, 200.0] {
        let mut scene = Scene::without_gravity();
        scene.insert(beam())?;
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(0.0, 6.0))
            .linvel(vec2(0.0, -speed));
        let (ball, _) = scene
            .world
            .insert(body, ColliderBuilder::ball(0.1).density(10.0));
        scene.steps(60)?;
        let y = scene.height(ball);
        assert!(y > 1.0, "at {speed} m/s the ball ends at {y} m");
    }
    Ok(())
}

#[test]
fn a_ball_teleported_near_a_beam_at_high_speed_does_not_pass_through_it() -> Outcome {
    let mut scene = Scene::without_gravity();
    scene.insert(beam())?;
    let body = RigidBodyBuilder::dynamic().translation(vec2(30.0, 30.0));
    let (ball, _) = scene
        .world
        .insert(body, ColliderBuilder::ball(0.1).density(10.0));
    scene.steps(5)?;
    scene.world.bodies[ball].set_translation(vec2(0.0, 2.3), true);
    scene.world.bodies[ball].set_linvel(vec2(0.0, -120.0), true);
    scene.steps(10)?;
    assert!(scene.height(ball) > 1.0, "{}", scene.height(ball));
    Ok(())
}

#[test]
fn a_fast_flexible_body_meets_another_whichever_was_inserted_first() -> Outcome {
    for plate_first in [true, false] {
        let mut scene = Scene::without_gravity();
        let plate = || {
            FlexBodyBuilder::rectangle([4.0, 0.2], [16, 2])
                .material(rubber())
                .pin_where(|[x, _]| x == 0.0 || x == 4.0, Pin::both())
                .translation([-2.0, 0.0])
        };
        let bullet = || {
            FlexBodyBuilder::rectangle([0.2, 0.2], [2, 2])
                .material(rubber())
                .translation([-0.1, 1.5])
                .linvel([0.0, -80.0])
        };
        let bullet = if plate_first {
            scene.insert(plate())?;
            scene.insert(bullet())?
        } else {
            let bullet = scene.insert(bullet())?;
            scene.insert(plate())?;
            bullet
        };
        let mut met = false;
        for _ in 0..5 {
            met |= !scene.step()?.contacts().is_empty();
        }
        let y = scene.flex_bodies[bullet].centre_of_mass()[1];
        assert!(met, "plate first: {plate_first}: the bullet ends at {y} m");
    }
    Ok(())
}

/// Bodies of 0.6 m with inertia inside, on their contact boundary too, and in one layer of cells.
fn dropped(index: usize) -> (&'static str, FlexBodyBuilder) {
    let plate = |divisions| FlexBodyBuilder::rectangle([0.6, 0.4], divisions);
    match index {
        0 => ("four cells across", plate([4, 4])),
        1 => ("six cells across", plate([6, 6])),
        2 => ("six cells across, heavy boundary", {
            plate([6, 6]).contact_inertia(ContactInertia::Kept)
        }),
        3 => (
            "consistent mass",
            plate([6, 6]).mass_kind(MassKind::Consistent),
        ),
        4 => (
            "one layer of cells",
            FlexBodyBuilder::rectangle([1.5, 0.15], [8, 1]),
        ),
        _ => ("two cells across", plate([2, 2])),
    }
}

#[test]
fn a_dropped_body_never_has_more_energy_than_it_was_dropped_with() -> Outcome {
    let mut failures = Vec::new();
    for index in 0..6 {
        for (young, turn, height) in [
            (1e6, 0.0, 0.001),
            (1e6, 0.5, 1.0),
            (1e8, 0.0, 0.001),
            (1e8, 0.5, 0.001),
            (1e8, 0.5, 1.0),
        ] {
            let (name, builder) = dropped(index);
            let material = elastic(young, 1000.0, 2e-3);
            let mut scene = Scene::with_floor();
            let body = scene.insert(
                builder
                    .material(material)
                    .rotation(turn)
                    .translation([0.0, height]),
            )?;
            let potential = |body: &FlexBody| GRAVITY * body.mass() * body.centre_of_mass()[1];
            let start = potential(&scene.flex_bodies[body]);
            let (mut highest, mut last) = (0.0f64, 0.0f64);
            for _ in 0..240 {
                if let Err(error) = scene.step() {
                    failures.push(format!("{name}, E = {young:e}, {turn} rad: {error}"));
                    break;
                }
                let now = &scene.flex_bodies[body];
                let energy = now.energy();
                let total = energy.kinetic + energy.elastic + potential(now);
                last = total / start;
                highest = highest.max(last);
            }
            // The bar for impacts is a thousandth. A surface with mass may overshoot while it loads, within one step, and
            // pays as it unloads.
            let model = scene.flex_bodies[body].model();
            let has_mass = !(0..model.n_nodes()).any(|node| model.is_massless(node));
            let overshoot = if has_mass { 0.1 } else { 0.001 };
            if highest > 1.0 + overshoot || last > 1.0 + 1e-9 {
                failures.push(format!(
                    "{name}, E = {young:e} Pa, {turn} rad, from {height} m: energy × {highest:.3e}, then × {last:.3e}"
                ));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
    Ok(())
}

#[test]
fn a_block_that_falls_on_a_rigid_box_comes_to_rest_on_it_or_beside_it() -> Outcome {
    for x in [0.0, 0.05, -0.3] {
        let mut scene = Scene::with_floor();
        let crate_body = scene.insert_box(0.25, [0.5, 0.25], 500.0);
        let block = scene.insert(square().translation([x, 1.5]))?;
        for step in 0..300 {
            scene.step()?;
            let body = &scene.flex_bodies[block];
            let fastest = body.velocities().iter().fold(0.0f64, |v, x| v.max(x.abs()));
            // A metre of fall gives 4.4 m/s; a corner that whips round may double it twice.
            assert!(fastest < 20.0, "x = {x} m, step {step}: {fastest:e} m/s");
        }
        assert!(
            scene.height(crate_body) > 0.2,
            "the box is not pressed into the floor"
        );
        let body = &scene.flex_bodies[block];
        let lowest = body.positions().iter().skip(1).step_by(2);
        assert!(lowest.fold(f64::INFINITY, |low, y| low.min(*y)) > -1e-4);
    }
    Ok(())
}

#[test]
fn a_free_body_resists_rotation_as_its_shape_says_however_coarse_its_mesh() -> Outcome {
    for n in 2..=10 {
        let body = FlexBodyBuilder::rectangle([1.0, 1.0], [n, n])
            .material(rubber())
            .angvel(1.0)
            .build()?;
        let about = body.centre_of_mass();
        let ratio = body.angular_momentum(about) / (body.mass() / 6.0);
        // Mass lumped to the nodes lies farther out by 2/n² of the whole.
        let lumped = 1.0 + 2.0 / (n * n) as f64;
        assert!(
            ratio > 0.999 && ratio < lumped + 1e-9,
            "{n} × {n} cells: {ratio:.4} of m (a² + b²) / 12"
        );
    }
    Ok(())
}
