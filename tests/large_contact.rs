//! Bodies of large strain in a pipeline: the steps they take by themselves, contact, what is conserved, and what is refused.

mod common;
#[path = "large_contact/round.rs"]
mod round;

use common::*;
use foil2d::body::BuildError;
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::{
    Corotated, Hyperelastic, HyperelasticSolid, NeoHookean, StableNeoHookean,
};
use foil2d::fe::material::{Material, Rayleigh};
use foil2d::fe::mesh::{CellKind, generate::rectangle};
use foil2d::fe::model::MassKind;
use foil2d::integrator::IntegratorError;
use foil2d::large::{LargeSettings, LargeStepper, WorldMotion};
use foil2d::pipeline::{Participant, Quality, StepError};

fn of_law(
    law: impl Hyperelastic + 'static,
    size: [f64; 2],
    divisions: [usize; 2],
) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle_of(size, divisions, CellKind::Tri6)
        .material(HyperelasticSolid::new(law).with_density(1000.0))
}

/// Brings bodies of half a metre and 1e5 Pa to rest within seconds.
fn settling() -> Rayleigh {
    Rayleigh {
        mass: 0.0,
        stiffness: 0.05,
    }
}

/// Tip down to -0.9 of the length: turns of more than a right angle.
#[test]
fn a_clamped_strip_swings_as_it_does_by_itself() {
    let (size, divisions) = ([1.0, 0.05], [20, 2]);
    let law = Corotated::plane_strain(1e6, 0.3);
    let mesh = rectangle(size, divisions, CellKind::Tri6).expect("a mesh");
    let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, 1000.0))
        .expect("a body");
    let mut motion = WorldMotion::at_rest(&model);
    let masses = model.masses().iter();
    let weight: Vec<f64> = masses.flat_map(|mass| [0.0, -G * mass]).collect();
    let settings = LargeSettings::conserving().with_tolerance(1e-10);
    let mut stepper = LargeStepper::new(model, settings).expect("sound settings");
    stepper.pin_where(|[x, _]| x == 0.0, Pin::both());

    let mut scene = Scene::new(1.0 / 60.0).with_integrator(Beta2::trapezoidal());
    let strip =
        scene.flexible(of_law(law, size, divisions).pin_where(|[x, _]| x == 0.0, Pin::both()));
    let mut lowest = 0.0f64;
    for step in 0..60 {
        stepper
            .step(scene.dt(), &weight, &mut motion)
            .expect("a step");
        scene.step();
        let pairs = scene.body(strip).positions().iter().zip(&motion.position);
        let apart = pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(apart < 1e-6, "{apart:e} m apart at step {step}");
        lowest = lowest.min(motion.position[41]);
    }
    assert!(lowest < -0.85, "the tip gets down to {lowest} m only");
}

fn spinning_plate(integrator: Beta2, young: f64) -> (Scene, FlexBodyHandle) {
    let mut scene = Scene::in_free_space(1.0 / 60.0).with_integrator(integrator);
    let plate = of_law(Corotated::plane_strain(young, 0.3), [1.0, 0.5], [4, 2]);
    let plate = scene.flexible(plate.linvel([0.3, -0.2]).angvel(5.0));
    (scene, plate)
}

/// 5 rad/s for 10 s. The plate starts unstretched: it vibrates all the way.
#[test]
fn a_free_plate_keeps_its_energy_and_its_momenta() {
    for young in [1e7, 1e5] {
        let (mut scene, plate) = spinning_plate(Beta2::trapezoidal(), young);
        let before = [
            energy_of(&scene),
            scene.body(plate).angular_momentum([0.0; 2]),
        ];
        let momentum = scene.body(plate).momentum();
        for _ in 0..600 {
            scene.step();
            let energy = energy_of(&scene);
            assert!((energy / before[0] - 1.0).abs() < 1e-6, "{energy} J");
            let spin = scene.body(plate).angular_momentum([0.0; 2]);
            // Without the turn that balances it the tolerance of the iterations leaves 1e-8.
            assert!((spin / before[1] - 1.0).abs() < 1e-11, "{spin} N m s");
            let now = scene.body(plate).momentum();
            let lost = (now[0] - momentum[0]).hypot(now[1] - momentum[1]);
            assert!(lost < 1e-9, "{lost:e} N s lost");
        }
    }
}

/// The default integrator takes vibrations, and nothing of the rotation.
#[test]
fn damping_by_the_step_does_not_brake_a_rotation() {
    let (mut scene, plate) = spinning_plate(Beta2::default(), 1e7);
    let before = scene.body(plate).angular_momentum([0.0; 2]);
    let mut energy = energy_of(&scene);
    for _ in 0..600 {
        scene.step();
        let now = energy_of(&scene);
        assert!(now < energy * (1.0 + 1e-6), "{energy} J, then {now} J");
        energy = now;
    }
    let after = scene.body(plate).angular_momentum([0.0; 2]);
    assert!(
        (after / before - 1.0).abs() < 1e-5,
        "{before}, then {after} N m s"
    );
    assert!(energy > 0.9 * 0.5 * 5.0 * before.abs(), "{energy} J left");
}

/// Falls by half its height, is crushed, and rests in the end on the ground that carries its weight.
#[test]
fn a_soft_block_falls_and_rests() {
    let mut findings = Findings::default();
    for (name, law) in [
        (
            "stable",
            Box::new(StableNeoHookean::plane_strain(1e5, 0.3)) as Box<dyn Hyperelastic>,
        ),
        ("logarithmic", Box::new(NeoHookean::plane_strain(1e5, 0.3))),
    ] {
        let mut scene = Scene::new(1.0 / 60.0);
        let ground = scene.ground(0.5);
        let solid = HyperelasticSolid::of(law.into()).with_density(1000.0);
        let block = scene.flexible(
            FlexBodyBuilder::rectangle_of([1.0, 1.0], [5, 5], CellKind::Tri6)
                .material(solid.with_damping(settling()))
                .translation([-0.5, 0.5])
                .rotation(0.1),
        );
        let mut onlooker = Onlooker::default();
        onlooker.watch(&mut scene, 600, |_| {});
        onlooker.check(&mut findings, name);
        onlooker.check_energy(&mut findings, name, 1000.0 * G * 0.5);
        let [x, y] = scene.force_on_collider(ground);
        let weight = 1000.0 * G;
        findings.check(
            (y / weight + 1.0).abs() < 1e-3 && x.abs() < 1e-3 * weight,
            || {
                format!(
                    "{name}: the ground carries {:.5} of the weight, {x:.2e} N aside",
                    -y / weight
                )
            },
        );
        let speed = scene.body(block).linvel();
        findings.check(speed[0].hypot(speed[1]) < 1e-4, || {
            format!("{name}: {speed:?} m/s")
        });
    }
    findings.report();
}

/// Two of large strain, one of small strain and a rigid one meet far from everything.
#[test]
fn collisions_keep_momentum_and_bring_no_energy() {
    let mut scene = Scene::in_free_space(1.0 / 120.0);
    let law = StableNeoHookean::plane_strain(2e5, 0.3);
    let soft = |x: f64, speed: f64| {
        of_law(law, [0.6, 0.6], [3, 3])
            .translation([x, 0.1 * x])
            .linvel([speed, 0.0])
            .angvel(-0.3 * speed)
    };
    scene.flexible(soft(-1.0, 3.0));
    scene.flexible(soft(0.0, 0.0));
    scene.flexible(
        FlexBodyBuilder::rectangle([0.6, 0.6], [3, 3])
            .material(elastic(1e7, 1000.0, 0.0))
            .translation([1.0, 0.2])
            .linvel([-2.0, 0.0]),
    );
    let ball = RigidBodyBuilder::dynamic()
        .translation(vec2(2.2, 0.4))
        .linvel(vec2(-4.0, 0.0));
    scene.rigid(ball, ColliderBuilder::ball(0.2).mass(200.0));
    let before = momentum_of(&scene);
    let energy = energy_of(&scene);
    let mut n_contacts = 0;
    for step in 0..240 {
        let report = scene.step();
        assert_eq!(report.quality(), Quality::Solved, "step {step}");
        n_contacts = n_contacts.max(report.contacts().len());
        let now = momentum_of(&scene);
        let lost = (now[0] - before[0]).hypot(now[1] - before[1]);
        let moved = before[0].abs().max(1000.0);
        assert!(
            lost < by_precision(1e-5, 1e-10) * moved,
            "{lost:e} N s lost by step {step}"
        );
        let rise = energy_of(&scene) / energy;
        assert!(rise < 1.0 + 1e-3, "{rise} of the energy at step {step}");
    }
    assert!(n_contacts > 2, "they met");
}

/// Stretched to twice its length between two grips that let it shrink: principal stresses are those of the law.
#[test]
fn stresses_of_a_stretched_strip_are_cauchys() {
    let law = StableNeoHookean::plane_strain(1e5, 0.3);
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let left = Pin { x: true, y: false };
    let solid = HyperelasticSolid::new(law).with_density(1000.0);
    let body = of_law(law, [1.0, 1.0], [2, 2])
        .material(solid.with_damping(settling()))
        .pin_where(|[x, _]| x == 0.0 || x == 1.0, left)
        .pin_where(|[x, y]| x == 0.0 && y == 0.0, Pin::both());
    let body = scene.flexible(body);
    for step in 1..=1200 {
        let way = (f64::from(step) / 600.0).min(1.0);
        let ends: Vec<usize> = (0..scene.body(body).n_nodes())
            .filter(|&node| scene.body(body).mesh().nodes()[node][0] == 1.0)
            .collect();
        let flexible = scene.bodies.get_mut(body).expect("it is there");
        for node in ends {
            flexible
                .set_pin_displacement(node, [way, 0.0])
                .expect("a pin");
        }
        scene.step();
    }
    // The stretch across is where the stress there vanishes.
    let across =
        |stretch: f64| foil2d::fe::material::hyperelastic::principal_stress(&law, [2.0, stretch]);
    let (mut low, mut high) = (0.3, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if across(middle)[1] < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let height = scene.body(body).position(scene.body(body).n_nodes() - 1)[1];
    let nominal = across(low)[0];
    let cauchy = nominal / low;
    for stress in scene.body(body).stress().expect("stresses") {
        let error = (stress.xx / cauchy - 1.0).abs();
        assert!(error < 1e-3, "{} Pa for {cauchy} Pa", stress.xx);
        assert!(stress.yy.abs() < 1e-3 * cauchy && stress.xy.abs() < 1e-3 * cauchy);
    }
    assert!(height < 1.0, "{height}");
    let pull: f64 = (0..scene.body(body).n_nodes())
        .filter(|&node| scene.body(body).mesh().nodes()[node][0] == 1.0)
        .map(|node| scene.body(body).reaction(node)[0])
        .sum();
    assert!(
        (pull / nominal - 1.0).abs() < 1e-3,
        "{pull} N for {nominal} N"
    );
}

#[test]
fn a_mirrored_impact_is_the_impact_mirrored() {
    let run = |side: f64| {
        let mut scene = Scene::new(1.0 / 120.0);
        scene.ground(0.5);
        let law = StableNeoHookean::plane_strain(1e5, 0.3);
        let disc = FlexBodyBuilder::disc(0.4, 0.2)
            .material(HyperelasticSolid::new(law).with_density(1000.0))
            .translation([0.0, 0.7])
            .linvel([side * 2.0, -3.0])
            .angvel(-side);
        let disc = scene.flexible(disc);
        scene.steps(60);
        scene.body(disc).centre_of_mass()
    };
    let ([x, y], [mirrored_x, mirrored_y]) = (run(1.0), run(-1.0));
    // The mesh of a disc is no mirror image of itself: its discretization shows, nothing else may.
    assert!((x + mirrored_x).abs() < 0.02, "{x} and {mirrored_x}");
    assert!((y - mirrored_y).abs() < 0.02, "{y} and {mirrored_y}");
}

/// A material of which nobody has said what it does at large strain.
#[derive(Debug)]
struct Stranger;

impl Material for Stranger {
    fn density(&self) -> f64 {
        1000.0
    }

    fn stress(&self, strain: [f64; 3]) -> [f64; 3] {
        strain.map(|strain| 1e6 * strain)
    }

    fn tangent(&self, _: [f64; 3]) -> [[f64; 3]; 3] {
        [[1e6, 0.0, 0.0], [0.0, 1e6, 0.0], [0.0, 0.0, 1e6]]
    }

    fn energy_density(&self, strain: [f64; 3]) -> f64 {
        strain.iter().map(|strain| 0.5e6 * strain * strain).sum()
    }

    fn out_of_plane_stress(&self, _: [f64; 3]) -> f64 {
        0.0
    }

    fn wave_speed(&self) -> f64 {
        40.0
    }

    fn is_linear(&self) -> bool {
        true
    }
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let law = Corotated::plane_strain(1e6, 0.3);
    let body = || of_law(law, [1.0, 0.2], [4, 1]);
    let refused = body().mass_kind(MassKind::Consistent).build();
    assert!(
        matches!(refused, Err(BuildError::LargeConsistent)),
        "{refused:?}"
    );
    let refused = FlexBodyBuilder::rectangle([1.0, 0.2], [4, 1])
        .material(Stranger)
        .large_strain()
        .build();
    let lawless = |refused: Result<FlexBody, BuildError>, expected: Option<u32>, name: &str| {
        let error = refused.expect_err("it has no law");
        let BuildError::NoLargeLaw { material, region } = &error else {
            panic!("{error}");
        };
        assert!(material.contains(name) && *region == expected, "{error}");
        let said = error.to_string();
        assert!(
            said.contains(name) && said.contains(".small_strain()"),
            "{said}"
        );
    };
    lawless(refused, None, "Stranger");
    // Nobody has said that the body is to bend little, and nothing that was asked for says so.
    let strange = || FlexBodyBuilder::rectangle([1.0, 0.2], [4, 1]).material(Stranger);
    lawless(strange().build(), None, "Stranger");
    assert!(strange().small_strain().build().is_ok());
    assert!(strange().mass_kind(MassKind::Consistent).build().is_ok());
    let moved = ContactInertia::RedistributedAt(vec![0]);
    assert!(strange().contact_inertia(moved).build().is_ok());
    let auxetic = || LinearElastic::plane_stress(1e6, -0.6).density(1.0);
    lawless(strange().material(auxetic()).build(), None, "-0.6");
    let halves = || body().regions_by(|[x, _]| u32::from(x > 0.5));
    let refused = halves().region_material(1, Stranger).build();
    lawless(refused, Some(1), "Stranger");
    let mut whole = halves().build().expect("a body");
    let refused = whole.set_region_material(1, Stranger).map(|()| whole);
    lawless(refused, Some(1), "Stranger");
    let mut whole = body().build().expect("a body");
    let refused = whole.set_material(auxetic()).map(|()| whole);
    lawless(refused, None, "-0.6");
    let bare = HyperelasticSolid::new(law);
    let refused = FlexBodyBuilder::rectangle([1.0, 0.2], [4, 1])
        .material(bare)
        .build();
    assert!(
        matches!(refused, Err(BuildError::Material(_))),
        "{refused:?}"
    );
    let mut scene = Scene::new(1.0 / 60.0).with_integrator(Beta2::central_difference());
    scene.flexible(body());
    let refused = scene.try_step().map(|_| ());
    let is_it = matches!(
        refused,
        Err(StepError::Integrator {
            source: IntegratorError::LargeStrain,
            ..
        })
    );
    assert!(is_it, "{refused:?}");
}

/// What rests sleeps, and wakes under the forces that it slept with.
#[test]
fn a_block_at_rest_falls_asleep_and_wakes_without_a_start() {
    let mut scene = Scene::new(1.0 / 60.0);
    let ground = scene.ground(0.5);
    let law = NeoHookean::plane_strain(1e6, 0.3);
    let solid = HyperelasticSolid::new(law).with_density(1000.0);
    let block = FlexBodyBuilder::rectangle_of([0.6, 0.4], [3, 2], CellKind::Tri6)
        .material(solid.with_damping(Rayleigh {
            mass: 0.0,
            stiffness: 2e-3,
        }))
        .translation([0.0, 0.05]);
    let block = scene.flexible(block);
    let mut n_steps = 0;
    while scene.report().n_asleep() == 0 {
        scene.step();
        n_steps += 1;
        assert!(n_steps < 1200, "awake after 20 s");
    }
    scene.steps(10);
    scene.bodies.get_mut(block).expect("it is there").wake_up();
    let weight = 0.24 * 1000.0 * G;
    for step in 0..20 {
        scene.step();
        let [_, y] = scene.force_on_collider(ground);
        assert!(
            (y / weight + 1.0).abs() < 1e-4,
            "{y} N of {weight} N in step {step}"
        );
    }
}

/// Pins that move take the body along, in whatever parts the step is taken. Its ends come to lie in one another: it is a sensor, which does not
/// meet itself.
#[test]
fn a_strip_is_bent_by_its_pins() {
    let law = Corotated::plane_strain(1e6, 0.3);
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let strip =
        of_law(law, [1.0, 0.05], [16, 1]).pin_where(|[x, _]| x == 0.0 || x == 1.0, Pin::both());
    let strip = scene.flexible(strip.sensor(true));
    let ends: Vec<(usize, [f64; 2])> = scene
        .body(strip)
        .mesh()
        .nodes()
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, [x, _])| *x == 1.0)
        .collect();
    // The right end goes round by half a turn about the middle of the strip and is turned by as much.
    for step in 1..=240 {
        let angle = std::f64::consts::PI * (f64::from(step) / 200.0).min(1.0);
        for &(node, [x, y]) in &ends {
            let arm = [x - 0.5, y - 0.025];
            let to = [
                0.5 + angle.cos() * arm[0] - angle.sin() * arm[1],
                0.025 + angle.sin() * arm[0] + angle.cos() * arm[1] + 0.3 * angle.sin(),
            ];
            let body = scene.bodies.get_mut(strip).expect("it is there");
            body.set_pin_displacement(node, [to[0] - x, to[1] - y])
                .expect("a pin");
        }
        let report = scene.step();
        assert_eq!(report.quality(), Quality::Solved, "step {step}");
    }
    let body = scene.body(strip);
    for &(node, [x, y]) in &ends {
        let at = body.position(node);
        let to = [1.0 - x, 0.05 - y];
        assert!(
            (at[0] - to[0]).hypot(at[1] - to[1]) < 1e-12,
            "{at:?} for {to:?}"
        );
    }
    assert!(body.energy().elastic > 0.0 && body.energy().elastic.is_finite());
}

/// A stiff block vibrates at what the step does not resolve while it hits the ground on its corner: impulses that answered the alternating
/// velocity of a node would throw it.
#[test]
fn impulses_do_not_answer_what_the_step_does_not_resolve() {
    let law = NeoHookean::plane_strain(2e8, 0.3);
    // Which damps nothing of it.
    let mut scene = Scene::new(1.0 / 60.0).with_integrator(Beta2::trapezoidal());
    scene.ground(0.5);
    let block = of_law(law, [0.8, 0.8], [6, 3])
        .translation([0.0, 1.0])
        .rotation(0.3);
    let n_nodes = block.clone().build().expect("a body").n_nodes();
    // By turns, within a cell: no momentum, and one tenth of the energy of the fall.
    let velocities = (0..n_nodes).map(|node| {
        if node % 2 == 0 {
            [0.9, -0.9]
        } else {
            [-0.9, 0.9]
        }
    });
    let block = scene.flexible(block.velocities(velocities.collect()));
    let total = |scene: &Scene| energy_of(scene);
    let before = total(&scene);
    let mut findings = Findings::default();
    let mut onlooker = Onlooker::default();
    let mut n_parts = 0;
    onlooker.watch(&mut scene, 240, |scene| n_parts += scene.report().n_parts());
    // Steps in which energy would be gained are taken in parts: 295 with the velocities as they are, 241 of 240 without.
    findings.check(n_parts <= 260, || format!("{n_parts} parts"));
    onlooker.check(&mut findings, "block");
    onlooker.check_energy(
        &mut findings,
        "block",
        before.abs().max(scene.body(block).mass() * G),
    );
    findings.report();
}

/// Crushed to half its height a surface folds (Biot, at a stretch of .54): there are more ends than one to a step then, and Newton's iterations go
/// from the one to the other. Such a step is cut before they are tried.
#[test]
fn a_crushed_block_costs_some_factorizations_a_step() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let law = NeoHookean::plane_strain(1.6e5, 0.15);
    scene.flexible(of_law(law, [0.55, 0.55], [5, 5]).friction(0.5));
    let (slab, _) = scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(0.275, 0.65)),
        ColliderBuilder::cuboid(0.3, 0.099).density(44_000.0),
    );
    let mut findings = Findings::default();
    let mut onlooker = Onlooker::default();
    let mut lowest = f64::INFINITY;
    onlooker.watch(&mut scene, 40, |scene| {
        lowest = lowest.min(place_of(&scene.world.bodies[slab])[1] - 0.099);
    });
    onlooker.check(&mut findings, "block");
    println!("lowest {lowest:.3} m, {:?}", onlooker.most_from(0));
    findings.check(lowest < 0.55 * 0.55, || {
        format!("it is crushed to {lowest:.3} m only")
    });
    // Some ten for each of up to thirty-two parts, with the folds held open by their guards; 24 for each pass of each part without.
    let most = onlooker.most_from(0).n_factorizations;
    findings.check(most < 500, || format!("{most} factorizations in a step"));
    findings.report();
}

/// A sheet of Hooke's law that sags by a hundredth of its length under its own weight: the two bodies are one. In quadrilaterals, and in plane stress.
#[test]
fn where_strains_are_small_a_body_of_large_strain_is_the_other_one() {
    let sheet = || {
        FlexBodyBuilder::rectangle([2.0, 0.1], [40, 2])
            .material(elastic(2e9, 1000.0, 0.02))
            .pin_where(|[x, _]| x == 0.0, Pin::both())
    };
    let [small, large] = [sheet().small_strain(), sheet().large_strain()].map(|builder| {
        let mut scene = Scene::new(1.0 / 60.0);
        let body = scene.flexible(builder);
        (0..600).for_each(|_| {
            scene.step();
        });
        let body = scene.body(body);
        let n_nodes = body.n_nodes();
        let tip = (0..n_nodes).map(|node| body.position(node)[1]);
        let stress = body.stress().expect("stresses");
        let bent = stress.iter().map(|stress| stress.xx.abs());
        let out = stress.iter().map(|stress| stress.zz.abs());
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        (
            tip.fold(f64::INFINITY, f64::min),
            most(&mut bent.into_iter()),
            most(&mut out.into_iter()),
        )
    });
    // q L⁴/8EI under 981 N/m: 1.18e-2 m.
    assert!((small.0 + 1.18e-2).abs() < 2e-4, "{small:?}");
    assert!(
        (large.0 - small.0).abs() < 1e-3 * small.0.abs(),
        "{large:?}, {small:?}"
    );
    assert!(
        (large.1 - small.1).abs() < 5e-3 * small.1,
        "{large:?}, {small:?}"
    );
    assert_eq!([small.2, large.2], [0.0; 2]);
}

/// A heavy box crushes a soft block to a few hundredths of its height. Under forces that are far from right the block's end is not found: it is led
/// there from the base of the path. Of 48 of these 128 scenes 11 had a step that was not finished without that. What is left comes and goes with
/// rounding: one or two scenes.
#[test]
fn soft_blocks_that_are_shot_at_seldom_stop_a_step() {
    let mut unfinished = Vec::new();
    for (speed, young) in [8.0, 12.0, 15.0, 20.0, 25.0, 32.0, 40.0, 60.0]
        .into_iter()
        .flat_map(|speed| [5e4, 1e5, 3e5, 1e6].map(|young| (speed, young)))
    {
        for (turn, size) in [(0.3, 0.08), (0.3, 0.15), (0.7, 0.08), (0.7, 0.15)] {
            let mut scene = Scene::new(1.0 / 60.0);
            scene.ground(0.5);
            let block = FlexBodyBuilder::rectangle([0.8, 0.3], [10, 4])
                .material(elastic(young, 500.0, 5e-3))
                .friction(0.5)
                .translation([-0.4, 0.001]);
            scene.flexible(block);
            let shot = RigidBodyBuilder::dynamic()
                .translation(vec2(0.1, 0.55))
                .rotation(real(turn))
                .linvel(vec2(0.0, -speed));
            let shape = ColliderBuilder::cuboid(real(size), real(size)).density(5000.0);
            scene.rigid(shot, shape.friction(0.5));
            for _ in 0..60 {
                let report = scene.try_step().expect("the step can be taken");
                assert!(report.quarantined_flex_bodies().is_empty());
                if report.quality() == Quality::Unfinished {
                    unfinished.push((speed, young, turn, size));
                }
            }
        }
    }
    unfinished.dedup();
    println!("{unfinished:?}");
    assert!(unfinished.len() <= 4, "{unfinished:?}");
}

/// Soft blocks are thrown at the ground and at stones beside them at hundreds of metres a second. Cells are all but flat then, and as much as 10^20
/// times as stiff as their masses are in a step: where impulses were sought with what rounding left of the masses, one of these scenes doubled its
/// energy in a step, and others gained 3 % in parts of one that were not solved.
#[test]
fn blocks_that_are_thrown_beyond_all_measure_gain_nothing() {
    let mut findings = Findings::default();
    let mut n_unfinished = 0;
    for seed in 0..160 {
        let mut dice = Dice(seed);
        let mut scene = Scene::new(dice.pick(&[1.0 / 240.0, 1.0 / 60.0, 1.0 / 30.0]));
        scene.ground(dice.between(0.0, 1.5));
        let [width, height] = [dice.between(0.3, 0.8), dice.between(0.2, 0.5)];
        let cells = [dice.pick(&[2, 3, 4]), dice.pick(&[2, 3])];
        let block = FlexBodyBuilder::rectangle([width, height], cells)
            .material(elastic(
                10f64.powf(dice.between(4.0, 6.0)),
                dice.between(200.0, 1500.0),
                0.0,
            ))
            .friction(dice.between(0.0, 1.5))
            .linvel([dice.between(-300.0, 300.0), -dice.between(200.0, 450.0)])
            .angvel(dice.between(-50.0, 50.0))
            .translation([-0.5 * width, 0.5]);
        scene.flexible(block);
        let mut stones = Vec::new();
        for side in [-1.0, 1.0] {
            let stone = RigidBodyBuilder::dynamic()
                .translation(vec2(side * dice.between(0.5, 1.0), 0.25))
                .rotation(real(dice.between(0.0, 1.5)))
                .linvel(vec2(-side * dice.between(0.0, 50.0), 0.0));
            let shape = ColliderBuilder::cuboid(real(0.2), real(0.2))
                .density(real(10f64.powf(dice.between(3.0, 6.0))));
            stones.push(scene.rigid(stone, shape.friction(0.5)));
        }
        let of_stone = |scene: &Scene, stone: RigidBodyHandle| {
            let body = &scene.world.bodies[stone];
            kinetic_of(body) + scene.mass(stone) * G * f64::from(body.center_of_mass().y)
        };
        let mut energy = energy_of(&scene);
        for step in 0..12 {
            let before = [0, 1].map(|k| of_stone(&scene, stones[k].0));
            let report = scene.try_step().expect("the step can be taken");
            n_unfinished += usize::from(report.quality() == Quality::Unfinished);
            let told = report.gap_violation();
            let touches = stones.iter().map(|&(_, collider)| {
                let stone = Participant::Rigid(collider);
                let mut contacts = report.contacts().iter();
                contacts.any(|one| one.contactor == stone || one.target == stone)
            });
            let touches: Vec<bool> = touches.collect();
            // Where rapier alone has put a stone on the ground, what that gains is not ours: 4 % of the energy of one of 19 t.
            for k in (0..2).filter(|&k| !touches[k]) {
                energy += (of_stone(&scene, stones[k].0) - before[k]).max(0.0);
            }
            let left = energy_of(&scene);
            findings.check(left < 1.01 * energy, || {
                format!("seed {seed}, step {step}: {left:e} J of {energy:e} J, {told:e} m")
            });
            energy = left;
        }
    }
    println!("{n_unfinished} steps unfinished");
    findings.report();
}

/// Two heavy boxes crush a soft block between them, in free space: led or not, nobody gains or loses momentum, and no step gains energy.
#[test]
fn what_is_crushed_in_free_space_keeps_the_momentum_of_all() {
    for (speed, young, turn) in [
        (20.0, 1e5, 0.3),
        (40.0, 1e5, 0.3),
        (40.0, 3e5, 0.7),
        (60.0, 3e5, 0.1),
    ] {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.world.gravity = vec2(0.0, 0.0);
        let block = FlexBodyBuilder::rectangle([0.8, 0.3], [10, 4])
            .material(elastic(young, 500.0, 5e-3))
            .friction(0.5)
            .translation([-0.4, -0.15]);
        let block = scene.flexible(block);
        let shots = [(0.1, 0.45, -speed, turn), (-0.05, -0.45, 0.8 * speed, -0.2)].map(
            |(x, y, v, turn)| {
                let shot = RigidBodyBuilder::dynamic()
                    .translation(vec2(x, y))
                    .rotation(real(turn))
                    .linvel(vec2(0.0, v));
                let shape = ColliderBuilder::cuboid(real(0.15), real(0.15)).density(5000.0);
                scene.rigid(shot, shape.friction(0.5)).0
            },
        );
        let momentum = |scene: &Scene| {
            let body = scene.body(block);
            let mut sum = body.linvel().map(|v| body.mass() * v);
            for shot in shots {
                let body = &scene.world.bodies[shot];
                let mass = f64::from(body.mass());
                for (sum, v) in sum.iter_mut().zip(velocity_of(body)) {
                    *sum += mass * v;
                }
            }
            sum
        };
        let began = momentum(&scene);
        let scale = f64::from(scene.world.bodies[shots[0]].mass()) * speed;
        let mut energy = energy_of(&scene);
        let mut n_parts = 0;
        for step in 0..60 {
            let report = scene.try_step().expect("the step can be taken");
            n_parts = n_parts.max(report.n_parts());
            let now = momentum(&scene);
            let off = [0, 1].map(|k| (now[k] - began[k]).abs() / scale);
            assert!(off[0].max(off[1]) < 1e-7, "step {step}: {off:?}");
            let left = energy_of(&scene);
            assert!(left < 1.001 * energy, "step {step}: {left} J of {energy} J");
            energy = left;
        }
        assert!(n_parts > 1, "it is crushed in parts of a step");
    }
}
