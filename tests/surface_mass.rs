//! Bodies of small strain whose surface has mass while nothing touches it, and none while something does.

mod common;

use common::{Dice, Scene, is_solved, vec2};
use foil2d::prelude::*;
use foil2d::rapier::prelude::ColliderBuilder;

/// A bar without damping, ten times as long as high.
fn bar(divisions: [usize; 2], young: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 0.1], divisions)
        .small_strain()
        .material(LinearElastic::plane_stress(young, 0.3).density(1000.0))
}

/// Velocities that bend it, beside others of its centre.
fn bending(body: &FlexBody, [x, y]: [f64; 2]) -> Vec<[f64; 2]> {
    let nodes = body.mesh().nodes().iter();
    nodes
        .map(|place| [x, y + 0.05 * (1.0 - 12.0 * (place[0] - 0.5).powi(2))])
        .collect()
}

/// How high the middle of the lower side is above the line of its ends, step by step (m).
fn bends(scene: &mut Scene, body: FlexBodyHandle, n: usize) -> Vec<f64> {
    (0..n)
        .map(|_| {
            scene.step();
            let height = |node: usize| scene.body(body).displacement(node)[1];
            height(5) - 0.5 * (height(0) + height(10))
        })
        .collect()
}

/// In free flight the bar swings as one that keeps its mass, bit for bit, at the frequency of its mode.
#[test]
fn it_vibrates_as_without_contact_when_nothing_touches() {
    let dt = 1.0 / 2000.0;
    let swing = |inertia: ContactInertia| {
        let mut scene = Scene::in_free_space(dt).with_integrator(Beta2::trapezoidal());
        let builder = bar([10, 2], 1e7);
        let built = builder.clone().build().expect("a sound bar");
        let body = builder
            .contact_inertia(inertia)
            .velocities(bending(&built, [0.0; 2]));
        let body = scene.flexible(body);
        let modes = scene
            .body(body)
            .natural_modes(4, 1e-9)
            .expect("it has modes");
        let first = modes.frequencies()[3];
        (bends(&mut scene, body, 2000), first)
    };
    let (default, first) = swing(ContactInertia::Redistributed);
    let (kept, _) = swing(ContactInertia::Kept);
    assert_eq!(default, kept);
    // Zero crossings from below.
    let rises: Vec<f64> = (1..default.len())
        .filter(|&step| default[step - 1] < 0.0 && default[step] >= 0.0)
        .map(|step| step as f64 - default[step] / (default[step] - default[step - 1]))
        .collect();
    let periods = (rises.len() - 1) as f64;
    let period = dt * (rises[rises.len() - 1] - rises[0]) / periods;
    let found = std::f64::consts::TAU / period;
    // The trapezoidal rule draws periods out by (ω dt)²/12, 4e-4 here.
    assert!(
        (found / first - 1.0).abs() < 2e-3,
        "{found} of {first} rad/s"
    );
}

/// Energy that a vibrating bar has left of its vibration when it has flown past a pillar, near enough for a pair.
///
/// - `place`: of the pillar (m), which chooses the phases of the vibration.
fn left_behind_a_pillar(
    builder: FlexBodyBuilder,
    velocities: Vec<[f64; 2]>,
    place: f64,
    dt: f64,
) -> f64 {
    let mut scene = Scene::in_free_space(dt).with_integrator(Beta2::trapezoidal());
    scene.fixed(ColliderBuilder::cuboid(0.1, 0.5).translation(vec2(place, -0.512)));
    let body = scene.flexible(builder.velocities(velocities));
    let figures = |scene: &Scene| {
        let body = scene.body(body);
        let energy = body.energy();
        let [x, y] = body.linvel();
        let translation = 0.5 * body.mass() * (x * x + y * y);
        let spin = body.polar_moment() * body.angvel();
        (
            body.momentum(),
            spin,
            energy.kinetic + energy.elastic - translation,
        )
    };
    let (momentum, spun, before) = figures(&scene);
    let mut energy = before;
    let mut changes = 0;
    let mut had_mass = true;
    for _ in 0..(1.6 / dt) as usize {
        assert!(is_solved(scene.step()));
        assert!(
            scene.report().contacts().is_empty(),
            "it touches the pillar"
        );
        let has_mass = !scene.body(body).model().has_massless_nodes();
        changes += usize::from(has_mass != had_mass);
        had_mass = has_mass;
        let (now, spin, left) = figures(&scene);
        for (now, before) in now.into_iter().zip(momentum) {
            assert!(
                (now - before).abs() < 1e-9 * momentum[0],
                "{now} of {before}"
            );
        }
        assert!((spin - spun).abs() < 1e-9, "{spin} of {spun}");
        // A frame that turns keeps it to some 1e-5 in a step.
        assert!(left < (1.0 + 1e-3) * energy, "{left} J after {energy} J");
        energy = energy.min(left);
    }
    assert_eq!(changes, 2, "near the pillar, and away from it");
    energy / before
}

/// Momentum goes on from mass to mass, and energy never grows, whatever the step resolves; what it loses, the surface's own, is the less the finer the mesh.
#[test]
fn what_flies_past_keeps_momentum_and_gains_no_energy() {
    let dt = 1.0 / 500.0;
    let [coarse, fine] = [[10, 2], [20, 4]].map(|divisions| {
        let builder = bar(divisions, 1e7);
        let built = builder.clone().build().expect("a sound bar");
        left_behind_a_pillar(builder, bending(&built, [2.0, 0.0]), 2.0, dt)
    });
    println!("{coarse} {fine}");
    assert!(coarse > 0.95 && fine > 0.99);
    let mut dice = Dice(7);
    for young in [1e5, 1e6, 1e7, 1e8, 1e9, 1e10] {
        for dt in [1.0 / 500.0, 1.0 / 60.0] {
            for phase in 0..10 {
                // Every node by itself, which no step resolves.
                let mut own = |mean: f64| mean + dice.between(-5e-3, 5e-3);
                let velocities = (0..33).map(|_| [own(2.0), own(0.0)]).collect();
                let place = 1.6 + 0.05 * f64::from(phase);
                left_behind_a_pillar(bar([10, 2], young), velocities, place, dt);
            }
        }
    }
}
