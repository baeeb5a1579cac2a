//! Central difference with multipliers at the forward increment: bars that hit a wall, free motion, partners, and what is
//! refused.

mod common;

use common::*;
use foil2d::integrator::IntegratorError;
use foil2d::linalg::complementarity::Method;
use foil2d::pipeline::StepError;

const LENGTH: f64 = 10.0;
const WIDTH: f64 = 0.1;
const SPEED: f64 = 0.1;
const WAVE_SPEED: f64 = 30.0;
const CELLS: usize = 100;

/// A guided bar of 100 cells, E = 900 Pa, rho = 1 kg/m³: c = 30 m/s.
fn bar() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([WIDTH, LENGTH], [1, CELLS])
        .small_strain()
        .material(LinearElastic::plane_stress(900.0, 0.0).density(1.0))
        .pin_where(|_| true, Pin::x())
        .friction(0.0)
}

/// The end nodes give up their inertia, or keep it.
fn end_inertia(is_kept: bool) -> ContactInertia {
    if is_kept {
        ContactInertia::Kept
    } else {
        ContactInertia::RedistributedAt(vec![0, 1])
    }
}

/// The step in which a wave passes `cfl` cells (s).
fn step_of(cfl: f64) -> f64 {
    cfl * LENGTH / CELLS as f64 / WAVE_SPEED
}

fn explicit(scene: Scene) -> Scene {
    scene.with_integrator(Beta2::central_difference())
}

/// What one impact of the bar shows.
#[derive(Debug)]
struct Impact {
    /// Largest error of the contact pressure away from its fronts, relative.
    plateau: f64,
    /// Time of the last contact force (s).
    release: f64,
    /// Least and largest energy, and that at the end, over that at the beginning, without the swing of a leapfrog.
    energy: [f64; 3],
    /// Largest energy with the swing.
    swinging: f64,
    /// Error of the sum of the forces times the step against the change of momentum, relative.
    impulse: f64,
    overlap: f64,
}

/// Benchmark B1, scaled to 0.1 m/s.
///
/// ```text
///   |#|  c = 30 m/s, v0 = 0.1 m/s, gap 0.05 m
///   |#|  contact from 0.5 s for 2 L / c = 2/3 s, pressure rho c v0 = 3 Pa throughout,
///  ===== then away at v0 and unstrained
/// ```
fn impact_of_a_bar(is_kept: bool, solver: Method) -> Impact {
    let mut scene = explicit(Scene::in_free_space(step_of(0.9)));
    scene.flex = scene.flex.with_contact_solver(solver);
    scene.ground(0.0);
    let body = scene.flexible(
        bar()
            .contact_inertia(end_inertia(is_kept))
            .linvel([0.0, -SPEED])
            .translation([0.0, 0.05]),
    );
    let momentum = scene.body(body).momentum()[1];
    let at_start = scene.body(body).energy().kinetic;
    let force = WIDTH * WAVE_SPEED * SPEED;
    let mut impact = Impact {
        plateau: 0.0,
        release: 0.0,
        energy: [1.0; 3],
        swinging: 1.0,
        impulse: 0.0,
        overlap: 0.0,
    };
    for n in 1..=500 {
        let report = scene.step();
        let swinging = report.energy().total() / at_start;
        let energy = swinging - report.energy().swing / at_start;
        impact.swinging = impact.swinging.max(swinging);
        impact.overlap = impact.overlap.max(report.gap_violation());
        impact.energy[0] = impact.energy[0].min(energy);
        impact.energy[1] = impact.energy[1].max(energy);
        impact.energy[2] = energy;
        let (time, found) = (
            n as f64 * scene.dt(),
            scene.body(body).total_contact_force()[1],
        );
        impact.impulse += found * scene.dt();
        if found > 0.0 {
            impact.release = time;
        }
        if (0.55..1.1).contains(&time) {
            impact.plateau = impact.plateau.max((found / force - 1.0).abs());
        }
    }
    let change = scene.body(body).momentum()[1] - momentum;
    impact.impulse = (impact.impulse / change - 1.0).abs();
    impact
}

/// The bars are those of the benchmark: 1 % for the plateau, two steps for the release.
#[test]
fn b1_the_bar_meets_the_wall_with_the_exact_pressure() {
    // A node with mass loses `m v0²/2` at closing, m = 1/200 of the bar, and once more what it vibrates with when it lets go;
    // while it is held it accelerates without moving, and that swing is none.
    for (is_kept, least) in [(false, 0.9999), (true, 0.985)] {
        let found = impact_of_a_bar(is_kept, Method::ActiveSet);
        println!("kept {is_kept}: {found:?}");
        assert!(found.plateau < 0.01, "{found:?}");
        let late = found.release - (0.5 + 2.0 * LENGTH / WAVE_SPEED);
        assert!(late.abs() <= 2.0 * step_of(0.9), "{found:?}");
        assert!(
            found.energy[0] > least && found.energy[1] < 1.0001,
            "{found:?}"
        );
        // Two fronts of a few cells swing, of 100.
        assert!(found.swinging < 1.005, "{found:?}");
        assert!(found.overlap < 1e-9, "{found:?}");
        // What release takes back of the last half step is in no report: 1/2 of a step of 222 at most.
        assert!(found.impulse < 1.0 / 444.0, "{found:?}");
    }
}

/// One multiplier per node hardly couples: sweeps and the direct solver agree to the tolerance of the sweeps.
#[test]
fn gauss_seidel_gives_what_the_direct_solver_gives() {
    for is_kept in [false, true] {
        let direct = impact_of_a_bar(is_kept, Method::ActiveSet);
        let swept = impact_of_a_bar(is_kept, Method::GaussSeidel);
        assert_eq!(direct.release, swept.release);
        assert!(
            (direct.plateau - swept.plateau).abs() < 1e-9,
            "{direct:?} {swept:?}"
        );
        assert!(
            (direct.energy[2] - swept.energy[2]).abs() < 1e-9,
            "{direct:?} {swept:?}"
        );
    }
}

/// Benchmark B2 scaled by 1/100: dropped 0.05 m under g = 0.1 m/s², the bar bounces with a period of 16/3 s for ever.
#[test]
fn b2_the_bouncing_bar_keeps_its_energy_over_ten_periods() {
    let run = |is_kept: bool| {
        let mut scene = explicit(Scene::new(step_of(0.9))).with_gravity(0.0, -0.1);
        scene.ground(0.0);
        let body = scene.flexible(
            bar()
                .contact_inertia(end_inertia(is_kept))
                .translation([0.0, 0.05]),
        );
        let mass = scene.body(body).mass();
        let at_start = mass * 0.1 * 0.05;
        let (mut energy, mut most, mut overlap) = ([0.0; 2], 0.0f64, 0.0f64);
        for _ in 0..(10.0 * 16.0 / 3.0 / scene.dt()).round() as usize {
            let report = scene.step();
            overlap = overlap.max(report.gap_violation());
            let swinging = report.energy().total() - mass * 0.1 * 0.5 * LENGTH;
            energy = [swinging, swinging - report.energy().swing].map(|e| e / at_start);
            most = most.max(energy[1]);
        }
        println!("kept {is_kept}: energy {energy:?}, most {most}, overlap {overlap}");
        (energy, most, overlap)
    };
    let ([swinging, conserved], most, overlap) = run(false);
    assert!(swinging > 0.985 && overlap < 1e-9, "{swinging}");
    // What a leapfrog conserves: some switches late in the run have no weight between 0 and 1 that keeps it.
    assert!(
        (conserved - 1.0).abs() < 0.005 && most < 1.005,
        "{conserved}"
    );
    // A node with mass is stopped at every impact: it is known to lose, and must not gain.
    let ([_, conserved], most, _) = run(true);
    assert!(
        conserved > 0.1 && conserved < 0.5 && most < 1.002,
        "{conserved} {most}"
    );
}

/// A plate that spins, deforms and vibrates; `fixed` holds its lower edge instead.
fn plate(is_fixed: bool, inertia: ContactInertia) -> FlexBodyBuilder {
    let velocities = (0..13 * 9)
        .map(|node| {
            let (x, y) = ((node % 13) as f64 / 12.0, (node / 13) as f64 / 16.0);
            [0.3 * y * y, 0.2 * (3.0 * x).sin() * y]
        })
        .collect();
    let plate = FlexBodyBuilder::rectangle([1.0, 0.5], [12, 8])
        .small_strain()
        .material(LinearElastic::plane_stress(1e4, 0.3).density(10.0))
        .contact_inertia(inertia)
        .velocities(velocities);
    if is_fixed {
        plate.pin_where(|[_, y]| y == 0.0, Pin::both())
    } else {
        plate.angvel(2.0)
    }
}

/// Positions after 1/2 s, at steps that rapier's precision holds exactly.
fn positions(builder: FlexBodyBuilder, dt: f64) -> Vec<f64> {
    let mut scene = explicit(Scene::new(dt));
    let body = scene.flexible(builder);
    scene.steps((0.5 / dt).round() as usize);
    scene.body(body).positions().to_vec()
}

/// Errors against the same mesh at a step 8 times finer than the finest: 1/64 of its error is left, or 1.6 % of an order
/// of .02.
#[test]
fn the_step_is_of_second_order() {
    for (is_fixed, inertia) in [
        (true, ContactInertia::Kept),
        (true, ContactInertia::Redistributed),
        (false, ContactInertia::Kept),
        (false, ContactInertia::Redistributed),
    ] {
        let at = |dt: f64| positions(plate(is_fixed, inertia.clone()), dt);
        let steps = [12, 13, 14].map(|power| 0.5f64.powi(power));
        let exact = at(0.5f64.powi(17));
        let errors = steps.map(|dt| {
            let off = at(dt)
                .iter()
                .zip(&exact)
                .map(|(a, b)| (a - b).powi(2))
                .sum::<f64>();
            off.sqrt()
        });
        let order = order(&steps, &errors);
        println!("{is_fixed} {inertia:?}: {errors:?}, order {order}");
        assert!((order - 2.0).abs() < 0.05, "order {order}: {errors:?}");
    }
}

/// Leapfrog keeps linear momentum and angular momentum exactly, turning frames and massless boundaries included.
#[test]
fn a_spinning_body_keeps_momentum_and_energy() {
    for inertia in [ContactInertia::Kept, ContactInertia::Redistributed] {
        let dt = 1.0 / 4096.0;
        let mut scene = explicit(Scene::in_free_space(dt));
        let body = scene.flexible(plate(false, inertia).linvel([0.3, -0.2]));
        let about = [0.0, 0.0];
        let momentum = scene.body(body).momentum();
        let angular = scene.body(body).angular_momentum(about);
        let start = scene.step().energy().total();
        let mut off = 0.0f64;
        for _ in 0..16000 {
            off = off.max((scene.step().energy().total() / start - 1.0).abs());
        }
        let body = scene.body(body);
        println!("turned {} rad, energy off {off}", body.angle());
        assert!(body.angle() > 6.0);
        for (end, start) in body.momentum().iter().zip(momentum) {
            assert!((end - start).abs() < 1e-11);
        }
        assert!((body.angular_momentum(about) - angular).abs() < 1e-11 * angular.abs().max(1.0));
        // The largest frequency is resolved by few steps: its energy swings by (ω dt)²/4 and does not drift.
        assert!(off < 0.01, "energy is off by {off}");
    }
}

/// A flexible plate and a rigid box meet in free space.
#[test]
fn a_body_and_a_rigid_box_that_collide_keep_momentum() {
    for inertia in [ContactInertia::Kept, ContactInertia::Redistributed] {
        let mut scene = explicit(Scene::in_free_space(1.0 / 4096.0));
        let body = scene.flexible(
            plate(false, inertia.clone())
                .translation([-0.5, 0.0])
                .friction(0.4),
        );
        let shape = ColliderBuilder::cuboid(real(0.3), real(0.2))
            .density(real(10.0))
            .friction(real(0.4));
        let at = RigidBodyBuilder::dynamic()
            .translation(vec2(0.15, -0.5))
            .linvel(vec2(0.0, 1.0));
        let (rigid, _) = scene.rigid(at, shape);
        let mass = scene.mass(rigid);
        let start = scene.body(body).momentum();
        let angular = scene.body(body).angular_momentum([0.0; 2]) + 0.15 * mass;
        let kinetic = scene.body(body).energy().kinetic + 0.5 * mass;
        let mut touched = 0;
        let mut most = 0.0f64;
        for _ in 0..6000 {
            let report = scene.step();
            touched += usize::from(!report.contacts().is_empty());
            if !report.contacts().is_empty() {
                let momentum = report.momentum();
                // Rapier's precision of the box's mass and motion is what is left when it is claimed.
                let close = by_precision(1e-6, 1e-11);
                assert!((momentum[0] - start[0]).abs() < close, "{momentum:?}");
                assert!(
                    (momentum[1] - start[1] - mass).abs() < close,
                    "{momentum:?}"
                );
                assert!(
                    (report.angular_momentum() - angular).abs() < by_precision(1e-5, 1e-10),
                    "{} {angular}",
                    report.angular_momentum()
                );
                most = most.max(report.energy().total() / kinetic);
            }
        }
        println!("{inertia:?}: touched in {touched} steps, energy at most {most}");
        assert!(touched > 5);
        assert!(most < 1.01, "energy {most}");
    }
}

fn rubber(side: usize) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 1.0], [side, side])
        .small_strain()
        .material(elastic(1e5, 1000.0, 2e-4).rayleigh_mass(10.0))
}

/// A step well below the critical one of [`rubber`] with 10 cells a side (s).
const SHORT: f64 = 1.0 / 2048.0;

/// The sum of the contact forces is the weight once vibrations have died out, whoever carries it: nodes without mass, nodes
/// with mass, and a rigid box on top.
#[test]
fn a_resting_body_and_a_box_on_it_press_with_their_weight() {
    for inertia in [ContactInertia::Redistributed, ContactInertia::Kept] {
        let mut scene = explicit(Scene::new(SHORT));
        let ground = scene.ground(0.5);
        let body = scene.flexible(rubber(10).contact_inertia(inertia).friction(0.5));
        let shape = ColliderBuilder::cuboid(real(0.3), real(0.1)).density(real(500.0));
        let (rigid, top) = scene.rigid(
            RigidBodyBuilder::dynamic().translation(vec2(0.5, 1.1)),
            shape,
        );
        let on_top = G * scene.mass(rigid);
        let weight = G * scene.body(body).mass() + on_top;
        scene.steps(16384);
        let below = -scene.force_on_collider(ground)[1] / weight;
        let above = scene.force_on_collider(top)[1] / on_top;
        println!(
            "below {below}, above {above}, kinetic {}",
            scene.report().energy().kinetic
        );
        // The body's damping leaves exp(-40) of its own motion; the box has none and settles through it, to some 1e-8 by now.
        assert!((below - 1.0).abs() < 1e-6, "{below}");
        assert!((above - 1.0).abs() < 1e-6, "{above}");
        assert!(scene.report().energy().kinetic < 1e-6 * weight);
    }
}

/// Coulomb: on ground of friction 0.3 a block that slides at 2 m/s stops after `v² / 2 μ g`; the block is stiff enough to slide
/// as one. Damping would drag it: none here.
#[test]
fn a_sliding_block_stops_where_friction_stops_it() {
    let dt = 1.0 / 8192.0;
    for inertia in [ContactInertia::Redistributed, ContactInertia::Kept] {
        let mut scene = explicit(Scene::new(dt));
        scene.ground(0.3);
        let body = scene.flexible(
            FlexBodyBuilder::rectangle([1.0, 0.5], [12, 6])
                .small_strain()
                .material(elastic(1e7, 1000.0, 5e-5))
                .contact_inertia(inertia)
                .friction(0.3)
                .linvel([2.0, 0.0]),
        );
        let start = scene.body(body).centre_of_mass()[0];
        scene.steps((1.5 / dt) as usize);
        let slid = scene.body(body).centre_of_mass()[0] - start;
        let exact = 4.0 / (2.0 * 0.3 * G);
        println!("slid {slid} of {exact}");
        // It bounces by micrometres at first and leans by its own height over length when it stops.
        assert!((slid / exact - 1.0).abs() < 0.02, "slid {slid} of {exact}");
        let rested = scene.body(body).centre_of_mass()[0];
        scene.steps((0.5 / dt) as usize);
        let crept = scene.body(body).centre_of_mass()[0] - rested;
        assert!(crept.abs() < 1e-4, "crept {crept}");
    }
}

/// The state is that of full steps: a new step length begins where the old one ended, and costs no accuracy.
#[test]
fn the_step_may_change_at_any_time() {
    let mut scene = explicit(Scene::in_free_space(1.0 / 4096.0));
    let body = scene.flexible(plate(false, ContactInertia::Redistributed));
    let start = scene.step().energy().total();
    let mut off = 0.0f64;
    for n in 0..8000 {
        scene.world.integration_parameters.dt = real(if n % 7 < 3 {
            1.0 / 4096.0
        } else {
            1.0 / 8192.0
        });
        off = off.max((scene.step().energy().total() / start - 1.0).abs());
    }
    println!(
        "energy off by {off}, factorizations {}",
        scene.report().n_factorizations()
    );
    assert!(off < 0.01, "energy off by {off}");
    assert!(scene.body(body).angle() > 2.0);
}

#[test]
fn a_step_beyond_the_critical_one_is_refused_unless_the_user_insists() {
    let mut scene = explicit(Scene::in_free_space(step_of(1.1)));
    let body = scene.flexible(bar().linvel([0.0, 1.0]));
    let frequency = scene.body(body).explicit_frequency();
    // The bar's last frequency is 2 c / h.
    assert!((frequency * step_of(1.0) / 2.0 - 1.0).abs() < 0.01);
    let error = scene.try_step().expect_err("the step is too long");
    let StepError::Integrator {
        source: IntegratorError::Unstable { critical, .. },
        ..
    } = &error
    else {
        panic!("{error}");
    };
    assert!((critical / step_of(1.0) - 1.0).abs() < 0.01);
    assert!(error.to_string().contains("critical step"), "{error}");
    scene.flex = std::mem::take(&mut scene.flex).insisting();
    assert!(scene.try_step().is_ok());
}

/// Damped bodies, by members that damp as well: what swings at the longest step dies out, and a longer one is refused.
#[test]
fn the_critical_step_of_damped_bodies_is_stable_for_every_member() {
    for beta1 in [0.5, 1.0, 1.5] {
        for damping in [0.0, 2e-3, 1e-2] {
            let integrator = Beta2::explicit(beta1).expect("in range");
            let body = || {
                FlexBodyBuilder::rectangle([1.0, 0.2], [10, 2])
                    .material(
                        LinearElastic::plane_stress(1e6, 0.3)
                            .density(1000.0)
                            .rayleigh(damping),
                    )
                    .small_strain()
                    .pin_where(|[x, _]| x == 0.0, Pin::both())
            };
            let critical = body().build().expect("a body").critical_step(&integrator);
            let mut scene = Scene::in_free_space(0.99 * critical);
            scene.world.gravity = vec2(0.0, -9.81);
            scene.flex = FlexPipeline::new().with_integrator(integrator);
            let beam = scene.flexible(body());
            for _ in 0..1500 {
                scene.step();
            }
            let tip = scene.body(beam).position(10)[1];
            assert!(tip.abs() < 1.0, "{beta1} {damping}: {tip} m");
            scene.world.integration_parameters.dt = real(1.01 * critical);
            let outcome = scene.flex.step(&mut scene.world, &mut scene.bodies);
            assert!(outcome.is_err(), "{beta1} {damping}");
        }
    }
}

#[test]
fn a_consistent_mass_is_refused_with_the_cure() {
    let mut scene = explicit(Scene::in_free_space(1e-4));
    scene.flexible(rubber(4).mass_kind(MassKind::Consistent));
    let error = scene
        .try_step()
        .expect_err("the mass couples the accelerations");
    assert!(error.to_string().contains("MassKind::Lumped"), "{error}");
}

/// Only the block of the massless nodes is ever factorized, and that once.
#[test]
fn the_mesh_is_never_factorized() {
    for (inertia, expected) in [
        (ContactInertia::Kept, 0),
        (ContactInertia::Redistributed, 1),
    ] {
        let mut scene = explicit(Scene::new(SHORT));
        scene.ground(0.5);
        scene.flexible(rubber(10).contact_inertia(inertia));
        let mut found = 0;
        for _ in 0..100 {
            found += scene.step().n_factorizations();
        }
        assert_eq!(found, expected);
    }
}

/// A light box on springs: `ω² = k / m` is beyond the step although the mesh alone is not.
#[test]
fn a_partner_too_light_for_the_step_is_refused_with_its_critical_step() {
    let mut scene = explicit(Scene::new(SHORT));
    scene.ground(0.5);
    scene.flexible(rubber(10));
    let shape = ColliderBuilder::cuboid(real(0.3), real(0.1)).density(real(0.01));
    let (light, _) = scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(0.5, 1.1)),
        shape,
    );
    let error = (0..1000).find_map(|_| scene.try_step().err());
    let error = error.expect("the box is a gram on springs of 1e5 N/m");
    assert!(
        error.to_string().contains("shorten the step below"),
        "{error}"
    );
    assert!(
        matches!(error, StepError::LightPartner { body, .. } if body == light),
        "{error:?}"
    );
}

/// A plate that hangs from a corner swings: its frame turns about the pin.
#[test]
fn a_hinged_body_swings_with_its_energy() {
    for inertia in [ContactInertia::Kept, ContactInertia::Redistributed] {
        let mut scene = explicit(Scene::new(1.0 / 8192.0));
        let body = scene.flexible(
            FlexBodyBuilder::rectangle([1.0, 0.5], [12, 8])
                .small_strain()
                .material(LinearElastic::plane_stress(1e5, 0.3).density(10.0))
                .contact_inertia(inertia)
                .pin_where(|at| at == [0.0, 0.5], Pin::both()),
        );
        let start = scene.step().energy().total();
        let scale = G * scene.body(body).mass() * 0.5;
        let mut off = 0.0f64;
        let mut lowest = 0.0f64;
        for _ in 0..16384 {
            let report = scene.step();
            off = off.max((report.energy().total() - start).abs() / scale);
            lowest = lowest.min(scene.body(body).angle());
        }
        println!("swung to {lowest} rad, energy off {off}");
        assert_eq!(scene.body(body).position(8 * 13), [0.0, 0.5]);
        // From level to as far beyond the lowest point: pi less twice the corner's angle.
        let exact = -(std::f64::consts::PI - 2.0 * 0.5f64.atan());
        assert!((lowest - exact).abs() < 0.01, "{lowest} of {exact}");
        assert!(off < 1e-3, "{off}");
    }
}

/// Many contacts with friction through a dense flexibility: the same motion by sweeps.
#[test]
fn gauss_seidel_slides_a_block_like_the_direct_solver() {
    let run = |solver: Method| {
        let mut scene = explicit(Scene::new(SHORT));
        scene.flex = scene.flex.with_contact_solver(solver);
        scene.ground(0.3);
        let body = scene.flexible(rubber(10).friction(0.3).linvel([0.5, 0.0]));
        scene.steps(400);
        scene.body(body).positions().to_vec()
    };
    let (direct, swept) = (run(Method::ActiveSet), run(Method::GaussSeidel));
    let off = direct
        .iter()
        .zip(&swept)
        .fold(0.0f64, |off, (a, b)| off.max((a - b).abs()));
    println!("off {off}");
    // 400 steps of positions known to 1e-11 m.
    assert!(off < 1e-8, "{off}");
}

/// Both surfaces without mass, and one of them with: momentum goes over to the last digit.
#[test]
fn two_explicit_bodies_that_collide_keep_momentum() {
    for upper in [ContactInertia::Redistributed, ContactInertia::Kept] {
        let mut scene = explicit(Scene::in_free_space(1.0 / 4096.0));
        let block = |inertia| {
            FlexBodyBuilder::rectangle([1.0, 0.5], [12, 8])
                .small_strain()
                .material(LinearElastic::plane_stress(1e4, 0.3).density(10.0))
                .contact_inertia(inertia)
                .friction(0.4)
        };
        let one = scene.flexible(block(ContactInertia::Redistributed));
        let other = scene.flexible(
            block(upper.clone())
                .translation([0.3, 0.51])
                .linvel([0.2, -0.5]),
        );
        let momentum = |scene: &Scene| {
            let (a, b) = (scene.body(one).momentum(), scene.body(other).momentum());
            [a[0] + b[0], a[1] + b[1]]
        };
        let angular = |scene: &Scene| {
            let about = [0.0; 2];
            scene.body(one).angular_momentum(about) + scene.body(other).angular_momentum(about)
        };
        let (start, turn) = (momentum(&scene), angular(&scene));
        let energy = scene.body(other).energy().kinetic;
        let (mut touched, mut most) = (0, 0.0f64);
        for _ in 0..3000 {
            let report = scene.step();
            touched += usize::from(!report.contacts().is_empty());
            most = most.max((report.energy().total() - report.energy().swing) / energy);
        }
        let end = momentum(&scene);
        println!(
            "{upper:?}: touched {touched}, energy at most {most}, angular {} {turn}",
            angular(&scene)
        );
        assert!(touched > 10);
        assert!(
            end.iter()
                .zip(start)
                .all(|(end, start)| (end - start).abs() < 1e-11),
            "{end:?}"
        );
        assert!((angular(&scene) - turn).abs() < 1e-10);
        assert!(most < 1.001, "energy {most}");
        assert!(scene.body(one).linvel()[1] < -0.1);
    }
}

/// Where an explicit body was, and whether it went on as numbers.
fn places(body: &FlexBody) -> Vec<[f64; 2]> {
    (0..body.n_nodes())
        .map(|node| body.position(node))
        .collect()
}

/// Bodies that spin faster than a step can follow, with boxes teleported into them: now and then no forces are found. Such a step is told of
/// as unfinished, and the body waits where it was, at rest.
#[test]
fn an_explicit_step_without_an_end_rests_where_it_began_and_the_next_one_goes_on() {
    let mut n_unfinished = 0;
    for seed in 0..60 {
        let mut dice = Dice(seed);
        let mut scene = explicit(Scene::new(SHORT));
        scene.ground(0.5);
        scene.fixed(ColliderBuilder::cuboid(0.1, 3.0).translation(vec2(1.5, 3.0)));
        let body = FlexBodyBuilder::rectangle([1.0, 0.5], [6, 3])
            .small_strain()
            .material(LinearElastic::plane_stress(1e5, 0.3).density(1000.0))
            .angvel(dice.between(-900.0, 900.0))
            .rotation(dice.between(0.0, 6.0))
            .linvel([dice.between(-200.0, 200.0), dice.between(-200.0, 0.0)])
            .translation([dice.between(-1.0, 1.0), dice.between(0.0, 2.0)]);
        let body = scene.flexible(body);
        let (intruder, _) = scene.rigid(
            RigidBodyBuilder::dynamic().translation(vec2(0.5, 1.1)),
            ColliderBuilder::cuboid(0.3, 0.3),
        );
        for step in 0..100 {
            if step % 20 == 10 {
                let [x, y] = scene.body(body).centre_of_mass();
                scene.world.bodies[intruder].set_translation(vec2(x, y), true);
            }
            let before = places(scene.body(body));
            let report = scene.try_step().expect("no step is refused");
            let is_held = report.n_unfinished() > 0;
            n_unfinished += report.n_unfinished();
            let after = places(scene.body(body));
            assert!(
                after.iter().flatten().all(|x| x.is_finite()),
                "seed {seed}, step {step}"
            );
            if is_held {
                // At rest but for half a step of its own forces, `v = dt/2 a`: the kinetic energy is the swing `dt²/8 a·M a`.
                let energy = *scene.report().energy();
                let beyond = scene.body(body).energy().kinetic - energy.swing;
                assert!(
                    beyond <= 1e-9 * energy.swing,
                    "seed {seed}, step {step}: held, with {beyond} J: {energy:?}"
                );
                let moved = before.iter().zip(&after).fold(0.0f64, |worst, (a, b)| {
                    worst.max((a[0] - b[0]).hypot(a[1] - b[1]))
                });
                assert!(moved < 1e-9, "held, and moved by {moved} m");
            }
        }
    }
    println!("{n_unfinished} of 6000 steps unfinished");
}
