//! Energy: kept exactly where nothing dissipates, accounted for where something does, and never added by contact.

mod common;

use common::*;

/// Largest relative change of `total` over a run, and its value at the beginning.
fn beam(young: f64, dt: f64) -> Scene {
    let mut scene = Scene::in_free_space(dt);
    let builder = FlexBodyBuilder::rectangle([1.0, 0.1], [20, 2])
        .material(LinearElastic::plane_stress(young, 0.3).density(1000.0))
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    let body = builder.clone().build().expect("the beam is right");
    let speed = 0.02 * (young / 1e6).sqrt();
    let velocities = body
        .mesh()
        .nodes()
        .iter()
        .map(|&[x, y]| [0.2 * speed * y * x, speed * x * x])
        .collect();
    scene.flexible(builder.velocities(velocities));
    scene
}

#[test]
fn a_clamped_vibrating_beam_keeps_its_energy_over_ten_thousand_steps() {
    for (young, dt) in [(1e6, 1.0 / 60.0), (2.1e11, 1.0 / 60.0), (2.1e11, 1e-5)] {
        let mut scene = beam(young, dt);
        let start = {
            let (_, body) = scene.bodies.iter().next().expect("one body");
            body.energy().kinetic + body.energy().elastic
        };
        let mut worst = 0.0f64;
        let mut elastic = 0.0f64;
        for _ in 0..10_000 {
            let report = scene.step();
            worst = worst.max((report.energy().total() / start - 1.0).abs());
            elastic = elastic.max(report.energy().elastic / start);
        }
        println!("E {young:.0e} dt {dt:.2e}: drift {worst:.2e}, elastic share {elastic:.3}");
        assert!(elastic > 0.8, "the beam does not vibrate: {elastic}");
        assert!(worst <= 1e-9, "E {young}, dt {dt}: energy drifts by {worst:e}");
    }
}

/// A free square that spins at 3 rad/s, flies and vibrates in its stretching mode.
fn spinning(young: f64, dt: f64, steps: usize) -> [f64; 3] {
    let mut scene = Scene::in_free_space(dt);
    let builder = FlexBodyBuilder::rectangle([1.0, 1.0], [6, 6])
        .material(LinearElastic::plane_stress(young, 0.3).density(1000.0))
        .linvel([1.0, 0.5])
        .angvel(3.0);
    let velocities = builder
        .clone()
        .build()
        .expect("the block is right")
        .mesh()
        .nodes()
        .iter()
        .map(|&[x, y]| [0.2 * (x - 0.5), -0.2 * (y - 0.5)])
        .collect();
    let body = scene.flexible(builder.velocities(velocities));
    let [px, py] = scene.body(body).momentum();
    let spin = scene.body(body).angular_momentum([0.0, 0.0]);
    let energy = scene.body(body).energy().kinetic;
    let mut worst = [0.0f64; 3];
    for _ in 0..steps {
        let report = scene.step();
        let [qx, qy] = report.momentum();
        worst[0] = worst[0].max((qx - px).hypot(qy - py) / px.hypot(py));
        worst[1] = worst[1].max((report.angular_momentum() / spin - 1.0).abs());
        worst[2] = worst[2].max((report.energy().total() / energy - 1.0).abs());
    }
    worst
}

#[test]
fn a_spinning_vibrating_body_keeps_momentum_and_its_energy_error_falls_as_dt_squared() {
    let dts = [1.0 / 120.0, 1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0];
    let errors = dts.map(|dt| spinning(2e5, dt, (2.0 / dt) as usize));
    for (dt, error) in dts.iter().zip(errors) {
        println!("dt {dt:.2e}: momentum {:.1e}, angular {:.1e}, energy {:.1e}", error[0], error[1], error[2]);
    }
    println!("order {}", order(&dts, &errors.map(|e| e[2])));
    for (young, dt) in [(2e5, 1.0 / 60.0), (1e7, 1.0/60.0), (2.1e11, 1.0/60.0)] {
    println!("long {young:e} {:?}", spinning(young, dt, 10_000));
    }
}

/// Kinetic, elastic and potential energy of all flexible bodies, from the bodies themselves (J).
fn total_energy(scene: &Scene) -> f64 {
    scene
        .bodies
        .iter()
        .map(|(_, body)| {
            let energy = body.energy();
            energy.kinetic + energy.elastic + G * body.mass() * body.centre_of_mass()[1]
        })
        .sum()
}

#[test]
fn what_rayleigh_damping_takes_is_the_work_of_its_forces() {
    // Mass-proportional damping takes the power α v·M v = 2 α T, which the reports integrate independently.
    let (alpha, dt) = (0.8, 1.0 / 500.0);
    let mut scene = Scene::new(dt);
    let block = FlexBodyBuilder::rectangle([1.0, 0.1], [20, 2])
        .material(
            LinearElastic::plane_stress(1e7, 0.3)
                .density(1000.0)
                .rayleigh_mass(alpha),
        )
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    scene.flexible(block);
    let start = total_energy(&scene);
    let mut taken = 0.0;
    let mut last = 0.0;
    for _ in 0..1000 {
        let energy = *scene.step().energy();
        taken += alpha * dt * (last + energy.kinetic);
        last = energy.kinetic;
        let missing = start - total_energy(&scene) - energy.dissipated;
        // The report's work and the bodies' own potential differ by rounding only.
        assert!(missing.abs() < 1e-9 * energy.dissipated.max(1.0), "{missing:e}");
    }
    let dissipated = scene.report().energy().dissipated;
    println!("alpha: {taken} {dissipated}");
    // Both sums are second order in ω dt = 0.06 for the first mode.
    assert!((dissipated / taken - 1.0).abs() < 2e-3, "{dissipated} against {taken}");
}

#[test]
fn stiffness_damping_decays_as_its_ratio_says() {
    // ζ = β ω / 2 of the first mode, ω = 1.875² sqrt(E h² / 12 ρ) / L² (Euler–Bernoulli): energy falls as exp(-2 ζ ω t).
    let (young, dt) = (1e7, 1.0 / 500.0);
    let omega = 1.87510407f64.powi(2) * (young * 0.01 / 12.0 / 1000.0f64).sqrt();
    let beta = 0.02 / omega;
    let mut scene = Scene::in_free_space(dt);
    let builder = FlexBodyBuilder::rectangle([1.0, 0.1], [20, 2])
        .material(
            LinearElastic::plane_stress(young, 0.3)
                .density(1000.0)
                .rayleigh(beta),
        )
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    let velocities = first_mode_velocities(&builder, 0.1);
    scene.flexible(builder.velocities(velocities));
    let start = scene.bodies.iter().next().expect("a body").1.energy().kinetic;
    let steps = (2.0 / dt) as usize;
    scene.steps(steps);
    let energy = scene.report().energy();
    let decay = -(energy.total() / start).ln() / 2.0;
    println!("beta: decay {decay}, wanted {}", 0.02 * omega);
    // Shear lowers the frequency by 0.7 %, and with it the decay by 1.4 %; the trapezoidal rule by 0.1 % more.
    assert!((decay / (0.02 * omega) - 1.0).abs() < 0.03);
    assert!(((energy.total() + energy.dissipated) / start - 1.0).abs() < 1e-9);
}

/// Velocities along the first bending mode of a unit beam clamped at `x = 0`.
fn first_mode_velocities(builder: &FlexBodyBuilder, tip: f64) -> Vec<[f64; 2]> {
    let body = builder.clone().build().expect("the beam is right");
    let (k, ratio) = (1.87510407f64, 0.73409551f64);
    let mode = |x: f64| {
        let z = k * x;
        0.5 * (z.cosh() - z.cos() - ratio * (z.sinh() - z.sin()))
    };
    let slope = |x: f64| {
        let z = k * x;
        0.5 * k * (z.sinh() + z.sin() - ratio * (z.cosh() - z.cos()))
    };
    let nodes = body.mesh().nodes().iter();
    nodes
        .map(|&[x, y]| [-tip * (y - 0.05) * slope(x), tip * mode(x)])
        .collect()
}

#[test]
fn a_sliding_block_dissipates_friction_times_the_way() {
    let (mu, speed, dt) = (0.3, 3.0, 1.0 / 240.0);
    let mut scene = Scene::new(dt);
    scene.ground(mu);
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([1.0, 0.5], [8, 4])
            .material(
                LinearElastic::plane_stress(1e9, 0.3)
                    .density(1000.0)
                    .rayleigh(1e-3),
            )
            .friction(mu)
            .linvel([speed, 0.0]),
    );
    let (start, mass) = (total_energy(&scene), scene.body(block).mass());
    let at = scene.body(block).centre_of_mass()[0];
    for step in 1..=400 {
        let dissipated = scene.step().energy().dissipated;
        let missing = start - total_energy(&scene) - dissipated;
        assert!(missing.abs() < 1e-9 * start, "step {step}: {missing:e} J are not accounted for");
    }
    let way = scene.body(block).centre_of_mass()[0] - at;
    let dissipated = scene.report().energy().dissipated;
    println!("way {way} (exact {}), dissipated {dissipated} of {}", speed * speed / 2.0 / mu / G, mu * mass * G * way);
    // The block has stopped: friction took its kinetic energy, and the weight sank by its own squeeze of 1e-6 m.
    assert!((dissipated / (0.5 * mass * speed * speed) - 1.0).abs() < 1e-4);
    assert!((dissipated / (mu * mass * G * way) - 1.0).abs() < 1e-2);
}

/// A unit block with a damping ratio of 0.3 in its squeezing mode.
fn damped_block(young: f64, cells: [usize; 2], kind: foil2d::fe::mesh::CellKind) -> FlexBodyBuilder {
    let omega = std::f64::consts::FRAC_PI_2 * (young / 1000.0).sqrt();
    FlexBodyBuilder::rectangle_of([1.0, 1.0], cells, kind).material(
        LinearElastic::plane_stress(young, 0.3)
            .density(1000.0)
            .rayleigh(0.6 / omega),
    )
}

#[test]
fn a_body_at_rest_presses_with_its_weight() {
    use foil2d::fe::mesh::CellKind::{Quad4, Tri3, Tri6};
    for dt in [1.0 / 30.0, 1.0 / 60.0, 1.0 / 240.0, 1.0 / 1000.0] {
        for young in [1e5, 1e7, 2e11] {
            for (cells, kind) in [([1, 1], Quad4), ([2, 2], Quad4), ([6, 6], Quad4), ([3, 3], Tri6), ([4, 4], Tri3)] {
                let mut scene = Scene::new(dt);
                scene.ground(0.5);
                let block = scene.flexible(damped_block(young, cells, kind));
                scene.steps((2.0 / dt) as usize);
                let mut worst = 0.0f64;
                for _ in 0..20 {
                    scene.step();
                    let [fx, fy] = scene.force_on_flexible(block);
                    let weight = G * scene.body(block).mass();
                    worst = worst.max((fy / weight - 1.0).abs()).max((fx / weight).abs());
                }
                // exp(-0.3 ω t) < 1e-2 only for the softest block, whose last sway is what is left.
                let tolerance = if young < 1e6 { 1e-3 } else { 1e-6 };
                if worst > tolerance { println!("dt {dt:.1e} E {young:.0e} {cells:?} {kind:?}: {worst:.2e} {:?} {:?}", scene.force_on_flexible(block), scene.body(block).mass()*G); }
            }
        }
    }
}

#[test]
fn impacts_never_add_energy() {
    let mut dice = Dice(7);
    for case in 0..60 {
        let young = 10f64.powf(dice.between(4.0, 11.3));
        let dt = 1.0 / 10f64.powf(dice.between(30f64.log10(), 3.0));
        let cells = [dice.pick(&[1, 2, 4, 6]), dice.pick(&[2, 3, 5])];
        let angle = dice.between(-0.8, 0.8);
        let height = dice.between(0.6, 1.2);
        let (spin, vx) = (dice.between(-2.0, 2.0), dice.between(-1.0, 1.0));
        let mu = dice.pick(&[0.0, 0.3, 1.0]);
        let mut scene = Scene::new(dt);
        scene.ground(mu);
        print!("case {case}: E {young:.1e} dt 1/{:.0} cells {cells:?} angle {angle:.2} mu {mu} spin {spin:.2} ", 1.0/dt);
        scene.flexible(
            FlexBodyBuilder::rectangle([1.0, 0.6], cells)
                .material(LinearElastic::plane_stress(young, 0.3).density(1000.0))
                .friction(mu)
                .rotation(angle)
                .translation([0.0, height])
                .linvel([vx, -2.0])
                .angvel(spin),
        );
        let start = total_energy(&scene);
        let mut worst = f64::MIN;
        let mut penetration = 0.0f64;
        let (mut at, mut limited) = (0, 0.0);
        let steps = ((2.5 / dt) as usize).min(1000);
        for k in 0..steps {
            let report = match scene.flex.step(&mut scene.world, &mut scene.bodies) { Ok(r) => r, Err(e) => { println!("ERROR {e} at {k}"); break; } };
            let gain = report.energy().total() / start - 1.0;
            limited += report.energy_limited();
            if gain > worst { worst = gain; at = k; }
            penetration = penetration.max(report.gap_violation());
        }
        println!(": gain {worst:.2e} at {at}/{steps}, limited {:.1e}, left {:.2}, penetration {penetration:.1e}", limited/start, scene.report().energy().total()/start);
    }
}
