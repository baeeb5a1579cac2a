//! Bodies that flow in a world: a bar shot at a wall, what is refused, rest and sleep.

use super::common::*;
use foil2d::body::BuildError;
use foil2d::fe::material::Rayleigh;
use foil2d::fe::material::hyperelastic::{Hencky, HyperelasticSolid, J2Plasticity};
use foil2d::fe::mesh::CellKind;

/// Like soft lead: 1000 kg/m³, E = 20 MPa, yields at 40 kPa.
fn lead() -> J2Plasticity {
    J2Plasticity::plane_strain(2e7, 0.35, 4e4).with_hardening(4e4)
}

fn bar(kind: CellKind, divisions: [usize; 2]) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle_of([0.2, 0.8], divisions, kind)
        .material(HyperelasticSolid::new(lead()).with_density(1000.0))
}

/// Widest place below a height above the lowest node (m), and the height of the body.
fn foot(body: &FlexBody, below: f64) -> [f64; 2] {
    let nodes = || body.positions().chunks_exact(2);
    let lowest = nodes().fold(f64::INFINITY, |least, x| least.min(x[1]));
    let highest = nodes().fold(f64::NEG_INFINITY, |most, x| most.max(x[1]));
    let near = || nodes().filter(|x| x[1] < lowest + below).map(|x| x[0]);
    let width = near().fold(f64::NEG_INFINITY, f64::max) - near().fold(f64::INFINITY, f64::min);
    [width, highest - lowest]
}

/// A bar of 0.2 x 0.8 m hits a rigid floor at 8 m/s (Taylor 1948): it is left with a foot, shorter, and flies off with little of its speed.
#[test]
fn a_bar_shot_at_a_wall_keeps_a_foot() {
    let mut scene = Scene::in_free_space(1.0 / 1000.0).with_integrator(Beta2::trapezoidal());
    scene.ground(0.0);
    let bar = scene.flexible(
        bar(CellKind::Tri6, [2, 8])
            .translation([-0.1, 0.002])
            .linvel([0.0, -8.0]),
    );
    let before = scene.body(bar).energy().kinetic;
    let mut flowed = 0.0;
    for _ in 0..150 {
        let report = scene.step();
        let energy = *report.energy();
        assert!(energy.flowed >= 0.0);
        flowed += energy.flowed;
        let account = energy.total() + energy.dissipated;
        assert!(
            (account / before - 1.0).abs() < 1e-9,
            "{account} of {before}"
        );
        // What is dissipated otherwise is taken, not given.
        assert!(energy.dissipated > flowed - 1e-9 * before);
        let body = scene.body(bar);
        assert!((body.plastic_dissipation() - flowed).abs() < 1e-12 * before);
    }
    let body = scene.body(bar);
    let [width, height] = foot(body, 0.1);
    assert!(width > 0.24 && height < 0.74, "{width} x {height}");
    assert!(flowed > 0.8 * before, "{flowed} of {before}");
    assert!(body.linvel()[1] > 0.0 && body.linvel()[1] < 2.0);
    let foot = body.plastic_strains(0);
    assert_eq!(foot.len(), 3);
    assert!(body.max_plastic_strain() > 0.3);
    let far = body.plastic_strains(31);
    assert!(
        far.iter()
            .all(|&strain| strain < 0.1 * body.max_plastic_strain())
    );
    // Stresses do not exceed what the most hardened place yields at, but for smoothing and the volume of the foot.
    let yields = lead().yield_stress_at(body.max_plastic_strain());
    let largest = body
        .von_mises()
        .expect("stresses")
        .into_iter()
        .fold(0.0, f64::max);
    assert!(largest < 1.2 * yields, "{largest} of {yields}");
}

/// No contact: kinetic, stored and dissipated energy are one number, spin and momentum stay.
#[test]
fn a_body_thrown_so_that_it_flows_accounts_for_its_energy() {
    let mut scene = Scene::in_free_space(1.0 / 1000.0).with_integrator(Beta2::trapezoidal());
    let velocities = |nodes: usize, place: &dyn Fn(usize) -> [f64; 2]| -> Vec<[f64; 2]> {
        (0..nodes)
            .map(|node| {
                let [x, y] = place(node);
                [4.0 * x - 6.0 * y, 6.0 * x + 8.0 * (y - 0.4) * y]
            })
            .collect()
    };
    let built = bar(CellKind::Tri6, [2, 8]).build().expect("a bar");
    let rest = |node: usize| built.position(node);
    let own = velocities(built.n_nodes(), &rest);
    let bar = scene.flexible(bar(CellKind::Tri6, [2, 8]).velocities(own));
    let before = scene.body(bar).energy().kinetic;
    let spin = scene.body(bar).angular_momentum([0.0; 2]);
    let (mut flowed, mut worst) = (0.0, 0.0f64);
    for _ in 0..200 {
        flowed += scene.step().energy().flowed;
        let body = scene.body(bar);
        let now = body.energy();
        worst = worst.max(((now.kinetic + now.elastic + flowed) / before - 1.0).abs());
        let error = body.angular_momentum([0.0; 2]) / spin - 1.0;
        assert!(error.abs() < 1e-10, "{error:e}");
    }
    assert!(worst < 1e-9, "{worst:e}");
    assert!(flowed > 0.05 * before, "{flowed} of {before}");
}

/// Laid down hard enough to flow, it comes to rest and sleeps as it is left.
#[test]
fn a_bar_that_was_dropped_sleeps_as_it_was_left() {
    let mut scene = Scene::new(1.0 / 240.0);
    scene.ground(0.5);
    let bar = scene.flexible(
        FlexBodyBuilder::rectangle_of([0.8, 0.2], [8, 2], CellKind::Tri6)
            .material(HyperelasticSolid::new(lead()).with_density(1000.0))
            .translation([0.0, 0.01])
            .linvel([0.0, -6.0]),
    );
    let mut n_steps = 0;
    while !scene.body(bar).is_sleeping(&scene.world.bodies) && n_steps < 2400 {
        scene.step();
        n_steps += 1;
    }
    let strain = scene.body(bar).max_plastic_strain();
    assert!(
        scene.body(bar).is_sleeping(&scene.world.bodies) && strain > 0.01,
        "{strain}"
    );
    for _ in 0..20 {
        assert_eq!(scene.step().energy().flowed, 0.0);
    }
    assert_eq!(scene.body(bar).max_plastic_strain(), strain);
}

#[test]
fn what_flows_is_refused_where_it_cannot() {
    let refused = bar(CellKind::Tri6, [1, 2]).small_strain().build().err();
    assert_eq!(
        refused,
        Some(BuildError::FlowSmallStrain {
            law: "J2 plasticity"
        })
    );
    let mut scene = Scene::in_free_space(1.0 / 1000.0);
    let body = scene.flexible(bar(CellKind::Tri6, [1, 2]));
    let other = HyperelasticSolid::new(lead().with_hardening(1.0)).with_density(1000.0);
    let elastic = HyperelasticSolid::new(Hencky::plane_strain(2e7, 0.35)).with_density(1000.0);
    let heavier = HyperelasticSolid::new(lead()).with_density(3000.0);
    let body = &mut scene.bodies[body];
    assert_eq!(
        body.set_material(other).err(),
        Some(BuildError::FlowChanged)
    );
    assert_eq!(
        body.set_material(elastic).err(),
        Some(BuildError::FlowChanged)
    );
    assert_eq!(body.set_material(heavier).err(), None);
    assert!((body.mass() - 3000.0 * 0.16).abs() < 1e-9);
    let soft = J2Plasticity::plane_strain(1e5, 0.3, -1.0);
    let built = FlexBodyBuilder::rectangle([1.0, 1.0], [1, 1])
        .material(HyperelasticSolid::new(soft).with_density(1.0));
    let told = built.build().err().map(|error| error.to_string());
    assert!(told.is_some_and(|text| text.contains("yield stress")));
    let elastic = FlexBodyBuilder::rectangle([1.0, 1.0], [1, 1])
        .material(LinearElastic::plane_strain(1e5, 0.3).density(1.0))
        .build()
        .expect("an elastic body");
    assert_eq!(
        (
            elastic.max_plastic_strain(),
            elastic.plastic_strains(0).len()
        ),
        (0.0, 0)
    );
}

/// What flows in the parts of a step has flowed at its end: the body keeps what the report tells.
#[test]
fn steps_in_parts_leave_what_flowed_in_each() {
    let mut most_parts = 0;
    for (rate, yields_at) in [(90.0, 4e4), (60.0, 1.5e4), (30.0, 5e3), (30.0, 4e4)] {
        let mut scene = Scene::new(1.0 / rate);
        scene.ground(0.0);
        let law = J2Plasticity::plane_strain(1e6, 0.3, yields_at).with_hardening(5e4);
        let block = scene.flexible(
            FlexBodyBuilder::rectangle([0.5, 0.5], [6, 6])
                .material(HyperelasticSolid::new(law).with_density(1000.0))
                .translation([0.0, 0.5])
                .friction(0.5)
                .linvel([0.3, -8.0])
                .rotation(0.05),
        );
        let before = scene.body(block).energy().kinetic;
        let mut flowed = 0.0;
        for _ in 0..60 {
            let report = scene.step();
            most_parts = most_parts.max(report.n_parts());
            flowed += report.energy().flowed;
            let own = scene.body(block).plastic_dissipation();
            assert!((own - flowed).abs() < 1e-9 * before, "{own} of {flowed}");
        }
    }
    assert!(most_parts > 1, "{most_parts}");
}

/// A cantilever of one four-node cell across flows and hardens as one of four, in steps whose tip is driven to five times its elastic deflection and back:
/// hardening counted for nothing where a cell flows in bending alone (a fifth of the force), and its plastic strain was told as 0.
#[test]
fn what_flows_in_the_bending_of_one_cell_hardens() {
    let (length, height) = (1.0, 0.1);
    let (young, poisson, density) = (1e8, 0.49, 1000.0);
    let law = |hardening: f64| {
        J2Plasticity::plane_strain(young, poisson, 1e-3 * young).with_hardening(hardening * young)
    };
    let stiffness = young / (1.0 - poisson * poisson);
    // Yield of the edge in plane strain, and the deflection there.
    let edge = 1e-3 * young / (1.0 - poisson + poisson * poisson).sqrt();
    let first = edge * height * height / 6.0 / length;
    let bending = stiffness * height.powi(3) / 12.0;
    let elastic = first * length.powi(3) / (3.0 * bending);
    let frequency = 3.516 * (bending / (density * height)).sqrt();
    let bent = |divisions: [usize; 2], hardening: f64| {
        let mut scene = Scene::in_free_space(1.0 / 240.0);
        let damping = Rayleigh {
            mass: 1.4 * frequency,
            stiffness: 0.0,
        };
        let metal = HyperelasticSolid::new(law(hardening))
            .with_density(density)
            .with_damping(damping);
        let bar = FlexBodyBuilder::rectangle_of([length, height], divisions, CellKind::Quad4)
            .material(metal)
            .pin_where(|[x, _]| x == 0.0, Pin::both())
            .pin_where(move |[x, _]| x == length, Pin::y());
        let bar = scene.flexible(bar);
        let tips: Vec<usize> = (0..scene.body(bar).n_nodes())
            .filter(|&node| scene.body(bar).mesh().nodes()[node][0] == length)
            .collect();
        let n = (4.0 * std::f64::consts::TAU / frequency * 240.0) as i32;
        let mut most = 0.0_f64;
        for step in 1..=n {
            let way = 5.0 * elastic * f64::from(step) / f64::from(n);
            for &node in &tips {
                let body = &mut scene.bodies[bar];
                body.set_pin_displacement(node, [0.0, -way]).expect("a pin");
            }
            scene.step();
            let forces = tips.iter().map(|&node| scene.body(bar).reaction(node)[1]);
            most = most.max(-forces.sum::<f64>());
        }
        let body = scene.body(bar);
        [
            most / first,
            body.max_plastic_strain(),
            body.plastic_dissipation(),
        ]
    };
    for hardening in [0.0, 0.02, 0.1] {
        let [coarse, fine] = [[20, 1], [80, 4]].map(|divisions| bent(divisions, hardening));
        println!("H = {hardening} E: {coarse:?}, {fine:?}");
        let off = (coarse[0] / fine[0] - 1.0).abs();
        assert!(off < 0.05, "H = {hardening} E: {coarse:?}, {fine:?}");
        let off = (coarse[1] / fine[1] - 1.0).abs();
        assert!(off < 0.2, "H = {hardening} E: {coarse:?}, {fine:?}");
    }
}
