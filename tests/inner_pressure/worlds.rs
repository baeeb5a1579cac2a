//! Tyres and balloons in worlds: as blocks of islands, beside contact, sleep and pumps.

use crate::common::*;
use foil2d::body::BuildError;
use foil2d::fe::finite_strain::{FiniteStrainError, PressureError};
use foil2d::fe::material::Rayleigh;
use foil2d::fe::mesh::generate::annulus_divided;

/// A ring of soft rubber (plane strain, 1 MPa), .3 m inside.
fn balloon(wall: f64, edge: f64, damping: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::annulus(0.3, 0.3 + wall, edge).material(rubber().rayleigh(damping))
}

fn rubber() -> LinearElastic {
    LinearElastic::plane_strain(1e6, 0.4).density(1000.0)
}

/// What a world has of energy (J), without what constant pressures have done.
fn energy(scene: &Scene, body: FlexBodyHandle) -> f64 {
    let energy = scene.body(body).energy();
    energy.kinetic + energy.elastic
}

/// Free, spinning, breathing, under the rule that takes nothing: energy and spin to what the tolerance of the iterations leaves, momentum to rounding,
/// and what is told to be dissipated is none.
#[test]
fn a_free_tyre_keeps_its_energy_and_its_momenta() {
    for pressure in [
        InnerPressure::isothermal(3e4),
        InnerPressure::adiabatic(8e4, 1.4),
        InnerPressure::constant(3e4),
    ] {
        let integrator = Beta2::trapezoidal();
        let mut scene = Scene::in_free_space(1.0 / 120.0).with_integrator(integrator);
        let ring = balloon(0.03, 0.06, 0.0).inner_pressure(pressure);
        let ring = scene.flexible(ring.linvel([0.3, -0.2]).angvel(5.0));
        let start = scene.body(ring).positions().to_vec();
        let kept = |scene: &Scene| {
            let body = scene.body(ring);
            let model = body.large().expect("a body of large strain");
            energy(scene, ring) - model.pressure_work(&start, body.positions())
        };
        let spin = scene.body(ring).angular_momentum([0.0; 2]);
        let momentum = scene.body(ring).momentum();
        let first = kept(&scene);
        for step in 0..240 {
            scene.step();
            let error = (kept(&scene) / first - 1.0).abs();
            assert!(
                error < 1e-7,
                "{pressure:?}: {error:e} of the energy by step {step}"
            );
            let now = scene.body(ring).angular_momentum([0.0; 2]);
            let error = (now / spin - 1.0).abs();
            assert!(
                error < 1e-7,
                "{pressure:?}: {error:e} of the spin by step {step}"
            );
            let now = scene.body(ring).momentum();
            let lost = (now[0] - momentum[0]).hypot(now[1] - momentum[1]);
            assert!(lost < 1e-10 * scene.body(ring).mass());
        }
        let dissipated = scene.report().energy().dissipated;
        assert!(dissipated.abs() < 1e-7 * first, "{dissipated:e} of {first}");
    }
}

/// `P A` of what the body tells, in any step of a swing.
#[test]
fn what_is_told_of_a_gas_follows_its_law() {
    let mut scene = Scene::new(1.0 / 120.0);
    scene.ground(0.5);
    let gas = InnerPressure::isothermal(5e3);
    let ring = balloon(0.02, 0.06, 1e-3)
        .inner_pressure(gas)
        .translation([0.0, 0.6]);
    let ring = scene.flexible(ring.linvel([1.0, -4.0]));
    let rest = scene.body(ring).inner_area(0).expect("a hole");
    assert!((scene.body(ring).gas_pressure(0).expect("a hole") - 5e3).abs() < 1e-9);
    let product = (101_325.0 + 5e3) * rest;
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for _ in 0..120 {
        scene.step();
        let body = scene.body(ring);
        let area = body.inner_area(0).expect("a hole");
        let pressure = 101_325.0 + body.gas_pressure(0).expect("a hole");
        assert!((pressure * area / product - 1.0).abs() < 1e-14);
        (least, most) = (least.min(area), most.max(area));
    }
    assert!(most > 1.01 * least, "{least} {most}");
}

/// A plate of 150 N on a balloon whose skin is 5 mm thick: what carries it is the pressure over the length that is flat, less the weight of the skin there. Nodes amid that
/// length get `(p - ρ g h) l`; the skin's stiffness carries what is off over the two next to its ends.
#[test]
fn a_plate_lies_on_the_pressure_of_a_balloon() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let (skin, weight) = (0.005, 150.0);
    let mesh = annulus_divided(0.3, 0.3 + skin, [180, 2], CellKind::Quad4).expect("a ring");
    let ring = FlexBodyBuilder::mesh(mesh)
        .material(rubber().rayleigh(5e-3).rayleigh_mass(6.0))
        .friction(0.0)
        .friction_combine_rule(CoefficientCombineRule::Min)
        .inner_pressure(InnerPressure::isothermal(1.2e3))
        .translation([0.0, 0.3 + skin]);
    let ring = scene.flexible(ring);
    let (_, plate) = scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(0.0, 0.625 + 2.0 * skin))
            .locked_axes(LockedAxes::ROTATION_LOCKED | LockedAxes::TRANSLATION_LOCKED_X),
        ColliderBuilder::cuboid(1.0, 0.01).mass(real(weight / G)),
    );
    scene.steps(540);
    let pressure = scene.body(ring).gas_pressure(0).expect("a hole") - 1000.0 * G * skin;
    let [_, force] = scene.force_on_collider(plate);
    assert!((force / weight - 1.0).abs() < 1e-3, "{force} N");
    let mut touching: Vec<[f64; 2]> = (scene.report().contacts().iter())
        .filter(|contact| contact.position[1] > 0.3)
        .map(|contact| [contact.position[0], contact.normal_force])
        .collect();
    touching.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let n = touching.len();
    assert!(n >= 12, "{n} nodes touch");
    let length = touching[n - 1][0] - touching[0][0];
    let edge = length / (n - 1) as f64;
    // Every node carries an edge.
    let (carried, flat) = (force / pressure, length + edge);
    assert!(
        (carried - flat).abs() < edge,
        "{carried} m of {flat} m, edges of {edge} m"
    );
    for [x, force] in &touching[3..n - 3] {
        let expected = pressure * edge;
        assert!(
            (force / expected - 1.0).abs() < 0.02,
            "{force} N at {x}, not {expected}"
        );
    }
}

/// What a pump does is what the energy rises by: 10 strokes into a free ring that breathes, and a last valve that lets all out.
#[test]
fn a_pump_does_work_and_wakes() {
    let integrator = Beta2::trapezoidal();
    let mut scene = Scene::in_free_space(1.0 / 120.0).with_integrator(integrator);
    let ring = scene.flexible(balloon(0.03, 0.06, 0.0).large_strain());
    let mut pumped = 0.0;
    let mut most = 0.0f64;
    for stroke in 1..=10 {
        let gas = InnerPressure::isothermal(2e3 * f64::from(stroke));
        let body = scene.bodies.get_mut(ring).expect("it is there");
        pumped += body.set_inner_pressure(0, gas).expect("a gas");
        scene.steps(3);
        let now = energy(&scene, ring);
        most = most.max(now);
        assert!(
            (now - pumped).abs() < 1e-9 * most,
            "{now} J, pumped {pumped} J"
        );
    }
    assert!(pumped > 1.0);
    let body = scene.bodies.get_mut(ring).expect("it is there");
    let work = body.set_inner_pressure(0, InnerPressure::NONE);
    pumped += work.expect("a valve");
    assert!(pumped < most);
    scene.steps(30);
    let now = energy(&scene, ring);
    assert!(
        (now - pumped).abs() < 1e-8 * most,
        "{now} J, pumped {pumped} J"
    );
}

/// A tyre falls asleep on the ground, wakes when it is filled and sleeps again, larger.
#[test]
fn a_tyre_sleeps_until_it_is_filled() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let gas = InnerPressure::isothermal(1e4);
    // It would rock on for minutes on the corners of its mesh: air drags it.
    let dragged = rubber().rayleigh(1e-2).rayleigh_mass(4.0);
    let ring = balloon(0.03, 0.06, 0.0)
        .material(dragged)
        .inner_pressure(gas)
        .translation([0.0, 0.33]);
    let ring = scene.flexible(ring);
    let sleep = |scene: &mut Scene| {
        let fell = (0..1200).find(|_| {
            scene.step();
            scene.body(ring).is_sleeping(&scene.world.bodies)
        });
        fell.expect("it falls asleep")
    };
    sleep(&mut scene);
    let before = scene.body(ring).inner_area(0).expect("a hole");
    scene.steps(10);
    assert_eq!(scene.body(ring).inner_area(0), Ok(before));
    let body = scene.bodies.get_mut(ring).expect("it is there");
    let more = InnerPressure::isothermal(3e4);
    assert!(body.set_inner_pressure(0, more).expect("a gas") > 0.0);
    scene.step();
    assert!(!scene.body(ring).is_sleeping(&scene.world.bodies));
    sleep(&mut scene);
    assert!(scene.body(ring).inner_area(0).expect("a hole") > 1.02 * before);
}

/// At once, and by so much that the ring is half as large again: rings of a tenth to a hundredth of their radius.
#[test]
fn thin_rings_are_blown_up_at_once() {
    for wall in [0.03, 0.01, 0.003] {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.ground(0.5);
        // The skin carries μ h/R at most; in a vacuum nearly, so that the gas is soft.
        let pressure = 3.6e5 * wall / 0.3;
        for (place, gas) in [
            InnerPressure::isothermal(4.0 * pressure).outside(0.1 * pressure),
            InnerPressure::adiabatic(1.5e5, 1.4),
            InnerPressure::constant(0.8 * pressure),
        ]
        .into_iter()
        .enumerate()
        {
            let at = [3.0 * place as f64, 0.8];
            let ring = balloon(wall, 0.05, 2e-3)
                .inner_pressure(gas)
                .translation(at);
            scene.flexible(ring);
        }
        scene.steps(240);
        for (handle, body) in scene.bodies.iter() {
            let grown = body.inner_area(0).expect("a hole") / (std::f64::consts::PI * 0.09);
            assert!(grown > 1.2 && grown < 12.0, "{wall} {handle:?}: {grown}");
            let quiet = body.energy().kinetic / body.mass();
            assert!(quiet < 0.05, "{wall} {handle:?}: {quiet} J/kg");
        }
    }
}

#[test]
fn what_can_have_no_inner_pressure_is_refused_by_name() {
    let gas = InnerPressure::isothermal(1e4);
    let small = balloon(0.03, 0.06, 0.0).small_strain();
    let error = small
        .clone()
        .inner_pressure(gas)
        .build()
        .expect_err("small strain");
    assert_eq!(error, BuildError::PressureSmallStrain);
    let mut small = small.build().expect("a ring");
    assert_eq!(
        small.set_inner_pressure(0, gas),
        Err(BuildError::PressureSmallStrain)
    );
    assert_eq!(small.inner_area(0), Err(BuildError::PressureSmallStrain));
    let block = FlexBodyBuilder::rectangle([1.0, 1.0], [2, 2]).material(elastic(1e6, 1e3, 0.0));
    let error = block.inner_pressure(gas).build().expect_err("no hole");
    assert_eq!(error, BuildError::NoHole);
    let vacuum = balloon(0.03, 0.06, 0.0).inner_pressure(InnerPressure::isothermal(-2e5));
    let error = vacuum.build().expect_err("a vacuum");
    assert!(matches!(
        error,
        BuildError::Large(FiniteStrainError::Pressure(PressureError::Vacuum { .. }))
    ));
    let consistent = balloon(0.03, 0.06, 0.0).mass_kind(MassKind::Consistent);
    let error = consistent
        .inner_pressure(gas)
        .build()
        .expect_err("a consistent mass");
    assert_eq!(error, BuildError::LargeConsistent);
    let mut ring = balloon(0.03, 0.06, 0.0).build().expect("a ring");
    let missing = FiniteStrainError::Pressure(PressureError::Hole {
        hole: 1,
        n_holes: 1,
    });
    assert_eq!(ring.set_inner_pressure(1, gas), Err(missing.into()));
    assert_eq!(ring.gas_pressure(0), Ok(0.0));
    // Another material keeps the gas.
    ring.set_inner_pressure(0, gas).expect("a gas");
    let harder =
        HyperelasticSolid::new(StableNeoHookean::plane_strain(2e6, 0.3)).with_density(900.0);
    ring.set_material(harder.with_damping(Rayleigh::NONE))
        .expect("a law");
    assert!((ring.gas_pressure(0).expect("a hole") - 1e4).abs() < 1e-8);
}

/// A gas couples all nodes around its hole, and what it takes the place of did not: the island goes on, also where contacts are so many that its pattern is kept.
#[test]
fn a_gas_may_take_the_place_of_a_constant_pressure_under_a_pile() {
    let mut scene = Scene::new(1.0 / 120.0);
    let floor = ColliderBuilder::cuboid(5.0, 0.5).translation(vec2(0.0, -0.5));
    scene.fixed(floor);
    let ring = balloon(0.1, 0.1, 2e-3).inner_pressure(InnerPressure::constant(1e4));
    let ring = scene.flexible(ring.translation([0.0, 0.401]));
    for row in 0..8 {
        for column in 0..5 {
            let [x, y] = [f64::from(column) - 2.0, f64::from(row)];
            let at = vec2(0.11 * x + 0.01 * y, 0.9 + 0.11 * y);
            let cube = ColliderBuilder::cuboid(0.05, 0.05).density(100.0);
            scene.rigid(RigidBodyBuilder::dynamic().translation(at), cube);
        }
    }
    let mut most = 0;
    for pressure in [
        InnerPressure::isothermal(2e4),
        InnerPressure::constant(1e4),
        InnerPressure::adiabatic(2e4, 1.4),
    ] {
        scene.steps(60);
        most = most.max(scene.report().contacts().len());
        let body = &mut scene.bodies[ring];
        body.set_inner_pressure(0, pressure).expect("a pressure");
        scene.steps(2);
    }
    assert!(most > 40, "{most} contacts");
}
